/* work.h - runs of a sweep as processes of their own, so many side by side: `slender run`, whose end, however bad, is that
 * of one run. What has finished is kept, what was interrupted goes on, what another process is at is left to it. */
#pragma once
#include "job/host.h"
#include "base/error.h"
#include "sweep/sweep.h"

typedef struct SweepWork {
    const Sweep *sweep;
    const Host *host;
    int jobs, threads; /* side by side, of each */
    bool retry, force; /* state_next */
} SweepWork;

typedef struct SweepTally {
    int converged, not_converged, failed, interrupted, held;
} SweepTally;

/* Counts a run that has ended with that code. */
void tally_add(SweepTally *tally, int code);

/* Does these runs, whose folder is there, and counts them: returns when all are done, or the host has stopped it and all is saved. False and a sentence where no run can be
 * started at all. */
bool work_run(const SweepWork *work, const int *runs, int count, SweepTally *tally, Error *err);
