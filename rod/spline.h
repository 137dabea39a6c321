/* spline.h - a quintic spline that smooths points. Private to samples.c.
 *
 * Minimises sum |x_i - f(u_i)|^2 + weight int |f'''|^2 du. The points' parameters are scaled so that the
 * knots are 1 apart on average, which makes the weight a pure number. There is a knot at every so many
 * points, not at equal parameters: each interval has points, and a curve may be sampled more densely where it
 * bends more.
 *
 * Solved by rotating the banded rows of points and penalty into a triangle [Lawson & Hanson 1974, ch. 27]
 * rather than by normal equations, so that any weight will do, from one that only settles what the points
 * leave open (1e-15) to one that leaves a parabola (intervals^6). The effective number of unknowns is the
 * trace of the influence matrix, from the band of the inverse [Hutchinson & de Hoog 1985]. All of it is
 * linear in the number of points. */
#pragma once
#include "base/vec3.h"

enum { ROD_SPLINE_ORDER = 6 };

typedef double RodSplineRow[ROD_SPLINE_ORDER];

typedef struct RodSpline {
    int points, intervals, coefficients; /* intervals + 5                                               */
    const Vec3 *x;                       /* [points] borrowed                                           */
    double *u;                           /* [points] owned, like all below                              */
    double *knots;                       /* [coefficients + 6], six at either end                       */
    Vec3 *c;                             /* [coefficients] from x[0]                                    */
    RodSplineRow *data, *penalty;        /* [coefficients] triangular: entries (k, k) .. (k, k + 5)     */
    RodSplineRow *factor;                /* the two with the weight                                     */
    Vec3 *data_right, *right;            /* [coefficients] right-hand sides of data and factor          */
    double beyond;                       /* sum of squares that no spline on these knots can reach, m^2 */
    double weight, squares, freedom;     /* of the last fit: sum |x_i - f(u_i)|^2, effective unknowns   */
} RodSpline;

/* u[points] does not decrease, starts with 0 and has three different values at least. */
RodSpline rod_spline_create(const double *u, const Vec3 *x, int points, int intervals);
void rod_spline_fit(RodSpline *spline, double weight);

/* A RodCurveJet in a parameter that counts the knots, from 0 to `intervals`. */
void rod_spline_jet(void *spline, double at, Vec3 jet[3]);

/* Sum of squares of the points' distances across the curve: the part along it only says where on the curve a
 * point belongs. */
double rod_spline_squares_across(const RodSpline *spline);

/* The farthest that a point is from where the spline should have it. */
double rod_spline_worst(const RodSpline *spline);

void rod_spline_clear(RodSpline *spline);
