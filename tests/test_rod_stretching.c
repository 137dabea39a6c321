/* Scenes of rods with model: cosserat: what their results have, a column that stands or falls, states that are gone on
 * from and resumed, and previews beside equilibria. */
#include <math.h>
#include <string.h>

#define NAME "test_rod_stretching"
#include "tests/run_fixture.h"

/* By a row of settings that ends with NULL. */
static Result *run_set(const char *text, const char *const *settings, bool resume)
{
    SlenderError err;
    int count = 0;
    while (settings && settings[count]) count++;
    return run_to(slender_scene_parse(text, settings, count, &err), &err, resume, SLENDER_NOT_CONVERGED);
}

/* Copies the numbers of a dataset; returns how many. */
static size_t numbers(Result *result, const char *path, size_t most, double *to)
{
    Array array = read_all(result, path);
    size_t count = (size_t)array_count(&array);
    assert_true(count <= most);
    memcpy(to, array.data, count * sizeof *to);
    array_clear(&array);
    return count;
}

static const char HANGING[] =
    "slender: 1\njob: equilibrium\nrod:\n  model: cosserat\n  natural_strain: [0, 0, 0]\n  length: 0.2\n"
    "  clamp: {frame: [[0, 0, -1], [1, 0, 0], [0, -1, 0]]}\n  elements: 10\n  ellipse: [5 mm, 2 mm]\n"
    "  young: 100 kPa\n  poisson: 0.5\n  density: 1000\n  loads: [{point: 0.2, force: [1.0e-4, 0, 0]}]\n"
    "  gravity: [0, 0, -10]\n";

/* Stretch and energy of a rod that hangs and is pulled aside a little, which it shears along n1: by F over kappa G A, less
 * what its section has turned. */
static void test_result(void **state)
{
    (void)state;
    double G[30], energy, x[33];
    Result *result = run_set(HANGING, NULL, 0);
    assert_int_equal(numbers(result, "slender/final/stretch", 30, G), 30);
    numbers(result, "slender/final/energy/stretch", 1, &energy);
    numbers(result, "slender/rod/x", 33, x);
    double weight = 1000 * 10 * 0.2, sum = 0, E = 1e5, area = M_PI * 10e-6;
    for (int e = 0; e < 10; e++) {
        double expected = weight * (1 - (e + 0.5) / 10) / E;
        assert_float_equal(G[3 * e] / expected, 1, 1e-3);
        sum += 0.02 * E * area / 2 * G[3 * e] * G[3 * e];
    }
    assert_float_equal(-x[32] / (0.2 + weight * 0.2 / (2 * E)), 1, 1e-4);
    assert_float_equal(energy / sum, 1, 1e-3);
    Array point;
    Error err;
    assert_true(result_read_step(result, "PointData/stretch", result_step_count(result) - 1, &point, &err));
    const double *mean = point.data;
    assert_float_equal(mean[0], (float)G[0], 1e-7);
    assert_float_equal(mean[3 * 4], (float)((G[3 * 3] + G[3 * 4]) / 2), 1e-7);
    assert_float_equal(mean[3 * 10], (float)G[3 * 9], 1e-7);
    array_clear(&point);
    result_close(result);
}

/* The same as it is without loads: no moment turns it, but what hangs below an element is more than its strain says. */
static void test_unstretched(void **state)
{
    (void)state;
    Result *result = run_set(HANGING, (const char *const[]){"job=evaluate", "rod.loads=[]", NULL}, 0);
    Array status = read_all(result, "slender/cases/case1/status");
    assert_string_equal(status.data, "evaluated");
    array_clear(&status);
    result_close(result);
}

/* Haringx's load, as an evaluation sees it beside a pose that is in balance: from an equilibrium under less of it. */
static void test_column(void **state)
{
    (void)state;
    static const char text[] =
        "slender: 1\njob: %s\nrod:\n  model: cosserat\n  natural_strain: [0, 0, 0]\n  length: 0.1\n"
        "  elements: 50\n  radius: 10 mm\n  young: 1 MPa\n  poisson: 0.5\n  density: 1000\n"
        "  gravity: [0, 0, 0]\n  loads: [{point: 0.1, force: [%.9g, 0, 0]}]\nload_steps: 1\n";
    double r = 10e-3, EA = 1e6 * M_PI * r * r, c = (3.0 + 1 / 3.0 - 1) / EA,
           euler = M_PI * M_PI * EA * r * r / 4 / (4 * 0.01), P = (sqrt(1 + 4 * euler * c) - 1) / (2 * c);
    for (int k = 0; k < 2; k++) {
        char *scene = mem_format(text, "equilibrium", -P * (k ? 1.002 : 0.998));
        Result *result = run_set(scene, NULL, 0);
        double x[51 * 3], off = 0;
        numbers(result, "slender/rod/x", 51 * 3, x);
        for (int i = 0; i < 51; i++) off = fmax(off, hypot(x[3 * i + 1], x[3 * i + 2]));
        print_message("%.4f of Euler's load: %.1e m off\n", P * (k ? 1.002 : 0.998) / euler, off);
        assert_true(k ? off > 1e-3 : off < 1e-9);
        result_close(result);
        mem_free(scene);
    }
}

static const char SWINGING[] =
    "slender: 1\njob: simulate\nrod:\n  model: cosserat\n  natural_strain: [2, 10, 20]\n  length: 0.3\n"
    "  elements: 20\n  radius: 5 mm\n  young: 50 kPa\n  poisson: 0.5\n  density: 1070\n"
    "time: {step: 5 ms, steps: 20}\n";

/* A run that goes on is the uninterrupted one, bit by bit. */
static void test_resumed(void **state)
{
    (void)state;
    double x[2][1000];
    size_t count = 0;
    for (int k = 0; k < 2; k++) {
        if (k) result_close(run_set(SWINGING, (const char *const[]){"time.steps=9", NULL}, 0));
        Result *result = run_set(SWINGING, NULL, k);
        count = numbers(result, "slender/state/dofs", 1000, x[k]);
        result_close(result);
    }
    assert_int_equal(count, 21 * 10 + 20 * 6);
    assert_memory_equal(x[0], x[1], count * sizeof **x);
}

/* Where a swing with drag comes to rest by Newton's method, and where the preview does. */
static void test_preview(void **state)
{
    (void)state;
    static const char text[] =
        "slender: 1\njob: %s\nrod:\n  model: %s\n  natural_strain: [0, 3, 5]\n  length: 0.2\n  elements: 24\n"
        "  radius: 2 mm\n  young: 0.5 MPa\n  poisson: 0.5\n  density: 1100\n  magnetization: [2.0e+4, "
        "1.0e+4, 0]\n"
        "%s%sflux_density: [0, 2 mT, 5 mT]\n%s";
    static const char pinned[] = "  hold: pinned\n  end: {position: [0.16, 0.03, 0.05]}\n",
                      clamped[] =
                          "  end: {position: [0.16, 0.03, 0.05], hold: clamped, frame: [[0, 1, 0], [-1, 0, "
                          "0], [0, 0, 1]]}\n";
    const char *const ends[] = {"", clamped, pinned};
    for (int k = 0; k < 6; k++) {
        double x[2][75], off = 0;
        for (int preview = 0; preview < 2; preview++) {
            char *scene = mem_format(
                text, preview ? "simulate" : "equilibrium", k % 2 ? "cosserat" : "kirchhoff", ends[k / 2],
                preview ? "  solver: pbd\n  damping: 0.3\n  pbd: {substeps: 80, sweeps: 4}\n" : "",
                preview ? "time: {step: 10 ms, steps: 200}\n" : "");
            Result *result = run_set(scene, NULL, 0);
            assert_int_equal(numbers(result, "slender/rod/x", 75, x[preview]), 75);
            result_close(result);
            mem_free(scene);
        }
        for (int i = 0; i < 75; i++) off = fmax(off, fabs(x[0][i] - x[1][i]));
        print_message("%s, %s: the preview is %.2f mm off\n", k % 2 ? "cosserat" : "kirchhoff",
                      k / 2 == 0   ? "free"
                      : k / 2 == 1 ? "clamped"
                                   : "hinged",
                      off * 1e3);
        assert_true(off < (k % 2 ? 1.1e-3 : 1.5e-3));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_result), cmocka_unit_test(test_unstretched),
                                       cmocka_unit_test(test_column), cmocka_unit_test(test_resumed),
                                       cmocka_unit_test(test_preview)};
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
