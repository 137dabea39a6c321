/* Sheets of St. Venant-Kirchhoff that are pulled until nothing is left of their width, in whole runs. */
#include "solve/newton.h"
#define NAME "test_crushed"
#include "tests/run_fixture.h"
#include <math.h>

static const double LINE = 200, THICKNESS = 1e-3, POISSON = 0.3;

/* A square in its plane, free across. */
static char *pulled(const char *job, double young, const char *more)
{
    return mem_format(
        "slender: 1\njob: %s\nshell:\n  mesh: {shape: sheet, size: [40 mm, 40 mm], cells: [4, 4]}\n"
        "  thickness: %.17g\n  young: %.17g\n  poisson: %.17g\nfix:\n"
        "  - {box: [[-1, -1, -1], [1e-6, 1, 1]], axes: x}\n  - {box: [[-1, -1, -1], [1, 1e-6, 1]], axes: y}\n"
        "  - {box: [[-1, -1, -1], [1, 1, 1]], axes: z}\nloads:\n"
        "  - {line: [%.17g, 0, 0], on: {box: [[39.99 mm, -1, -1], [1, 1, 1]]}}\n%s",
        job, THICKNESS, young, POISSON, LINE, more);
}

/* That bears the load at G = 1/(2 nu), where no width is left: of the stress Y G (1 + 2 G)^1/2. */
static double least_young(void)
{
    double strain = 1 / (2 * POISSON);
    return LINE / THICKNESS / (strain * sqrt(1 + 2 * strain));
}

static Result *run_badly(char *text)
{
    SlenderError err;
    SlenderScene *scene = slender_scene_parse(text, NULL, 0, &err);
    mem_free(text);
    return run_to(scene, &err, false, SLENDER_NOT_CONVERGED);
}

static void test_equilibrium(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        Result *result = run_badly(pulled("equilibrium", (k ? 0.98 : 1.02) * least_young(), ""));
        Array status = read_all(result, "slender/cases/case1/status");
        assert_string_equal((const char *)status.data,
                            newton_status_name(k ? NEWTON_CRUSHED : NEWTON_CONVERGED));
        array_clear(&status);
        result_close(result);
    }
}

/* A design that is to be as long as crushed sheets alone are ends before it crushes. */
static void test_design(void **state)
{
    (void)state;
    Result *result = run_badly(pulled(
        "design", 5e5,
        "target: {formula: [\"2.6*x\", y, \"0\"], axes: x, on: {box: [[39.99 mm, -1, -1], [1, 1, 1]]}}\n"
        "design:\n  optimizer: gauss_newton\n  iterations: 20\n  objectives: [{target: 1}]\n"
        "  unknowns: {young: {per: body, bounds: [10 kPa, 10 MPa]}}\n"));
    Array young = read_all(result, "slender/design/young");
    double part = *(double *)young.data / least_young();
    print_message("designed down to %.4f of the least modulus\n", part);
    assert_true(part > 1 && part < 1.05);
    array_clear(&young);
    result_close(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_equilibrium), cmocka_unit_test(test_design)};
    return cmocka_run_group_tests(tests, remove_run, remove_run);
}
