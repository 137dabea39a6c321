/* Loads of rods, as scenes say them: a couple at the end and its inversion, line loads by formula, potentials, formulas of the
 * time, and what identifications make of them. */
#define NAME "test_rod_loads"
#include "base/vec3.h"
#include "tests/run_fixture.h"
#include <math.h>
#include <stdio.h>

static const double radius = 1e-3, young = 1e6;

static double bend(void)
{
    return young * M_PI * pow(radius, 4) / 4;
}

/* A straight rod of 0.1 m along x without weight: job, elements, Poisson's ratio, loads, and what else. */
static char *rod_text(const char *job, int elements, double poisson, const char *loads, const char *more)
{
    return mem_format(
        "slender: 1\njob: %s\nrod:\n  natural_strain: [0, 0, 0]\n  length: 0.1\n  radius: 1 mm\n"
        "  elements: %d\n  young: 1 MPa\n  poisson: %g\n  density: 1000\n  gravity: [0, 0, 0]\n"
        "  loads: [%s]\n%s",
        job, elements, poisson, loads, more);
}

/* rod/x, or another array of the nodes' vectors, of a run; the caller frees. */
static double *run_nodes(char *text, const char *path, int nodes)
{
    Result *result = run_text(text);
    Array array = read_all(result, path);
    assert_int_equal(array.dims[0], nodes);
    double *values = mem_copy(array.data, 3 * (size_t)nodes, sizeof *values);
    array_clear(&array);
    result_close(result);
    return values;
}

static double farthest(const double *a, const double *b, int nodes)
{
    double far = 0;
    for (int i = 0; i < nodes; i++)
        far = fmax(far, vec3_length(vec3_sub(vec3_load(a + 3 * i), vec3_load(b + 3 * i))));
    return far;
}

/* A couple of 8 EI/L at the end, by 0.7 rad off the tangent, winds the rod up to a helix; and the helix, inverted with it, is a
 * straight rod, in Bishop's frames twisted by what the couple twists. */
static void test_helix(void **state)
{
    (void)state;
    enum { N = 100 };
    const double angle = 0.7, k = 80, C = k * bend(), c = cos(angle), s = sin(angle);
    char *couple = mem_format("{point: end, couple: [%.17g, 0, %.17g]}", C * c, C * s);
    double *x = run_nodes(rod_text("equilibrium", N, 0, couple, ""), "slender/rod/x", N + 1), off = 0;
    for (int i = 0; i <= N; i++) {
        double at = 0.1 * i / N, turn = k * at;
        Vec3 axis = vec3(c, 0, s), across = vec3(s * s, 0, -s * c);
        Vec3 exact = vec3_axpy(sin(turn) / k, across, vec3_scale(at * c, axis));
        exact = vec3_axpy((1 - cos(turn)) / k, vec3_cross(axis, across), exact);
        off = fmax(off, vec3_length(vec3_sub(vec3_load(x + 3 * i), exact)));
    }
    print_message("equilibrium: %.1e L off the helix\n", off / 0.1);
    assert_true(off < 1e-14);
    mem_free(x);
    for (int round = 0; round < 2; round++) {
        double poisson = round ? 0.4 : 0, twist = -C * c * (1 + poisson) / bend(), worst = 0;
        Result *result = run_text(mem_format(
            "slender: 1\njob: invert\nchecks: [round_trip]\nrod:\n  curve: {formula: "
            "[\"%.17g*sin(u)+%.17g*u\", "
            "\"%.17g*(1-cos(u))\", \"%.17g*(u-sin(u))\"], range: [0, 8]}\n  radius: 1 mm\n  elements: 400\n"
            "  young: 1 MPa\n  poisson: %g\n  density: 1000\n  gravity: [0, 0, 0]\n  loads: [%s]\n",
            s * s / k, c * c / k, s / k, s * c / k, poisson, couple));
        Array strain = read_all(result, "slender/rod/natural_strain"),
              trip = read_all(result, "slender/metrics/round_trip");
        for (int i = 0; i <= 400; i++) {
            const double *own = (const double *)strain.data + 3 * i;
            worst = fmax(worst, vec3_length(vec3(own[0] - twist, own[1], own[2])));
        }
        print_message(
            "inverted, GJ/EI = %.2f: natural strains %.1e of the curvature off a straight rod's, round trip "
            "%.1e m\n",
            1 / (1 + poisson), worst / (k * s), *(const double *)trip.data);
        assert_true(worst < 1e-8 * k && *(const double *)trip.data < 1e-12);
        array_clear(&strain);
        array_clear(&trip);
        result_close(result);
    }
    mem_free(couple);
}

/* Small deflections of cantilevers: q L^4/30 EI at the end for a load that falls from q at the clamp to none there; with a
 * stiffness under it of k per length and a force P at the end, 2 P beta/k, beta^4 = k/4EI, if it is long. */
static void test_deflections(void **state)
{
    (void)state;
    enum { N = 200 };
    const double q = 1e-6, k = 4 * bend() * pow(80, 4), P = 1e-8;
    double *x = run_nodes(rod_text("equilibrium", N, 0.4, "{line: [\"0\", \"0\", \"-1e-6*(1-s/L)\"]}", ""),
                          "slender/rod/x", N + 1);
    double triangle = -x[3 * N + 2] / (q * pow(0.1, 4) / (30 * bend())) - 1;
    char *loads =
        mem_format("{potential: \"k/2*z^2\", where: {k: \"%.17g\"}}, {point: end, force: [0, 0, %g]}", k, P);
    double *y = run_nodes(rod_text("equilibrium", N, 0.4, loads, ""), "slender/rod/x", N + 1);
    double bed = y[3 * N + 2] / (2 * P * 80 / k) - 1;
    print_message("triangular load: %.1e of the deflection off; on an elastic bed %.1e\n", triangle, bed);
    assert_true(fabs(triangle) < 1e-4 && fabs(bed) < 1e-3);
    mem_free(x);
    mem_free(y);
    mem_free(loads);
}

/* What a formula says that numbers say, too; and a potential that is linear in the place is a line load: in statics, and over
 * time in motion. The load at the end is that of the time there. */
static void test_times(void **state)
{
    (void)state;
    enum { N = 20 };
    static const char steps[] = "  damping: 0.01\ntime: {step: 2 ms, steps: 25}\n";
    static const char stages[] = "sequence: [{time: 0.02}, {time: 0.05}]\n";
    static const struct {
        const char *job, *more, *one, *other;
    } pairs[] = {
        {"equilibrium", "", "{line: [0, 1.0e-5, 2.0e-5]}", "{line: [\"0\", \"1e-5\", \"2e-5\"]}"},
        {"equilibrium", "", "{line: [0, 1.0e-5, 2.0e-5]}", "{potential: \"-1e-5*y-2e-5*z\"}"},
        {"simulate", steps, "{line: [\"0\", \"0\", \"0.1*t\"]}", "{potential: \"-0.1*t*z\"}"},
        {"simulate", steps, "{point: end, force: [\"0\", \"0\", \"1e-4\"]}",
         "{point: 0.1, force: [0, 0, 1.0e-4]}"},
        {"equilibrium", stages, "{point: end, couple: [\"0\", \"t*1e-5\", \"0\"]}",
         "{point: end, couple: [0, 5.0e-7, 0]}"},
        {"equilibrium", stages, "{line: [\"0\", \"0\", \"4e-4*t\"]}", "{line: [0, 0, 2.0e-5]}"},
        {"equilibrium", "time: {at: 0.05}\n", "{potential: \"-4e-4*t*z\"}", "{line: [0, 0, 2.0e-5]}"},
    };
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++) {
        double *a = run_nodes(rod_text(pairs[k].job, N, 0.4, pairs[k].one, pairs[k].more), "slender/rod/x",
                              N + 1),
               *b = run_nodes(rod_text(pairs[k].job, N, 0.4, pairs[k].other, pairs[k].more), "slender/rod/x",
                              N + 1);
        print_message("%s as %s: %.1e m apart, the end has moved by %.2g m\n", pairs[k].one, pairs[k].other,
                      farthest(a, b, N + 1), hypot(a[3 * N + 1], a[3 * N + 2]));
        assert_true(farthest(a, b, N + 1) < 1e-9 && hypot(a[3 * N + 1], a[3 * N + 2]) > 1e-4);
        mem_free(a);
        mem_free(b);
    }
    double *load =
        run_nodes(rod_text("simulate", N, 0.4, "{point: end, force: [\"0\", \"t^2\", \"0\"]}", steps),
                  "slender/design/load", N + 1);
    assert_true(fabs(load[3 * N + 1] - 0.05 * 0.05) < 1e-15 && load[3 * N] == 0);
    mem_free(load);
}

/* ---- Poses of one rod ---- */

static const char pose_loads[] =
    "{line: [\"0\", \"1e-5*s/L\", \"-4e-5*(1-s/L)\"]}, {point: end, couple: [1.0e-6, 2.0e-6, -1.0e-6]}";
static const char *const frames[] = {"[[1, 0, 0], [0, 1, 0], [0, 0, 1]]", "[[0, 0, 1], [1, 0, 0], [0, 1, 0]]",
                                     "[[0, 1, 0], [0, 0, 1], [1, 0, 0]]"};

static void write_pose(int k, const char *job_loads, double gravity)
{
    enum { N = 200 };
    char path[40];
    double *x = run_nodes(mem_format("slender: 1\njob: equilibrium\nrod:\n  natural_strain: [4, 8, 2]\n"
                                     "  length: 0.1\n  clamp: {frame: %s}\n  radius: 1 mm\n  elements: %d\n"
                                     "  young: 1 MPa\n  poisson: 0.4\n  density: 1000\n"
                                     "  gravity: [0, 0, %g]\n  loads: [%s]\n",
                                     frames[k], N, gravity, job_loads),
                          "slender/rod/x", N + 1);
    snprintf(path, sizeof path, NAME "_%d.csv", k);
    FILE *file = fopen(path, "w");
    for (int i = 0; i <= N; i++) fprintf(file, "%.17g,%.17g,%.17g\n", x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    fclose(file);
    mem_free(x);
}

static double number(Result *result, const char *name)
{
    char *path = mem_format("slender/rod/identified/%s", name);
    Array array = read_all(result, path);
    double value = *(const double *)array.data;
    array_clear(&array);
    mem_free(path);
    return value;
}

/* What the poses are said to be of, with loads as they were. */
static Result *identify_poses(const char *noise, const char *material, double gravity, const char *loads)
{
    char *poses = mem_text("");
    for (int k = 0; k < 3; k++) {
        char *pose = mem_format("    - {file: " NAME "_%d.csv, noise: %s, frame: %s}\n", k, noise, frames[k]);
        poses = mem_join(poses, pose, "");
        mem_free(pose);
    }
    Result *result = run_text(
        mem_format("slender: 1\njob: identify\nrod:\n  poses:\n%s%s  gravity: [0, 0, %g]\n  loads: [%s]\n",
                   poses, material, gravity, loads));
    mem_free(poses);
    return result;
}

/* Poses of a rod that formulas pull at and a couple turns tell its modulus. */
static void test_identify(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) write_pose(k, pose_loads, 0);
    Result *result = identify_poses("0", "  radius: 1 mm\n  density: 1000\n", 0, pose_loads);
    double E = number(result, "young"), nu = number(result, "poisson");
    print_message("identified: E off by %.1e, nu by %.1e\n", E / young - 1, nu - 0.4);
    assert_true(fabs(E / young - 1) < 1e-3 && fabs(nu - 0.4) < 5e-3);
    result_close(result);
}

/* Radius and density: the weight grows with what is looked for, formulas and potentials do not. What is called noise is put on
 * the poses with the loads where it has them: the standard error covers what the smoothing does. */
static void test_identify_weight(void **state)
{
    (void)state;
    static const char loads[] = "{line: [\"0\", \"1e-3*s/L\", \"0\"]}, {potential: \"5e-2*(x^2+y^2)\"}";
    static const struct {
        const char *name, *material;
        double exact;
    } sought[] = {{"radius", "  young: 1 MPa\n  poisson: 0.4\n  density: 1000\n", 1e-3},
                  {"density", "  young: 1 MPa\n  poisson: 0.4\n  radius: 1 mm\n", 1000}};
    for (int k = 0; k < 3; k++) write_pose(k, loads, -9.81);
    for (int k = 0; k < 4; k++) {
        bool exact = k < 2;
        char *error_name = mem_format("%s_error", sought[k % 2].name);
        Result *result = identify_poses(exact ? "0" : "1.0e-5", sought[k % 2].material, -9.81, loads);
        double off = number(result, sought[k % 2].name) / sought[k % 2].exact - 1,
               error = number(result, error_name) / sought[k % 2].exact;
        print_message("%s off by %.1e +- %.1e\n", sought[k % 2].name, off, error);
        assert_true(fabs(off) < (exact ? 1e-3 : 4 * error) && error < 1e-2 && error > (exact ? 0 : 1e-5));
        result_close(result);
        mem_free(error_name);
    }
    for (int k = 0; k < 3; k++) {
        char *path = mem_format(NAME "_%d.csv", k);
        remove(path);
        mem_free(path);
    }
}

/* A range of loads, in place of the scene's, is the same as formulas of a time that goes evenly; the last stage alone is a case
 * with its loads. A potential stays beside them. */
static void test_ranges(void **state)
{
    (void)state;
    enum { N = 20, STAGES = 5 };
    static const char beside[] = "{potential: \"-1e-5*y\"}";
    static const char last[] =
        "[{line: [0, 0, 2.0e-5]}, {point: end, force: [0, 2 uN, 0]}, {point: 0.031, couple: [1.0e-6, 0, 0]}]";
    char *formulas =
        mem_format("%s, {line: [\"0\", \"0\", \"1e-5*(1+t)\"]}, {point: end, force: [\"0\", \"2e-6*t\", "
                   "\"0\"]}, {point: 0.031, couple: [\"1e-6*t\", \"0\", \"0\"]}",
                   beside);
    char *replaced = mem_format("%s, {point: 0.05, force: [0, 0, 1]}", beside);
    char *more[] = {
        mem_format("sequence: {time: {from: 0, to: 1, count: %d}}\noutput: {precision: double}\n", STAGES),
        mem_format("sequence: {loads: {from: [{line: [0, 0, 1.0e-5]}], to: %s, count: %d}}\noutput: "
                   "{precision: double}\n",
                   last, STAGES),
        mem_format("cases: [{name: last, loads: %s}]\n", last)};
    Array x[2];
    for (int k = 0; k < 2; k++) {
        Result *result = run_text(rod_text("equilibrium", N, 0.4, k ? replaced : formulas, more[k]));
        x[k] = read_all(result, "slender/frames/x");
        assert_int_equal(x[k].dims[0], STAGES);
        result_close(result);
    }
    double *a = run_nodes(rod_text("equilibrium", N, 0.4, replaced, more[2]), "slender/rod/x", N + 1);
    double off = farthest(x[0].data, x[1].data, STAGES * (N + 1)),
           alone = farthest((const double *)x[0].data + 3 * (STAGES - 1) * (N + 1), a, N + 1);
    print_message("ranges of loads: %.1e m off formulas of t, the last one alone %.1e m\n", off, alone);
    assert_true(off < 1e-9 && alone < 1e-9);
    mem_free(a);
    mem_free(formulas);
    mem_free(replaced);
    for (int k = 0; k < 3; k++) mem_free(more[k]);
    for (int k = 0; k < 2; k++) array_clear(&x[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_helix),           cmocka_unit_test(test_deflections),
        cmocka_unit_test(test_times),           cmocka_unit_test(test_identify),
        cmocka_unit_test(test_identify_weight), cmocka_unit_test(test_ranges)};
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
