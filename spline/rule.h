/* rule.h - quadrature along a segment, s in [0, 1], and the cubic basis at its points.
 *
 * r(s) = sum_k value[k] x_k over x = (p0, v0, p1, v1), the segment's dofs in their order; `first` and
 * `second` give r' and r'' [strokes.h]. */
#pragma once
#include <stdbool.h>

enum { RULE_MAX_GAUSS = 8, RULE_MAX_POINTS = 32 };

typedef struct SplineRule {
    int count;
    double s[RULE_MAX_POINTS], weight[RULE_MAX_POINTS]; /* weights sum to 1 */
    double value[RULE_MAX_POINTS][4], first[RULE_MAX_POINTS][4], second[RULE_MAX_POINTS][4];
} SplineRule;

/* Are there Gauss points for that count? 3, 4, 5 and 8. */
bool spline_rule_exists(int count);

/* Gauss-Legendre, exact to degree 2 count - 1. */
SplineRule spline_rule_gauss(int count);

/* No quadrature points but the four control points, with r' at thirds: where these are, in whose convex hull
 * the segment lies, none of it can be elsewhere. */
SplineRule spline_rule_hull(void);

/* So many places at equal steps of s, with both ends: the trapezoidal rule. 2 to RULE_MAX_POINTS. */
SplineRule spline_rule_even(int count);
