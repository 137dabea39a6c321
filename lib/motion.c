/* Motions, and their derivatives. */
#include "base/memory.h"
#include "job/contacts.h"
#include "lib/objects.h"
#include <math.h>
#include <string.h>

static const double FACTOR_MEMORY = 1 << 30; /* bytes */
enum { STEPS_MAX = 100000000 };

/* ---- The march ---- */

static void load(void *self, double time, double *p)
{
    SlenderMotion *motion = self;
    motion->refused |= !model_load(motion->model->model, time, motion->given, p, &motion->err);
}

static bool move(void *self, double time, double *x)
{
    SlenderMotion *motion = self;
    motion->refused |= !model_move(motion->model->model, held_way(time), x, &motion->err);
    return !motion->refused;
}

static void tell(void *self, const State *now, double dt)
{
    SlenderMotion *motion = self;
    const Host *host = &motion->host;
    const Model *model = motion->model->model;
    (void)dt;
    motion->reached++;
    host_step(host, motion->reached, motion->problem.steps, "t %.4g s", now->time);
    if (!host->frame) return;
    double *place = mem_alloc(3 * (size_t)model->point_count, sizeof *place);
    model->body->ops->places(model, now->x, place);
    host->frame(host->self, now->time, model->point_count, place);
    mem_free(place);
}

/* The parameters, with a row of the flux density for each step behind them where it is given. */
static void put_parameters(SlenderMotion *motion, const SlenderMotionDef *def, const double *p)
{
    const Model *model = motion->model->model;
    int size = model->params->size, steps = def->steps;
    motion->params = *model->params;
    motion->params.size += motion->given ? 3 * steps : 0;
    motion->problem.p = mem_resize((double *)NULL, 0, (size_t)motion->params.size, sizeof *p);
    memcpy(motion->problem.p, p, (size_t)size * sizeof *p);
    if (!motion->given) return;
    memcpy(motion->problem.p + size, def->flux, 3 * (size_t)steps * sizeof *p);
    motion->control = (Control){.kind = CONTROL_FRAME,
                                .from = size,
                                .to = model->flux_blocks.uniform,
                                .rows = steps,
                                .width = 3,
                                .steps = steps,
                                .start = motion->start.time,
                                .duration = steps * def->step};
}

static void set_up(SlenderMotion *motion, const SlenderMotionDef *def)
{
    System *sys = lib_system(motion->model, motion->load_case, true);
    motion->given = def->flux != NULL;
    motion->host = lib_host(&def->host);
    motion->run =
        (Run){.scene = &motion->model->scene->scene, .model = motion->model->model, .host = &motion->host};
    put_parameters(motion, def, lib_params(motion->model, motion->load_case));
    motion->problem.sys = sys;
    motion->problem.params = &motion->params;
    motion->problem.controls = &motion->control;
    motion->problem.control_count = motion->given;
    motion->problem.start = &motion->start;
    motion->problem.step = def->step;
    motion->problem.steps = def->steps;
    motion->march = march_default();
    motion->march.implicit = motion->model->model->world && motion->model->model->world->implicit;
    run_newton(&motion->run, &motion->march.newton);
    motion->march.observer = run_observer(&motion->run);
    motion->march.load = load, motion->march.stored = tell, motion->march.self = motion;
    if (motion->model->model->moves) motion->march.move = move;
    motion->path =
        path_create(&motion->problem, &motion->march, (long)(def->memory > 0 ? def->memory : FACTOR_MEMORY));
}

typedef struct Simulation {
    SlenderModel *model;
    int load_case;
    const SlenderState *start;
    const SlenderMotionDef *def;
    SlenderMotion *motion; /* made */
} Simulation;

static SlenderStatus check(const Simulation *s, Error *err)
{
    if (!lib_has_case(s->model, s->load_case, err)) return SLENDER_REFUSED;
    int dofs = s->model->model->cases[s->load_case].state.dofs;
    if (s->start->now.dofs != dofs)
        return lib_refuse(err, "the state has %d dofs and the model %d: it is of another model",
                          s->start->now.dofs, dofs);
    if (s->def->flux && s->model->model->flux_blocks.uniform < 0)
        return lib_refuse(err, "%s feels no flux density", s->model->model->body->noun);
    if (s->def->steps < 0 || s->def->steps > STEPS_MAX || !(s->def->step > 0) || !isfinite(s->def->step))
        return lib_refuse(err, "%d steps of %g s; they must be 0 to %d, and longer than 0 s", s->def->steps,
                          s->def->step, STEPS_MAX);
    if (!(s->def->memory >= 0))
        return lib_refuse(err, "memory is %g bytes; it must be 0 or more", s->def->memory);
    if (!isfinite(s->start->now.time)) return lib_refuse(err, "the start's time is no finite number");
    return SLENDER_DONE;
}

static SlenderStatus simulate(void *self, Error *err)
{
    Simulation *s = self;
    SlenderStatus status = check(s, err);
    if (status != SLENDER_DONE) return status;
    SlenderMotion *motion = s->motion = mem_alloc(1, sizeof *motion);
    motion->model = s->model, motion->load_case = s->load_case;
    motion->start = state_clone(&s->start->now);
    set_up(motion, s->def);
    MarchInfo info = {0};
    int reached;
    bool ok = path_march(&motion->path, NULL, NULL, &info, &reached);
    motion->reached = reached;
    motion->host = (Host){0}; /* the caller's is gone when derivatives march again */
    if (motion->refused) {
        *err = motion->err;
        return SLENDER_REFUSED;
    }
    if (ok && info.passed)
        error_set(err, "%s in %d of the shortest parts of steps", newton_status_text(NEWTON_PIERCED),
                  info.passed);
    if (ok) return info.passed ? SLENDER_NOT_CONVERGED : SLENDER_DONE;
    if (info.newton.status == NEWTON_STOPPED) {
        error_set(err, "stopped after %d of %d steps", reached, s->def->steps);
        return SLENDER_INTERRUPTED;
    }
    error_set(err, "step %d failed: %s", reached + 1, newton_status_text(info.newton.status));
    return SLENDER_NOT_CONVERGED;
}

SlenderMotion *slender_simulate(SlenderModel *model, int load_case, const SlenderState *start,
                                const SlenderMotionDef *def, SlenderStatus *status, SlenderError *err)
{
    Simulation s = {model, load_case, start, def, NULL};
    SlenderStatus ended = lib_call(simulate, &s, err);
    if (status) *status = ended;
    if (ended == SLENDER_REFUSED && s.motion) slender_motion_destroy(s.motion), s.motion = NULL;
    return ended == SLENDER_NO_MEMORY ? NULL : s.motion;
}

void slender_motion_destroy(SlenderMotion *motion)
{
    if (!motion) return;
    path_destroy(&motion->path);
    state_destroy(&motion->start);
    arrays_clear(&motion->met);
    mem_free(motion->problem.p);
    mem_free(motion);
}

/* ---- States ---- */

int slender_motion_steps(const SlenderMotion *motion)
{
    return motion->reached;
}

static SlenderStatus no_such_step(const SlenderMotion *motion, int n, Error *err)
{
    return lib_refuse(err, "there is no state after %d steps: the motion has %d", n, motion->reached);
}

typedef struct At {
    const SlenderMotion *motion;
    int n;
    State state;
} At;

/* Its velocities are the last (sub-)step's. */
static SlenderStatus state_at(void *self, Error *err)
{
    At *at = self;
    const Path *path = &at->motion->path;
    if (at->n < 0 || at->n > at->motion->reached) return no_such_step(at->motion, at->n, err);
    at->state = state_clone(&at->motion->start);
    int k = path->end[at->n], positions = system_position_count(path->problem->sys);
    if (k == 0) return SLENDER_DONE;
    const double *now = path_x(path, k), *before = path_x(path, k - 1);
    memcpy(at->state.x, now, (size_t)path->dofs * sizeof *now);
    memcpy(at->state.memory, path_memory(path, k), (size_t)path->memory_count * sizeof *now);
    for (int i = 0; i < path->dofs; i++)
        at->state.v[i] = i < positions ? (now[i] - before[i]) / path->dt[k] : 0;
    at->state.time = path->time[k];
    return SLENDER_DONE;
}

SlenderState *slender_motion_state(const SlenderMotion *motion, int n, SlenderError *err)
{
    At at = {.motion = motion, .n = n};
    if (lib_call(state_at, &at, err) != SLENDER_DONE) return NULL;
    SlenderState *state = lib_state(&at.state, err);
    state_destroy(&at.state);
    return state;
}

/* ---- What the body met ---- */

/* A (sub-)step. */
static void add_part(Path *path, int k, double *v, Contacts *contacts)
{
    State state = *path->problem->start;
    path_load(path, path->frame[k], path->time[k]);
    path_velocities(path, k, v);
    state.x = path_x(path, k), state.v = v, state.memory = path_memory(path, k), state.time = path->time[k];
    contacts_add(contacts, &state, path->dt[k], path->p);
}

static void find_met(SlenderMotion *motion)
{
    Path *path = &motion->path;
    double *v = mem_alloc((size_t)path->dofs, sizeof *v), *rows[CONTACTS_ROWS];
    Case moving = motion->model->model->cases[motion->load_case];
    moving.sys = motion->problem.sys; /* a scene of rest has another one */
    Contacts contacts = contacts_create(motion->model->model, &moving);
    contacts_start(&contacts, &motion->start);
    for (int n = 1; n <= motion->reached; n++) {
        contacts_begin(&contacts);
        for (int k = path->end[n - 1] + 1; k <= path->end[n]; k++) add_part(path, k, v, &contacts);
        contacts_add_row(&contacts, "", n, motion->reached, rows, &motion->met);
    }
    contacts_destroy(&contacts);
    mem_free(v);
    motion->met_known = true;
}

typedef struct Met {
    SlenderMotion *motion;
    int number;
    Array array;
} Met;

static SlenderStatus copy_met(void *self, Error *err)
{
    (void)err;
    Met *met = self;
    const Arrays *all = &met->motion->met;
    if (!met->motion->met_known) find_met(met->motion);
    if (met->number < 0 || (size_t)met->number >= all->count) return SLENDER_DONE;
    Array *array = &met->array;
    *array = all->arrays[met->number];
    array->name = mem_text(array->name), array->unit = mem_text(array->unit);
    array->data = mem_copy((const double *)array->data, array_count(array), sizeof(double));
    return SLENDER_DONE;
}

SlenderStatus slender_motion_met(SlenderMotion *motion, int number, SlenderArray *array, SlenderError *err)
{
    Met met = {.motion = motion, .number = number};
    SlenderStatus status = lib_call(copy_met, &met, err);
    *array = status == SLENDER_DONE ? lib_array(&met.array) : (SlenderArray){0};
    return status;
}

/* ---- Derivatives ---- */

typedef struct Pull {
    SlenderMotion *motion;
    int count;
    const int *frame;
    const double *dx, *dv; /* dv: NULL where F has no velocities */
    double *dp, *dflux, *start_x, *start_v;
} Pull;

static void copy_out(double *to, const double *from, int count)
{
    if (to) memcpy(to, from, (size_t)count * sizeof *to);
}

/* dF/dx of all states: a velocity is a difference of two (state_at). */
static void seed_states(const Pull *p, const Path *path, double *seed)
{
    size_t n = (size_t)path->dofs, positions = (size_t)system_position_count(path->problem->sys);
    for (int k = 0; k < p->count; k++) {
        int end = path->end[p->frame[k]];
        const double *dx = p->dx ? p->dx + (size_t)k * n : NULL, *dv = p->dv ? p->dv + (size_t)k * n : NULL;
        double *row = seed + (size_t)end * n;
        for (size_t i = 0; i < n && dx; i++) row[i] += dx[i];
        for (size_t i = 0; i < positions && dv && end > 0; i++) {
            row[i] += dv[i] / path->dt[end];
            row[i - n] -= dv[i] / path->dt[end];
        }
    }
}

/* The start's velocities are its own. */
static void add_start_velocity(const Pull *p, double *start_v)
{
    size_t n = (size_t)p->motion->path.dofs;
    const System *sys = p->motion->problem.sys;
    for (int k = 0; k < p->count && p->dv; k++)
        for (size_t i = 0; i < n && p->frame[k] == 0; i++)
            if (!system_is_fixed(sys, (int)i)) start_v[i] += p->dv[(size_t)k * n + i];
}

static SlenderStatus pull(void *self, Error *err)
{
    const Pull *p = self;
    SlenderMotion *motion = p->motion;
    Path *path = &motion->path;
    size_t n = (size_t)path->dofs, rows = (size_t)path->count + 1;
    int size = motion->model->model->params->size;
    if (p->count < 0) return lib_refuse(err, "%d states; they must be 0 or more", p->count);
    for (int k = 0; k < p->count; k++)
        if (p->frame[k] < 0 || p->frame[k] > motion->reached) return no_such_step(motion, p->frame[k], err);
    double *seed = mem_alloc(rows * n, sizeof *seed), *dv = mem_alloc(n, sizeof *dv),
           *dp = mem_alloc((size_t)motion->params.size, sizeof *dp);
    seed_states(p, path, seed);
    path_adjoint(path, seed, dp, dv);
    add_start_velocity(p, dv);
    copy_out(p->dp, dp, size);
    if (motion->given) copy_out(p->dflux, dp + size, 3 * motion->problem.steps);
    copy_out(p->start_x, seed, path->dofs);
    copy_out(p->start_v, dv, path->dofs);
    mem_free(seed);
    mem_free(dv);
    mem_free(dp);
    return SLENDER_DONE;
}

SlenderStatus slender_motion_vjp(SlenderMotion *motion, int count, const int *frame, const double *dx,
                                 const double *dv, double *dp, double *dflux, double *start_x,
                                 double *start_v, SlenderError *err)
{
    Pull p = {motion, count, frame, dx, dv, dp, dflux, start_x, start_v};
    return lib_call(pull, &p, err);
}

typedef struct Push {
    SlenderMotion *motion;
    const double *dp, *dflux, *start_x, *start_v;
    double *dx;
} Push;

static SlenderStatus push(void *self, Error *err)
{
    (void)err;
    const Push *p = self;
    SlenderMotion *motion = p->motion;
    Path *path = &motion->path;
    size_t n = (size_t)path->dofs, rows = (size_t)path->count + 1;
    int size = motion->model->model->params->size;
    double *all = mem_alloc(rows * n, sizeof *all), *dv = mem_alloc(n, sizeof *dv),
           *dp = mem_alloc((size_t)motion->params.size, sizeof *dp);
    copy_out(p->dp ? dp : NULL, p->dp, size);
    copy_out(p->dflux && motion->given ? dp + size : NULL, p->dflux, 3 * motion->problem.steps);
    copy_out(p->start_x ? all : NULL, p->start_x, path->dofs);
    copy_out(p->start_v ? dv : NULL, p->start_v, path->dofs);
    path_tangent(path, dp, dv, all);
    for (int k = 0; k <= motion->reached; k++)
        memcpy(p->dx + (size_t)k * n, all + (size_t)path->end[k] * n, n * sizeof *all);
    mem_free(all);
    mem_free(dv);
    mem_free(dp);
    return SLENDER_DONE;
}

SlenderStatus slender_motion_jvp(SlenderMotion *motion, const double *dp, const double *dflux,
                                 const double *start_x, const double *start_v, double *dx, SlenderError *err)
{
    Push p = {motion, dp, dflux, start_x, start_v, dx};
    return lib_call(push, &p, err);
}
