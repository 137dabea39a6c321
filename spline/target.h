/* target.h - what the strokes of a drawing are to look like: the page with its fields, made ready for
 * energies.
 *
 * density D is the part of the paper that ink covers, 0 to 1: lines at distance pen/D give it. align is a
 * symmetric matrix M (xx, xy, yy): a line of unit direction u costs u.M u, which takes no notice of the
 * line's sense. potential and flow are for the energies of Linewise. All but the density may be left out.
 * Without an outline the page is the region. */
#pragma once
#include "spline/grid_spline.h"
#include "spline/probes.h"

typedef struct SplineFields {
    SplineGrid density;   /* width 1 */
    SplineGrid align;     /* width 3 */
    SplineGrid potential; /* width 1 */
    SplineGrid flow;      /* width 2 */
    SplineGrid outline;   /* width 1, the signed distance from it (contour.h) */
} SplineFields;

typedef struct SplineTarget {
    SplinePage page;
    double density; /* mean over the page                            */
    double spacing; /* spline_line_distance of it                    */
    Probes *probes; /* of tone                                       */
    GridSpline *align, *potential, *flow, *outline;
} SplineTarget;

/* The grids are copied into what is made of them. */
SplineTarget *spline_target_create(const SplinePage *page, const SplineFields *fields, const ProbesDef *def);
void spline_target_destroy(SplineTarget *target);

/* Paper lighter than one line in a third of the page stays blank. */
static inline double spline_blank_density(const SplinePage *page)
{
    return page->pen / 0.3;
}

/* The mean distance of lines: pen/density, the mean over what is not blank; 0.3 where all is. */
double spline_line_distance(const SplineGrid *density, const SplinePage *page);

/* Length of segments that are to be so many line distances long: at most a 20th of the page, which has bends
 * too. */
static inline double spline_segment_length(double distances, double spacing)
{
    return fmin(distances * spacing, 0.05);
}

/* Length of all lines that give the mean density, and how many strokes of so many segments of length L0 that
 * is. */
double spline_ink_budget(const SplineTarget *target);
int spline_stroke_budget(const SplineTarget *target, int segments, double rest);
