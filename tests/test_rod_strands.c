/* Many rods in one system: each moves as it would alone. */
#include "rod/stations.h"
#include "solve/march.h"
#include "tests/rod_taper.h"
#include "tests/rod_fixture.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

enum { STRANDS = 3, N = 10, STEPS = 40 };

static const double lengths[STRANDS] = {0.1, 0.13, 0.08}, young = 2e6, dt = 2e-3;

static void dress(Rod *rod, int first, double *p)
{
    int each = rod_each(rod);
    rod_default_params(rod, young, p);
    p[rod->gravity + 2] = -9.8;
    p[rod->damping] = 1e-3;
    vec3_store(p + rod->flux.uniform, vec3(0.01, 0.02, 0));
    RodPointLoad point = {.s = 0.05, .force = {0, 2e-4, 1e-4}};
    for (int k = 0; k < rod->strands; k++)
        rod_share_loads(rod, k, (RodLoads){.line = vec3(0, 0, -1e-3), .points = &point, .point_count = 1}, p);
    rod_sum_loads(rod, p);
    for (int k = 0; k < rod->strands; k++) {
        int n = first + k;
        rod->strand[k].position = vec3(0.05 * n, 0, -0.02 * n);
        rod->strand[k].frame = quat_exp(vec3(0.2 * n, 1 - 0.3 * n, 0.1));
        for (int e = k * each; e < (k + 1) * each; e++) {
            vec3_store(p + rod->natural_strain + 3 * e, vec3(3 * n, 10, 20 - 5 * n));
            p[rod->magnetization + 3 * e] = 2e4;
        }
    }
}

/* Places and moments of the nodes after the steps. */
static void move(Rod *rod, int first, bool wet, double *place, Vec3 *moment)
{
    RodLayout layout = rod_layout(rod, true);
    if (wet) {
        WorldBody shown = rod_world_body(rod);
        rod->world = world_create(&shown, NULL, 0);
        rod->world->wet = true;
        world_add_params(rod->world, &rod->params);
    }
    double *p = params_vector(&rod->params);
    dress(rod, first, p);
    if (wet) {
        p[rod->world->water.density] = 200, p[rod->world->water.viscosity] = 0.5;
        p[rod->world->water.velocity + 1] = 0.1;
    }
    System *sys = rod_system(rod, young, true);
    MarchDef def = march_default();
    State now = system_state(sys);
    rod_natural_state(rod, &layout, p, now.x);
    for (int k = 0; k < STEPS; k++) {
        MarchInfo info;
        assert_true(march_step(sys, &def, dt, p, &now, &info));
    }
    rod_places(rod, &layout, now.x, layout.nodes, place);
    rod_node_moments(rod, &layout, now.x, p, moment);
    state_destroy(&now);
    system_destroy(sys);
    mem_free(p);
}

static void check_alone(bool wet)
{
    const double taper[] = {0.4, 0.7};
    RodSection section = rod_circle(1e-3, 1, 0.4, 1200);
    double together[STRANDS * (N + 1)][3], alone[N + 1][3], off = 0, turned = 0, far = 0;
    Vec3 moments[STRANDS * (N + 1)], moment[N + 1];
    Rod *all = rod_create_strands(STRANDS, N, lengths, section, NULL);
    rod_taper(all, 2e-3, 1.6e-3, taper, 0.4, 1200);
    move(all, 0, wet, together[0], moments);
    for (int k = 0; k < STRANDS; k++) {
        Rod *one = rod_create(N, lengths[k], section, NULL);
        rod_taper(one, 2e-3, 1.6e-3, taper, 0.4, 1200);
        move(one, k, wet, alone[0], moment);
        for (int i = 0; i <= N; i++) {
            int node = k * (N + 1) + i;
            off = fmax(off, vec3_length(vec3_sub(vec3_load(alone[i]), vec3_load(together[node]))));
            turned = fmax(turned, vec3_length(vec3_sub(moment[i], moments[node])));
        }
        far = fmax(far, vec3_length(moment[0]));
        rod_destroy(one);
    }
    rod_destroy(all);
    print_message("%d strands%s together are %.1e m off those alone, moments %.1e of %.1e N m\n", STRANDS,
                  wet ? " in water" : "", off, turned, far);
    assert_true(off < 1e-10 && turned < 1e-8 * far); /* steps end where Newton is content with all of them */
}

static void test_alone(void **state)
{
    (void)state;
    check_alone(false);
    check_alone(true);
}

/* Strands that rest on curves of their own. */
static void test_resting(void **state)
{
    (void)state;
    RodCurve curves[2];
    RodFrame *frames[2];
    double length[2];
    Error err;
    for (int k = 0; k < 2; k++) {
        const ReferenceRod *r = &reference_rods[k];
        assert_true(rod_curve_create(r->point, (void *)r->omega, 0, r->range, N, &curves[k], &err));
        frames[k] = mem_alloc(2 * N + 1, sizeof *frames[k]);
        rod_frenet(&curves[k], frames[k]);
        length[k] = curves[k].length;
    }
    Rod *rod = rod_create_strands(2, N, length, reference_section(1), NULL);
    RodLayout layout = rod_layout(rod, false);
    double *p = params_vector(&rod->params);
    rod_default_params(rod, reference_rods[0].young, p);
    p[rod->gravity + 2] = -reference_gravity;
    for (int hanging = 1; hanging >= 0; hanging--) {
        RodLayout own = rod_layout(rod, !hanging);
        System *sys = hanging ? rod_hanging_system(rod) : rod_system(rod, reference_rods[0].young, false);
        State at = system_state(sys), turns = {.x = mem_alloc((size_t)layout.dofs, sizeof(double))};
        rod_follow_curves(rod, curves, frames, turns.x);
        rod_copy_state(rod, &layout, turns.x, &own, at.x);
        rod_balance(rod, sys, &own, 0, at.x, p);
        double *g = mem_alloc((size_t)own.dofs, sizeof *g), most = 0, away = 0, place[2 * (N + 1)][3];
        Point point = state_point(&at, p);
        Evaluation now = system_gradient(sys, &point, g);
        for (int i = 0; i < own.dofs; i++)
            if (!system_is_fixed(sys, i)) most = fmax(most, fabs(g[i]));
        rod_places(rod, &own, at.x, own.nodes, place[0]);
        for (int i = 0; i < own.nodes; i++)
            away = fmax(away,
                        vec3_length(vec3_sub(vec3_load(place[i]), curves[i / (N + 1)].x[2 * (i % (N + 1))])));
        print_message("two curves, %s: forces of %.1e of %.1e, %.1e m off\n", hanging ? "turns" : "positions",
                      most, now.force_scale, away);
        assert_true(most < 1e-13 * now.force_scale + 1e-16 && away < 1e-15);
        mem_free(g);
        state_destroy(&at);
        mem_free(turns.x);
        system_destroy(sys);
    }
    mem_free(p);
    rod_destroy(rod);
    for (int k = 0; k < 2; k++) {
        rod_curve_clear(&curves[k]);
        mem_free(frames[k]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_alone), cmocka_unit_test(test_resting)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
