/* cloud_fixture.h - particles that fly towards each other and repel: a motion whose couplings change from step to step. */
#pragma once
#include "base/random.h"
#include "solve/kinetic.h"
#include "solve/lumped.h"
#include "solve/params.h"
#include "solve/system.h"
#include "tests/near_springs.h"

enum { CLOUD_VERTICES = 60, CLOUD_DOFS = 3 * CLOUD_VERTICES };

typedef struct Cloud {
    Params params;
    int gravity, stiffness, damping; /* first entries in p */
    double p[5];
    double mass[CLOUD_VERTICES];
} Cloud;

static inline Cloud cloud_create(void)
{
    Cloud cloud = {0};
    Random random = random_seed(5);
    cloud.gravity = params_add(&cloud.params, "gravity", "m/s2", 1, 3, true);
    cloud.stiffness = params_add(&cloud.params, "stiffness", "N/m", 1, 1, false);
    cloud.damping = params_add(&cloud.params, "damping", "kg/s", 1, 1, false);
    double p[5] = {0.3, -0.2, -1, 40, 0.05};
    memcpy(cloud.p, p, sizeof p);
    for (int v = 0; v < CLOUD_VERTICES; v++) cloud.mass[v] = 0.1 * (1 + random_uniform(&random));
    return cloud;
}

static inline System *cloud_system(const Cloud *cloud)
{
    System *sys = system_create(CLOUD_DOFS, &(DofClass){.count = CLOUD_DOFS, .size = 1}, 1);
    system_add(sys, lumped_gravity_term(masses_fixed(CLOUD_VERTICES, cloud->mass), cloud->gravity));
    system_add(sys, near_springs_term(CLOUD_VERTICES, 0.3, cloud->stiffness));
    system_add(sys, kinetic_inertia_term(masses_fixed(CLOUD_VERTICES, cloud->mass)));
    system_add(sys, kinetic_damping_term(CLOUD_VERTICES, NULL, cloud->damping));
    for (int i = 0; i < 3; i++) system_fix(sys, i);
    system_prepare(sys);
    return sys;
}

static inline const NearSprings *cloud_springs(const System *sys)
{
    return system_term(sys, 1)->self;
}

/* In a box, moving inwards. */
static inline State cloud_state(const System *sys)
{
    State state = system_state(sys);
    Random random = random_seed(11);
    for (int i = 3; i < CLOUD_DOFS; i++) {
        state.x[i] = 0.5 * random_signed(&random);
        state.v[i] = -2 * state.x[i] + 0.3 * random_signed(&random);
    }
    return state;
}
