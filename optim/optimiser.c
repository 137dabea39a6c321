#include "optim/optimiser.h"
#include "base/memory.h"
#include "base/vector.h"
#include "optim/best.h"
#include <float.h>
#include <math.h>
#include <string.h>

OptimiserDef optimiser_default(void)
{
    return (OptimiserDef){.method = OPTIMISER_MMA, .evaluations = 50, .gradient_tol = 1e-6};
}

const char *optimiser_status_name(OptimiserStatus status)
{
    static const char *const names[] = {"converged",  "max_iterations", "stalled",
                                        "stationary", "failed",         "stopped"};
    return names[status];
}

static Best create(const Problem *problem, const OptimiserDef *def)
{
    size_t n = (size_t)problem->n;
    return (Best){.problem = problem,
                  .def = def,
                  .u = mem_alloc(n, sizeof(double)),
                  .gradient = mem_alloc(n, sizeof(double)),
                  .objective = INFINITY,
                  .info = {.status = OPTIMISER_FAILED, .objective = INFINITY}};
}

static void destroy(Best *best)
{
    mem_free(best->u);
    mem_free(best->gradient);
}

bool best_is_held(const Problem *problem, int i, double at, double pull)
{
    return (at <= problem->lower[i] && pull < 0) || (at >= problem->upper[i] && pull > 0);
}

/* Norm of the gradient without what pushes against the bounds. */
static double projected_norm(const Problem *problem, const double *u, const double *gradient)
{
    double sum = 0;
    for (int i = 0; i < problem->n; i++)
        if (!best_is_held(problem, i, u[i], -gradient[i])) sum += gradient[i] * gradient[i];
    return sqrt(sum);
}

bool optimiser_is_zero(const double *gradient, int n, double objective)
{
    const double digits = 1e-12;
    double sum = 0;
    for (int i = 0; i < n; i++) sum += gradient[i] * gradient[i];
    return objective != 0 && sqrt(sum) <= digits * fabs(objective);
}

double best_evaluate(Best *best, const double *u, double *gradient)
{
    const Problem *problem = best->problem;
    double objective = problem->evaluate(problem->self, u, gradient);
    best->info.evaluations++;
    if (objective < best->objective) {
        best->objective = best->info.objective = objective;
        memcpy(best->u, u, (size_t)problem->n * sizeof *u);
        memcpy(best->gradient, gradient, (size_t)problem->n * sizeof *gradient);
        best->info.gradient_norm = projected_norm(problem, u, gradient);
        if (best->info.first_norm == 0) best->info.first_norm = best->info.gradient_norm;
        if (!best->succeeded) best->stationary = optimiser_is_zero(gradient, problem->n, objective);
        best->succeeded = true;
        problem->accept(problem->self);
    }
    if (!problem->go_on(problem->self)) best->stopped = true;
    return objective;
}

bool best_is_done(Best *best)
{
    OptimiserInfo *info = &best->info;
    if (best->stopped)
        info->status = OPTIMISER_STOPPED;
    else if (best->stationary)
        info->status = OPTIMISER_STATIONARY;
    else if (isfinite(best->objective) && info->gradient_norm <= best->def->gradient_tol * info->first_norm)
        info->status = OPTIMISER_CONVERGED;
    else if (info->evaluations >= best->def->evaluations)
        info->status = OPTIMISER_MAX_ITERATIONS;
    else
        return false;
    return true;
}

const char *const optimiser_names[] = {
    [OPTIMISER_MMA] = "mma", [OPTIMISER_LBFGS] = "lbfgs", [OPTIMISER_GAUSS_NEWTON] = "gauss_newton", NULL};

static void (*const runs[])(Best *best, double *u) = {
    [OPTIMISER_MMA] = mma_run, [OPTIMISER_LBFGS] = lbfgs_run, [OPTIMISER_GAUSS_NEWTON] = gauss_newton_run};

/* What is left of a sum of squares is less than the rounding of the unknowns makes: residuals are below `digits` of what a
 * unit of the scaled unknowns does to them, along the gradient; a linear model says the same of F. */
static bool is_rounding(const Best *best)
{
    const double digits = 16 * DBL_EPSILON;
    const Problem *problem = best->problem;
    int n = problem->n;
    double size = vector_dot(n, best->gradient, best->gradient), F = best->objective;
    if (!(F >= 0 && size > 0 && F <= digits * sqrt(size))) return false;
    double *product = mem_alloc((size_t)n, sizeof *product);
    problem->product(problem->self, best->gradient, 0, product);
    double along = vector_dot(n, best->gradient, product);
    mem_free(product);
    return along > 0 && F * size <= digits * digits * along;
}

OptimiserInfo optimise(const Problem *problem, const OptimiserDef *def, double *u)
{
    Best best = create(problem, def);
    for (int i = 0; i < problem->n; i++) u[i] = fmin(fmax(u[i], problem->lower[i]), problem->upper[i]);
    runs[def->method](&best, u);
    bool ended = best.info.status == OPTIMISER_STALLED || best.info.status == OPTIMISER_MAX_ITERATIONS;
    if (ended && isfinite(best.objective) && is_rounding(&best)) best.info.status = OPTIMISER_CONVERGED;
    OptimiserInfo info = best.info;
    if (!isfinite(best.objective))
        info.status = OPTIMISER_FAILED;
    else
        memcpy(u, best.u, (size_t)problem->n * sizeof *u);
    destroy(&best);
    return info;
}
