/* Modes in Hz: strips, bars and rods that are clamped at one end, or free, against Euler and Bernoulli's beam. */
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

/* Without positions as dofs, and with them (a potential that is 0). */
static char *rod(const char *gravity, int positions)
{
    return mem_format("slender: 1\njob: equilibrium\nrod:\n  natural_strain: [0, 0, 0]\n  length: 0.1\n"
                      "  elements: 50\n  radius: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n  density: 1100\n"
                      "  gravity: [%s, 0, 0]\n%smodes: 4\n",
                      gravity, positions ? "  loads: [{potential: \"0*x\"}]\n" : "");
}

/* Section pi r^2, EI = Y pi r^4/4: as if sqrt 3 r high. Modes come in pairs. */
static void test_rod(void **state)
{
    (void)state;
    double first = beam(1.875104, sqrt(3) * 1e-3, 1100), second = beam(4.694091, sqrt(3) * 1e-3, 1100);
    for (int k = 0; k < 2; k++)
        check(rod("0", k), 4, (int[]){0, 1, 2, 3, -1}, (double[]){first, first, second, second}, 0.01);
}

static char *held_rod(const char *hold, const char *end, double young)
{
    return mem_format("slender: 1\njob: equilibrium\nrod:\n  natural_strain: [0, 0, 0]\n  length: 0.1\n"
                      "  elements: 50\n  radius: 1 mm\n  young: %g\n  poisson: 0.3\n  density: 1100\n"
                      "  gravity: [0, 0, 0]\n  hold: %s\n  end: {position: [0.1, 0, 0], %s}\nmodes: 4\n",
                      young, hold, end);
}

/* Straight between its ends: what holds them depends on no turn, and on hinges it spins, which nothing holds and no mass has. */
static void test_held_rod(void **state)
{
    (void)state;
    for (double young = YOUNG; young <= 1e12; young *= 1e3) {
        double stiff = sqrt(young / YOUNG), hinged[2], clamped[2];
        for (int k = 0; k < 2; k++) {
            hinged[k] = stiff * beam((k + 1) * M_PI, sqrt(3) * 1e-3, 1100);
            clamped[k] = stiff * beam(k ? 7.853205 : 4.730041, sqrt(3) * 1e-3, 1100);
        }
        check(held_rod("pinned", "hold: pinned", young), 4, (int[]){0, 1, 2, 3, -1},
              (double[]){hinged[0], hinged[0], hinged[1], hinged[1]}, 0.01);
        check(held_rod("clamped", "hold: clamped, frame: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]", young), 4,
              (int[]){0, 1, 2, 3, -1}, (double[]){clamped[0], clamped[0], clamped[1], clamped[1]}, 0.01);
    }
}

/* A stiff rod on one hinge swings as a stick does, f^2 = 3 g/(2 L)/(2 pi)^2. */
static void test_rod_pendulum(void **state)
{
    (void)state;
    double exact = sqrt(3 * 9.81 / (2 * LENGTH)) / (2 * M_PI);
    char *scene =
        mem_format("slender: 1\njob: equilibrium\nrod:\n  natural_strain: [0, 0, 0]\n  length: 0.1\n"
                   "  elements: 50\n  radius: 1 mm\n  young: 10 GPa\n  poisson: 0.3\n  density: 1100\n"
                   "  hold: pinned\nmodes: 2\n");
    check(scene, 2, (int[]){0, 1, -1}, (double[]){exact, exact}, 1e-3);
}

/* Hanging down it swings faster: with w = rho A g L^3/(EI) the square is Rayleigh's of the clamped rod's mode,
 * 1 + 1.5709 w/3.51602^2, from above. */
static void test_hanging_rod(void **state)
{
    (void)state;
    double w = 1100 * 9.81 * 1e-3 / (1e6 * 1e-6 / 4), found[2],
           most = beam(1.875104, sqrt(3) * 1e-3, 1100) * sqrt(1 + 1.5709 * w / 3.51602 / 3.51602);
    for (int k = 0; k < 2; k++) {
        Result *result = run_text(rod("9.81", k));
        Array hz = read_all(result, "slender/final/modes_hz");
        found[k] = *(const double *)hz.data;
        print_message("hanging: %.5f Hz, at most %.5f Hz\n", found[k], most);
        array_clear(&hz);
        result_close(result);
    }
    assert_true(fabs(found[1] / found[0] - 1) < 1e-6);
    assert_true(found[0] < most && found[0] > 0.98 * most);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clamped_strip), cmocka_unit_test(test_free_strip),
        cmocka_unit_test(test_clamped_bar),   cmocka_unit_test(test_rod),
        cmocka_unit_test(test_held_rod),      cmocka_unit_test(test_rod_pendulum),
        cmocka_unit_test(test_hanging_rod)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
