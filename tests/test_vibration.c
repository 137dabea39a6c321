/* Modes in Hz: strips and bars that are clamped at one end, or free, against Euler and Bernoulli's beam. */
#include "base/memory.h"
#include <math.h>

#define NAME "test_vibration"
#include "tests/run_fixture.h"

#define LENGTH 0.1
#define YOUNG  1e6

/* f = (beta L)^2/(2 pi L^2) sqrt(Y h^2/(12 rho)). */
static double beam(double beta_length, double height, double density)
{
    return beta_length * beta_length / (2 * M_PI * LENGTH * LENGTH) *
           sqrt(YOUNG * height * height / (12 * density));
}

/* A mode is a unit vector, as those of the stiffness alone are. */
static void check_modes(Result *result, int count)
{
    Array modes = read_all(result, "slender/final/vibrations");
    const double *v = modes.data;
    assert_int_equal(modes.rank, 3);
    assert_int_equal(modes.dims[0], count);
    for (int k = 0, each = modes.dims[1] * 3; k < count; k++) {
        double sum = 0;
        for (int i = 0; i < each; i++) sum += v[k * each + i] * v[k * each + i];
        assert_true(fabs(sum - 1) < 1e-12);
    }
    array_clear(&modes);
}

static void check(char *scene, int count, const int *which, const double *exact, double within)
{
    Result *result = run_text(scene);
    Array hz = read_all(result, "slender/final/modes_hz");
    assert_string_equal(hz.unit, "Hz");
    assert_int_equal(hz.dims[0], count);
    const double *f = hz.data;
    for (int k = 0; which[k] >= 0; k++) {
        double ratio = f[which[k]] / exact[k];
        print_message("mode %d: %.5f Hz, of a beam %.5f Hz\n", which[k], f[which[k]], exact[k]);
        assert_true(exact[k] > 0 ? fabs(ratio - 1) < within : fabs(f[which[k]]) < 1e-3 * f[count - 1]);
    }
    check_modes(result, count);
    array_clear(&hz);
    result_close(result);
}

static char *strip(const char *job, const char *rest)
{
    return mem_format(
        "slender: 1\njob: %s\nshell:\n  mesh: {shape: strip, size: [100 mm, 10 mm], n: 40}\n"
        "  thickness: 0.5 mm\n  young: 1 MPa\n  poisson: 0\n  density: 1100\noutput: {precision: double}\n%s",
        job, rest);
}

static void test_clamped_strip(void **state)
{
    (void)state;
    check(strip("equilibrium", "fix: [{group: root, clamp: true}]\nmodes: 3\n"), 3, (int[]){0, 1, 2, -1},
          (double[]){beam(1.875104, 5e-4, 1100), beam(4.694091, 5e-4, 1100), beam(7.854757, 5e-4, 1100)},
          0.01);
}

/* Six modes of a free body cost nothing. */
static void test_free_strip(void **state)
{
    (void)state;
    check(strip("evaluate", "modes: 8\n"), 8, (int[]){0, 1, 2, 3, 4, 5, 6, 7, -1},
          (double[]){0, 0, 0, 0, 0, 0, beam(4.730041, 5e-4, 1100), beam(7.853205, 5e-4, 1100)}, 0.01);
}

/* Of a bar both ways that it bends; the density is the default, 1000. */
static void test_clamped_bar(void **state)
{
    (void)state;
    check(mem_text("slender: 1\njob: equilibrium\nsolid:\n"
                   "  mesh: {shape: box, size: [100 mm, 4 mm, 8 mm], cells: [25, 1, 2]}\n"
                   "  young: 1 MPa\n  poisson: 0\nfix: [{group: left}]\nmodes: 3\n"),
          3, (int[]){0, 1, 2, -1},
          (double[]){beam(1.875104, 4e-3, 1000), beam(1.875104, 8e-3, 1000), beam(4.694091, 4e-3, 1000)},
          0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_clamped_strip),
                                       cmocka_unit_test(test_free_strip), cmocka_unit_test(test_clamped_bar)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
