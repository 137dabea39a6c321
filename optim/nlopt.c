/* NLopt's MMA [Svanberg 2002] and L-BFGS. Traps of 2.7.1: it asks for a gradient at every inner evaluation,
 * counts MAXEVAL as a success, and one NaN in a gradient silently ruins a run; so counting, stopping and the
 * best point are ours (best.h), and a failed simulation is +Inf with a zero gradient. */
#include "base/memory.h"
#include "optim/best.h"
#include <math.h>
#include <nlopt.h>
#include <stdio.h>
#include <string.h>

typedef struct Run {
    Best *best;
    nlopt_opt opt;
    double *gradient;
    bool begun;
} Run;

static double objective(unsigned n, const double *u, double *gradient, void *data)
{
    Run *run = data;
    Best *best = run->best;
    if (best_is_done(best)) return best->objective; /* asked once more after the stop */
    /* The start of L-BFGS after Gauss-Newton. Later on the same point counts: within very narrow bounds MMA asks for
     * one without end. */
    bool known = !run->begun && isfinite(best->objective) && !memcmp(u, best->u, n * sizeof *u);
    run->begun = true;
    double value = best->objective;
    if (known)
        memcpy(run->gradient, best->gradient, n * sizeof *gradient);
    else
        value = best_evaluate(best, u, run->gradient);
    if (gradient) memcpy(gradient, run->gradient, n * sizeof *gradient);
    if (best_is_done(best)) nlopt_force_stop(run->opt);
    return value;
}

static void run_algorithm(Best *best, double *u, nlopt_algorithm algorithm)
{
    const Problem *problem = best->problem;
    unsigned n = (unsigned)problem->n;
    Run run = {.best = best, .gradient = mem_alloc(n, sizeof(double))};
    run.opt = nlopt_create(algorithm, n);
    nlopt_set_min_objective(run.opt, objective, &run);
    nlopt_set_lower_bounds(run.opt, problem->lower);
    nlopt_set_upper_bounds(run.opt, problem->upper);
    double value;
    nlopt_optimize(run.opt, u, &value);
    nlopt_destroy(run.opt);
    mem_free(run.gradient);
    if (!best_is_done(best)) best->info.status = OPTIMISER_STALLED;
}

void mma_run(Best *best, double *u)
{
    run_algorithm(best, u, NLOPT_LD_MMA);
}

void lbfgs_run(Best *best, double *u)
{
    run_algorithm(best, u, NLOPT_LD_LBFGS);
}

const char *optimiser_nlopt_version(void)
{
    static _Thread_local char text[32];
    int major, minor, bugfix;
    nlopt_version(&major, &minor, &bugfix);
    snprintf(text, sizeof text, "%d.%d.%d", major, minor, bugfix);
    return text;
}
