/* Rods whose ends are led by formulas of time, in whole runs of scenes; and what holds them. */
#define NAME "test_rod_ends"
#include "tests/run_fixture.h"
#include "base/vec3.h"
#include <math.h>

static const double PI = 3.14159265358979323846;

static const double *numbers(const Array *array)
{
    return array->data;
}

/* A straight rod along x of round section: GJ = E/(2(1 + nu)) pi r^4/2 with nu = 0.5. */
enum { N = 40 };
static const double LENGTH = 0.2, GJ = 1e6 / 3 * 3.14159265358979323846e-12 / 2;

#define STRAIGHT                                                                                             \
    "slender: 1\nrod:\n  radius: 1 mm\n  young: 1 MPa\n  poisson: 0.5\n  density: 1000\n  elements: 40\n"    \
    "  natural_strain: [0, 0, 0]\n  length: 0.2\n"
#define WEIGHTLESS STRAIGHT "  gravity: [0, 0, 0]\n"
#define END        "  end: {position: [0.2, 0, 0], hold: clamped, frame: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "

static void check_rows(Result *result, const char *path, const double *wanted, int count, double most)
{
    Array rows = read_all(result, path);
    assert_int_equal((int)array_count(&rows), count);
    for (int i = 0; i < count; i++)
        if (!(fabs(numbers(&rows)[i] - wanted[i]) <= most))
            fail_msg("%s[%d] is %.12g, not %.12g", path, i, numbers(&rows)[i], wanted[i]);
    array_clear(&rows);
}

/* ---- Statics ---- */

/* An end that turns about the rod, by two turns and more: the torque is G J angle/L, with as many turns as were made, also
 * where one stage makes all of them. */
static void test_torque(void **state)
{
    (void)state;
    static const char *const sequences[] = {"[{time: 0}, {time: 1}, {time: 2}]", "[{time: 2}]"};
    for (int k = 0; k < 2; k++) {
        Result *result =
            run_text(mem_format("%s%sturn: [\"7*t\", \"0\", \"0\"]}\njob: equilibrium\nsequence: %s\n"
                                "probes: {first: {couple: 0}, last: {couple: 1}}\n",
                                WEIGHTLESS, END, sequences[k]));
        double wanted[2][9] = {{0}}, torque = GJ * 7 / LENGTH;
        for (int n = 0; n < 3; n++) wanted[1][3 * n] = n * torque, wanted[0][3 * n] = -n * torque;
        int from = k ? 6 : 0;
        check_rows(result, "slender/probes/first", wanted[0] + from, 9 - from, 1e-7 * torque);
        check_rows(result, "slender/probes/last", wanted[1] + from, 9 - from, 1e-7 * torque);
        const double both[6] = {-2 * torque, 0, 0, 2 * torque, 0, 0};
        check_rows(result, "slender/final/support_couple", both, 6, 1e-7 * torque);
        Array energy = read_all(result, "slender/final/energy/strain");
        assert_true(fabs(*numbers(&energy) / (torque * 14) - 1) < 1e-9);
        array_clear(&energy);
        result_close(result);
    }
}

/* Euler's elastica between hinges: an end that moves by 2 (1 - E/K) of the length, k = sin 30 degrees, is pushed by
 * 4 K^2 EI/L^2. The last stage returns, and the rod with it. */
static void test_elastica(void **state)
{
    (void)state;
    const double K = 1.6857503548125961, E = 1.4674622093394272, EI = 1e6 * PI * 1e-12 / 4;
    Result *result = run_text(mem_format("slender: 1\njob: equilibrium\nrod:\n  radius: 1 mm\n  young: 1 "
                                         "MPa\n  poisson: 0.5\n  density: 1000\n"
                                         "  natural_strain: [0, 1.0e-4, 0]\n  length: 1\n  elements: 100\n  "
                                         "gravity: [0, 0, 0]\n  hold: pinned\n"
                                         "  end: {position: [1, 0, 0], move: [\"-%.16g*t\", 0, 0]}\n"
                                         "sequence: [{time: 0.1}, {time: 1}, {time: 0.1}]\nprobes: {push: "
                                         "{force: {fix: 1}}, mid: {vertex: 50}}\n",
                                         2 * (1 - E / K)));
    Array push = read_all(result, "slender/probes/push"), mid = read_all(result, "slender/probes/mid");
    const double *F = numbers(&push), *x = numbers(&mid);
    double off = -F[3] / (4 * K * K * EI) - 1, deflection = hypot(x[4], x[5]) - 0.5 / K;
    print_message("elastica by an end that moves: force %.1e off, deflection %.1e m off\n", off, deflection);
    assert_true(fabs(off) < 4e-4 && fabs(deflection) < 2e-4);
    assert_true(fabs(F[6] / F[0] - 1) < 1e-6);
    array_clear(&push);
    array_clear(&mid);
    result_close(result);
}

/* What holds a rod bears its weight and the moment of it, in both forms: of turns only, and (with a potential of nothing)
 * with positions. A load at a point and its couple are borne, too. */
static void test_weight(void **state)
{
    (void)state;
    const double weight = 1000 * PI * 1e-6 * LENGTH * 9.81;
    for (int k = 0; k < 2; k++) {
        Result *result = run_text(
            mem_format("%s  loads:\n    - {point: 0.1, force: [0, 1 mN, 0], couple: [0, 0, 2.0e-6]}\n%s"
                       "job: equilibrium\nprobes: {mass: {mass_center: true}, at: {vertex: 20}}\n",
                       STRAIGHT, k ? "    - {potential: \"0*z\"}\n" : ""));
        Array mass = read_all(result, "slender/probes/mass"), at = read_all(result, "slender/probes/at");
        Vec3 moment = vec3_add(vec3_cross(vec3_load(numbers(&mass)), vec3(0, 0, -weight)),
                               vec3_cross(vec3_load(numbers(&at)), vec3(0, 1e-3, 0)));
        const double force[3] = {0, -1e-3, weight}, couple[3] = {-moment.x, -moment.y, -moment.z - 2e-6};
        check_rows(result, "slender/final/support_force", force, 3, 1e-9 * weight);
        check_rows(result, "slender/final/support_couple", couple, 3, 1e-7 * weight * LENGTH);
        check_rows(result, "slender/cases/case1/support_couple", couple, 3, 1e-7 * weight * LENGTH);
        array_clear(&mass);
        array_clear(&at);
        result_close(result);
    }
}

/* A clamp that turns to where gravity is another: the rod hangs from it as one that is clamped so. */
static void test_turned_clamp(void **state)
{
    (void)state;
    Array x[2];
    for (int k = 0; k < 2; k++) {
        Result *result = run_text(mem_format(
            "%s  clamp: {%s}\njob: equilibrium\n", STRAIGHT,
            k ? "position: [0.01, 0, 0], frame: [[0, 0.6, 0.8], [0, -0.8, 0.6], [1, 0, 0]]"
              : "position: [0, 0, 0], move: [\"0.01\", \"0\", \"0\"], turn: [\"0\", \"0\", \"0\"], "
                "frame: [[0, 0.6, 0.8], [0, -0.8, 0.6], [1, 0, 0]]"));
        x[k] = read_all(result, "slender/state/x");
        result_close(result);
    }
    for (int i = 0; i < 3 * (N + 1); i++) assert_true(fabs(numbers(&x[0])[i] - numbers(&x[1])[i]) < 1e-9);
    for (int k = 0; k < 2; k++) array_clear(&x[k]);
}

/* ---- Motions ---- */

/* Results say where the ends are: the last one's columns are those of a turn about z of 0.3 rad a stage. */
static void test_poses(void **state)
{
    (void)state;
    Result *result =
        run_text(mem_format("%s%smove: [\"-0.01*t\", \"0\", \"0\"], turn: [\"0\", \"0\", \"0.3*t\"]}\n"
                            "job: equilibrium\nsequence: {time: {from: 0, to: 2, count: 3}}\n",
                            WEIGHTLESS, END));
    double wanted[3][2][12] = {{{0}}};
    for (int n = 0; n < 3; n++)
        for (int k = 0; k < 2; k++) {
            double c = cos(0.3 * n * k), s = sin(0.3 * n * k), x = k * (LENGTH - 0.01 * n);
            const double pose[12] = {c, -s, 0, x, s, c, 0, 0, 0, 0, 1, 0};
            memcpy(wanted[n][k], pose, sizeof pose);
        }
    check_rows(result, "slender/frames/support_pose", wanted[0][0], 72, 1e-12);
    check_rows(result, "slender/rod/support_pose", wanted[0][0], 24, 1e-12);
    result_close(result);
}

/* The outline of a rectangle that tapers is that of the first end, corners and all; of a circle it is round. */
static void test_outline(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        Result *result = run_text(mem_format(
            "slender: 1\njob: evaluate\nrod:\n  %s\n  young: 1 GPa\n  poisson: 0.5\n  density: 1000\n  "
            "length: 0.1\n"
            "  natural_strain: [0, 0, 0]\n  elements: 10\n",
            k ? "section: {width: {formula: \"0.003*(1 - s/L/2)\"}, height: 1 mm}" : "radius: 2 mm"));
        Array outline = read_all(result, "slender/rod/section_outline");
        int corners = 0;
        for (int i = 0; i < outline.dims[0]; i++) {
            double y = fabs(numbers(&outline)[2 * i]), z = fabs(numbers(&outline)[2 * i + 1]);
            if (k) assert_true(fabs(fmax(y / 1.5e-3, z / 0.5e-3) - 1) < 1e-12);
            if (!k) assert_true(fabs(hypot(y, z) - 2e-3) < 1e-15);
            corners += fabs(y - 1.5e-3) + fabs(z - 0.5e-3) < 1e-15;
        }
        assert_int_equal(corners, k ? 4 : 0);
        array_clear(&outline);
        result_close(result);
    }
}

/* kg, of a node: half an element at the ends. */
static double node_mass(double length, int i)
{
    return 1e-3 * PI * length / N * (i == 0 || i == N ? 0.5 : 1);
}

/* What held the first end in each step of a motion is what accelerated the rod and bore its weight, and turned it about there:
 * implicit Euler's accelerations are second differences of its frames. With `couple` the moments are balanced, too; returns the
 * largest force. */
static double check_reactions(Result *result, double length, double dt, bool couple)
{
    Array x = read_all(result, "slender/frames/x"), force = read_all(result, "slender/history/support_force"),
          turn = read_all(result, "slender/history/support_couple");
    double most = 0, off = 0, turned = 0;
    for (int n = 2; n < x.dims[0]; n++) {
        Vec3 sum = vec3(0, 0, 0), moment = sum, own = vec3_load(numbers(&force) + 3 * (n - 1)),
             held = vec3_load(numbers(&turn) + 3 * (n - 1));
        const double *at = numbers(&x) + 3 * (N + 1) * n;
        for (int i = 0; i <= N; i++) {
            Vec3 x0 = vec3_load(at + 3 * i), x1 = vec3_load(at - 3 * (N + 1) + 3 * i),
                 x2 = vec3_load(at - 6 * (N + 1) + 3 * i);
            Vec3 a = vec3_scale(1 / (dt * dt), vec3_add(vec3_axpy(-2, x1, x0), x2));
            Vec3 f = vec3_scale(node_mass(length, i), vec3_add(a, vec3(0, 0, 9.81)));
            sum = vec3_add(sum, f);
            moment = vec3_add(moment, vec3_cross(vec3_sub(x0, vec3_load(at)), f));
        }
        off = fmax(off, vec3_length(vec3_sub(sum, own)));
        turned = fmax(turned, vec3_length(vec3_sub(moment, held)));
        most = fmax(most, vec3_length(own));
    }
    print_message("reactions: %.1e of %.1e N off, couples %.1e N m\n", off, most, turned);
    assert_true(off < 1e-6 * most && (!couple || turned < 1e-6 * most * length));
    array_clear(&x);
    array_clear(&force);
    array_clear(&turn);
    return most;
}

/* A clamp that is accelerated evenly, from rest as implicit Euler has it (a (t^2 + t dt)/2): a rod whose curve bears its inertia
 * goes with it as a rigid one. The load that stands for the inertia acts at the beginning only, where the natural strains are
 * found. */
static void test_accelerated(void **state)
{
    (void)state;
    enum { STEPS = 60 };
    Result *result = run_text(mem_format(
        "slender: 1\njob: simulate\nrod:\n  radius: 1 mm\n  young: 20 MPa\n  poisson: 0.5\n  density: 1000\n"
        "  elements: 40\n  curve: {formula: [\"0.02*sin(20*u)\", \"u/2\", \"-u\"], range: [0, 0.15]}\n"
        "  start: curve\n  clamp: {move: [\"2*(t*t + 0.01*t)/2\", \"0\", \"-1*(t*t + 0.01*t)/2\"]}\n"
        "  loads: [{line: [\"-2*%.17g*(t > 0 ? 0 : 1)\", \"0\", \"%.17g*(t > 0 ? 0 : 1)\"]}]\n"
        "time: {step: 10 ms, steps: %d}\noutput: {precision: double}\n",
        1e-3 * PI, 1e-3 * PI, STEPS));
    Array x = read_all(result, "slender/frames/x");
    Array length = read_all(result, "slender/rod/s");
    double most = 0;
    assert_int_equal(x.dims[0], STEPS + 1);
    for (int n = 0; n <= STEPS; n++)
        for (int i = 0; i < 3 * (N + 1); i++) {
            double t = 0.01 * n, way = (t * t + 0.01 * t) / 2, a[3] = {2, 0, -1};
            double off = numbers(&x)[3 * (N + 1) * n + i] - a[i % 3] * way - numbers(&x)[i];
            most = fmax(most, fabs(off));
        }
    print_message("accelerated by 2.2 m/s^2 over 0.4 m: %.1e m off a rigid motion\n", most);
    assert_true(most < 1e-12);
    check_reactions(result, numbers(&length)[N], 0.01, true);
    array_clear(&x);
    array_clear(&length);
    result_close(result);
}

/* A stiff rod on a hinge, let go as it lies: where it hangs its hinge bears 5/2 of its weight (1 % less with these steps of first
 * order), and does not turn it. */
static void test_pendulum(void **state)
{
    (void)state;
    Result *result = run_text(mem_format(
        "slender: 1\njob: simulate\nrod:\n  radius: 1 mm\n  young: 10 GPa\n  poisson: 0.5\n  density: 1000\n"
        "  elements: 40\n  natural_strain: [0, 0, 0]\n  length: 0.2\n  hold: pinned\n"
        "time: {step: 0.5 ms, steps: 450}\noutput: {precision: double}\nprobes: {hinge: {force: {fix: 0}}, "
        "none: {couple: 0}}\n"));
    double weight = 1e-3 * PI * LENGTH * 9.81, most = check_reactions(result, LENGTH, 5e-4, true);
    print_message("a pendulum's hinge bears %.4f of its weight\n", most / weight);
    assert_true(fabs(most / weight - 2.5) < 0.03);
    Array probe = read_all(result, "slender/probes/hinge"),
          force = read_all(result, "slender/history/support_force"),
          none = read_all(result, "slender/probes/none");
    assert_int_equal(probe.dims[0], 451);
    assert_memory_equal(numbers(&probe) + 3, force.data, array_count(&force) * sizeof(double));
    for (size_t i = 0; i < array_count(&none); i++) assert_true(numbers(&none)[i] == 0);
    array_clear(&probe);
    array_clear(&force);
    array_clear(&none);
    result_close(result);
}

/* Turns have no inertia: a straight rod whose last clamp turns about it, while the first one turns the other way, is twisted
 * evenly in every frame. Both begin turned already. */
static void test_wound_up(void **state)
{
    (void)state;
    Result *result =
        run_text(mem_format("%s  clamp: {turn: [\"-1 - 10*t\", \"0\", \"0\"]}\n%sturn: [\"1 + 30*t\", \"0\", "
                            "\"0\"]}\njob: simulate\n"
                            "time: {step: 5 ms, steps: 60}\noutput: {precision: double, stress: true}\n",
                            WEIGHTLESS, END));
    Array strain;
    Error err;
    for (int n = 0; n <= 60; n += 20) {
        if (!result_read_step(result, "PointData/strain", n, &strain, &err)) fail_msg("%s", err.text);
        double wanted = (2 + 40 * 0.005 * n) / LENGTH, off = 0;
        for (int i = 0; i < 3 * (N + 1); i++) {
            double value =
                strain.type == ARRAY_FLOAT64 ? numbers(&strain)[i] : ((const float *)strain.data)[i];
            off = fmax(off, fabs(value - (i % 3 ? 0 : wanted)));
        }
        assert_true(off < 2e-6 * wanted);
        array_clear(&strain);
    }
    Array couple = read_all(result, "slender/history/support_couple");
    for (int n = 1; n <= 60; n++) {
        double torque = GJ * (2 + 40 * 0.005 * n) / LENGTH;
        const double *own = numbers(&couple) + 6 * (n - 1);
        assert_true(fabs(own[0] + torque) < 1e-7 * torque && fabs(own[3] - torque) < 1e-7 * torque);
    }
    array_clear(&couple);
    result_close(result);
}

/* A motion that goes on from another one's end is that one, bit for bit. */
static void test_resumed(void **state)
{
    (void)state;
    static const char form[] =
        "%s  clamp: {move: [\"0.02*sin(20*t)\", \"0\", \"0\"], turn: [\"0\", \"t\", \"0\"]}\njob: "
        "simulate\ntime: {step: 5 ms, steps: %d}\noutput: {precision: double}\n";
    SlenderError err;
    Array x[2];
    for (int k = 0; k < 2; k++) {
        for (int part = k; part < 2; part++) {
            char *text = mem_format(form, STRAIGHT, part ? 20 : 7);
            Result *result = run(slender_scene_parse(text, NULL, 0, &err), &err, part > k);
            mem_free(text);
            if (part) x[k] = read_all(result, "slender/frames/x");
            result_close(result);
        }
    }
    assert_int_equal(x[0].dims[0], 21);
    assert_memory_equal(x[0].data, x[1].data, array_count(&x[0]) * sizeof(double));
    for (int k = 0; k < 2; k++) array_clear(&x[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_torque),      cmocka_unit_test(test_elastica),
        cmocka_unit_test(test_weight),      cmocka_unit_test(test_turned_clamp),
        cmocka_unit_test(test_accelerated), cmocka_unit_test(test_wound_up),
        cmocka_unit_test(test_resumed),     cmocka_unit_test(test_poses),
        cmocka_unit_test(test_outline),     cmocka_unit_test(test_pendulum),
    };
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
