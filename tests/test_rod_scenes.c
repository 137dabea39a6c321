/* Scenes of rods that meet something, as the program reads them: a stream, a floor at rest, and those of scenes/ in small. */
#define NAME "test_rod_scenes"
#include "solve/march.h"
#include "tests/run_fixture.h"
#include <math.h>
#include <stdio.h>

/* ---- What scenes say becomes what they say ---- */

static const char STILL[] =
    "slender: 1\njob: %s\nrod:\n  natural_strain: [0, 0, 0]\n  length: 0.1\n  radius: 1 mm\n"
    "  elements: 20\n  young: %s\n  poisson: 0.4\n  density: 1200\n%s";

/* The force of the first element on its clamp, which bears all but half an element, by its multipliers. */
static const double *clamp_force(const Built *b)
{
    return b->model->cases[0].state.x + 6 * 21;
}

/* A stiff rod in a stream across it, and along it: as one that sinks so fast. */
static void test_stream(void **state)
{
    (void)state;
    double mu = 0.05, rho = 900, r = 1e-3, L = 0.1, v = 0.02, slender = log(L / r), part = 1 - 0.5 / 20;
    double across = L * (4 * M_PI * mu / (slender + 0.5) * v + rho * 1.1 * r * v * v),
           along = L * 2 * M_PI * mu / (slender - 0.5) * v;
    for (int k = 0; k < 2; k++) {
        char *world = mem_format(
            "  gravity: [0, 0, 0]\ntime: {step: 1, steps: 1}\nwater: {density: 900, viscosity: 0.05, "
            "velocity: [%g, 0, %g]}\n",
            k ? v : 0, k ? 0 : v);
        Built b = scene_build(mem_format(STILL, "simulate", "1e15", world));
        Case *c = &b.model->cases[0];
        MarchDef def = march_default();
        for (int step = 0; step < 5; step++) {
            MarchInfo info;
            assert_true(march_step(c->sys, &def, 1, c->stages[0].p, &c->state, &info));
        }
        double force = clamp_force(&b)[k ? 0 : 2], exact = part * (k ? along : across);
        print_message("a stream %s: %.6e N, exactly %.6e\n", k ? "along" : "across", force, exact);
        assert_true(fabs(force / exact - 1) < 1e-5);
        mem_free(world);
        clear(&b);
    }
}

/* ---- Whole runs ---- */

/* The largest number of a history; least: the least. */
static double extreme(Result *result, const char *path, bool least)
{
    Array array = read_all(result, path);
    const double *values = array.data;
    double found = values[0];
    for (int i = 1; i < array.dims[0]; i++) found = least ? fmin(found, values[i]) : fmax(found, values[i]);
    array_clear(&array);
    return found;
}

/* A rod that has fallen on a floor, and the equilibrium there. */
static void test_rest(void **state)
{
    (void)state;
    static const char FLOOR[] = "  gravity: [0, 0, -9.81]\n  clamp: {position: [0, 0, 5 mm]}\n%s"
                                "obstacles: [{name: floor, plane: {}}]\n";
    double tip[2][3];
    for (int k = 0; k < 2; k++) {
        char *world = mem_format(
            FLOOR, k ? "  damping: 0.05\ntime: {step: 20 ms, steps: 100}\noutput: {every: 100}\n" : "");
        Result *result = run_text(mem_format(STILL, k ? "simulate" : "equilibrium", "1 MPa", world));
        Array x = read_all(result, "slender/rod/x"),
              depth = read_all(result, "slender/cases/case1/contact_depth");
        memcpy(tip[k], (const double *)x.data + 3 * 20, sizeof *tip);
        assert_true(*(const double *)depth.data > 0 && *(const double *)depth.data < 1e-5);
        array_clear(&x);
        array_clear(&depth);
        result_close(result);
        mem_free(world);
    }
    print_message("tip at rest: x = %.6f, z = %.7f; after a fall %.6f, %.7f\n", tip[0][0], tip[0][2],
                  tip[1][0], tip[1][2]);
    for (int i = 0; i < 3; i++) assert_true(fabs(tip[0][i] - tip[1][i]) < 1e-7);
}

static int tip_touches(Result *result, int node)
{
    int touches = 0;
    for (int k = 1; k < result_step_count(result); k++) {
        Array force;
        Error err;
        if (!result_read_step(result, "PointData/contact_force", k, &force, &err)) fail_msg("%s", err.text);
        const double *f = (const double *)force.data + 3 * node;
        touches += f[0] * f[0] + f[1] * f[1] + f[2] * f[2] > 1e-18;
        array_clear(&force);
    }
    return touches;
}

/* The tip of a catheter scrapes along a bent pipe, but for the field. */
static void test_pipe(void **state)
{
    (void)state;
    int touches[2];
    for (int k = 0; k < 2; k++) {
        const char *const settings[] = {"rod.elements=40", "time.step=10 ms", "time.steps=150",
                                        "output.every=1", "rod.magnetization=[0, 0, 0]"};
        Result *result = run_file(SOURCE_DIR "/scenes/rod_pipe.yaml", settings, 4 + k, false);
        touches[k] = tip_touches(result, 40);
        assert_true(extreme(result, "slender/history/contact_depth", false) < 1e-2 * 5e-4);
        result_close(result);
    }
    print_message("the tip touches the pipe in %d of 150 steps, without a field in %d\n", touches[0],
                  touches[1]);
    assert_true(touches[0] < 8 && touches[1] > 55);
}

/* Hair on a head, combed. */
static void test_comb(void **state)
{
    (void)state;
    const char *const settings[] = {"rod.curve.strands=25", "time.steps=200"};
    Result *result = run_file(SOURCE_DIR "/scenes/hair_comb.yaml", settings, 2, false);
    Array x = read_all(result, "slender/rod/x"), strands = read_all(result, "slender/rod/strands");
    assert_int_equal(strands.dims[0], 26);
    assert_int_equal(((const int *)strands.data)[25], 25 * 11);
    double nearest = INFINITY, contacts = extreme(result, "slender/history/contacts", false),
           distance = extreme(result, "slender/history/self_distance", true);
    for (int i = 0; i < x.dims[0]; i++) {
        const double *at = (const double *)x.data + 3 * i;
        nearest = fmin(nearest, sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]));
    }
    print_message(
        "hair: up to %g contacts, nearest %.3f mm above the head, strands %.2f mm from each other\n",
        contacts, 1e3 * (nearest - 0.0795), 1e3 * distance);
    assert_true(extreme(result, "slender/history/crossings", false) == 0);
    assert_true(nearest > 0.0795 + 0.985 * 5e-4 && contacts > 20 && distance > 0.8e-3);
    array_clear(&x);
    array_clear(&strands);
    result_close(result);
}

/* A finished run of strands in contact that is extended is that which was longer from the beginning, bit by bit, its frames
 * with what the result had beside moving points left out. */
static void test_extended(void **state)
{
    (void)state;
    double *x[2], *force[2];
    int points = 0;
    for (int k = 0; k < 2; k++) {
        const char *const settings[] = {"rod.curve.strands=12", "output.every=2", "time.step=4 ms",
                                        "time.steps=60", "time.steps=67"};
        const char *const longer[] = {settings[0], settings[1], settings[2], settings[4]};
        if (k) result_close(run_file(SOURCE_DIR "/scenes/hair_comb.yaml", settings, 4, false));
        Result *result = run_file(SOURCE_DIR "/scenes/hair_comb.yaml", longer, 4, k);
        Array end = read_all(result, "slender/state/dofs"), touch;
        Error err;
        points = end.dims[0] > 0 ? end.dims[end.rank - 1] : 0;
        x[k] = mem_copy(end.data, (size_t)points, sizeof *x[k]);
        assert_int_equal(result_step_count(result), 35);
        assert_true(result_read_step(result, "PointData/contact_force", 28, &touch, &err));
        force[k] = mem_copy(touch.data, 3 * 12 * 11, sizeof *force[k]);
        array_clear(&touch);
        array_clear(&end);
        result_close(result);
    }
    double largest = 0;
    for (int i = 0; i < 3 * 12 * 11; i++) largest = fmax(largest, fabs(force[0][i]));
    assert_true(points > 12 * 11 * 6 && largest > 0);
    assert_memory_equal(x[0], x[1], (size_t)points * sizeof *x[0]);
    assert_memory_equal(force[0], force[1], 3 * 12 * 11 * sizeof *force[0]);
    for (int k = 0; k < 2; k++) {
        mem_free(x[k]);
        mem_free(force[k]);
    }
}

/* ---- Poses ---- */

/* A rod's pose evaluated: what its case is said to be. */
static void expect_status(char *text, const char *wanted)
{
    Result *result = run_text(text);
    Array status;
    Error err;
    if (!result_read(result, "slender/cases/case1/status", &status, &err)) fail_msg("%s", err.text);
    assert_string_equal(status.data, wanted);
    array_clear(&status);
    result_close(result);
}

/* A column under its own weight stands up to g m L^3/(EI) = 7.8373 [Greenhill 1881]: of turns only, and with positions and
 * multipliers, which a field of position asks for. */
static void test_column(void **state)
{
    (void)state;
    static const char text[] =
        "slender: 1\njob: evaluate\nrod:\n  natural_strain: [0, 0, 0]\n  length: 1\n  radius: 10 mm\n"
        "  clamp: {frame: [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]}\n  young: 1 MPa\n  poisson: 0.4\n"
        "  density: 1000\n  elements: 60\n  gravity: [0, 0, %.9g]\n%s";
    double r = 0.01, bending = 1e6 * M_PI * pow(r, 4) / 4, mass = 1000 * M_PI * r * r;
    for (int k = 0; k < 4; k++) {
        double weight = k % 2 ? 7.88 : 7.80;
        const char *field = k / 2 ? "flux_density: {dipole: {at: [1, 0, 0], moment: [0, 0, 1]}}\n" : "";
        expect_status(mem_format(text, -weight * bending / mass, field), k % 2 ? "saddle" : "converged");
    }
}

/* Where a rod came to rest it is said to rest, and nowhere else: held at its other end, on a floor, beside a magnet. */
static void test_rest_again(void **state)
{
    (void)state;
    static const char *const around[] = {
        "  end: {position: [80 mm, 0, 0]}\nflux_density: [0, 0, %s]\n",
        "  end: {position: [80 mm, 0, 0], hold: clamped, frame: [[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]]}\n"
        "flux_density: [0, 0, %s]\n",
        "flux_density: [0, 0, %s]\nobstacles: [{plane: {point: [0, 0, -5 mm], normal: [0, 0, 1]}}]\n",
        "flux_density: [0, 0, %s]\n",
    };
    static const char text[] =
        "slender: 1\njob: %s\nrod:\n  natural_strain: [0, 2, 0]\n  length: 0.1\n  radius: 0.5 mm\n"
        "  young: 5 MPa\n  poisson: 0.5\n  density: 1200\n  elements: 30\n  magnetization: [2.0e+4, 1000, "
        "0]\n%s%s";
    for (size_t k = 0; k < sizeof around / sizeof *around; k++) {
        for (int step = 0; step < 3; step++) {
            char *here = mem_format(around[k], step == 2 ? "6 mT" : "5 mT");
            char *scene = mem_format(text, step ? "evaluate" : "equilibrium", here,
                                     step ? "start: {result: rest.vtkhdf}\n" : "");
            expect_status(scene, step == 2 ? "evaluated" : "converged");
            if (step == 0) assert_int_equal(rename(NAME ".vtkhdf", "rest.vtkhdf"), 0);
            mem_free(here);
        }
    }
    unlink("rest.vtkhdf");
}

/* The pull at the ends of a chain that long, between places so far apart and one so much higher than the other:
 * 2 a sinh(apart/2a) = sqrt(L^2 - h^2), H = w a. */
static double catenary_pull(double length, double apart, double high, double weight)
{
    double low = 0.1 * apart, up = 10 * apart, chord = sqrt(length * length - high * high);
    for (int k = 0; k < 100; k++) {
        double a = 0.5 * (low + up);
        *(2 * a * sinh(apart / (2 * a)) > chord ? &low : &up) = a;
    }
    return weight * low;
}

/* A cable between two towers, of a rod that is hardly bent: a motion by long steps brings it near, an equilibrium goes on from there. */
static void test_cable(void **state)
{
    (void)state;
    static const char text[] =
        "slender: 1\njob: %s\nrod:\n  model: cosserat\n  natural_strain: [0, -0.01, 0]\n  length: 110\n"
        "  radius: 15 mm\n  young: 60 GPa\n  poisson: 0.3\n  density: 4000\n  elements: 120\n  hold: pinned\n"
        "  end: {position: [100, 0, 10]}\n%s";
    expect_status(mem_format(text, "simulate", "time: {step: 0.5, steps: 60}\n"), "converged");
    assert_int_equal(rename(NAME ".vtkhdf", "rest.vtkhdf"), 0);
    Result *result = run_text(mem_format(text, "equilibrium", "start: {result: rest.vtkhdf}\n"));
    Array force = read_all(result, "slender/final/support_force");
    double exact = catenary_pull(110, 100, 10, 4000 * 9.81 * M_PI * 0.015 * 0.015),
           pull = -((const double *)force.data)[0];
    print_message("a cable pulls with %.1f N, a chain with %.1f N\n", pull, exact);
    assert_true(fabs(pull / exact - 1) < 5e-3);
    array_clear(&force);
    result_close(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_stream),     cmocka_unit_test(test_rest),
                                       cmocka_unit_test(test_pipe),       cmocka_unit_test(test_comb),
                                       cmocka_unit_test(test_extended),   cmocka_unit_test(test_column),
                                       cmocka_unit_test(test_rest_again), cmocka_unit_test(test_cable)};
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
