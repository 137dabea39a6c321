/* water_fixture.h - free masses, a rod of them, and streams of water, for tests. */
#pragma once
#include "base/memory.h"
#include "base/random.h"
#include "base/vec3.h"
#include "solve/kinetic.h"
#include "solve/lumped.h"
#include "solve/params.h"
#include "solve/system.h"
#include "world/water.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static const double RHO = 1000;

/* Free masses in water: what is tested is what moves them, gravity and water. */
typedef struct Swarm {
    int vertices;
    Params params;
    int gravity;
    Water water;
    double *p;
    System *sys;
    State state;
    const Term *term; /* water's */
} Swarm;

static inline Water add_water(Params *params)
{
    return (Water){.density = params_add(params, "water_density", "kg/m3", 1, 1, false),
                   .viscosity = params_add(params, "viscosity", "Pa s", 1, 1, false),
                   .velocity = params_add(params, "velocity", "m/s", 1, 3, false)};
}

/* Blocks, of which p has water's density. */
static inline Swarm swarm_begin(int vertices)
{
    Swarm s = {.vertices = vertices};
    s.gravity = params_add(&s.params, "gravity", "m/s2", 1, 3, true);
    s.water = add_water(&s.params);
    s.p = params_vector(&s.params);
    s.p[s.water.density] = RHO;
    return s;
}

static inline void swarm_end(Swarm *s, const double *mass, Term water)
{
    int dofs = 3 * s->vertices;
    s->sys = system_create(dofs, &(DofClass){.count = dofs, .size = 1}, 1);
    system_add(s->sys, water);
    system_add(s->sys, lumped_gravity_term(masses_fixed(s->vertices, mass), s->gravity));
    system_add(s->sys, kinetic_inertia_term(masses_fixed(s->vertices, mass)));
    system_prepare(s->sys);
    s->term = system_term(s->sys, 0);
    s->state = system_state(s->sys);
}

static inline void swarm_clear(Swarm *s)
{
    system_destroy(s->sys);
    params_clear(&s->params);
    mem_free(s->p);
    state_destroy(&s->state);
}

static inline FluxField *flow_of(const char *u, const char *v, const char *w)
{
    const char *const expressions[] = {u, v, w};
    static const char *const variables[] = {"x", "y", "z", "r", "t", NULL};
    Error err;
    Formula *formula = formula_create(expressions, 3, NULL, 0, variables, &err);
    if (!formula) fail_msg("%s", err.text);
    return flux_field_formula(formula, 0.01);
}

/* One that is not the same anywhere. */
static inline FluxField *shear_flow(void)
{
    return flow_of("0.1+20*y*z*x/0.01", "0.2*t-8*x", "30*x*z/0.01-5*y");
}

static inline void shake(Swarm *s, Random *random, double size, double speed)
{
    for (int i = 0; i < 3 * s->vertices; i++) {
        s->state.x[i] += size * random_signed(random);
        s->state.v[i] = speed * random_signed(random);
    }
}

/* ---- A straight rod along x, of 40 mm and 0.2 mm, that falls ---- */

enum { NODES = 21 };

static const double LENGTH = 0.04, RADIUS = 2e-4, ROD_DENSITY = 1100;

static inline Swarm rod_create_of(const double *radii, const FluxField *flow)
{
    Swarm s = swarm_begin(NODES);
    double mass[NODES], element = ROD_DENSITY * M_PI * RADIUS * RADIUS * LENGTH / (NODES - 1);
    s.water.flow = flow;
    for (int i = 0; i < NODES; i++) mass[i] = i == 0 || i == NODES - 1 ? element / 2 : element;
    RodWaterDef def = {
        .element_count = NODES - 1, .strands = 1, .length = &LENGTH, .radius = radii, .water = s.water};
    swarm_end(&s, mass, rod_water_term(&def));
    for (int i = 0; i < NODES; i++) s.state.x[3 * i] = i * LENGTH / (NODES - 1);
    return s;
}

static inline Swarm rod_create(const FluxField *flow)
{
    double radii[NODES - 1];
    for (int e = 0; e < NODES - 1; e++) radii[e] = RADIUS;
    return rod_create_of(radii, flow);
}
