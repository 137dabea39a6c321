/* streamlines.h - strokes to start a relaxation from: along the directions, with the ink that the tone asks
 * for.
 *
 * A density D drawn with a pen of width w takes lines of the total length mean(D)/w in a page of area 1 (the
 * budget; where it is not blank), less what fixed strokes have of it. Nodes of a stroke are equally far apart, about `segment`, with v a third of
 * that along the stroke. Blank paper (target.h) stays so. The
 * same seed gives the same strokes. */
#pragma once
#include "spline/fixed.h"
#include "spline/strokes.h"
#include <stdint.h>

typedef struct SplineStartDef {
    double separation; /* of neighbours, in units of w/D; default 0.86, near which the ink comes out right */
    double ink;     /* total length in units of the budget; default 1. Streamlines meet it within 3 %, or in
                     * three tries, by adapting the separation; 0: they take the separation as given */
    double longest; /* of a stroke, in units of the page; default 4, as good as any                 */
    double segment; /* distance of nodes; default 0: of 1.2 line distances, as RelaxDef.rest        */
    int segments;   /* of a random stroke; default 8                                                */
    uint64_t seed;  /* default 1                                                                    */
    SplineGrid outline; /* of the region (contour.h); default: no columns, the page is the region; borrowed */
    SplineFixed fixed;  /* strokes that are there, which streamlines keep away from; default: none */
} SplineStartDef;

SplineStartDef spline_start_default(void);

/* Evenly spaced streamlines [Jobard and Lefer 1997], appended: each new one starts beside one that exists and
 * is followed until it comes too near to another; long ones are then cut, at places that differ from
 * neighbour to neighbour, into strokes that leave a pen's width between them. */
void spline_streamlines(const SplineGrid *tone, const SplineGrid *direction, const SplinePage *page,
                        const SplineStartDef *def, int layer, Strokes *strokes);

/* Strokes of so many segments, or of all the ink, through random places, more where it is dark, until the ink
 * is used up; appended. Only an edge, blank paper or a singularity makes one shorter. */
void spline_random_strokes(const SplineGrid *tone, const SplineGrid *direction, const SplinePage *page,
                           const SplineStartDef *def, int layer, Strokes *strokes);
