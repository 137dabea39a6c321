#include "optim/trajectory_adjoint.h"
#include "base/clock.h"
#include "base/memory.h"
#include "optim/path.h"
#include <math.h>
#include <string.h>

struct Trajectory {
    TrajectoryProblem problem;
    TrajectoryDef def;
    Path paths[2]; /* the best motion, and the one at work */
    int best;
    bool has_best;
    double *u, *best_u;   /* [design->size]                                             */
    double *dp, *hp;      /* [params]                                                   */
    double *guess, *seed; /* [rows][dofs] a tangent along the best path; dF/dx of states */
    int guess_rows, seed_rows;
    double *dv; /* [dofs] */
    bool guessed;
};

TrajectoryDef trajectory_default(void)
{
    TrajectoryDef def = {.march = march_default(), .factor_memory = 2L << 30};
    return def;
}

/* ---- Life ---- */

Trajectory *trajectory_create(const TrajectoryProblem *problem, const TrajectoryDef *def)
{
    Trajectory *t = mem_alloc(1, sizeof *t);
    *t = (Trajectory){.problem = *problem, .def = *def};
    size_t params = (size_t)problem->params->size, size = (size_t)problem->design->size;
    t->u = mem_alloc(size, sizeof(double));
    t->best_u = mem_alloc(size, sizeof(double));
    t->dp = mem_alloc(params, sizeof(double));
    t->hp = mem_alloc(params, sizeof(double));
    t->dv = mem_alloc((size_t)system_dof_count(problem->sys), sizeof(double));
    for (int k = 0; k < 2; k++) t->paths[k] = path_create(&t->problem, &t->def.march, def->factor_memory / 2);
    return t;
}

void trajectory_destroy(Trajectory *t)
{
    if (!t) return;
    for (int k = 0; k < 2; k++) path_destroy(&t->paths[k]);
    double *owned[] = {t->u, t->best_u, t->dp, t->hp, t->guess, t->seed, t->dv};
    for (size_t k = 0; k < sizeof owned / sizeof *owned; k++) mem_free(owned[k]);
    mem_free(t);
}

/* ---- The motion ---- */

static double *rows(double **vector, int *room, int count, int dofs)
{
    if (count > *room) {
        mem_free(*vector);
        *vector = mem_alloc((size_t)count * (size_t)dofs, sizeof **vector);
        *room = count;
    } else {
        memset(*vector, 0, (size_t)count * (size_t)dofs * sizeof **vector);
    }
    return *vector;
}

/* Where the best motion goes with the new design, to first order. */
static void guess_motion(Trajectory *t)
{
    Path *best = &t->paths[t->best];
    int dofs = best->dofs;
    t->guessed = t->has_best && best->end[t->problem.steps] == best->count;
    if (!t->guessed) return;
    double *dx = rows(&t->guess, &t->guess_rows, best->count + 1, dofs);
    int params = t->problem.params->size;
    memcpy(t->dp, t->problem.p, (size_t)params * sizeof *t->dp);
    memcpy(t->hp, t->problem.p, (size_t)params * sizeof *t->hp);
    design_apply(t->problem.design, 0, t->u, t->dp);
    design_apply(t->problem.design, 0, t->best_u, t->hp);
    for (int i = 0; i < params; i++) t->dp[i] -= t->hp[i];
    memset(t->dv, 0, (size_t)dofs * sizeof *t->dv);
    path_tangent(best, t->dp, t->dv, dx);
    for (size_t i = 0; i < (size_t)(best->count + 1) * (size_t)dofs; i++) dx[i] += best->x[i];
}

/* The best motion's state at the end of this frame, moved along the tangent; its factor is a better
 * preconditioner than that of the step before. What is held is where the best motion has it: turns are from the references
 * of theirs. */
static bool find_guess(void *self, int frame, double dt, double *x)
{
    Trajectory *t = self;
    const Path *best = &t->paths[t->best];
    if (!t->guessed || dt != t->problem.step) return false;
    int k = best->end[frame], dofs = best->dofs;
    memcpy(x, t->guess + (size_t)k * (size_t)dofs, (size_t)dofs * sizeof *x);
    if (best->factor[k]) system_use_factor(t->problem.sys, best->factor[k]);
    return true;
}

/* ---- The objective ---- */

/* Its value; where seed is not NULL, dF/dx of the states and dF/dp. */
static double objective(Trajectory *t, const Path *path, double *seed, double *dp)
{
    double sum = 0;
    for (int k = 0; k < t->problem.objective_count; k++) {
        const Objective *row = &t->problem.objectives[k];
        for (int n = row->first; n <= row->last; n++) {
            size_t at = (size_t)path->end[n] * (size_t)path->dofs;
            sum += row->weight * row->ops->value(row->self, row->weight, path->x + at, path->p,
                                                 seed ? seed + at : NULL, dp);
        }
    }
    return sum;
}

double trajectory_evaluate(Trajectory *t, const double *u, double *gradient, TrajectoryInfo *info)
{
    const Design *design = t->problem.design;
    Path *path = &t->paths[1 - t->best];
    *info = (TrajectoryInfo){0};
    memcpy(t->u, u, (size_t)design->size * sizeof *u);
    if (gradient) memset(gradient, 0, (size_t)design->size * sizeof *gradient);
    double begin = clock_seconds();
    memcpy(path->p, t->problem.p, (size_t)t->problem.params->size * sizeof *path->p);
    design_apply(design, 0, u, path->p);
    guess_motion(t);
    bool ok = path_march(path, find_guess, t, &info->march, &info->reached);
    info->forward = clock_seconds() - begin;
    if (ok && info->march.passed) info->march.newton.status = NEWTON_PIERCED;
    if (!ok || info->march.passed) return INFINITY;
    double F = objective(t, path, NULL, NULL);
    if (!gradient || !isfinite(F)) return F;
    begin = clock_seconds();
    double *seed = rows(&t->seed, &t->seed_rows, path->count + 1, path->dofs);
    memset(t->dp, 0, (size_t)t->problem.params->size * sizeof *t->dp);
    objective(t, path, seed, t->dp);
    path_adjoint(path, seed, t->dp, t->dv);
    info->backward = clock_seconds() - begin;
    if (path->unsolved) {
        info->march.newton.status = NEWTON_UNSETTLED;
        return INFINITY;
    }
    design_transpose(design, 0, u, t->dp, gradient);
    return F;
}

void trajectory_accept(Trajectory *t)
{
    memcpy(t->best_u, t->u, (size_t)t->problem.design->size * sizeof *t->u);
    t->best = 1 - t->best;
    t->has_best = true;
}

void trajectory_tangent(Trajectory *t, const double *v, double *dx)
{
    Path *best = &t->paths[t->best];
    size_t dofs = (size_t)best->dofs;
    double *all = rows(&t->guess, &t->guess_rows, best->count + 1, best->dofs);
    memset(t->hp, 0, (size_t)t->problem.params->size * sizeof *t->hp);
    design_forward(t->problem.design, 0, t->best_u, v, t->hp);
    memset(t->dv, 0, dofs * sizeof *t->dv);
    path_tangent(best, t->hp, t->dv, all);
    for (int n = 0; dx && n <= t->problem.steps; n++)
        memcpy(dx + (size_t)n * dofs, all + (size_t)best->end[n] * dofs, dofs * sizeof *dx);
}

void trajectory_product(Trajectory *t, const double *v, double *out)
{
    Path *best = &t->paths[t->best];
    trajectory_tangent(t, v, NULL);
    double *seed = rows(&t->seed, &t->seed_rows, best->count + 1, best->dofs);
    memset(t->dp, 0, (size_t)t->problem.params->size * sizeof *t->dp);
    for (int k = 0; k < t->problem.objective_count; k++) {
        const Objective *row = &t->problem.objectives[k];
        for (int n = row->first; row->ops->product && n <= row->last; n++) {
            size_t at = (size_t)best->end[n] * (size_t)best->dofs;
            row->ops->product(row->self, row->weight, best->x + at, best->p, t->guess + at, t->hp, seed + at,
                              t->dp);
        }
    }
    path_adjoint(best, seed, t->dp, t->dv);
    memset(out, 0, (size_t)t->problem.design->size * sizeof *out);
    design_transpose(t->problem.design, 0, t->best_u, t->dp, out);
}

void trajectory_gradients(Trajectory *t, double *dp, double *dx, double *dv)
{
    Path *best = &t->paths[t->best];
    double *seed = rows(&t->seed, &t->seed_rows, best->count + 1, best->dofs);
    memset(t->dp, 0, (size_t)t->problem.params->size * sizeof *t->dp);
    objective(t, best, seed, t->dp);
    path_adjoint(best, seed, t->dp, t->dv);
    if (dp) memcpy(dp, t->dp, (size_t)t->problem.params->size * sizeof *dp);
    if (dx) memcpy(dx, seed, (size_t)best->dofs * sizeof *dx);
    if (dv) memcpy(dv, t->dv, (size_t)best->dofs * sizeof *dv);
}

/* ---- What is kept ---- */

const double *trajectory_params(Trajectory *t, int frame)
{
    Path *best = &t->paths[t->best];
    path_load(best, frame, best->time[best->end[frame]]);
    return best->p;
}

State trajectory_frame(const Trajectory *t, int frame)
{
    const Path *best = &t->paths[t->best];
    int k = best->end[frame];
    return (State){.dofs = best->dofs,
                   .memory_count = best->memory_count,
                   .x = path_x(best, k),
                   .memory = path_memory(best, k),
                   .time = best->time[k]};
}

void trajectory_velocities(const Trajectory *t, int frame, double *v)
{
    const Path *best = &t->paths[t->best];
    path_velocities(best, best->end[frame], v);
}

TrajectoryState trajectory_state(const Trajectory *t)
{
    const Path *best = &t->paths[t->best];
    return (TrajectoryState){best->count, best->x, best->memory, best->dt + 1};
}

void trajectory_restore(Trajectory *t, const double *u, const TrajectoryState *state)
{
    Path *best = &t->paths[t->best];
    size_t dofs = (size_t)best->dofs, memory = (size_t)best->memory_count;
    memcpy(t->best_u, u, (size_t)t->problem.design->size * sizeof *u);
    memcpy(best->p, t->problem.p, (size_t)t->problem.params->size * sizeof *best->p);
    design_apply(t->problem.design, 0, u, best->p);
    path_clear(best);
    double start = t->problem.start->time, step = t->problem.step;
    State now = state_clone(t->problem.start);
    for (int k = 1, frame = 1; k <= state->count; k++) {
        memcpy(now.x, state->x + (size_t)k * dofs, dofs * sizeof *now.x);
        memcpy(now.memory, state->memory + (size_t)k * memory, memory * sizeof *now.memory);
        now.time += state->dt[k - 1];
        path_add(best, frame, &now, state->dt[k - 1]);
        if (now.time < start + step * (frame - 1e-6)) continue;
        now.time = start + step * frame++;
    }
    state_destroy(&now);
    t->has_best = true;
}
