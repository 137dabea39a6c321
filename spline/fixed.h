/* fixed.h - strokes that stay where they are, beside those that relax: contours. The tone counts their ink. */
#pragma once
#include "spline/strokes.h"
#include "spline/target.h"

typedef struct SplineFixed {
    const Strokes *strokes; /* borrowed; NULL: none                            */
    double pen;             /* width of their line, in units of the page       */
    double share;           /* of their ink that this target counts, 0 to 1    */
} SplineFixed;

/* What these strokes cover is asked of no others any more: takes the counted ink, as each probe sees it, out of what
 * the probe asks for, and out of the target's mean density. */
void spline_fixed_take_ink(const SplineFixed *fixed, SplineTarget *target);

/* The counted ink, as a length of lines of that pen. */
double spline_fixed_length(const SplineFixed *fixed, double pen);
