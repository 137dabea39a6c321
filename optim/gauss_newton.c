/* Levenberg-Marquardt, matrix-free: min |r + J d|^2 + mu |d|^2 by conjugate gradients with products J^T J v,
 * mu down after a success and up after a failure, bounds by projection. It stalls where an equilibrium is
 * about to snap (J grows without limit in the soft mode): after three refused steps in a row L-BFGS goes on
 * from the best point. Constants measured in docs/optimisers.md. */
#include "base/memory.h"
#include "optim/best.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { CG_MAX = 60, REFUSED_MAX = 3, WINDOW = 4 };

static const double CG_TOL = 1e-2, DAMPING_FIRST = 1e-2, DAMPING_DOWN = 5, DAMPING_UP = 5, GAIN_MIN = 0.05;

typedef struct Cg {
    double *step, *residual, *direction, *product, *trial, *trial_gradient; /* [n] */
    bool *held; /* [n] at a bound, gradient outwards */
} Cg;

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* out = (J^T J) v over the free unknowns. F is the sum of squares, its gradient g = 2 J^T r, and products
 * come as 2 J^T J v. */
static void product(Best *best, const Cg *cg, const double *v, double *out)
{
    best->problem->product(best->problem->self, v, out);
    best->info.products++;
    for (int i = 0; i < best->problem->n; i++)
        if (cg->held[i]) out[i] = 0;
}

static void find_held(const Best *best, Cg *cg)
{
    const Problem *problem = best->problem;
    for (int i = 0; i < problem->n; i++)
        cg->held[i] = (best->u[i] <= problem->lower[i] && best->gradient[i] > 0) ||
                      (best->u[i] >= problem->upper[i] && best->gradient[i] < 0);
}

/* A lower bound of |2 J^T J|, which damping is measured in: g = 2 J^T r and F = |r|^2 give |g|^2 <= 4 |J|^2
 * F. */
static double curvature_scale(const Best *best, const Cg *cg)
{
    double sum = 0;
    for (int i = 0; i < best->problem->n; i++)
        if (!cg->held[i]) sum += best->gradient[i] * best->gradient[i];
    return sum / (2 * fabs(best->objective) + DBL_MIN);
}

/* (J^T J + damping) step = -gradient by conjugate gradients. */
static void solve_step(Best *best, Cg *cg, double damping)
{
    int n = best->problem->n;
    for (int i = 0; i < n; i++) {
        cg->step[i] = 0;
        cg->residual[i] = cg->direction[i] = cg->held[i] ? 0 : -best->gradient[i];
    }
    double size = dot(n, cg->residual, cg->residual), stop = CG_TOL * CG_TOL * size;
    for (int k = 0; k < CG_MAX && size > stop; k++) {
        product(best, cg, cg->direction, cg->product);
        for (int i = 0; i < n; i++) cg->product[i] += damping * cg->direction[i];
        double curvature = dot(n, cg->direction, cg->product);
        if (!(curvature > 0)) return;
        double a = size / curvature;
        for (int i = 0; i < n; i++) {
            cg->step[i] += a * cg->direction[i];
            cg->residual[i] -= a * cg->product[i];
        }
        double next = dot(n, cg->residual, cg->residual);
        for (int i = 0; i < n; i++) cg->direction[i] = cg->residual[i] + next / size * cg->direction[i];
        size = next;
    }
}

static void find_trial(Best *best, Cg *cg, double damping)
{
    const Problem *problem = best->problem;
    find_held(best, cg);
    solve_step(best, cg, damping);
    for (int i = 0; i < problem->n; i++)
        cg->trial[i] = fmin(fmax(best->u[i] + cg->step[i], problem->lower[i]), problem->upper[i]);
}

static void run(Best *best, Cg *cg, const double *u)
{
    const Problem *problem = best->problem;
    best_evaluate(best, u, cg->trial_gradient);
    if (!isfinite(best->objective)) return;
    find_held(best, cg);
    double damping = DAMPING_FIRST * curvature_scale(best, cg), history[WINDOW];
    for (int k = 0; k < WINDOW; k++) history[k] = INFINITY;
    for (int step = 0, refused = 0; refused < REFUSED_MAX && !best_is_done(best); step++) {
        double before = best->objective;
        if (!(before < (1 - GAIN_MIN) * history[step % WINDOW])) return;
        history[step % WINDOW] = before;
        if (!problem->recall(problem->self, cg->trial)) find_trial(best, cg, damping);
        bool better = best_evaluate(best, cg->trial, cg->trial_gradient) < before;
        if (!better)
            damping *= DAMPING_UP;
        else if (refused == 0)
            damping /= DAMPING_DOWN; /* after a refusal it stays: the model has just been found too bold */
        refused = better ? 0 : refused + 1;
    }
}

void gauss_newton_run(Best *best, double *u)
{
    size_t n = (size_t)best->problem->n;
    double *work = mem_alloc(6 * n, sizeof *work);
    Cg cg = {
        work, work + n, work + 2 * n, work + 3 * n, work + 4 * n, work + 5 * n, mem_alloc(n, sizeof(bool))};
    run(best, &cg, u);
    mem_free(work);
    mem_free(cg.held);
    if (!isfinite(best->objective) || best_is_done(best)) return;
    memcpy(u, best->u, n * sizeof *u);
    nlopt_run(best, u);
}
