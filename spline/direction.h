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
    double detail; /* deviation of the Gaussian before the gradient; default 0.006      */
    double smooth; /* of the one over the structure tensor; default 0.02                */
    double spread; /* edges are followed so far where nothing contradicts; default 0.02 */
    double angle;  /* of strokes where the picture says nothing at all, rad; default 0  */
} SplineDirectionDef;

SplineDirectionDef spline_direction_default(void);

/* Along the edges and isophotes of a density (width 1; made with `extend`, so that a frame is no edge).
 *
 * The gradient's structure tensor, as the doubled angle z of the edges (|z| = |grad D|^2), is smoothed; where
 * it is strong and of one mind it is believed with the weight a = |z|/(<|grad D|^2> + noise), and the field u
 * = (cos 2 phi, sin 2 phi) minimises integral a |u - z/|z||^2 + spread^2 |grad u|^2 with free values at the
 * page's edges: flat parts take over the directions around them, creases become curves, and conflicts leave
 * |u| small [Knoeppel et al. 2013]. */
SplineField spline_direction_from_tone(const SplineField *tone, const SplinePage *page,
                                       const SplineDirectionDef *def);

/* One angle everywhere, rad, from x towards y (clockwise on paper, as y runs down). */
SplineField spline_direction_constant(const SplinePage *page, double angle);

/* From expressions of the vector's two components, of the variables x, y in units of the page; c = min(1,
 * length), so that a vector of zero leaves the place free. */
bool spline_direction_from_formula(Formula *formula, const SplinePage *page, SplineField *direction,
                                   Error *err);

/* The unit vector v at a place; *coherence may be NULL. */
Vec2 spline_direction_at(const SplineGrid *direction, const SplinePage *page, Vec2 at, double *coherence);
