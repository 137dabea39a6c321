/* motion_fixture.h - F of a motion in time and its gradient, for tests: the adjoint against the tangent, against
 * differences, and with kept factors and without. */
#pragma once
#include "base/memory.h"
#include "base/random.h"
#include "optim/objectives.h"
#include "optim/trajectory_adjoint.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

/* F: how far three of the vertices are from some places in the second half. Steps, and all of def, may still be changed. */
typedef struct Motion {
    TrajectoryProblem problem;
    TrajectoryDef def;
    Design design;
    Objective objective;
    State start;
    double *u, *v, *gradient; /* [design.size] the unknowns, a direction, dF/du */
} Motion;

/* p is borrowed; the start is copied. */
static inline Motion motion_create(System *sys, const Params *params, double *p, const State *start,
                                   int vertices)
{
    Motion m = {.def = trajectory_default(), .design.case_count = 1, .start = state_clone(start)};
    m.def.march.newton.energy_tol = 1e-15;
    const int some[] = {0, vertices / 2, vertices - 1};
    const double goal[3][3] = {{0.01, 0.02, 0.03}, {-0.01, 0.01, 0}, {0.02, 0.02, -0.01}};
    m.objective = objective_target(3, some, goal, 1);
    m.problem = (TrajectoryProblem){
        .sys = sys, .params = params, .objective_count = 1, .step = 2e-3, .steps = 20, .p = p};
    return m;
}

/* all: one number for the whole block. */
static inline void motion_unknown(Motion *m, const char *name, UnknownMap map, double scale, bool all)
{
    const ParamBlock *block = params_find(m->problem.params, name);
    design_add(&m->design, (Unknown){.block = block,
                                     .group_count = all ? 1 : block->count,
                                     .group = all ? mem_alloc((size_t)block->count, sizeof(int)) : NULL,
                                     .map = map,
                                     .scale = scale,
                                     .lower = -INFINITY,
                                     .upper = INFINITY});
}

static inline void motion_clear(Motion *m)
{
    objective_destroy(m->objective);
    design_clear(&m->design);
    state_destroy(&m->start);
    mem_free(m->u);
    mem_free(m->v);
    mem_free(m->gradient);
}

/* At u + a v; with its gradient, or without. */
static inline Trajectory *motion_evaluate(Motion *m, double a, bool gradient, double *F, TrajectoryInfo *info)
{
    size_t size = (size_t)m->design.size;
    double *u = mem_copy(m->u, size, sizeof *u);
    for (size_t i = 0; i < size; i++) u[i] += a * m->v[i];
    m->objective.first = m->problem.steps / 2, m->objective.last = m->problem.steps;
    m->problem.design = &m->design, m->problem.objectives = &m->objective, m->problem.start = &m->start;
    Trajectory *t = trajectory_create(&m->problem, &m->def);
    *F = trajectory_evaluate(t, u, gradient ? m->gradient : NULL, info);
    if (!isfinite(*F))
        fail_msg("step %d: %s", info->reached + 1, newton_status_text(info->march.newton.status));
    if (gradient) trajectory_accept(t);
    mem_free(u);
    return t;
}

static inline double motion_value(Motion *m, double a)
{
    double F;
    TrajectoryInfo info;
    trajectory_destroy(motion_evaluate(m, a, false, &F, &info));
    return F;
}

/* dF along v by the tangent. */
static inline double motion_tangent(Motion *m, Trajectory *t)
{
    size_t dofs = (size_t)m->start.dofs, frames = (size_t)m->problem.steps + 1;
    double *dx = mem_alloc(frames * dofs, sizeof *dx), *g = mem_alloc(dofs, sizeof *g), slope = 0;
    trajectory_tangent(t, m->v, dx);
    for (int n = m->objective.first; n <= m->objective.last; n++) {
        memset(g, 0, dofs * sizeof *g);
        m->objective.ops->value(m->objective.self, m->objective.weight, trajectory_frame(t, n).x,
                                trajectory_params(t, n), g, NULL);
        for (size_t i = 0; i < dofs; i++) slope += g[i] * dx[(size_t)n * dofs + i];
    }
    mem_free(dx);
    mem_free(g);
    return slope;
}

static inline double motion_along(const Motion *m)
{
    double sum = 0;
    for (int i = 0; i < m->design.size; i++) sum += m->gradient[i] * m->v[i];
    return sum;
}

/* The relative error of central differences of the fourth order: the least of several sizes, because where contacts come
 * and go, or steps are cut, one size misleads. */
static inline double motion_differences(Motion *m, double adjoint, double most)
{
    double best = INFINITY;
    for (double h = 1e-3; h > 5e-7 && best > most; h /= 10) {
        double near = motion_value(m, h) - motion_value(m, -h),
               far = motion_value(m, 2 * h) - motion_value(m, -2 * h);
        best = fmin(best, fabs(adjoint / ((8 * near - far) / (12 * h)) - 1));
    }
    return best;
}

/* Once all unknowns are there. The motion that was evaluated, to look at. */
static inline Trajectory *motion_check(Motion *m, const char *name, double differences_most)
{
    Random random = random_seed(12);
    size_t size = (size_t)m->design.size;
    m->u = mem_alloc(size, sizeof(double)), m->v = mem_alloc(size, sizeof(double));
    m->gradient = mem_alloc(size, sizeof(double));
    design_read(&m->design, 0, m->problem.p, m->u);
    for (size_t i = 0; i < size; i++) m->v[i] = random_signed(&random);

    double F;
    TrajectoryInfo info, again;
    Trajectory *t = motion_evaluate(m, 0, true, &F, &info);
    double adjoint = motion_along(m), tangent = motion_tangent(m, t);
    double *kept = mem_copy(m->gradient, size, sizeof *kept);
    m->def.factor_memory = 0; /* the same factors, made again */
    trajectory_destroy(motion_evaluate(m, 0, true, &F, &again));
    assert_memory_equal(kept, m->gradient, size * sizeof *kept);
    mem_free(kept);
    m->def.factor_memory = trajectory_default().factor_memory;
    double best = motion_differences(m, adjoint, differences_most);
    print_message("%-28s adjoint against tangent %.1e, against differences %.1e; %d steps refused\n", name,
                  fabs(adjoint / tangent - 1), best, info.march.refused);
    assert_true(fabs(adjoint / tangent - 1) < 1e-11 && best < differences_most);
    return t;
}
