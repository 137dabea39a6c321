/* Previews of rods whose ends move, in whole runs of scenes, beside Newton's motion; and previews that go on. */
#define NAME "test_rod_preview"
#include "tests/run_fixture.h"
#include <math.h>
#include <stdio.h>

enum { N = 40, STEPS = 80 };

static const double *numbers(const Array *array)
{
    return array->data;
}

/* Both clamps move and turn, for half of the time; `more` is of the rod, `rest` of the scene. */
static char *swaying(const char *more, int steps, const char *rest)
{
    return mem_format(
        "slender: 1\njob: simulate\nrod:\n  radius: 1 mm\n  young: 1 MPa\n  poisson: 0.5\n  density: 1000\n"
        "  elements: %d\n  natural_strain: [0, 3, 0]\n  length: 0.2\n  damping: 0.05\n"
        "  clamp: {move: [\"0.01*min(t, 0.4)\", \"0.02*sin(5*min(t, 0.4))\", \"0\"], turn: [\"0\", "
        "\"1.5*min(t, 0.4)\", \"0\"]}\n"
        "  end: {position: [0.15, 0, 0], hold: clamped, frame: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "
        "move: [\"-0.05*min(t, 0.4)\", \"0\", \"0\"], turn: [\"8*min(t, 0.4)\", \"0\", \"0\"]}\n"
        "%stime: {step: 10 ms, steps: %d}\noutput: {precision: double, states: all}\n%s",
        N, more, steps, rest);
}

#define PBD "  solver: pbd\n  pbd: {substeps: 100, sweeps: 2}\n"

static void test_beside_newton(void **state)
{
    (void)state;
    Array x[2], pose[2];
    for (int k = 0; k < 2; k++) {
        Result *result = run_text(swaying(k ? PBD : "", STEPS, ""));
        x[k] = read_all(result, "slender/frames/x");
        pose[k] = read_all(result, "slender/frames/support_pose");
        result_close(result);
    }
    double most = 0, last = 0;
    assert_int_equal((int)array_count(&x[0]), (int)array_count(&x[1]));
    for (size_t i = 0; i < array_count(&x[0]); i++) {
        double off = fabs(numbers(&x[0])[i] - numbers(&x[1])[i]);
        most = fmax(most, off);
        if (i >= 3 * (N + 1) * STEPS) last = fmax(last, off);
    }
    assert_int_equal((int)array_count(&pose[0]), 24 * (STEPS + 1));
    assert_int_equal((int)array_count(&pose[1]), 24 * (STEPS + 1));
    for (size_t i = 0; i < array_count(&pose[0]); i++)
        assert_true(fabs(numbers(&pose[0])[i] - numbers(&pose[1])[i]) < 1e-12);
    print_message("a preview whose ends move is %.1e m off Newton's motion at most, %.1e m at the end\n",
                  most, last);
    assert_true(most < 4e-3 && last < 1e-3);
    for (int n = 0; n <= STEPS; n++)
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < 3; i++)
                assert_true(fabs(numbers(&x[1])[3 * ((N + 1) * n + k * N) + i] -
                                 numbers(&pose[1])[12 * (2 * n + k) + 4 * i + 3]) < 1e-15);
    for (int k = 0; k < 2; k++) array_clear(&x[k]), array_clear(&pose[k]);
}

/* One that goes on from another one's end, in the middle of the ends' way, is that one, bit for bit. */
static void test_goes_on(void **state)
{
    (void)state;
    static const char first[] = NAME "_first.vtkhdf";
    Result *result = run_text(swaying(PBD, STEPS, ""));
    Array whole = read_all(result, "slender/state/dofs");
    result_close(result);
    result_close(run_text(swaying(PBD, 27, "")));
    assert_int_equal(rename(NAME ".vtkhdf", first), 0);
    result = run_text(swaying(PBD, STEPS - 27, "start: {result: " NAME "_first.vtkhdf}\n"));
    Array parts = read_all(result, "slender/state/dofs");
    result_close(result);
    assert_int_equal((int)array_count(&whole), (int)array_count(&parts));
    assert_memory_equal(whole.data, parts.data, array_count(&whole) * sizeof(double));
    array_clear(&whole);
    array_clear(&parts);
    unlink(first);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_beside_newton), cmocka_unit_test(test_goes_on)};
    return cmocka_run_group_tests(tests, remove_run, remove_run);
}
