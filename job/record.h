/* record.h - a run from its journal's beginning to its result, for whoever runs jobs. */
#pragma once
#include "job/run.h"

/* Begins the run's journal, or goes on with the run that it holds (resume): only the keys that its job leaves free may
 * have changed, and no file. Runs the job, writes the result and the further files that the scene names. On
 * RUN_REFUSED and RUN_CANNOT_WRITE err says why. */
RunStatus record_run(Run *run, bool resume, Error *err);
