/* pierce.h - what an obstacle goes through in a step of time: faces of a body, or elements of a rod.
 *
 * Seen from the obstacle, the corners of a face go straight from where the step begins to where it ends; all places of the
 * face on that way, a prism of space and time, are looked at. The obstacle has gone through it where one of them is deeper
 * than half its inradius and none was so deep before. So it is known of what lies between samples, and of what is on the
 * other side at the end of the step. A turn of the obstacle by more than half a radian in a step is too much to be seen so. */
#pragma once
#include "world/poses.h"
#include "world/samples.h"

typedef struct Pierced {
    int count;          /* pairs of an obstacle and a face */
    int obstacle, face; /* the first of them               */
} Pierced;

/* Between whole vectors `from` and `to`, of the poses' step; the faces' corners are those of the samples. */
Pierced pierce_find(const Poses *poses, const Samples *faces, const double *from, const double *to);
