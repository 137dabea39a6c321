/* points.h - all quadrature points of a drawing side by side, and the way back from forces on them to dofs:
 * for energies that are no sums over segments. */
#pragma once
#include "solve/bulk.h"
#include "spline/model.h"

/* Point q of segment m has number m rule->count + q. Arrays are [count]. The pen is round: beyond each end of
 * a stroke it covers half a disc, which counts as a further length `cap` of line at the last point. */
typedef struct SplinePoints {
    const SplineRule *rule;
    int count;
    double cap;
    double *x, *y;   /* r                                   */
    double *tx, *ty; /* t = r'                              */
    double *n;       /* |t|                                 */
    double *ink;     /* length of ink: the weight's part of n, and caps */
} SplinePoints;

/* Arrays for so many segments; the caller fills them by the functions below. */
SplinePoints spline_points_create(const SplineRule *rule, int segments, double cap);
void spline_points_clear(SplinePoints *points);

/* Points of a segment from its eight dofs; does its stroke begin, or end, with it? */
void spline_points_set(const SplinePoints *points, int segment, bool first, bool last, const double x[8]);

/* Points of all segments of the model. */
void spline_points_update(const SplinePoints *points, const SplineModel *model, const double *x);

/* What acts on the points: with E = f(ink), S = dE/d(length of ink) there at fixed place, and its derivatives
 * in the place. [count] each. */
typedef struct PointForces {
    double *S, *x, *y;
} PointForces;

PointForces point_forces_create(int count);
void point_forces_clear(PointForces *forces);

/* g += dE/dx, per segment N_k ink_q (x, y) + N'_k w_q S u; of all, and of one group of the model's: groups share no
 * dofs. */
void spline_points_add_gradient(const SplinePoints *points, const SplineModel *model,
                                const PointForces *forces, double *g);
void spline_points_add_group(const SplinePoints *points, const SplineModel *model, const PointForces *forces,
                             int group, double *g);

/* Points of a group. */
typedef struct SplineRange {
    int first, end;
} SplineRange;

SplineRange spline_group_points(const SplinePoints *points, const SplineModel *model, int group);

/* The 8x8 block that segments a and b have in common to a Hessian: at (dofs of a, dofs of b) and, transposed,
 * at (dofs of b, dofs of a); a == b: once, symmetric. They may share a node. */
void spline_add_block(const BulkMatrix *H, const SplineModel *model, int a, int b, const double block[64]);

/* A coupling of all pairs of segments (first of each: segment, then those coupled with it). */
typedef struct SegmentPairs {
    long count, room;
    int (*pairs)[2]; /* [count] */
    long *start;     /* what spline_pairs_coupling makes of them */
    int *dofs;
} SegmentPairs;

void spline_pairs_add(SegmentPairs *pairs, int a, int b);
BulkCoupling spline_pairs_coupling(SegmentPairs *pairs, const SplineModel *model);
void spline_pairs_clear(SegmentPairs *pairs);
