/* curve.h - a smooth curve as a rod sees it: places and tangents at equal arclengths.
 *
 * A rod of N elements has 2 N + 1 stations: its nodes (even ones) and the middles of its elements (odd ones).
 */
#pragma once
#include "base/error.h"
#include "base/vec3.h"

typedef struct RodCurve {
    int elements;
    double length; /* m */
    Vec3 *x, *t;   /* [2 elements + 1] m, unit tangents; owned    */
    Vec3 *c;       /* [2 elements + 1] dt/ds, 1/m                 */
} RodCurve;

/* The place at parameter u; false where there is none. */
typedef bool RodCurvePoint(void *self, double u, Vec3 *x);

/* Reparametrises the curve from u0 to u1 by its arclength: to 1e-12 of its length where it is smooth
 * (composite Gauss quadrature of the speed, which comes from differences of eighth order; only places between
 * u0 and u1 are asked for, at 1024 equal steps or as many more as its waves need). False and a sentence where
 * a point is missing or not finite, where the curve stands still or turns back on itself, and where it has a kink or
 * waves that 131072 steps cannot follow. */
bool rod_curve_create(RodCurvePoint *point, void *self, double u0, double u1, int elements, RodCurve *curve,
                      Error *err);

/* The place at parameter u, dx/du and d2x/du2. */
typedef void RodCurveJet(void *self, double u, Vec3 jet[3]);

/* The same of a curve that knows its derivatives and is smooth on each of `pieces` equal parts of its range,
 * u from 0 to `pieces`: a spline whose u counts the knots. Where two pieces meet, the parameter's speed may
 * jump; place, tangent and curvature should not. */
bool rod_curve_create_pieces(RodCurveJet *jet, void *self, int pieces, int elements, RodCurve *curve,
                             Error *err);

/* What is said where a curve does; returns false. */
bool rod_curve_refuse_turn(Vec3 x, double length, Error *err);

void rod_curve_clear(RodCurve *curve);
