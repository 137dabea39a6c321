/* segment.h - private to objectives: how far a point is from a segment. */
#pragma once
#include "base/vec3.h"
#include <math.h>

/* From the nearest point of a..b, which is `part` (0..1) of the way along, to q; t: the segment's direction where that is
 * inside it, else 0. */
static inline Vec3 from_segment(Vec3 a, Vec3 b, Vec3 q, Vec3 *t, double *part)
{
    Vec3 edge = vec3_sub(b, a), d = vec3_sub(q, a);
    double length2 = vec3_dot(edge, edge);
    *part = length2 > 0 ? vec3_dot(d, edge) / length2 : 0;
    *t = *part > 0 && *part < 1 ? vec3_scale(1 / sqrt(length2), edge) : vec3(0, 0, 0);
    *part = fmin(fmax(*part, 0), 1);
    return vec3_axpy(-*part, edge, d);
}
