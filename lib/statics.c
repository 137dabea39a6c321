/* States, and equilibria with their derivatives. */
#include "base/memory.h"
#include "lib/objects.h"
#include "model/sequence.h"
#include "optim/implicit.h"
#include "solve/ramp.h"
#include <math.h>
#include <string.h>

/* ---- States ---- */

typedef struct Copying {
    const SlenderModel *model; /* where its case starts, */
    int load_case;
    const State *from; /* or another one */
    SlenderState *state;
} Copying;

static SlenderStatus make_state(void *self, Error *err)
{
    Copying *copying = self;
    if (copying->model && !lib_has_case(copying->model, copying->load_case, err)) return SLENDER_REFUSED;
    const State *from =
        copying->model ? &copying->model->model->cases[copying->load_case].state : copying->from;
    SlenderState *state = copying->state = mem_alloc(1, sizeof *state);
    state->now = state_clone(from);
    state->status = "start";
    state->energy = NAN;
    return SLENDER_DONE;
}

SlenderState *slender_state_create(SlenderModel *model, int load_case, SlenderError *err)
{
    Copying copying = {.model = model, .load_case = load_case};
    return lib_call(make_state, &copying, err) == SLENDER_DONE ? copying.state : NULL;
}

SlenderState *lib_state(const State *from, SlenderError *err)
{
    Copying copying = {.from = from};
    return lib_call(make_state, &copying, err) == SLENDER_DONE ? copying.state : NULL;
}

static void forget(SlenderState *state)
{
    factor_release(state->factor);
    mem_free(state->rest);
    mem_free(state->p);
    state->factor = NULL, state->rest = state->p = NULL, state->model = 0;
}

void slender_state_destroy(SlenderState *state)
{
    if (!state) return;
    forget(state);
    state_destroy(&state->now);
    mem_free(state);
}

/* Of an equilibrium its factor is shared. */
static void remember(SlenderState *state, unsigned long model, int load_case, const double *p, int params,
                     Factor *factor)
{
    forget(state);
    state->model = model, state->load_case = load_case, state->params = params;
    state->rest = mem_copy(state->now.x, (size_t)state->now.dofs, sizeof(double));
    state->p = mem_copy(p, (size_t)params, sizeof *p);
    state->factor = factor;
}

static SlenderStatus copy_state(void *self, Error *err)
{
    Copying *copying = self;
    const SlenderState *from = (const SlenderState *)copying->state;
    copying->from = &from->now;
    SlenderStatus status = make_state(copying, err);
    SlenderState *state = copying->state;
    state->status = from->status, state->energy = from->energy,
    state->newton_iterations = from->newton_iterations;
    if (from->factor) {
        remember(state, from->model, from->load_case, from->p, from->params, factor_share(from->factor));
        memcpy(state->rest, from->rest, (size_t)from->now.dofs * sizeof(double));
    }
    return status;
}

SlenderState *slender_state_copy(const SlenderState *state)
{
    Copying copying = {.state = (SlenderState *)state};
    return lib_call(copy_state, &copying, NULL) == SLENDER_DONE ? copying.state : NULL;
}

SlenderStateInfo slender_state_info(SlenderState *state)
{
    State *now = &state->now;
    return (SlenderStateInfo){now->dofs,     now->memory_count, now->x,
                              now->v,        now->memory,       &now->time,
                              state->status, state->energy,     state->newton_iterations};
}

/* ---- Equilibria ---- */

typedef struct Rest {
    SlenderModel *model;
    int load_case;
    SlenderState *state;
    const SlenderHost *host;
    const double *in; /* of derivatives: dx or dp */
    double *out;
} Rest;

/* Is the state one of this model? */
static bool fits(const SlenderModel *model, int load_case, const SlenderState *state, Error *err)
{
    if (!lib_has_case(model, load_case, err)) return false;
    const State *own = &model->model->cases[load_case].state;
    return (own->dofs == state->now.dofs && own->memory_count == state->now.memory_count) ||
           error_set(err, "the state has %d dofs and the model %d: it is of another model", state->now.dofs,
                     own->dofs);
}

/* Is it, untouched, the equilibrium that was found of this case? */
static bool is_known(const Rest *rest)
{
    const SlenderState *state = rest->state;
    return state->factor && state->model == rest->model->id && state->load_case == rest->load_case &&
           !memcmp(state->rest, state->now.x, (size_t)state->now.dofs * sizeof(double));
}

typedef struct Mover {
    const Model *model;
    double time;
} Mover;

static bool move(void *self, double from, double to, double *x)
{
    const Mover *mover = self;
    return model_move(mover->model, (HeldWay){mover->time, mover->time, from, to}, x, NULL);
}

/* Tells of each iteration, and asks whether to go on. */
static bool tell(void *self, const NewtonInfo *info)
{
    const Run *run = self;
    host_step(run->host, info->iterations, run->scene->solver.max_iterations, "energy %.6g J", info->energy);
    return !host_stops(run->host);
}

static NewtonInfo from_start(const Rest *rest, Run *run, System *sys, double *p)
{
    const Model *model = run->model;
    Mover mover = {model, rest->state->now.time};
    RampDef def = ramp_default();
    run_newton(run, &def.newton);
    def.observer = (NewtonObserver){tell, run};
    def.steps = sequence_load_steps(model, run->scene);
    if (model->moves) def.move = move, def.self = &mover;
    const double *loads = model->cases[rest->load_case].loads; /* of a scene that starts from a result */
    return ramp_solve(sys, model->params, &def, loads, p, &rest->state->now).newton;
}

/* From the equilibrium with other parameters. */
static NewtonInfo from_known(const Rest *rest, Run *run, System *sys, double *p)
{
    SlenderState *state = rest->state;
    int size = run->model->params->size;
    double *dp = mem_alloc((size_t)size, sizeof *dp);
    Point from = state_point(&state->now, state->p), at = state_point(&state->now, p);
    for (int i = 0; i < size; i++) dp[i] = p[i] - state->p[i];
    system_use_factor(sys, state->factor);
    implicit_predict(sys, &from, dp, p, &state->now);
    mem_free(dp);
    NewtonDef def = newton_default();
    NewtonObserver observer = {tell, run};
    run_newton(run, &def);
    return newton_minimize(sys, &def, &at, &state->now, &observer);
}

static SlenderStatus find_rest(void *self, Error *err)
{
    Rest *rest = self;
    SlenderState *state = rest->state;
    if (!fits(rest->model, rest->load_case, state, err)) return SLENDER_REFUSED;
    Host host = lib_host(rest->host);
    Run run = {.scene = &rest->model->scene->scene, .model = rest->model->model, .host = &host};
    System *sys = lib_system(rest->model, rest->load_case, false);
    double *p = lib_params(rest->model, rest->load_case);
    memset(state->now.v, 0, (size_t)state->now.dofs * sizeof(double));
    state->now.time = rest->model->model->cases[rest->load_case].stages[0].time;
    NewtonInfo info = is_known(rest) ? from_known(rest, &run, sys, p) : from_start(rest, &run, sys, p);
    forget(state);
    state->status = newton_status_name(info.status);
    state->energy = info.energy;
    state->newton_iterations = info.iterations;
    if (info.status == NEWTON_CONVERGED)
        remember(state, rest->model->id, rest->load_case, p, run.model->params->size,
                 system_share_factor(sys));
    else
        error_set(err, "%s", newton_status_text(info.status));
    return info.status == NEWTON_CONVERGED ? SLENDER_DONE
           : info.status == NEWTON_STOPPED ? SLENDER_INTERRUPTED
                                           : SLENDER_NOT_CONVERGED;
}

SlenderStatus slender_equilibrium(SlenderModel *model, int load_case, SlenderState *state,
                                  const SlenderHost *host, SlenderError *err)
{
    Rest rest = {.model = model, .load_case = load_case, .state = state, .host = host};
    return lib_call(find_rest, &rest, err);
}

/* ---- Energy ---- */

typedef struct Energy {
    Rest rest;
    double *energies, *gradient, sum;
} Energy;

static SlenderStatus take_energy(void *self, Error *err)
{
    Energy *energy = self;
    const Rest *rest = &energy->rest;
    if (!fits(rest->model, rest->load_case, rest->state, err)) return SLENDER_REFUSED;
    System *sys = lib_system(rest->model, rest->load_case, false);
    Point at = state_point(&rest->state->now, lib_params(rest->model, rest->load_case));
    Evaluation now = energy->gradient ? system_gradient(sys, &at, energy->gradient) : system_energy(sys, &at);
    if (energy->energies)
        memcpy(energy->energies, system_energies(sys), (size_t)system_term_count(sys) * sizeof(double));
    energy->sum = now.finite ? now.energy : NAN;
    return SLENDER_DONE;
}

double slender_energy(SlenderModel *model, int load_case, const SlenderState *state, double *energies,
                      double *gradient, SlenderError *err)
{
    Energy energy = {
        {.model = model, .load_case = load_case, .state = (SlenderState *)state}, energies, gradient, NAN};
    lib_call(take_energy, &energy, err);
    return energy.sum;
}

/* ---- Derivatives ---- */

/* The system and the point, with the factor of its equilibrium. */
static SlenderStatus stand(const Rest *rest, System **sys, Point *at, Error *err)
{
    if (!fits(rest->model, rest->load_case, rest->state, err)) return SLENDER_REFUSED;
    const double *p = lib_params(rest->model, rest->load_case);
    if (!is_known(rest) || memcmp(p, rest->state->p, (size_t)rest->model->model->params->size * sizeof *p))
        return lib_refuse(
            err, "the state is no equilibrium of this case with these parameters: solve it before its "
                 "derivatives are asked for");
    *sys = lib_system(rest->model, rest->load_case, false);
    *at = state_point(&rest->state->now, p);
    system_use_factor(*sys, rest->state->factor);
    return SLENDER_DONE;
}

static SlenderStatus pull(void *self, Error *err)
{
    Rest *rest = self;
    System *sys;
    Point at;
    SlenderStatus status = stand(rest, &sys, &at, err);
    if (status != SLENDER_DONE) return status;
    double *gx = mem_copy(rest->in, (size_t)rest->state->now.dofs, sizeof *gx);
    memset(rest->out, 0, (size_t)rest->model->model->params->size * sizeof *rest->out);
    implicit_adjoint(sys, &at, gx, rest->out);
    mem_free(gx);
    return SLENDER_DONE;
}

static SlenderStatus push(void *self, Error *err)
{
    Rest *rest = self;
    System *sys;
    Point at;
    SlenderStatus status = stand(rest, &sys, &at, err);
    if (status == SLENDER_DONE) implicit_tangent(sys, &at, rest->in, rest->out);
    return status;
}

SlenderStatus slender_vjp(SlenderModel *model, int load_case, const SlenderState *state, const double *dx,
                          double *dp, SlenderError *err)
{
    Rest rest = {.model = model, .load_case = load_case, .state = (SlenderState *)state, .in = dx, .out = dp};
    return lib_call(pull, &rest, err);
}

SlenderStatus slender_jvp(SlenderModel *model, int load_case, const SlenderState *state, const double *dp,
                          double *dx, SlenderError *err)
{
    Rest rest = {.model = model, .load_case = load_case, .state = (SlenderState *)state, .in = dp, .out = dx};
    return lib_call(push, &rest, err);
}
