/* The adjoint of a motion in water: against the tangent, against differences, with kept factors and without. */
#include "shell/terms.h"
#include "tests/motion_fixture.h"
#include "tests/shell_fixture.h"
#include "tests/water_fixture.h"
#include <math.h>
#include <string.h>

static void check_motion(System *sys, const Params *params, double *p, const State *start, int vertices,
                         const char *name)
{
    Motion m = motion_create(sys, params, p, start, vertices);
    motion_unknown(&m, "water_density", UNKNOWN_LINEAR, 1000, false);
    motion_unknown(&m, "viscosity", UNKNOWN_LINEAR, 0.01, false);
    motion_unknown(&m, "velocity", UNKNOWN_LINEAR, 0.1, false);
    trajectory_destroy(motion_check(&m, name, 1e-6));
    motion_clear(&m);
}

/* A magnetised sheet that bends in a field while the water streams. */
static void test_shell_adjoint(void **unused)
{
    (void)unused;
    long blocks = mem_live_count();
    FluxField *flow = shear_flow();
    for (int outer = 0; outer < 2; outer++) {
        Shell *shell = shell_of_sheet((double[]){0.012, 0.004}, (int[]){6, 2}, PATTERN_ALTERNATE);
        const Mesh *mesh = shell->mesh;
        shell->thickness = 4e-4, shell->poisson = 0.4, shell->density = RHO;
        Water water = add_water(&shell->params);
        int positions = 3 * mesh->vertex_count;
        DofClass classes[] = {{.count = positions, .size = mesh_diagonal(mesh)},
                              {.first = positions, .count = mesh->edge_count, .size = 1}};
        System *sys = system_create(shell_dof_count(shell), classes, 2);
        for (int t = 0; t < shell_term_row_count; t++) system_add(sys, shell_term_rows[t].create(shell));
        system_add(sys, kinetic_inertia_term(shell_masses(shell)));
        water.flow = flow;
        system_add(
            sys, water_term(&(WaterDef){
                     .face_count = mesh->face_count, .faces = mesh->faces, .outer = outer, .water = water}));
        system_prepare(sys);
        Body body = body_create(shell, sys, 1e5);
        for (int f = 0; f < mesh->face_count; f++)
            body.p[shell->magnetization + 3 * f] = mesh->rest[mesh->faces[f][0]][0] < 0.006 ? 3e4 : -3e4;
        body.p[shell->flux.uniform + 2] = 0.02;
        body.p[water.density] = RHO;
        body.p[water.velocity + 2] = -0.05;
        check_motion(sys, &shell->params, body.p, &body.state, mesh->vertex_count,
                     outer ? "shell, outer" : "shell, two");
        body_clear(&body);
    }
    flux_field_destroy(flow);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_rod_adjoint(void **unused)
{
    (void)unused;
    Random random = random_seed(8);
    FluxField *flow = shear_flow();
    Swarm s = rod_create(flow);
    shake(&s, &random, 3e-4, 0.1);
    s.p[s.water.viscosity] = 0.01;
    check_motion(s.sys, &s.params, s.p, &s.state, NODES, "rod");
    swarm_clear(&s);
    flux_field_destroy(flow);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_shell_adjoint),
                                       cmocka_unit_test(test_rod_adjoint)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
