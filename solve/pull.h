/* pull.h - sums that many threads make, with the same bits however many they are.
 *
 * Whoever contributes to a target (a dof's gradient, an entry of the matrix) writes to a place of his own. Then each
 * target pulls what stands in its places, in their order. Ranges of targets are numbered tasks (base/workers.h). */
#pragma once

typedef struct Pull {
    int targets, ranges;
    int *first; /* [targets] the place that a target takes first; 0: it has none      */
    int *start; /* [ranges + 1] of each range's further places:                       */
    int *to;    /* [start[ranges]] target, ascending                                  */
    int *from;  /* [start[ranges]] place, ascending for each target                   */
} Pull;

/* target[places]: whose each place is; -1: nobody's. Place 0 is nobody's and must hold 0. */
Pull pull_create(int targets, int places, const int *target);
void pull_destroy(Pull *pull);

/* Sums of values[places] for the range's targets, over what stood there: that of target i goes to sums[where[i]], to
 * sums[i] where that is NULL. */
void pull_sum(const Pull *pull, int range, const double *values, const int *where, double *sums);
