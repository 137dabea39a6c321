/* Levenberg-Marquardt, matrix-free: min |r + J d|^2 + mu |d|^2 + nu |d|_S^2 by conjugate gradients with
 * products J^T J v, bounds by projection. Near a snap-through J grows without limit in the soft mode:
 * - the gradient is hardly anything else. Conjugate gradients that stop at a part of the gradient would move
 *   that mode alone, into the snap; so they go on until little of F is left to gain.
 * - a step is soon too long for that mode, and mu, which would shorten it, stops all others first. S measures
 *   steps in the state, soft modes most (Problem.product): after a refused step nu holds these and lets the
 *   others go.
 * mu and nu go down after a success and up after a failure. After some refused steps in a row, or successes
 * that bring little, L-BFGS goes on from the best point. Constants measured in docs/optimisers.md. */
#include "base/memory.h"
#include "optim/best.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { CG_MAX = 150, REFUSED_MAX = 6, WINDOW = 4 };

static const double CG_TOL = 1e-2, LEFT_MAX = 1e-2; /* parts of the gradient, and of F */
static const double MU_FIRST = 0.3, MU_UP = 1.5, MU_LEAST = 0.1, NU_FIRST = 10, DOWN = 5, UP = 5;
static const double BOLD = 1.2, GAIN_MIN = 0.05;

typedef struct Damping {
    double mu, nu;
} Damping;

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

/* out = (J^T J + nu S) v over the free unknowns. F is the sum of squares, its gradient g = 2 J^T r, and
 * products come as 2 J^T J v. */
static void product(Best *best, const Cg *cg, const double *v, double nu, double *out)
{
    best->problem->product(best->problem->self, v, nu, out);
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

/* (J^T J + nu S + mu) step = -gradient by conjugate gradients. No eigenvalue is below mu, so with the
 * residual q the model is at most q'q/(2 mu) above its minimum. */
static void solve_step(Best *best, Cg *cg, Damping damping)
{
    int n = best->problem->n;
    for (int i = 0; i < n; i++) {
        cg->step[i] = 0;
        cg->residual[i] = cg->direction[i] = cg->held[i] ? 0 : -best->gradient[i];
    }
    double size = dot(n, cg->residual, cg->residual);
    double stop = fmin(CG_TOL * CG_TOL * size, 2 * damping.mu * LEFT_MAX * fabs(best->objective));
    for (int k = 0; k < CG_MAX && size > stop; k++) {
        product(best, cg, cg->direction, damping.nu, cg->product);
        for (int i = 0; i < n; i++) cg->product[i] += damping.mu * cg->direction[i];
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

static void find_trial(Best *best, Cg *cg, Damping damping)
{
    const Problem *problem = best->problem;
    find_held(best, cg);
    solve_step(best, cg, damping);
    for (int i = 0; i < problem->n; i++)
        cg->trial[i] = fmin(fmax(best->u[i] + cg->step[i], problem->lower[i]), problem->upper[i]);
}

/* d'J^T J d/d'd of the refused step d: conjugate gradients that are cut short damp by themselves, and a mu
 * far below would give the same step again. With them d'(J^T J + mu) d = -gradient'd, also where d is
 * recalled. */
static double curvature_met(const Best *best, const Cg *cg, double mu)
{
    double slope = 0, length2 = 0;
    for (int i = 0; i < best->problem->n; i++) {
        double d = cg->trial[i] - best->u[i];
        slope += best->gradient[i] * d;
        length2 += d * d;
    }
    return length2 > 0 ? -slope / length2 - mu : 0;
}

/* After a refused step. Where a part snaps F grows a little; a step that makes it grow much was too bold
 * altogether. */
static Damping more_damping(const Best *best, const Cg *cg, double refused, Damping from)
{
    if (best->problem->knows_soft && refused < BOLD * fabs(best->objective))
        return (Damping){MU_UP * from.mu, fmax(NU_FIRST, UP * from.nu)};
    return (Damping){fmax(UP * from.mu, MU_LEAST * curvature_met(best, cg, from.mu)), from.nu};
}

static void run(Best *best, Cg *cg, const double *u)
{
    const Problem *problem = best->problem;
    best_evaluate(best, u, cg->trial_gradient);
    if (!isfinite(best->objective)) return;
    find_held(best, cg);
    Damping damping = {MU_FIRST * curvature_scale(best, cg), 0};
    double history[WINDOW];
    for (int k = 0; k < WINDOW; k++) history[k] = INFINITY;
    for (int step = 0, refused = 0; refused < REFUSED_MAX && !best_is_done(best);) {
        double before = best->objective;
        if (!problem->recall(problem->self, cg->trial)) find_trial(best, cg, damping);
        double value = best_evaluate(best, cg->trial, cg->trial_gradient);
        if (!(value < before)) {
            damping = more_damping(best, cg, value, damping);
            refused++;
            continue;
        }
        if (!(best->objective < (1 - GAIN_MIN) * history[step % WINDOW])) return;
        history[step++ % WINDOW] = before;
        if (refused == 0) /* after a refusal it stays: the model has just been found too bold */
            damping = (Damping){damping.mu / DOWN, damping.nu / DOWN};
        refused = 0;
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
