/* job.h - what a scene may ask for, one row each. */
#pragma once
#include "job/run.h"

typedef enum JobKind {
    JOB_EQUILIBRIUM,
    JOB_EVALUATE,
    JOB_DESIGN,
    JOB_SIMULATE,
    JOB_TRAJECTORY,
    JOB_INVERT,
    JOB_IDENTIFY,
    JOB_DRAW,
} JobKind;

extern const char *const job_names[]; /* by JobKind, NULL-terminated: the choices of the scene's key `job` */

/* Runs the scene's job: everything it acknowledges goes into the journal, its final arrays too. On
 * RUN_CANNOT_WRITE and RUN_REFUSED err says why, and nothing is written over an earlier result. */
RunStatus job_run(Run *run, Error *err);

/* The rows, each in its own file. */
RunStatus job_equilibrium(Run *run, Error *err);
RunStatus job_evaluate(Run *run, Error *err);
RunStatus job_design(Run *run, Error *err);
RunStatus job_simulate(Run *run, Error *err);
RunStatus job_trajectory(Run *run, Error *err);
RunStatus job_invert(Run *run, Error *err);
RunStatus job_identify(Run *run, Error *err);
RunStatus job_draw(Run *run, Error *err);

/* Of job_simulate, for rods with solver: pbd. */
RunStatus job_preview(Run *run, Error *err);
