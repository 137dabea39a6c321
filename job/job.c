#include "job/job.h"

const char *const job_names[] = {"equilibrium", "evaluate", "design", "simulate", "trajectory",
                                 "invert",      "identify", "draw",   NULL};

RunStatus job_run(Run *run, Error *err)
{
    static RunStatus (*const jobs[])(Run *, Error *) = {job_equilibrium, job_evaluate,   job_design,
                                                        job_simulate,    job_trajectory, job_invert,
                                                        job_identify,    job_draw};
    return jobs[run->scene->job](run, err);
}
