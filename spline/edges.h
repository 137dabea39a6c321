/* edges.h - strokes along the edges of a tone, and along lines of equal tone.
 *
 * The tone is looked at through a Gaussian of the deviation `detail`. An edge is where its gradient is greatest along
 * itself: where D_gg, the second derivative in the gradient's direction, is 0 and falls along it [Haralick 1984; Canny
 * 1986], found to a part of a pixel as the isoline 0 of |grad D|^2 D_gg. Its height is that of the step of density whose
 * gradient, so blurred, is as steep. An edge is kept where its height is half the contrast or more, and all of the
 * contrast somewhere along it [Canny: hysteresis]. */
#pragma once
#include "spline/grid.h"
#include "spline/strokes.h"

typedef struct SplineEdgeDef {
    double detail;      /* in units of the page                                                        */
    double contrast;    /* of edges, in densities                                                      */
    double shortest;    /* lines that are shorter are left out                                         */
    double segment;     /* distance of nodes, about                                                    */
    double margin;      /* strokes keep so far from the page's edge, and inside of the outline         */
    SplineGrid outline; /* signed distances (contour.h); no columns: the page is the region; borrowed */
} SplineEdgeDef;

/* Appends strokes along the edges of a density (width 1; made with `extend`, so that its frame is no edge). */
void spline_edge_strokes(const SplineField *tone, const SplinePage *page, const SplineEdgeDef *def, int layer,
                         Strokes *strokes);

/* Appends strokes along the lines where a field, a density or a distance, is `level`, so blurred; contrast is not used. */
void spline_level_strokes(const SplineField *field, const SplinePage *page, const SplineEdgeDef *def,
                          double level, int layer, Strokes *strokes);
