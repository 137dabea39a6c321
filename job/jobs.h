/* jobs.h - the jobs that fit more than one body: a row each, at the end of its file. A body's own jobs are in its front;
 * which jobs it has its row says (model/rows.h). */
#pragma once
#include "job/run.h"

extern const JobRow job_equilibrium, job_evaluate, job_design, job_simulate, job_trajectory;
extern const char *const job_simulate_free_keys[]; /* of other ways to simulate, too */
