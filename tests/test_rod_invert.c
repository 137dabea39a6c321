/* Whole runs of job: invert, and what their results say of the given curve. */
#include "base/memory.h"
#include "base/vec3.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#define NAME "test_rod_invert"
#include "tests/run_fixture.h"

enum { N = 100 };

/* Round, of E I = 1.988e-5 N m^2 and G J = 1.325e-5; takes the text of lines. */
static const char SCENE[] =
    "slender: 1\njob: invert\nrod:\n"
    "  curve: {formula: [\"0.015*cos(u)\", \"0.015*sin(u)\", \"-0.00318*u\"], range: [0, 19.565163762857]}\n"
    "  elements: 100\n  radius: 1.5 mm\n  young: 5 MPa\n  poisson: 0.5\n  density: 1200\n"
    "%s";
static const double BEND = 5e6 * M_PI * 5.0625e-12 / 4, WEIGHT = 1200 * M_PI * 2.25e-6 * 9.8;

static Result *invert(const char *lines)
{
    return run_text(mem_format(SCENE, lines));
}

/* Numbers of all nodes; the caller clears. */
static Array read_nodes(Result *result, const char *path)
{
    Array array = read_all(result, path);
    assert_int_equal(array.dims[0], N + 1);
    return array;
}

/* One vector of a dataset of nodes. */
static Vec3 vector_at(const Array *array, int i)
{
    return vec3_load((const double *)array->data + 3 * i);
}

/* Frames are orthonormal, and follow the curve; curvature and torsion are those of a helix; strains are the natural ones
 * and what moments add in the frames; the force is the weight of what hangs beyond a node, and the load at the middle. */
static void test_input(void **state)
{
    (void)state;
    enum { TANGENT, N1, N2, STRAIN, NATURAL, FORCE, MOMENT, CURVATURE, TORSION, COUNT };
    static const char *const paths[COUNT] = {"tangent", "n1",     "n2",        "strain", "natural_strain",
                                             "force",   "moment", "curvature", "torsion"};
    Result *result = invert("  gravity: [0, 0, -9.8]\n  frame: {formula: \"-6*pi*s/L\"}\n  loads: [{point: "
                            "0.1499, force: [1 mN, 2 mN, -3 mN]}]\n"
                            "  magnetization: [10 kA/m, 0, 0]\nflux_density: [0, 3 mT, 0]\n");
    Array a[COUNT];
    for (int k = 0; k < COUNT; k++) {
        char *path = mem_format("slender/rod/%s", paths[k]);
        a[k] = read_nodes(result, path);
        mem_free(path);
    }
    double length = 0.3, radius2 = 0.015 * 0.015 + 0.00318 * 0.00318, K[3] = {BEND / 1.5, BEND, BEND};
    double off[4] = {0};
    for (int i = 0; i <= N; i++) {
        double u = 19.565163762857 * i / N;
        Vec3 t = vector_at(&a[TANGENT], i), n1 = vector_at(&a[N1], i), n2 = vector_at(&a[N2], i);
        Vec3 along = vec3_scale(1 / sqrt(radius2), vec3(-0.015 * sin(u), 0.015 * cos(u), -0.00318));
        off[0] = fmax(off[0], vec3_length(vec3_sub(t, along)) + fabs(vec3_dot(t, n1)) +
                                  vec3_length(vec3_sub(vec3_cross(t, n1), n2)));
        Vec3 strain = vector_at(&a[STRAIN], i), M = vector_at(&a[MOMENT], i);
        Vec3 m = vec3(vec3_dot(M, t) / K[0], vec3_dot(M, n1) / K[1], vec3_dot(M, n2) / K[2]);
        off[1] = fmax(off[1], vec3_length(vec3_sub(vec3_sub(strain, vector_at(&a[NATURAL], i)), m)));
        double curvature = ((double *)a[CURVATURE].data)[i], torsion = ((double *)a[TORSION].data)[i];
        off[2] = fmax(off[2],
                      fabs(curvature - 0.015 / radius2) + fabs(hypot(strain.y, strain.z) - curvature) +
                          fabs(torsion + 0.00318 / radius2) + fabs(strain.x - torsion + 6 * M_PI / length));
        Vec3 force = vec3(0, 0, -WEIGHT * length * (N - i) / N);
        if (i < 50) force = vec3_add(force, vec3(1e-3, 2e-3, -3e-3));
        off[3] = fmax(off[3], vec3_length(vec3_sub(vector_at(&a[FORCE], i), force)));
    }
    print_message("frames off by %.0e, strains %.0e, curvature and torsion %.0e 1/m, force %.0e N\n", off[0],
                  off[1], off[2], off[3]);
    assert_true(off[0] < 1e-10 && off[1] < 1e-10 && off[2] < 2e-3 && off[3] < 1e-12);
    for (int k = 0; k < COUNT; k++) array_clear(&a[k]);
    result_close(result);
}

static double number(Result *result, const char *path)
{
    Array array;
    Error err;
    if (!result_read(result, path, &array, &err)) fail_msg("%s: %s", path, err.text);
    double value = array.type == ARRAY_INT32 ? *(int *)array.data : *(double *)array.data;
    array_clear(&array);
    return value;
}

/* rms along the rod, of the components from `first` on. */
static double rms(Result *result, const char *path, int first)
{
    Array array = read_nodes(result, path);
    double sum = 0;
    for (int i = 0; i <= N; i++)
        for (int k = first; k < 3; k++) sum += pow(((double *)array.data)[3 * i + k], 2) / (N + 1);
    array_clear(&array);
    return sqrt(sum);
}

/* Held at both ends: force and moment at the last node are those of the support, the rod stays and comes back; a support that
 * is not known leaves the rod less stressed (rms |M|/EI 11.0 without), or has its natural shape all but straight (65.8). */
static void test_held(void **state)
{
    (void)state;
    Result *result =
        invert("  gravity: [0, 0, -9.8]\n"
               "  end: {hold: clamped, force: [1 mN, -2 mN, 3 mN], couple: [20 uN m, 0, -10 uN m]}\n"
               "checks: [stability]\n");
    Array force = read_nodes(result, "slender/rod/force"), moment = read_nodes(result, "slender/rod/moment");
    assert_true(vec3_length(vec3_sub(vector_at(&force, N), vec3(1e-3, -2e-3, 3e-3))) < 1e-16);
    assert_true(vec3_length(vec3_sub(vector_at(&moment, N), vec3(2e-5, 0, -1e-5))) < 1e-18);
    assert_true(number(result, "slender/rod/stable") == 1 &&
                number(result, "slender/metrics/residual") < 1e-13);
    assert_true(number(result, "slender/metrics/strain_route") < 1e-3);
    assert_false(result_has(result, "slender/rod/critical_young"));
    array_clear(&force);
    array_clear(&moment);
    result_close(result);

    result = invert("  gravity: [0, 0, -9.8]\n  end: {hold: clamped, choose: least_stressed}\nchecks: "
                    "[stability, round_trip]\n");
    double stress = rms(result, "slender/rod/moment", 0) / BEND;
    print_message("least stressed: rms |M|/EI %.2f 1/m\n", stress);
    assert_true(fabs(stress - 5.4) < 0.05 && number(result, "slender/rod/stable") == 1);
    assert_true(number(result, "slender/metrics/round_trip") < 1e-12);
    result_close(result);

    result = invert("  gravity: [0, 0, -9.8]\n  end: {hold: clamped, choose: straightest}\n");
    double bend = rms(result, "slender/rod/natural_strain", 1);
    print_message("straightest: rms natural curvature %.2f 1/m\n", bend);
    assert_true(fabs(bend - 1.48) < 0.03);
    result_close(result);
}

/* Held at both ends under a load by formula, a potential and a couple: the discrete rod is in equilibrium, both ways to the
 * strains agree, and let down from its natural shape it comes back. */
static void test_held_loads(void **state)
{
    (void)state;
    static const char *const ends[] = {
        "{hold: clamped, force: [1 mN, -2 mN, 3 mN], couple: [20 uN m, 0, -10 uN m]}",
        "{hold: pinned, choose: least_stressed}"};
    for (int k = 0; k < 2; k++) {
        char *lines = mem_format(
            "  gravity: [0, 0, -9.8]\n  end: %s\n  loads: [{line: [\"0\", \"2e-3*s/L\", \"0.1*x\"]}, "
            "{potential: \"2*r^2\"}, {point: 0.15, couple: [10 uN m, 0, 0]}]\n"
            "checks: [round_trip]\n",
            ends[k]);
        Result *result = invert(lines);
        double left = number(result, "slender/metrics/residual"),
               route = number(result, "slender/metrics/strain_route"),
               trip = number(result, "slender/metrics/round_trip");
        print_message(
            "held, loads by formula: forces left %.0e of theirs, strains %.0e apart, back to %.0e m\n", left,
            route, trip);
        assert_true(left < 1e-12 && route < 1e-3 && trip < 1e-12);
        result_close(result);
        mem_free(lines);
    }
}

/* Four framings of one curve: four strands, other natural strains, one natural shape; turned twice by an angle that is zero
 * they are Frenet's. */
static void test_framings(void **state)
{
    (void)state;
    Result *result =
        invert("  gravity: [0, 0, -9.8]\n"
               "  frames: [frenet, bishop, {formula: \"-6*pi*s/L\"}, {formula: \"0*s\", from: frenet}]\n");
    Array natural, strain, names;
    Error err;
    assert_true(result_read_as(result, "slender/rod/natural", ARRAY_FLOAT64, 2, 3, &natural, &err));
    assert_true(result_read_as(result, "slender/rod/natural_strain", ARRAY_FLOAT64, 2, 3, &strain, &err));
    assert_true(result_read_as(result, "slender/rod/frames", ARRAY_TEXT, 1, 0, &names, &err));
    assert_int_equal(natural.dims[0], 4 * (N + 1));
    assert_memory_equal(names.data, "frenet\nbishop\n-6*pi*s/L\n0*s",
                        strlen("frenet\nbishop\n-6*pi*s/L\n0*s"));
    for (int k = 1; k < 4; k++) {
        double apart = 0;
        for (int i = 0; i <= N; i++) {
            int own = k * (N + 1) + i;
            assert_true(vec3_length(vec3_sub(vector_at(&natural, own), vector_at(&natural, i))) == 0);
            apart = fmax(apart, vec3_length(vec3_sub(vector_at(&strain, own), vector_at(&strain, i))));
        }
        assert_true(k == 3 ? apart < 1e-9 : apart > 10);
    }
    array_clear(&natural);
    array_clear(&strain);
    array_clear(&names);
    result_close(result);
}

/* ---- Of a moving rod ---- */

static const char MATERIAL[] = "  radius: 1 mm\n  young: 2 MPa\n  poisson: 0.4\n  density: 1200\n";

static void run_whole(char *text, const char *output)
{
    SlenderError trouble;
    SlenderScene *scene = slender_scene_parse(text, NULL, 0, &trouble);
    if (!scene) fail_msg("%s", trouble.text);
    SlenderRun def = {.output = output, .threads = 1, .force = true};
    if (slender_run(scene, &def, &trouble) != SLENDER_DONE) fail_msg("%s", trouble.text);
    slender_scene_destroy(scene);
    mem_free(text);
}

/* Natural strains from a simulation's frames, of so many elements, under loads: how far they are off, rms over the rod and 18
 * times. With files three frames are written out, and read again. */
static double strains_off(int elements, bool files, const char *loads)
{
    run_whole(
        mem_format(
            "slender: 1\njob: simulate\nrod:\n  natural_strain: [\"0\", \"6 + 40*s\", \"8*cos(15*s)\"]\n"
            "  length: 0.2\n  elements: %d\n%s  loads: [%s]\ntime: {step: 5 ms, steps: 20}\n"
            "output: {precision: double}\n",
            elements, MATERIAL, loads),
        NAME "_motion");
    const char *from = files ? "frames: [{file: " NAME "_7.csv, time: 35 ms, noise: 0}, {file: " NAME
                               "_8.csv, time: 40 ms, noise: 0}, {file: " NAME
                               "_9.csv, time: 45 ms, noise: 0}]"
                             : "result: " NAME "_motion.vtkhdf";
    Error err;
    Result *result = result_open(NAME "_motion.vtkhdf", &err);
    for (int k = 7; files && k < 10; k++) {
        Array x;
        char *path = mem_format(NAME "_%d.csv", k);
        FILE *file = fopen(path, "w");
        assert_true(result_read_rows(result, "slender/frames/x", k, 1, &x, &err));
        for (int i = 0; i <= elements; i++) {
            Vec3 at = vector_at(&x, i);
            fprintf(file, "%.17g, %.17g, %.17g\n", at.x, at.y, at.z);
        }
        fclose(file);
        mem_free(path);
        array_clear(&x);
    }
    result_close(result);
    run_whole(
        mem_format("slender: 1\njob: invert\nrod:\n  motion: {%s, difference: backward}\n  elements: %d\n"
                   "  bishop_normal: [0, 1, 0]\n%s  loads: [%s]\n",
                   from, elements, MATERIAL, loads),
        NAME);
    result = result_open(NAME ".vtkhdf", &err);
    Array strain, s;
    assert_true(result_read(result, "slender/rod/natural_strain", &strain, &err));
    assert_true(result_read(result, "slender/rod/s", &s, &err));
    assert_int_equal(strain.dims[0], (files ? 1 : 19) * (elements + 1));
    double sum = 0;
    for (int i = 0; i < strain.dims[0]; i++) {
        double at = ((double *)s.data)[i];
        Vec3 off = vec3_sub(vector_at(&strain, i), vec3(0, 6 + 40 * at, 8 * cos(15 * at)));
        sum += vec3_dot(off, off) / strain.dims[0];
    }
    array_clear(&strain);
    array_clear(&s);
    result_close(result);
    remove_files(NAME "_motion");
    return sqrt(sum);
}

/* Frames of a simulation, places only, give back its natural strains to the square of an element's length; so do files. */
static void test_motion(void **state)
{
    (void)state;
    double coarse = strains_off(50, false, ""), fine = strains_off(100, false, ""),
           files = strains_off(100, true, "");
    for (int k = 7; k < 10; k++) {
        char *path = mem_format(NAME "_%d.csv", k);
        remove(path);
        mem_free(path);
    }
    print_message("natural strains from frames of 50 and 100 elements off by %.2g and %.2g 1/m, rms; from "
                  "files by %.2g\n",
                  coarse, fine, files);
    assert_true(fine < 0.02 * 14 && fine < coarse / 3 && files < 0.02 * 14);
}

/* The same where loads by formula, a force and a couple change in time, each frame having those of its own: as well as without. */
static void test_motion_loads(void **state)
{
    (void)state;
    static const char loads[] =
        "{line: [\"0\", \"0.2*t*s/L\", \"0\"]}, {potential: \"(0.1+t)*z^2\"}, {point: end, force: "
        "[\"0\", \"2e-2*t\", \"0\"], couple: [\"0\", \"2e-5*t\", \"1e-5*t\"]}";
    double coarse = strains_off(50, false, loads), fine = strains_off(100, false, loads);
    print_message("under loads that change off by %.2g and %.2g 1/m, rms\n", coarse, fine);
    assert_true(fine < 0.02 * 14 && fine < coarse / 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_input),    cmocka_unit_test(test_held),   cmocka_unit_test(test_held_loads),
        cmocka_unit_test(test_framings), cmocka_unit_test(test_motion), cmocka_unit_test(test_motion_loads)};
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
