/* A field beyond half of a coercivity is told, with its place: before the work, and where it is found out afterwards. */
#include "tests/scene_fixture.h"
#include <math.h>

/* Half of 100 kA/m is 62.8 mT. */
static const char *const shell =
    "slender: 1\njob: %s\nshell:\n  mesh: {shape: sheet, size: [40 mm, 10 mm], cells: [4, 1]}\n"
    "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n"
    "  magnetization: {formula: [\"x > 0.03 ? 1000 : 0\", \"0\", \"0\"]}\n  %s\n"
    "fix: [{box: [[-1, -1, -1], [1 mm, 1, 1]]}]\n%s\n";

static const char *const solid =
    "slender: 1\njob: %s\nsolid:\n  mesh: {shape: box, size: [20 mm, 6 mm, 4 mm], cells: [4, 1, 1]}\n"
    "  young: 1 MPa\n  poisson: 0.3\n  magnetization: [1000, 0, 0]\n"
    "  skin: {thickness: 1 mm, on: top, magnetization: [0, 0, 1000]}\n  %s\n"
    "fix: [{group: left}]\n%s\n";

static const char *const rod = "slender: 1\njob: %s\nrod:\n  natural_strain: [0, 0, 0]\n  length: 40 mm\n  "
                               "elements: 8\n  radius: 0.5 mm\n"
                               "  young: 1 MPa\n  poisson: 0.3\n  density: 1000\n  gravity: [0, 0, 0]\n"
                               "  magnetization: [\"s > 0.03 ? 1000 : 0\", \"0\", \"0\"]\n  %s\n%s\n";

/* Whether each of them, in this order and no other, is the beginning of a warning. */
static void check(const char *scene, const char *job, const char *key, const char *field,
                  const char *const expected[])
{
    Built b = scene_build(mem_format(scene, job, key, field));
    const MeshReport *report = &b.model->report;
    int count = 0;
    for (int k = 0; k < report->warning_count; k++) {
        if (!strstr(report->warnings[k], "coercivity")) continue;
        assert_non_null(expected[count]);
        if (!strstr(report->warnings[k], expected[count])) fail_msg("%s", report->warnings[k]);
        count++;
    }
    assert_null(expected[count]);
    clear(&b);
}

#define NONE ((const char *const[]){NULL})

static void test_start(void **state)
{
    (void)state;
    static const char weak[] = "flux_density: [0, 0, 62 mT]", strong[] = "flux_density: [0, 0, -64 mT]";
    static const char *const face[] = {
        "case1: face 6, at (0.0367, 0.00333, 0) m, is in a field of 0.064 T, which is 0.509 of", NULL};
    check(shell, "equilibrium", "coercivity: 100 kA/m", weak, NONE);
    check(shell, "equilibrium", "coercivity: 100 kA/m", strong, face);
    check(shell, "equilibrium", "gravity: [0, 0, 0]", strong, NONE);
    static const char *const both[] = {"case1: tetrahedron 0,", "case1: face ", NULL};
    check(solid, "equilibrium", "coercivity: 100 kA/m", weak, NONE);
    check(solid, "equilibrium", "coercivity: 100 kA/m", strong, both);
    static const char *const element[] = {"case1: element 6, at (0.0325, 0, 0) m, is in a field of 0.064 T",
                                          NULL};
    check(rod, "equilibrium", "coercivity: 100 kA/m", weak, NONE);
    check(rod, "equilibrium", "coercivity: 100 kA/m", strong, element);
}

/* Largest in the middle of a motion; in a later stage. */
static void test_time(void **state)
{
    (void)state;
    static const char *const motion[] = {"case1: face 6, ", NULL}, *const stages[] = {"sequence: face 6, ",
                                                                                      NULL};
    check(shell, "simulate", "coercivity: 100 kA/m",
          "flux_density: [\"0\", \"0\", \"0.064*sin(pi*t)\"]\ntime: {step: 10 ms, steps: 100}", motion);
    check(shell, "simulate", "coercivity: 100 kA/m",
          "flux_density: [\"0\", \"0\", \"0.062*sin(pi*t)\"]\ntime: {step: 10 ms, steps: 100}", NONE);
    check(shell, "equilibrium", "coercivity: 100 kA/m",
          "sequence: [{flux_density: [0, 0, 1 mT]}, {flux_density: [0, 0, 64 mT]}]", stages);
}

/* Moved towards a magnet, 40 mm above the end: weak there, and strong 30 mm up. */
static void test_end(void **state)
{
    (void)state;
    Built b =
        scene_build(mem_format(shell, "equilibrium", "coercivity: 100 kA/m",
                               "flux_density: {dipole: {at: [35 mm, 5 mm, 40 mm], moment: [0, 0, 1]}}"));
    assert_int_equal(b.model->report.warning_count, 0);
    Case *c = &b.model->cases[0];
    Snapshot shot = {.load_case = c, .p = c->stages[0].p, .at = c->state};
    char *doubt = b.model->body->ops->doubt(b.model, &shot);
    assert_null(doubt);
    for (int v = 0; v < b.model->point_count; v++) c->state.x[3 * v + 2] += 0.03;
    doubt = b.model->body->ops->doubt(b.model, &shot);
    assert_non_null(doubt);
    assert_non_null(strstr(doubt, ", 0.03) m, is in a field of 0.1"));
    mem_free(doubt);
    clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_start), cmocka_unit_test(test_time),
                                       cmocka_unit_test(test_end)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
