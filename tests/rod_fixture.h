/* rod_fixture.h - a discrete rod that rests on a reference curve, and one that is straight, for tests. */
#pragma once
#include "base/memory.h"
#include "rod/rod.h"
#include "solve/ramp.h"
#include "tests/rod_reference.h"

typedef struct Resting {
    RodCurve curve;
    RodFrame *frames; /* [stations] Bishop */
    Rod *rod;
    RodLayout layout; /* of the hanging form */
    System *hanging;
    double *p; /* natural strains that make it rest in state */
    State state;
} Resting;

static inline Resting resting_create(const ReferenceRod *r, double young, int elements)
{
    Resting o = {0};
    Error err;
    if (!rod_curve_create(r->point, (void *)r->omega, 0, r->range, elements, &o.curve, &err)) return o;
    o.frames = mem_alloc(2 * (size_t)elements + 1, sizeof *o.frames);
    rod_frenet(&o.curve, o.frames);
    rod_bishop(&o.curve, o.frames[0].n1, o.frames);
    o.rod = rod_create(elements, o.curve.length, reference_section(1), NULL);
    o.p = mem_alloc((size_t)o.rod->params.size, sizeof *o.p);
    rod_default_params(o.rod, young, o.p);
    o.p[o.rod->gravity + 2] = -reference_gravity;
    o.layout = rod_layout(o.rod, false);
    o.hanging = rod_hanging_system(o.rod);
    o.state = system_state(o.hanging);
    rod_follow_curves(o.rod, &o.curve, &o.frames, o.state.x);
    rod_balance(o.rod, o.hanging, &o.layout, 0, o.state.x, o.p);
    return o;
}

static inline void resting_clear(Resting *o)
{
    system_destroy(o->hanging);
    rod_destroy(o->rod);
    rod_curve_clear(&o->curve);
    mem_free(o->frames);
    mem_free(o->p);
    state_destroy(&o->state);
}

/* Largest distance of places[nodes][3] to the curve. */
static inline double resting_distance(const Resting *o, const double *place)
{
    double worst = 0;
    for (int i = 0; i <= o->rod->elements; i++)
        worst = fmax(worst, vec3_length(vec3_sub(vec3_load(place + 3 * i), o->curve.x[2 * i])));
    return worst;
}

static inline double resting_distance_of(const Resting *o, const double *x)
{
    double *place = mem_alloc(3 * (size_t)o->layout.nodes, sizeof *place);
    rod_places(o->rod, &o->layout, x, o->layout.nodes, place);
    double worst = resting_distance(o, place);
    mem_free(place);
    return worst;
}

/* A straight rod along x without weight. */
static inline Rod *rod_plain(int elements, double length, double young, const FluxFields *fields,
                             double **params)
{
    Rod *rod = rod_create(elements, length, rod_circle(1e-3, 1, 0.4, 1000),
                          fields ? &(RodActs){.fields = *fields} : NULL);
    *params = mem_alloc((size_t)rod->params.size, sizeof **params);
    rod_default_params(rod, young, *params);
    return rod;
}

static inline NewtonDef rod_newton(void)
{
    NewtonDef def = newton_default();
    def.step_cap = 1.5;
    return def;
}

static inline RampInfo rod_relax(const Rod *rod, System *sys, int steps, const double *p, State *state)
{
    RampDef def = ramp_default();
    def.newton = rod_newton();
    def.steps = steps;
    return ramp_solve(sys, &rod->params, &def, NULL, p, state);
}
