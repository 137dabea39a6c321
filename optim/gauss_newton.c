/* Levenberg-Marquardt, matrix-free: min |r + J d|^2 + mu |d|^2 + nu |d|_S^2 by conjugate gradients with
 * products J^T J v. Near a snap-through J grows without limit in the soft mode:
 * - the gradient is hardly anything else. Conjugate gradients that stop at a part of the gradient would move
 *   that mode alone, into the snap; so they go on until little of F is left to gain.
 * - a step is soon too long for that mode, and mu, which would shorten it, stops all others first. S measures
 *   steps in the state, soft modes most (Problem.product): after a refused step nu holds these and lets the
 *   others go.
 * mu and nu go down after a success and up after a failure. After some refused steps in a row, or successes
 * that bring little, L-BFGS goes on from the best point. Constants measured in docs/optimisers.md. */
#include "base/memory.h"
#include "base/vector.h"
#include "optim/best.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { CG_MAX = 200, CG_RUNS = 3, REFUSED_MAX = 6, WINDOW = 4 };

static const double CG_TOL = 1e-2, LEFT_MAX = 1e-2; /* parts of the gradient, and of F */
static const double MU_FIRST = 0.3, MU_UP = 1.5, MU_LEAST = 0.1, NU_FIRST = 10, DOWN = 5, UP = 5;
static const double BOLD = 1.2, GAIN_MIN = 0.01;

typedef struct Damping {
    double mu, nu;
} Damping;

typedef struct Cg {
    double *step, *residual, *direction, *product, *trial, *trial_gradient; /* [n] */
    bool *held;                                                             /* [n] */
} Cg;

/* out = (J^T J + nu S) v. F is the sum of squares, its gradient g = 2 J^T r, and products come as 2 J^T J v. */
static void product(Best *best, const double *v, double nu, double *out)
{
    best->problem->product(best->problem->self, v, nu, out);
    best->info.products++;
}

/* A lower bound of |2 J^T J|, which damping is measured in: g = 2 J^T r and F = |r|^2 give |g|^2 <= 4 |J|^2
 * F. */
static double curvature_scale(const Best *best)
{
    double sum = 0;
    for (int i = 0; i < best->problem->n; i++)
        if (!best_is_held(best->problem, i, best->u[i], -best->gradient[i]))
            sum += best->gradient[i] * best->gradient[i];
    return sum / (2 * fabs(best->objective) + DBL_MIN);
}

/* residual = -gradient - (J^T J + nu S + mu) step, and who is held. */
static void find_residual(Best *best, Cg *cg, Damping damping, bool at_start)
{
    const Problem *problem = best->problem;
    if (!at_start) product(best, cg->step, damping.nu, cg->product);
    for (int i = 0; i < problem->n; i++) {
        double pull = -best->gradient[i], at = best->u[i] + cg->step[i];
        if (!at_start) pull -= cg->product[i] + damping.mu * cg->step[i];
        cg->held[i] = best_is_held(problem, i, at, pull);
        cg->residual[i] = cg->held[i] ? 0 : pull;
    }
}

/* Improves the step by conjugate gradients over the unknowns that are not held, until |residual|^2 is at most
 * stop; the products it took. */
static int improve_step(Best *best, Cg *cg, Damping damping, double stop, int most)
{
    int n = best->problem->n, count = 0;
    double size = vector_dot(n, cg->residual, cg->residual);
    memcpy(cg->direction, cg->residual, (size_t)n * sizeof *cg->direction);
    while (count < most && size > stop) {
        product(best, cg->direction, damping.nu, cg->product);
        count++;
        for (int i = 0; i < n; i++) cg->product[i] += damping.mu * cg->direction[i];
        double curvature = vector_dot(n, cg->direction, cg->product);
        if (!(curvature > 0)) break;
        double a = size / curvature;
        for (int i = 0; i < n; i++) {
            cg->step[i] += a * cg->direction[i];
            cg->residual[i] -= cg->held[i] ? 0 : a * cg->product[i];
        }
        double next = vector_dot(n, cg->residual, cg->residual);
        for (int i = 0; i < n; i++) cg->direction[i] = cg->residual[i] + next / size * cg->direction[i];
        size = next;
    }
    return count;
}

/* The trial that the step leads to, within the bounds; shortens the step to it. False: it was within. */
static bool put_within(const Best *best, Cg *cg)
{
    bool beyond = false;
    for (int i = 0; i < best->problem->n; i++) {
        double to = best->u[i] + cg->step[i];
        cg->trial[i] = fmin(fmax(to, best->problem->lower[i]), best->problem->upper[i]);
        if (cg->trial[i] == to) continue;
        cg->step[i] = cg->trial[i] - best->u[i];
        beyond = true;
    }
    return beyond;
}

/* (J^T J + nu S + mu) step = -gradient within the bounds: what conjugate gradients carry beyond its bound is
 * put on it, and they go on with the rest, which has to make up for it (as in More and Toraldo's GPCG, SIAM J.
 * Optim. 1 (1991) 93). Each run but the last has half of the products that are left. No eigenvalue is below
 * mu, so with the residual q the model is at most q'q/(2 mu) above its minimum. */
static void find_trial(Best *best, Cg *cg, Damping damping)
{
    double stop = 0;
    memset(cg->step, 0, (size_t)best->problem->n * sizeof *cg->step);
    for (int run = 1, left = CG_MAX; run <= CG_RUNS && left > 0; run++) {
        find_residual(best, cg, damping, run == 1);
        if (run == 1)
            stop = fmin(CG_TOL * CG_TOL * vector_dot(best->problem->n, cg->residual, cg->residual),
                        2 * damping.mu * LEFT_MAX * fabs(best->objective));
        left -= improve_step(best, cg, damping, stop, run < CG_RUNS ? left / 2 : left);
        if (!put_within(best, cg)) return;
    }
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

/* After a refused step. Where a part snaps F grows a little; a step that makes it grow much, or one that does
 * with the soft modes held, was too bold altogether. */
static Damping more_damping(const Best *best, const Cg *cg, double refused, Damping from, bool again)
{
    if (best->problem->knows_soft && !again && refused < BOLD * fabs(best->objective))
        return (Damping){MU_UP * from.mu, fmax(NU_FIRST, UP * from.nu)};
    return (Damping){fmax(UP * from.mu, MU_LEAST * curvature_met(best, cg, from.mu)), from.nu};
}

static void run(Best *best, Cg *cg, const double *u)
{
    const Problem *problem = best->problem;
    best_evaluate(best, u, cg->trial_gradient);
    if (!isfinite(best->objective)) return;
    Damping damping = {MU_FIRST * curvature_scale(best), 0};
    double history[WINDOW];
    for (int k = 0; k < WINDOW; k++) history[k] = INFINITY;
    for (int step = 0, refused = 0; refused < REFUSED_MAX && !best_is_done(best);) {
        double before = best->objective;
        if (!problem->recall(problem->self, cg->trial)) find_trial(best, cg, damping);
        double value = best_evaluate(best, cg->trial, cg->trial_gradient);
        if (!(value < before)) {
            damping = more_damping(best, cg, value, damping, refused > 0);
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
    lbfgs_run(best, u);
}
