/* rod_world_fixture.h - rods and what they meet, for tests. */
#pragma once
#include "rod/rod.h"
#include "solve/march.h"
#include "tests/obstacle_fixture.h"

enum { RIG_STRANDS = 2, RIG_OBSTACLES = 2 };

/* What rods are made of and what they meet, of which the obstacles go into the rig. */
typedef struct RigDef {
    int strands, elements; /* elements: of each strand */
    double length, radius, young, density, friction, stiffness;
    Obstacle obstacles[RIG_OBSTACLES];
    int obstacle_count;
    bool self;
} RigDef;

typedef struct Rig {
    Rod *rod;
    RodLayout layout;
    System *sys;
    State now;
    double *p;
    MarchDef march;
    WorldSums sums; /* of the last step */
    bool fast;      /* steps may be cut */
    double force[RIG_OBSTACLES][3];
} Rig;

static inline Rig rig_create(const RigDef *def)
{
    const double length[RIG_STRANDS] = {def->length, def->length}, r = def->radius;
    Rig rig = {.rod = rod_create_strands(def->strands, def->elements, length,
                                         rod_circle(r, 1, 0.4, def->density), NULL),
               .march = march_default()};
    Rod *rod = rig.rod;
    WorldBody shown = rod_world_body(rod);
    World *world = rod->world =
        world_create(&shown, mem_copy(def->obstacles, (size_t)def->obstacle_count, sizeof *def->obstacles),
                     def->obstacle_count);
    world->offset = r, world->slip_speed = 1e-3, world->distance = 2 * r;
    world->rubs = def->friction > 0, world->self = def->self;
    world_add_params(world, &rod->params);
    rig.p = params_vector(&rod->params);
    rod_default_params(rod, def->young, rig.p);
    for (int k = 0; k < def->obstacle_count; k++) rig.p[world->friction + k] = def->friction;
    if (def->obstacle_count) rig.p[world->stiffness] = def->stiffness;
    if (def->self) rig.p[world->self_friction] = def->friction;
    if (def->self) rig.p[world->self_stiffness] = def->young * pow(2 * r, 3);
    rig.layout = rod_layout(rod, true);
    rig.march.newton.step_cap = 1.5;
    return rig;
}

/* Makes the system, and begins where the rods are without loads. */
static inline void rig_start(Rig *rig, double young)
{
    rig->sys = rod_system(rig->rod, young, true);
    rig->now = system_state(rig->sys);
    rod_natural_state(rig->rod, &rig->layout, rig->p, rig->now.x);
}

static inline void rig_clear(Rig *rig)
{
    system_destroy(rig->sys);
    state_destroy(&rig->now);
    rod_destroy(rig->rod);
    mem_free(rig->p);
}

/* Steps, and what the last of them felt. */
static inline int rig_march(Rig *rig, double dt, int steps)
{
    State before = state_clone(&rig->now);
    int iterations = 0;
    for (int k = 0; k < steps; k++) {
        MarchInfo info;
        state_copy(&before, &rig->now);
        assert_true(march_step(rig->sys, &rig->march, dt, rig->p, &rig->now, &info));
        assert_true(info.refused == 0 || rig->fast);
        assert_int_equal(info.passed, 0);
        iterations += info.newton.iterations;
    }
    Point at = state_point(&rig->now, rig->p);
    at.x_prev = before.x, at.v_prev = before.v, at.dt = dt;
    memset(rig->force, 0, sizeof rig->force);
    rig->sums = (WorldSums){.contact = {.force = rig->force}};
    world_measure(rig->rod->world, &at, &rig->sums);
    state_destroy(&before);
    return iterations;
}

/* Of node i of all strands, and what element e does to its first node. */
static inline Vec3 rig_place(const Rig *rig, int i)
{
    return vec3_load(rig->now.x + rig->layout.position + 3 * i);
}

static inline Vec3 rig_pull(const Rig *rig, int e)
{
    return vec3_load(rig->now.x + rig->layout.multiplier + 3 * e);
}

/* How far positions are off where the turns have them, m. */
static inline double rig_torn(const Rig *rig)
{
    int nodes = rig->layout.nodes;
    double *place = mem_alloc(3 * (size_t)nodes, sizeof *place), most = 0;
    rod_places(rig->rod, &rig->layout, rig->now.x, nodes, place);
    for (int i = 0; i < nodes; i++)
        most = fmax(most, vec3_length(vec3_sub(vec3_load(place + 3 * i), rig_place(rig, i))));
    mem_free(place);
    return most;
}
