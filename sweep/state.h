/* state.h - what has become of a sweep's runs, by the files NAME/0001.* that they leave: .vtkhdf and .run, the run's own
 * (job/record.h); .lock, held while it is under way; .log, what it printed; .end, how it ended: its exit code, and of a
 * failure what it said last. */
#pragma once
#include "job/record.h"
#include "sweep/sweep.h"

typedef struct RunState {
    RecordState record;
    bool held;   /* it is under way */
    bool bare;   /* neither a journal nor a result: what else has its name is left of an earlier one */
    int code;    /* that it ended with, 128 + the signal that ended it; -1: it did not, or nobody saw it */
    char *said;  /* of a failure; NULL: nothing */
    Error wrong; /* of what is kept (record_is_kept) */
} RunState;

/* Of a scene that was loaded (sweep_load); clear it. */
RunState state_read(const Sweep *sweep, int run, const Scene *scene);
void state_clear(RunState *state);

bool state_is_failed(const RunState *state);

/* The option with which `slender run` is to do what there is to do; NULL: nothing. `retry`: go on with what has failed;
 * `force`: begin that anew, and what is of another scene. A result whose end nobody saw may lack the files beside it: it is
 * gone through again, which takes no time. In the sweep's folder files of a run that has neither journal nor result are the
 * sweep's own, and replaced. */
const char *state_next(const RunState *state, bool retry, bool force);

/* What there is to do of a run as it is now; *state: clear it. Where its scene is refused: nothing, with that code. */
const char *state_look(const Sweep *sweep, int run, bool retry, bool force, RunState *state);

/* "converged", "max_iterations", .. of a result; else "absent", "interrupted", "shorter", "running", "failed: 3", "changed", "damaged". The caller
 * frees. */
char *state_word(const RunState *state, const Sweep *sweep, int run);

/* Has any run left something in the sweep's folder? */
bool state_has_runs(const Sweep *sweep);

/* The folder of the results: made where it is not there. */
bool state_make_folder(const Sweep *sweep, Error *err);

/* The run begins: it has not ended. It has, with a code, and these words (NULL: none). */
void state_put_begin(const Sweep *sweep, int run);
bool state_put_end(const Sweep *sweep, int run, int code, const char *said, Error *err);
