/* slurm.h - a sweep's runs as job arrays of Slurm.
 *
 * A task does `slender sweep FILE --index N`, whose lock keeps any other one of that run away, and goes on with what a task
 * that was preempted has saved. Jobs have a name of the sweep's own, "slender-NAME-SUM+OFFSET": task t of it is run OFFSET + t,
 * from 1 on. What Slurm has under that name is asked of it before, so that nothing need be kept that a kill could lose. */
#pragma once
#include "base/error.h"
#include "sweep/sweep.h"

typedef struct SlurmDef {
    const Sweep *sweep;
    const char *const *options; /* of sbatch; ends with NULL */
    bool retry, force;          /* that tasks are to be given too */
} SlurmDef;

typedef struct SlurmTally {
    int submitted, waiting, held; /* given to Slurm; it had them already; under way elsewhere */
} SlurmTally;

/* The sweep's folder is there. Submits of those that were to be done, [runs], what Slurm does not have and what has neither ended nor begun elsewhere by
 * then. False and a sentence, after some perhaps. */
bool slurm_submit(const SlurmDef *def, const bool *todo, SlurmTally *tally, Error *err);
