#include "optim/path.h"
#include "base/memory.h"
#include "solve/tangent.h"
#include <string.h>

double *path_x(const Path *path, int k)
{
    return path->x + (size_t)k * (size_t)path->dofs;
}

double *path_memory(const Path *path, int k)
{
    return path->memory + (size_t)k * (size_t)path->memory_count;
}

static void make_room(Path *path, int room)
{
    size_t from = (size_t)path->room, to = (size_t)room, n = (size_t)path->dofs,
           m = (size_t)path->memory_count;
    path->frame = mem_resize(path->frame, from, to, sizeof *path->frame);
    path->dt = mem_resize(path->dt, from, to, sizeof *path->dt);
    path->time = mem_resize(path->time, from, to, sizeof *path->time);
    path->x = mem_resize(path->x, n * from, n * to, sizeof *path->x);
    path->memory = mem_resize(path->memory, m * from, m * to, sizeof *path->memory);
    path->factor = mem_resize(path->factor, from, to, sizeof(Factor *));
    path->room = room;
}

static void put_state(Path *path, int k, const State *state)
{
    memcpy(path_x(path, k), state->x, (size_t)path->dofs * sizeof(double));
    memcpy(path_memory(path, k), state->memory, (size_t)path->memory_count * sizeof(double));
    path->time[k] = state->time;
}

Path path_create(const TrajectoryProblem *problem, const MarchDef *march, long factor_memory)
{
    Path path = {.problem = problem,
                 .march = march,
                 .dofs = system_dof_count(problem->sys),
                 .memory_count = system_memory_count(problem->sys),
                 .factor_memory = factor_memory};
    make_room(&path, problem->steps + 1);
    path.end = mem_alloc((size_t)problem->steps + 1, sizeof(int));
    path.p = mem_copy(problem->p, (size_t)problem->params->size, sizeof(double));
    path.v = mem_alloc((size_t)path.dofs, sizeof(double));
    path.gradient = mem_alloc((size_t)path.dofs, sizeof(double));
    put_state(&path, 0, problem->start);
    return path;
}

void path_clear(Path *path)
{
    for (int k = 0; k <= path->count; k++) {
        factor_release(path->factor[k]);
        path->factor[k] = NULL;
    }
    path->count = 0;
    path->unsolved = false;
    path->factor_bytes = 0;
}

void path_destroy(Path *path)
{
    path_clear(path);
    mem_free(path->frame);
    mem_free(path->dt);
    mem_free(path->time);
    mem_free(path->x);
    mem_free(path->memory);
    mem_free(path->factor);
    mem_free(path->end);
    mem_free(path->p);
    mem_free(path->v);
    mem_free(path->gradient);
}

void path_load(Path *path, int frame, double time)
{
    const TrajectoryProblem *problem = path->problem;
    if (path->march->load) path->march->load(path->march->self, time, path->p);
    for (int c = 0; c < problem->control_count; c++)
        control_apply(&problem->controls[c], frame > 0 ? frame : 1, time, path->p);
}

void path_velocities(const Path *path, int k, double *v)
{
    int positions = system_position_count(path->problem->sys);
    const double *now = path_x(path, k), *before = path_x(path, k ? k - 1 : 0),
                 *start = path->problem->start->v;
    for (int i = 0; i < path->dofs; i++)
        v[i] = k == 0 ? start[i] : i < positions ? (now[i] - before[i]) / path->dt[k] : 0;
}

/* At the start of step k. */
static const double *start_velocity(Path *path, int k)
{
    path_velocities(path, k - 1, path->v);
    return path->v;
}

/* Step k at its end, with its parameters. */
static Point point(Path *path, int k)
{
    path_load(path, path->frame[k], path->time[k]);
    return (Point){.x = path_x(path, k),
                   .p = path->p,
                   .memory = path_memory(path, k),
                   .time = path->time[k],
                   .x_prev = path_x(path, k - 1),
                   .v_prev = start_velocity(path, k),
                   .dt = path->dt[k],
                   .x_lag = path->march->implicit ? path_x(path, k) : NULL};
}

static bool factor_at(Path *path, const Point *at)
{
    system_hessian(path->problem->sys, at, path->gradient);
    return system_factor(path->problem->sys, 0);
}

bool path_add(Path *path, int frame, const State *state, double dt)
{
    int k = ++path->count;
    if (k == path->room) make_room(path, 2 * path->room);
    put_state(path, k, state);
    path->end[frame] = k;
    path->frame[k] = frame;
    path->dt[k] = dt;
    path->factor[k] = NULL;
    Point at = point(path, k);
    if (!factor_at(path, &at)) return false;
    long bytes = system_info(path->problem->sys).factor_bytes; /* its elements may change from step to step */
    if (path->factor_bytes + bytes <= path->factor_memory) {
        path->factor[k] = system_share_factor(path->problem->sys);
        path->factor_bytes += bytes;
    }
    return true;
}

/* ---- The motion ---- */

typedef struct PathMarch {
    Path *path;
    PathGuess guess;
    void *self;
    int frame; /* that is being made */
    bool failed;
} PathMarch;

static void load(void *self, double time, double *p)
{
    PathMarch *m = self;
    path_load(m->path, m->frame, time);
    memcpy(p, m->path->p, (size_t)m->path->problem->params->size * sizeof *p);
}

static bool move(void *self, double time, double *x)
{
    const MarchDef *march = ((PathMarch *)self)->path->march;
    return march->move(march->self, time, x);
}

static bool find_start(void *self, double time, double dt, double *x)
{
    PathMarch *m = self;
    (void)time;
    return m->guess(m->self, m->frame, dt, x);
}

static void store(void *self, const State *state, double dt)
{
    PathMarch *m = self;
    m->failed |= !path_add(m->path, m->frame, state, dt);
}

static void add_info(MarchInfo *sum, const MarchInfo *step)
{
    NewtonInfo newton = step->newton;
    newton_add_counts(&newton, &sum->newton);
    *sum = (MarchInfo){newton, sum->steps + step->steps, sum->refused + step->refused,
                       sum->passed + step->passed};
}

bool path_march(Path *path, PathGuess guess, void *self, MarchInfo *info, int *reached)
{
    const TrajectoryProblem *problem = path->problem;
    PathMarch m = {.path = path, .guess = guess, .self = self};
    MarchDef def = *path->march;
    def.self = &m, def.load = load, def.stored = store;
    if (def.move) def.move = move;
    if (guess) def.guess = find_start;
    State now = state_clone(problem->start);
    double *p = mem_copy(path->p, (size_t)problem->params->size, sizeof *p);
    path_clear(path);
    system_use_factor(problem->sys, NULL);
    *reached = 0;
    for (m.frame = 1; m.frame <= problem->steps && !m.failed; m.frame++) {
        MarchInfo step;
        bool ok = march_step(problem->sys, &def, problem->step, p, &now, &step);
        add_info(info, &step);
        if (!ok) break;
        now.time = problem->start->time + problem->step * m.frame; /* not the sum of rounded steps */
        *reached = m.frame;
        if (path->march->stored) path->march->stored(path->march->self, &now, problem->step);
    }
    state_destroy(&now);
    mem_free(p);
    return *reached == problem->steps && !m.failed;
}

/* ---- Sweeps ---- */

/* The end of step k, with its factor at hand. */
static Point stand_at(Path *path, int k)
{
    Point at = point(path, k);
    if (path->factor[k])
        system_use_factor(path->problem->sys, path->factor[k]);
    else
        factor_at(path, &at);
    return at;
}

/* y = A^-1 b, or of A + L or its transposed where lagged quantities are the step's own end's, with the factor of A at hand. */
static void solve_step(Path *path, const Point *at, bool transposed, const double *b, double *y)
{
    path->unsolved |= !tangent_solve(path->problem->sys, at, transposed, b, y);
}

void path_tangent(Path *path, double *dp, const double *dv, double *dx)
{
    const TrajectoryProblem *problem = path->problem;
    System *sys = problem->sys;
    int positions = system_position_count(sys);
    double *speed = mem_copy(dv, (size_t)path->dofs, sizeof *speed);
    for (int k = 1; k <= path->count; k++) {
        Point at = stand_at(path, k);
        double *before = dx + (size_t)(k - 1) * (size_t)path->dofs, *now = before + path->dofs;
        for (int c = 0; c < problem->control_count; c++)
            control_apply(&problem->controls[c], path->frame[k], path->time[k], dp);
        system_param_forward(sys, &at, dp, now);
        system_prev_forward(sys, &at, before, speed, now);
        solve_step(path, &at, false, now, now);
        for (int i = 0; i < path->dofs; i++) now[i] = -now[i];
        for (int i = 0; i < positions; i++) speed[i] = (now[i] - before[i]) / path->dt[k];
    }
    mem_free(speed);
}

/* v_k = (x_k - x_{k-1})/dt: what v* asks of the two states. */
static void pull_velocity(int positions, double dt, double *v, double *now, double *before)
{
    for (int i = 0; i < positions; i++) {
        now[i] += v[i] / dt;
        before[i] -= v[i] / dt;
    }
}

void path_adjoint(Path *path, double *seed, double *dp, double *dv)
{
    const TrajectoryProblem *problem = path->problem;
    System *sys = problem->sys;
    size_t n = (size_t)path->dofs;
    double *w = mem_alloc(n, sizeof *w);
    memset(dv, 0, n * sizeof *dv);
    for (int k = path->count; k > 0; k--) {
        Point at = stand_at(path, k);
        double *before = seed + (size_t)(k - 1) * n, *now = before + n;
        pull_velocity(system_position_count(sys), path->dt[k], dv, now, before);
        solve_step(path, &at, true, now, w);
        memset(dv, 0, n * sizeof *dv);
        system_prev(sys, &at, w, before, dv);
        for (int i = 0; i < path->dofs; i++) w[i] = -w[i];
        system_param(sys, &at, w, dp);
        for (int c = 0; c < problem->control_count; c++)
            control_transpose(&problem->controls[c], path->frame[k], path->time[k], dp);
    }
    for (int i = 0; i < path->dofs; i++)
        if (system_is_fixed(sys, i)) seed[i] = dv[i] = 0;
    mem_free(w);
}
