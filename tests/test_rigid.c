/* Rigid motions that nothing holds: counted, refused under a net force, and solved with a base shift. */
#include "surface/rigid.h"
#include "base/memory.h"
#include "solve/newton.h"
#include "tests/shell_fixture.h"
#include <math.h>

static Shell *make_sheet(void)
{
    Shell *shell = shell_of_sheet((double[]){0.02, 0.01}, (int[]){6, 3}, PATTERN_RIGHT);
    shell->thickness = 1e-3, shell->poisson = 0.3, shell->density = 1000;
    return shell;
}

static void test_count(void **state)
{
    (void)state;
    Shell *shell = make_sheet();
    assert_int_equal(rigid_free_count(shell->mesh, shell->fixed, shell->clamped), 6);
    for (int i = 0; i < 3; i++) shell_fix(shell, 0, i);
    assert_int_equal(rigid_free_count(shell->mesh, shell->fixed, shell->clamped), 3);
    for (int i = 0; i < 3; i++) shell_fix(shell, 6, i); /* the other end of the edge y = 0 */
    assert_int_equal(rigid_free_count(shell->mesh, shell->fixed, shell->clamped), 1);
    shell_clamp(shell, mesh_edge(shell->mesh, 0, 1));
    assert_int_equal(rigid_free_count(shell->mesh, shell->fixed, shell->clamped), 0);
    shell_destroy(shell);
}

static bool is_balanced(const Shell *shell, const double *p, Error *err)
{
    double *mass = mem_alloc((size_t)shell->mesh->vertex_count, sizeof *mass);
    shell_vertex_mass(shell, p, mass);
    bool ok = rigid_check_force(shell->mesh, shell->fixed, mass, p + shell->gravity, p + shell->load, err);
    mem_free(mass);
    return ok;
}

static void test_net_force(void **state)
{
    (void)state;
    Shell *shell = make_sheet();
    double *p = mem_alloc((size_t)shell->params.size, sizeof *p);
    Error err;
    shell_default_params(shell, p);
    assert_true(is_balanced(shell, p, &err));
    p[shell->load + 3 * 5 + 1] = 1e-3, p[shell->load + 3 * 9 + 1] = -1e-3;
    assert_true(is_balanced(shell, p, &err));
    p[shell->gravity + 2] = -10;
    assert_false(is_balanced(shell, p, &err));
    assert_string_equal(
        err.text, "a net force of -0.002 N along z acts on a body that nothing holds along z: it has no "
                  "equilibrium; fix a vertex, or take the force away");
    shell_fix(shell, 3, 2);
    assert_true(is_balanced(shell, p, &err));
    mem_free(p);
    shell_destroy(shell);
}

/* A free sheet in a uniform field turns until its magnetisation lies along it. */
static void test_compass(void **state)
{
    (void)state;
    Shell *shell = make_sheet();
    Body b = body_create(shell, shell_system(shell), 1e6);
    assert_true(system_base_shift(b.sys) > 0);
    for (int f = 0; f < shell->mesh->face_count; f++) b.p[shell->magnetization + 3 * f] = 1e5;
    b.p[shell->flux.uniform] = 1e-3, b.p[shell->flux.uniform + 2] = 2e-3;
    NewtonDef def = newton_default();
    NewtonInfo info = newton_minimize(b.sys, &def, &(Point){.p = b.p}, &b.state, NULL);
    assert_int_equal(info.status, NEWTON_CONVERGED);
    const double *x = b.state.x;
    double along = x[3 * 6] - x[0], up = x[3 * 6 + 2] - x[2];
    assert_true(fabs(atan2(up, along) - atan2(2, 1)) < 1e-6);
    body_clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_count), cmocka_unit_test(test_net_force),
                                       cmocka_unit_test(test_compass)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
