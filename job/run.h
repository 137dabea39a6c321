/* run.h - a job on its way: model, journal and host. */
#pragma once
#include "base/memory.h"
#include "base/workers.h"
#include "io/journal.h"
#include "job/host.h"
#include "model/model.h"
#include "solve/newton.h"

typedef struct Run {
    const Scene *scene;
    Model *model;
    Journal *journal;
    const Host *host;
    const char *result; /* NAME.vtkhdf */
    int threads;
    Workers *side_by_side, **inside; /* run_share_threads */
    bool unsolved;                   /* nothing was found that could be drawn */
} Run;

/* Runs the scene's job: everything it acknowledges goes into the journal, its final arrays too. On RUN_CANNOT_WRITE and
 * RUN_REFUSED err says why, and nothing is written over an earlier result. */
RunStatus job_run(Run *run, Error *err);

/* The program and the libraries that it runs with, a line each. The caller frees. */
char *run_versions(void);

/* OpenBLAS's kernels that this run's numbers come from: of a run that goes on with others, a warning, and those before
 * too: "Haswell, SkylakeX". The caller frees. */
char *run_kernels(Run *run, Error *err);

/* Shares the run's threads out again: so many load cases are to be solved side by side, by the threads that are
 * returned (NULL: one after the other); those left over work inside their systems. */
Workers *run_share_threads(Run *run, int at_once);
void run_release_threads(Run *run);

/* Stops a solve after an interruption (Host.stop). */
NewtonObserver run_observer(Run *run);

/* Puts the scene's tolerances over the defaults. */
void run_newton(const Run *run, NewtonDef *def);

/* Is the state none of this body's (BodyOps.crushed)? Then says so, as its status does; `failed`: nothing was found beyond it. */
bool run_is_crushed(Run *run, Snapshot *shot, bool failed);

/* The lowest eigenvalues of a state whose first dofs are positions of the model's points, and so many modes and vibrations,
 * as final/..: for bodies (BodyOps.add_final). */
void run_add_stability(const Model *model, const Snapshot *shot, int modes, Arrays *list);

/* How a body vibrates about a state, undamped: so many frequencies and their modes, as final/..; its first dofs are
 * positions. Nothing where they are not found: the state is too unstable, or has no number. */
void run_add_vibrations(const Model *model, System *sys, const Point *at, int count, Arrays *list);

/* Of a solve that has failed: says which field has no value where the body was, or where it was going to be after a time dt
 * (0: statics), if that is so, as its status then does. */
void run_say_unknown_field(const Run *run, Snapshot *shot, double dt);

/* A frame of the result, shown at a time of its own: viewers want each frame's time to be later than that of
 * the one before. Parameters per face, which seldom change, are left out unless `whole`. */
bool run_put_frame(Run *run, int index, double shown, const Snapshot *shot, bool whole, Error *err);

/* To the arrays of the kind "final": final/.. and cases/<name>/..; the plain paths are those of the last
 * state. What a job puts there replaces all that an earlier end has left (arrays_replace). */
void run_add_final(Run *run, const Snapshot *shots, int count, const char *status, Arrays *list);

/* What a job goes on from, under the kind "state": vectors of numbers by name. */
typedef struct Kept {
    const char *name;
    double *values; /* [count] to be read, or filled */
    size_t count;
} Kept;

/* Puts all as one unit. */
bool run_put_state(Run *run, int index, const Kept *rows, int count, Error *err);

/* *has: all are there, each of its length. False and a sentence where the journal cannot be read. */
bool run_get_state(Run *run, int index, const Kept *rows, int count, bool *has, Error *err);

/* A block of p as an array of that name. */
Array run_block(const char *name, const ParamBlock *block, const double *p);
