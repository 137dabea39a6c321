/* walls.h - the four edges of the page, and the outline of a region on it, as walls: what their energies
 * share. */
#pragma once
#include "spline/segment_term.h"

/* Sums over the walls of some function of the distance. */
typedef struct Barrier {
    Pack value;
    Pack2 slope;
    Pack xx, xy, yy; /* xy: of the outline alone, no edge is oblique */
} Barrier;

/* b(d) = -(1 - d/reach)^2 ln(d/reach) for d < reach, else 0, with its derivatives in d: C2, convex, and
 * infinite at the wall [Li 2020, incremental potential contact]. Not finite outside. */
Pack wall_barrier(Pack d, double reach, Pack *slope, Pack *curvature);

/* Distances of a point to the walls x = 0, x = width, y = 0, y = height, and their derivatives in x or y: 1
 * or -1. */
static inline void wall_distances(const SplinePage *page, Pack2 r, Pack distance[4])
{
    distance[0] = r.x, distance[1] = page->width - r.x;
    distance[2] = r.y, distance[3] = page->height - r.y;
}

/* Second derivatives of a function of the distance d, from its first two in d; semidefinite: those of d itself are
 * left out. */
void wall_curve(Barrier *barrier, Pack slope, Pack curvature, const GridSample *d, bool positive);

/* psi = R n b(r) */
Pack wall_psi_of(const SegmentTerm *term, double weight, const Barrier *barrier, const SegmentPoint *s,
                 int order, Psi *psi);

/* A term that is infinite outside of the page. */
Term wall_term_create(const TermOps *ops, const SplineModel *model, const SplineRule *rule,
                      SplineHessian hessian, SegmentPsi *psi);

/* The ops of both. */
#define WALL_OPS(row_name)                                                                                   \
    {                                                                                                        \
        .name = row_name, .count = segment_term_count, .size = segment_term_size, .dofs = segment_term_dofs, \
        .eval = segment_term_eval, .project = wall_project, .destroy = mem_free,                             \
    }

/* Takes a stroke so much of the way to where it is: the others' are as they are. */
void wall_shorten(const SplineModel *model, int stroke, const double *from, double *x, double part);

/* Of the way to a trial, no stroke goes further than nine tenths of the way to the wall, be it at a point of
 * the rule. Each stroke is stopped for itself, so that one at the edge does not hold up all others. */
void wall_project(const void *self, const double *from, double *x);
