/* The discrete rods of an inversion, which rest on their curves to rounding, and where they come to rest when they are let
 * down from their natural shapes. */
#include "base/memory.h"
#include "rod/front/inversion.h"
#include "solve/eigen.h"
#include "solve/ramp.h"
#include <math.h>
#include <string.h>

enum { LOAD_STEPS = 10 };

/* The rod, its system, and the state that is the curve. */
typedef struct Discrete {
    const RodCurve *curve;
    Rod *rod;
    System *sys;
    RodLayout layout;
    State state;
    double *p;
} Discrete;

/* On the nodes, as implicit Euler has it: that of half an element on either side. */
static void add_inertia(const Rod *rod, const Vec3 *inertia, double *p)
{
    double h = rod_element_length(rod, 0);
    for (int i = 0; i <= rod->elements; i++) {
        double *load = p + rod->load + 3 * i, length = i == 0 || i == rod->elements ? h / 2 : h;
        vec3_store(load, vec3_axpy(length, inertia[2 * i], vec3_load(load)));
    }
    rod_sum_loads(rod, p);
}

/* A hanging rod is of turns only; one whose last end is held, or that has potentials, has places and multipliers, too. */
static Discrete discrete_create(const Inversion *o, int k)
{
    const RodModel *rm = o->rm;
    const RodScene *scene = rod_scene(o->run->scene);
    Discrete d = {.curve = &rm->curves[k]};
    double time = rod_model_time(rm, k, o->run->model->time);
    RodActs acts = rod_model_acts(rm);
    bool places = scene->end || acts.potentials.count > 0;
    Error err;
    d.rod = rod_create(o->elements, d.curve->length, rm->unit, &acts);
    rod_model_put_sections(rm, k, d.rod);
    d.p = mem_alloc((size_t)d.rod->params.size, sizeof *d.p);
    rod_model_loads(rm, k, d.rod, scene, d.curve, time, d.p, &err); /* finite: it was asked before */
    if (rm->inertia) add_inertia(d.rod, rm->inertia[k], d.p);
    for (int e = 0; e < o->elements && !isnan(scene->magnetization.value[0]); e++)
        d.p[d.rod->magnetization + 3 * e] = scene->magnetization.value[0];
    memcpy(d.p + d.rod->flux.uniform, rm->flux, sizeof rm->flux);
    if (scene->end) d.rod->end = scene->end->hold == HOLD_CLAMPED ? ROD_CLAMPED : ROD_PINNED;
    RodLayout turns = rod_layout(d.rod, false);
    double *x = mem_alloc((size_t)turns.dofs, sizeof *x);
    rod_follow_curves(d.rod, d.curve, &rm->frames[k], x);
    d.layout = rod_layout(d.rod, places);
    d.sys = places ? rod_system(d.rod, rm->young, false) : rod_hanging_system(d.rod);
    d.state = system_state(d.sys);
    d.state.time = time;
    rod_copy_state(d.rod, &turns, x, &d.layout, d.state.x);
    mem_free(x);
    return d;
}

static void discrete_clear(Discrete *d)
{
    state_destroy(&d->state);
    system_destroy(d->sys);
    mem_free(d->p);
    d->rod->potentials = (RodPotentials){0}; /* the model's */
    rod_destroy(d->rod);
}

/* Natural strains with which the state is in equilibrium, its last end under that force and couple; these are its support's
 * then. */
static void balance(Discrete *d, Vec3 force, Vec3 couple)
{
    double *load = d->p + d->rod->load + 3 * d->rod->elements;
    Vec3 own = vec3_load(load);
    vec3_store(load, vec3_add(own, force));
    rod_balance_end(d->rod, d->sys, &d->layout, d->state.time, couple, d->state.x, d->p);
    vec3_store(load, own);
}

static bool lead_end(void *self, double from, double to, double *x)
{
    const Discrete *d = self;
    Quat frame = rod_reference(&d->layout, d->state.x, d->rod->elements);
    rod_lead_end(&d->layout, d->layout.nodes - 1, d->curve->x[2 * d->rod->elements],
                 d->rod->end == ROD_CLAMPED ? &frame : NULL, ramp_part(from, to), x);
    return true;
}

/* From the natural shape, loads in steps, back to the curve, where the rod has the given energy: how far it ends from
 * it, and how much lower. */
static void go_round(Inversion *o, int k, Discrete *d, double energy)
{
    State state = system_state(d->sys);
    double *x = state.x, *place = &inversion_strand(o, o->x, k)->x;
    state.time = d->state.time;
    RampDef def = ramp_default();
    run_newton(o->run, &def.newton);
    def.observer = run_observer(o->run);
    def.steps = o->run->scene->load_steps.mode < 0 ? o->run->scene->load_steps.count : LOAD_STEPS;
    if (d->rod->end != ROD_FREE) def.move = lead_end, def.self = d;
    rod_natural_state(d->rod, &d->layout, d->p, x);
    RampInfo info = ramp_solve(d->sys, &d->rod->params, &def, NULL, d->p, &state);
    if (info.newton.status > o->worst) o->worst = info.newton.status;
    o->gain[k] = energy - info.newton.energy;
    rod_places(d->rod, &d->layout, x, d->layout.nodes, place);
    for (int i = 0; i < d->layout.nodes; i++) {
        Vec3 off = vec3_sub(vec3_load(place + 3 * i), d->curve->x[2 * i]);
        o->round_trip[k] = fmax(o->round_trip[k], vec3_length(off));
    }
    state_destroy(&state);
}

void inversion_elements(Inversion *o, int k)
{
    Discrete d = discrete_create(o, k);
    double *gradient = mem_alloc((size_t)d.layout.dofs, sizeof *gradient), lowest = INFINITY;
    balance(&d, vec3_sub(o->loads[k].end, o->rm->magnetic), o->loads[k].end_couple);
    Point at = state_point(&d.state, d.p);
    Evaluation left = system_gradient(d.sys, &at, gradient);
    o->residual[k] = left.force_scale > 0 ? left.gradient_max / left.force_scale : 0;
    memcpy(o->strain_elements + 3 * (size_t)k * (size_t)o->elements, d.p + d.rod->natural_strain,
           3 * (size_t)o->elements * sizeof *d.p);
    if (d.rod->end != ROD_FREE && inversion_asks(o->run->scene, CHECK_STABILITY))
        o->stable[k] = eigen_lowest(d.sys, &at, NULL, 1, &lowest, NULL) && lowest >= 0;
    if (o->x) go_round(o, k, &d, left.energy);
    mem_free(gradient);
    discrete_clear(&d);
}
