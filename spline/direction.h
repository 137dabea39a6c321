/* direction.h - which way strokes run, at every place of the page.
 *
 * A direction is a line, not an arrow: it is kept as the tensor M = c (I - v v^T), entries xx, xy, yy, of the
 * unit vector v and the coherence c in 0..1, so that t^T M t = c sin^2 for a stroke's unit tangent t (the
 * energy `align`). c is 1 where the direction is sure and falls to 0 at singularities, where no direction is
 * right. */
#pragma once
#include "base/error.h"
#include "io/formula.h"
#include "io/image.h"
#include "spline/grid.h"

typedef struct SplineDirectionDef {
    double detail; /* deviation of the Gaussian before the gradient                                   */
    double smooth; /* of the one over the structure tensor                                            */
    double spread; /* over this distance sure directions are bent towards each other; more is calmer  */
    double angle;  /* of strokes on a picture without any edge, rad; default 0                        */
} SplineDirectionDef;

/* detail 1, smooth 3.3 and spread 5 widths of the pen, of one between 0.004 and 0.01 of the page: finer pens do not
 * follow what is no more than texture. */
SplineDirectionDef spline_direction_default(const SplinePage *page);

/* Along the edges and isophotes of a density (width 1; made with `extend`, so that its frame is no edge).
 *
 * The structure tensor of the gradient, as the doubled angle z of the edges (|z| = |grad D|^2), is smoothed,
 * and believed with the weight a = |z|/<|grad D|^2>, its coherence, times up to 5 where the edge is strong.
 * The unit field u = (cos 2 phi, sin 2 phi) then minimises integral a |u - z/|z||^2 + spread^2 |grad u|^2
 * (diffuse.h), free at the page's edges: flat parts take over what surrounds them, creases become bends, and
 * what is left of conflicts are points. Around these the last smoothing lets c = |u| fall to 0. */
SplineField spline_direction_from_tone(const SplineField *tone, const SplinePage *page,
                                       const SplineDirectionDef *def);

/* One angle everywhere, rad, from x towards y (clockwise on paper, as y runs down). */
SplineField spline_direction_constant(const SplinePage *page, double angle);

/* From expressions (formula_field.h) of the vector's two components, y down; c = min(1, length), so that a
 * vector of zero leaves the place free. */
bool spline_direction_from_formula(Formula *formula, const SplinePage *page, SplineField *direction,
                                   Error *err);

/* From a picture stretched over the page: its grey is the angle, black 0 .. white pi; or, of red, green and
 * blue, the vector (2R - 1, 2G - 1) with c = min(1, length). */
SplineField spline_direction_from_grey(const Image *image, const SplinePage *page);
SplineField spline_direction_from_rgb(const Image rgb[3], const SplinePage *page);

/* Turns every direction by an angle, rad. */
void spline_direction_turn(SplineField *direction, double angle);

/* The unit vector v at a place; *coherence may be NULL. */
Vec2 spline_direction_at(const SplineGrid *direction, const SplinePage *page, Vec2 at, double *coherence);
