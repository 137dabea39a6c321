/* tone_hessian.h - second derivatives of tone: Gauss-Newton's K gain_c drho_c drho_c^T, summed over the
 * probes c, between all segments that share one or within each segment; and what the curvature of rho_c adds
 * to them. */
#pragma once
#include "spline/tone.h"

/* Which probes each segment is seen by, at some x and within a margin around it. */
typedef struct ToneCoupling {
    double margin;
    double *x, *y; /* [points] where the points stood; NULL: never yet                      */
    long *start;   /* [segments + 1] of each segment's sights                               */
    long *cell;    /* [start[segments]] index in the probes' arrays, segment by segment     */
    long *first;   /* [sights] where the cell's own list in `by_cell` begins, and its end   */
    long *end;
    long *by_cell; /* [sights] sights sorted by cell, in each by segment                    */
    int *segment;  /* [sights] of each sight                                                */
    SegmentPairs pairs;
} ToneCoupling;

/* Brings the lists up to date; false where no point has left the margin since they were made. */
bool tone_couple(ToneCoupling *coupling, const Tone *tone, const SplineModel *model,
                 const SplinePoints *points);
void tone_coupling_clear(ToneCoupling *coupling);

/* Between all segments. */
void tone_add_coupled(const ToneCoupling *coupling, const Tone *tone, const SplineModel *model,
                      const SplinePoints *points, double K, const BulkMatrix *H);

/* Within each segment. */
void tone_add_own(const Tone *tone, const SplineModel *model, const SplinePoints *points, double K,
                  const BulkMatrix *H);

/* The rest, within each segment by nature: not semidefinite. */
void tone_add_curvature(const Tone *tone, const SplineModel *model, const SplinePoints *points, double K,
                        const BulkMatrix *H);
