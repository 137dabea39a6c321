/* What holds a moving body: against closed forms, Newton's law for its mass centre, and runs that went on. */
#include <math.h>
#include <stdio.h>
#include <unistd.h>
#define NAME "test_support_forces"
#include "tests/run_fixture.h"

/* A sheet of 40 x 10 mm and 1 mm: 0.4 g, with 27 vertices. */
#define SHEET                                                                                                \
    "slender: 1\njob: simulate\noutput: {precision: double}\n"                                               \
    "shell:\n  mesh: {shape: sheet, size: [40 mm, 10 mm], cells: [8, 2]}\n  thickness: 1 mm\n"               \
    "  poisson: 0.3\n  density: 1000\n  gravity: [0, 0, -9.81]\n"

static const double SHEET_MASS = 0.4e-3, G = 9.81;

static const double *numbers(const Array *array)
{
    assert_int_equal(array->type, ARRAY_FLOAT64);
    return array->data;
}

static void assert_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance)) fail_msg("%.17g, not %.17g", value, wanted);
}

/* ---- Closed forms ---- */

/* All of it is moved along x by a t^2/2 and up by u t: M (a - g), and a drag of 27 vertices; in each step to rounding. */
static void test_accelerated(void **state)
{
    (void)state;
    Result *result = run_text(mem_text(SHEET "  young: 1 MPa\n  damping: 1e-4\n"
                                             "fix: [{box: [[-1, -1, -1], [1, 1, 1]], move: [\"x + 10*t^2\", "
                                             "y, \"0.3*t\"]}]\ntime: {step: 1 ms, steps: 6}\n"
                                             "probes: {pull: {force: all}, entry: {force: {fix: 0}}}\n"));
    Array all = read_all(result, "slender/history/support_force"),
          pull = read_all(result, "slender/probes/pull"), entry = read_all(result, "slender/probes/entry");
    assert_true(all.rank == 3 && all.dims[0] == 6 && all.dims[1] == 1 && all.dims[2] == 3);
    assert_true(pull.dims[0] == 7 && !strcmp(all.unit, "N"));
    for (int n = 2; n <= 6; n++) {
        double speed = 10e-3 * (2 * n - 1); /* of implicit Euler: the step's mean */
        const double *force = numbers(&all) + 3 * (n - 1);
        assert_near(force[0], SHEET_MASS * 20 + 27 * 1e-4 * speed, 1e-9);
        assert_near(force[1], 0, 1e-12);
        assert_near(force[2], SHEET_MASS * G + 27 * 1e-4 * 0.3, 1e-9);
        for (int i = 0; i < 3; i++) {
            assert_near(numbers(&pull)[3 * n + i], force[i], 1e-16);
            assert_true(numbers(&entry)[3 * n + i] == force[i]);
        }
    }
    assert_near(numbers(&pull)[2], SHEET_MASS * G, 1e-12); /* the start, as at rest */
    Array *read[] = {&all, &pull, &entry};
    for (int k = 0; k < 3; k++) array_clear(read[k]);
    result_close(result);
}

/* A plate that falls from level about its edge: it pulls with m g cos a + m L/2 w^2 along itself. */
static void test_pendulum(void **state)
{
    (void)state;
    Result *result =
        run_text(mem_text(SHEET "  young: 100 MPa\nfix: [{group: root}]\ntime: {step: 0.5 ms, steps: 200}\n"
                                "probes: {tip: {group: tip}, pull: {force: root}}\n"));
    Array tip = read_all(result, "slender/probes/tip"), pull = read_all(result, "slender/probes/pull");
    double pulled = 0;
    for (int n = 40; n < 200; n += 20) {
        const double *at = numbers(&tip) + 3 * n, *force = numbers(&pull) + 3 * n;
        double angle = atan2(at[0], -at[2]), speed = (atan2(at[3], -at[5]) - atan2(at[-3], -at[-1])) / 1e-3,
               wanted = SHEET_MASS * (G * cos(angle) + 0.04 / 2 * speed * speed);
        pulled = -force[0] * sin(angle) + force[2] * cos(angle);
        assert_near(pulled, wanted, 0.02 * SHEET_MASS * G);
    }
    assert_true(pulled > 2 * SHEET_MASS * G);
    array_clear(&tip);
    array_clear(&pull);
    result_close(result);
}

/* A damped strip that has come to rest: its weight. */
static void test_weight(void **state)
{
    (void)state;
    Result *result = run_text(mem_text(
        SHEET
        "  young: 5 MPa\n  damping: 2e-4\nfix: [{group: root, clamp: true}]\ntime: {step: 20 ms, steps: "
        "40}\nprobes: {pull: {force: root}}\n"));
    Array pull = read_all(result, "slender/probes/pull");
    assert_near(numbers(&pull)[3 * 40 + 2], SHEET_MASS * G, 1e-6 * SHEET_MASS * G);
    array_clear(&pull);
    result_close(result);
}

/* ---- The mass centre ---- */

/* All that holds a body in motion is M (a - g) of its mass centre, a as steps of time have it; wanted per N of weight. */
static void check_law(const char *scene, double mass, double tolerance)
{
    const double dt = 1e-3;
    Result *result =
        run_text(mem_format("%stime: {step: 1 ms, steps: 12}\nprobes: {centre: {mass_center: true}, "
                            "pull: {force: all}}\n",
                            scene));
    Array centre = read_all(result, "slender/probes/centre"), pull = read_all(result, "slender/probes/pull");
    double most = 0;
    for (int n = 1; n <= 12; n++)
        for (int i = 0; i < 3; i++) {
            const double *now = numbers(&centre) + 3 * n + i, *force = numbers(&pull) + 3 * n + i;
            double before = n > 1 ? now[-6] : now[-3], a = (now[0] - 2 * now[-3] + before) / (dt * dt);
            assert_near(*force, mass * (a + (i == 2) * G), tolerance * mass * G);
            most = fmax(most, fabs(a));
        }
    assert_true(most > 0.1 * G);
    array_clear(&centre);
    array_clear(&pull);
    result_close(result);
}

static void test_mass_centre(void **state)
{
    (void)state;
    check_law(SHEET "  young: 1 MPa\n  magnetization: [3.0e+4, 0, 0]\nfix: [{group: root, clamp: true}, "
                    "{vertices: [8], axes: y}]\nflux_density: [0, 0, \"0.01*sin(300*t)\"]\n",
              SHEET_MASS, 1e-6);
    check_law("slender: 1\njob: simulate\noutput: {precision: double}\n"
              "solid: {mesh: {shape: box, size: [20 mm, 4 mm, 4 mm], cells: [4, 1, 1]}, young: 1 MPa,\n"
              "        poisson: 0.3, density: 1000, gravity: [0, 0, -9.81]}\n"
              "fix: [{box: [[-1, -1, -1], [0, 1, 1]], move: [x, \"y + 0.001*sin(200*t)\", z]}]\n",
              0.32e-3, 1e-6);
    check_law(
        "slender: 1\njob: simulate\noutput: {precision: double}\n"
        "rod: {natural_strain: [0, 0, 0], length: 0.1, elements: 12, radius: 1 mm, young: 1 MPa, poisson: "
        "0.4, density: 1000,\n      gravity: [0, 0, -9.81]}\n",
        1e-7 * acos(-1) * 1000, 1e-6);
}

/* ---- Runs that went on, and trajectories ---- */

/* A moved root, steps between frames: the bits of the run in one go. */
static void test_resumed(void **state)
{
    (void)state;
    static const char scene[] = SOURCE_DIR "/tests/scene_simulate.yaml";
    const char *whole[] = {"probes={pull: {force: all}}", "time.steps=11"},
               *part[] = {"probes={pull: {force: all}}", "time.steps=5"};
    Result *result = run_file(scene, whole, 2, false);
    Array force = read_all(result, "slender/history/support_force"),
          pull = read_all(result, "slender/probes/pull");
    assert_true(force.dims[0] == 11 && pull.dims[0] == 5); /* frames 0, 3, 6, 9 and the end */
    assert_near(numbers(&pull)[3 * 4 + 2], numbers(&force)[3 * 10 + 2], 1e-15);
    result_close(result);
    result_close(run_file(scene, part, 2, false));
    result = run_file(scene, whole, 2, true);
    Array again = read_all(result, "slender/history/support_force"),
          pulled = read_all(result, "slender/probes/pull");
    assert_memory_equal(again.data, force.data, 33 * sizeof(double));
    assert_memory_equal(pulled.data, pull.data, 15 * sizeof(double));
    Array *read[] = {&force, &pull, &again, &pulled};
    for (int k = 0; k < 4; k++) array_clear(read[k]);
    result_close(result);
}

/* Those of the motion that was found: a simulation in its field has them, to its steps' tolerance. */
static void test_trajectory(void **state)
{
    (void)state;
    const char *settings[] = {"design.iterations=1", "probes={pull: {force: all}}", "output.every=10"};
    Result *result = run_file(SOURCE_DIR "/tests/scene_trajectory.yaml", settings, 3, false);
    Array force = read_all(result, "slender/trajectory/support_force"),
          pull = read_all(result, "slender/probes/pull");
    assert_true(force.dims[0] == 30 && pull.dims[0] == 4);
    for (int n = 1; n < 4; n++)
        for (int i = 0; i < 3; i++)
            assert_near(numbers(&pull)[3 * n + i], numbers(&force)[3 * (10 * n - 1) + i], 1e-15);
    assert_true(fabs(numbers(&force)[3 * 29 + 2]) > 1e-6);
    array_clear(&force);
    array_clear(&pull);
    result_close(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_accelerated), cmocka_unit_test(test_pendulum),
                                       cmocka_unit_test(test_weight),      cmocka_unit_test(test_mass_centre),
                                       cmocka_unit_test(test_resumed),     cmocka_unit_test(test_trajectory)};
    return cmocka_run_group_tests(tests, remove_run, remove_run);
}
