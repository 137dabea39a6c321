/* NLopt's MMA [Svanberg 2002] and L-BFGS. Traps of 2.7.1: it asks for a gradient at every inner evaluation,
 * counts MAXEVAL as a success, and one NaN in a gradient silently ruins a run; so counting, stopping and the
 * best point are ours (best.h), and a failed simulation is +Inf with a zero gradient. */
#include "base/memory.h"
#include "optim/best.h"
#include <math.h>
#include <nlopt.h>
#include <stdio.h>
#include <string.h>

static const double LEAST_GRADIENT =
    1e-8; /* of F as NLopt sees it: its L-BFGS ends there, whatever F's unit is */

typedef struct Run {
    Best *best;
    nlopt_opt opt;
    double *gradient, scale; /* NLopt sees scale*F */
    bool begun;
} Run;

static double objective(unsigned n, const double *u, double *gradient, void *data)
{
    Run *run = data;
    Best *best = run->best;
    if (best_is_done(best)) return run->scale * best->objective; /* asked once more after the stop */
    /* The start of L-BFGS after Gauss-Newton. Later on the same point counts: within very narrow bounds MMA asks for
     * one without end. */
    bool known = !run->begun && isfinite(best->objective) && !memcmp(u, best->u, n * sizeof *u);
    run->begun = true;
    double value = best->objective;
    if (known)
        memcpy(run->gradient, best->gradient, n * sizeof *gradient);
    else
        value = best_evaluate(best, u, run->gradient);
    for (unsigned i = 0; gradient && i < n; i++) gradient[i] = run->scale * run->gradient[i];
    if (best_is_done(best)) nlopt_force_stop(run->opt);
    return run->scale * value;
}

static void run_scaled(Best *best, double *u, nlopt_algorithm algorithm, double scale)
{
    const Problem *problem = best->problem;
    unsigned n = (unsigned)problem->n;
    Run run = {.best = best, .gradient = mem_alloc(n, sizeof(double)), .scale = scale};
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
    run_scaled(best, u, NLOPT_LD_MMA, 1);
}

/* Where NLopt finds the gradient too small, it goes on from the best point with one of 1: by a power of two, which takes no
 * digits. */
void lbfgs_run(Best *best, double *u)
{
    double scale = 1;
    for (;;) {
        run_scaled(best, u, NLOPT_LD_LBFGS, scale);
        double norm = best->info.gradient_norm;
        if (best_is_done(best) || !isfinite(best->objective) || !(norm > 0) ||
            scale * norm > LEAST_GRADIENT * sqrt(best->problem->n))
            return;
        int exponent;
        frexp(norm, &exponent);
        scale = ldexp(1, -exponent);
        memcpy(u, best->u, (size_t)best->problem->n * sizeof *u);
    }
}

const char *optimiser_nlopt_version(void)
{
    static _Thread_local char text[32];
    int major, minor, bugfix;
    nlopt_version(&major, &minor, &bugfix);
    snprintf(text, sizeof text, "%d.%d.%d", major, minor, bugfix);
    return text;
}
