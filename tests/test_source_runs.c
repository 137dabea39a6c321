/* Scenes with sources of the flux density, whole runs: the field in frames is the sum of all, magnets and coils are in the
 * result where they are, maps give the field that they were made of, and a design finds currents and a magnet's place. */
#include "base/memory.h"
#include "field/flux_sources.h"
#include "io/hdf5_file.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

#define NAME "test_source_runs"
#include "tests/run_fixture.h"

#define STRIP                                                                                                \
    "slender: 1\nshell:\n  mesh: {shape: strip, size: [40 mm, 5 mm], n: 8}\n  thickness: 0.5 mm\n"           \
    "  young: 1 MPa\n  poisson: 0.4\n  magnetization: [80 kA/m, 0, 0]\n"                                     \
    "fix:\n  - {group: root, clamp: true}\n"

static char *text_of(const char *more)
{
    return mem_format("%s%s", STRIP, more);
}

/* The middle of a strip that lies in z = 0. */
static const double middle[3] = {0.02, 0.0025, 0};

static void test_sum(void **unused)
{
    (void)unused;
    Result *result =
        run_text(text_of("job: simulate\n"
                         "flux_density:\n"
                         "  - {uniform: [1 mT, 0, 2 mT]}\n"
                         "  - [\"0\", \"1e-3*t\", \"0\"]\n"
                         "  - {name: big, magnet: {at: [20 mm, 0, 40 mm], size: [10 mm, 8 mm, 6 mm], "
                         "remanence: [0, 0, 1.2]},\n"
                         "     move: [\"0\", \"0\", \"-0.1*t\"], turn: [\"pi/2\", \"0\", \"0\"]}\n"
                         "  - {coil: {at: [20 mm, 0, -10 mm], radius: 15 mm, current: 3, turns: 20}}\n"
                         "time: {step: 2 ms, steps: 5}\noutput: {precision: double}\n"));
    Array B = read_all(result, "slender/frames/flux_density"),
          pose = read_all(result, "slender/frames/source_pose"),
          names = read_all(result, "slender/source_names"),
          pole = read_all(result, "slender/sources/big/pole");
    assert_string_equal(names.data, "big\nsource2\n");
    assert_int_equal(pose.rank, 3);
    assert_int_equal(pose.dims[1], 2);
    for (int n = 0; n <= 5; n++) {
        double t = 2e-3 * n, own[3], x[3];
        FluxSample magnet, coil;
        for (int i = 0; i < 3; i++) x[i] = middle[i];
        own[0] = x[0] - 0.02, own[1] = x[2] - (0.04 - 0.1 * t), own[2] = -x[1]; /* a quarter about x */
        flux_of_block((double[]){0.005, 0.004, 0.003}, (double[]){0, 0, 1.2}, own, &magnet);
        flux_of_round_coil(0.015, 0, 60, (double[]){x[0] - 0.02, x[1], x[2] + 0.01}, &coil);
        const double *found = (const double *)B.data + 3 * n, *R = (const double *)pose.data + 24 * n;
        assert_true(fabs(found[0] - (1e-3 + magnet.flux[0] + coil.flux[0])) < 1e-15);
        assert_true(fabs(found[1] - (1e-3 * t - magnet.flux[2] + coil.flux[1])) < 1e-15);
        assert_true(fabs(found[2] - (2e-3 + magnet.flux[1] + coil.flux[2])) < 1e-15);
        const double expected[12] = {1, 0, 0, 0.02, 0, 0, -1, 0, 0, 1, 0, 0.04 - 0.1 * t};
        for (int i = 0; i < 12; i++) assert_true(fabs(R[i] - expected[i]) < 1e-15);
    }
    double most = 0, least = 0;
    for (int f = 0; f < pole.dims[0]; f++) {
        most = fmax(most, ((const double *)pole.data)[f]);
        least = fmin(least, ((const double *)pole.data)[f]);
    }
    assert_true(most == 1 && least == -1);
    array_clear(&B), array_clear(&pose), array_clear(&names), array_clear(&pole);
    result_close(result);
}

enum { NX = 9, NY = 4, NZ = 6 };

/* A grid in mm, and on it polynomials of third order in mT. */
static void polynomial(int i, int j, int k, double place[3], double B[3])
{
    double x = -5 + 6.5 * i, y = -11 + 8 * j, z = -15 + 16 * k;
    place[0] = x, place[1] = y, place[2] = z;
    B[0] = 1e-3 * x * y, B[1] = 0.1 * z, B[2] = 5 + 1e-4 * x * x * z;
}

static void write_maps(void)
{
    static double axis[3][NX], B[3][NX * NY * NZ];
    FILE *file = fopen(NAME ".csv", "w");
    assert_non_null(file);
    fprintf(file, "x [mm], y [mm], z [mm], Bx [mT], By [mT], Bz [mT]\n");
    for (int n = 0; n < NX * NY * NZ; n++) {
        int at[3] = {n / NZ / NY, n / NZ % NY, n % NZ};
        double place[3], b[3];
        polynomial(at[0], at[1], at[2], place, b);
        for (int c = 0; c < 3; c++) axis[c][at[c]] = place[c], B[c][n] = b[c];
        fprintf(file, "%.17g, %.17g, %.17g, %.17g, %.17g, %.17g\n", place[0], place[1], place[2], b[0], b[1],
                b[2]);
    }
    fclose(file);
    static const char *const names[] = {"x", "y", "z", "Bx", "By", "Bz"};
    static const int nodes[] = {NX, NY, NZ};
    Hdf5 *grid = hdf5_create();
    void *bytes;
    size_t size;
    Error err;
    for (int c = 0; c < 3; c++) {
        Array places = array_float(names[c], "mm", axis[c], 1, nodes[c], 0),
              values = array_float(names[3 + c], "mT", B[c], 3, NX, NY);
        values.dims[2] = NZ;
        assert_true(hdf5_write(grid, places.name, &places, (Hdf5Layout){0}, &err));
        assert_true(hdf5_write(grid, values.name, &values, (Hdf5Layout){0}, &err));
    }
    assert_true(hdf5_image(grid, &bytes, &size, &err));
    hdf5_close(grid);
    file = fopen(NAME ".h5", "w");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
    mem_free(bytes);
}

/* Of a field that is a polynomial of third order the spline is it, from either file. */
static void test_map(void **unused)
{
    (void)unused;
    write_maps();
    static const char *const ways[] = {
        "{map: {file: " NAME ".csv, scale: 0.4}}", "{map: {file: " NAME ".h5, scale: 0.4}}",
        "[\"0.4e-3*x*y*1000\", \"0.4*0.1*z\", \"0.4e-3*(5 + 1e-4*1e9*x*x*z)\"]"};
    double x[3][3 * 18];
    for (int k = 0; k < 3; k++) {
        char *more =
            mem_format("job: equilibrium\nsolver: {force_tolerance: 1.0e-10}\nflux_density: %s\n", ways[k]);
        Result *result = run_text(text_of(more));
        Array found = read_all(result, "slender/state/x");
        assert_int_equal(found.dims[0], 18);
        memcpy(x[k], found.data, sizeof x[k]);
        array_clear(&found);
        result_close(result);
        mem_free(more);
    }
    double most = 0, off = 0, apart = 0;
    for (int i = 0; i < 3 * 18; i++) {
        most = fmax(most, fabs(x[0][i])), off = fmax(off, fabs(x[0][i] - x[2][i]));
        apart = fmax(apart, fabs(x[0][i] - x[1][i]));
    }
    print_message("a map and its formula: %.1e m apart; its two files: %.1e m\n", off, apart);
    assert_true(x[0][3 * 8 + 2] > 1e-3 && off < 1e-9 && apart < 1e-15);
}

/* The target is what currents of 2 and -1.5 and a magnet that is elsewhere make of the strip. */
static void test_design(void **unused)
{
    (void)unused;
    static const char around[] =
        "flux_density:\n"
        "  - {name: below, coil: {at: [20 mm, 0, -20 mm], radius: 15 mm, current: %s, turns: 500}}\n"
        "  - {name: beyond, coil: {at: [60 mm, 0, 0], axis: [1, 0, 0], radius: 15 mm, length: 5 mm, current: "
        "%s, "
        "turns: 500}}\n"
        "  - {magnet: {at: [30 mm, 2 mm, %s], radius: 5 mm, length: 10 mm, remanence: [0, 0, 0.5]}}\n";
    char *there = mem_format(around, "2", "-1.5", "42 mm"), *more = mem_format("job: equilibrium\n%s", there);
    Result *result = run_text(text_of(more));
    Array x = read_all(result, "slender/state/x");
    FILE *file = fopen(NAME ".obj", "w");
    assert_non_null(file);
    for (int v = 0; v < x.dims[0]; v++) {
        const double *place = (const double *)x.data + 3 * v;
        fprintf(file, "v %.17g %.17g %.17g\n", place[0], place[1], place[2]);
    }
    Array faces = read_all(result, "slender/faces");
    for (int f = 0; f < faces.dims[0]; f++) {
        const int *v = (const int *)faces.data + 3 * f;
        fprintf(file, "f %d %d %d\n", v[0] + 1, v[1] + 1, v[2] + 1);
    }
    fclose(file);
    array_clear(&faces);
    array_clear(&x), result_close(result), mem_free(there), mem_free(more);
    there = mem_format(around, "1", "1", "45 mm");
    more = mem_format("job: design\n%starget: {file: " NAME ".obj}\ndesign:\n  unknowns:\n"
                      "    source_strength: {sources: [below, beyond], bounds: [-5, 5]}\n"
                      "    source_move: {sources: [source3]}\n"
                      "  objectives:\n    - target: 1\n  optimizer: gauss_newton\n  iterations: 30\n",
                      there);
    result = run_text(text_of(more));
    Array F = read_all(result, "slender/history/objective"),
          I = read_all(result, "slender/design/source_strength"),
          move = read_all(result, "slender/design/source_move");
    const double *objective = F.data, *strength = I.data, *way = move.data;
    int last = F.dims[0] - 1;
    print_message("F %.1e of the start; strengths %.6f, %.6f, %g; the magnet %.6f mm up\n",
                  objective[last] / objective[0], strength[0], strength[1], strength[2], 1e3 * way[8]);
    assert_true(strength[2] == 1 && way[0] == 0 && way[3] == 0);
    assert_true(objective[last] < 1e-6 * objective[0]);
    array_clear(&F), array_clear(&I), array_clear(&move);
    result_close(result), mem_free(there), mem_free(more);
}

/* A uniform field of t in a sequence is that of each stage's time, also where the stage says no more than that. */
static void test_stages_of_time(void **unused)
{
    (void)unused;
    static const char *const ways[] = {"{time: {from: 0, to: 1, count: 3}}",
                                       "[{time: 0}, {time: 0.5}, {time: 1}]",
                                       "[{time: 0}, {time: 0.5, gravity: [0, 0, 0]}, {time: 1}]"};
    for (int k = 0; k < 3; k++) {
        char *more = mem_format("job: equilibrium\noutput: {precision: double}\nsequence: %s\nflux_density:\n"
                                "  - [\"0\", \"0\", \"0.002*t\"]\n  - {uniform: [1 mT, 0, 0]}\n",
                                ways[k]);
        Result *result = run_text(text_of(more));
        Array B = read_all(result, "slender/frames/flux_density");
        const double *found = B.data;
        assert_int_equal(B.dims[0], 3);
        for (int n = 0; n < 3; n++)
            assert_true(found[3 * n] == 1e-3 && fabs(found[3 * n + 2] - 1e-3 * n) < 1e-16);
        array_clear(&B), result_close(result), mem_free(more);
    }
}

/* A body that starts in a magnet is told so, by its name, be the magnet so small that no vertex is in it. */
static void test_within(void **unused)
{
    (void)unused;
    static const char *const sources[] = {
        "{name: in, magnet: {at: [20 mm, 0, 0], size: [8 mm, 8 mm, 8 mm], remanence: [0, 0, 1 mT]}}",
        "{name: in, magnet: {at: [20 mm, 0, 0], radius: 4 mm, length: 8 mm, remanence: [0, 0, 1 mT]}}",
        "{name: in, magnet: {at: [22.5 mm, 2.5 mm, 0], size: [3 mm, 3 mm, 3 mm], remanence: [0, 0, 1 mT]}}",
        "{name: in, coil: {at: [20 mm, 0, 0], radius: 20 mm, current: 1 mA}}",
        "{name: in, coil: {at: [20 mm, 0, 0], size: [40 mm, 20 mm], current: 1 mA}}",
        "{name: in, coil: {at: [20 mm, 0, 0], size: [60 mm, 10 mm], current: 1 mA}}",
        "{name: by, coil: {at: [20 mm, 0, 0], size: [60 mm, 20 mm], current: 1 mA}}",
        "{name: by, magnet: {at: [20 mm, 0, 5 mm], size: [8 mm, 8 mm, 8 mm], remanence: [0, 0, 1 mT]}}"};
    for (int k = 0; k < 8; k++) {
        char *more = mem_format("job: equilibrium\nflux_density: %s\n", sources[k]);
        Built b = scene_build(text_of(more));
        bool told = false;
        for (int w = 0; w < b.model->report.warning_count; w++)
            told = told || strstr(b.model->report.warnings[w], " 'in', at (");
        assert_true(told == !strncmp(sources[k], "{name: in", 9));
        clear(&b);
        mem_free(more);
    }
}

typedef struct Said {
    const char *sentence;
    bool found;
} Said;

static void look_for(void *self, const char *sentence)
{
    Said *said = self;
    said->found = said->found || strstr(sentence, said->sentence);
}

/* A face whose middle is on the wire of a coil: whatever the job, `check` says so, and the run, which ends as not finite. */
static void test_infinite(void **unused)
{
    (void)unused;
    static const char *const jobs[] = {"equilibrium", "evaluate", "simulate\ntime: {step: 1 ms, steps: 2}"};
    static const char said[] =
        "flux_density: the field of the coil 'ring', at (0.01562, 0.01562, 0) m, is infinite "
        "on its wire";
    FILE *file = fopen(NAME ".obj", "w"); /* sums of powers of 2 */
    assert_non_null(file);
    fprintf(file, "v 0 0 0\nv 0.046875 0 0\nv 0 0.046875 0\nf 1 2 3\n");
    fclose(file);
    for (int k = 0; k < 3; k++) {
        char *text = mem_format(
            "slender: 1\njob: %s\nshell: {mesh: {file: " NAME
            ".obj}, thickness: 1 mm, young: 1 MPa, poisson: 0.4, "
            "density: 1000, magnetization: [1 kA/m, 0, 0]}\nfix: [{vertices: [0]}]\n"
            "flux_density: {name: ring, coil: {at: [0, 0, 0], size: [0.03125, 0.25], current: 1}}\n",
            jobs[k]);
        Built b = scene_build(mem_text(text));
        bool told = false;
        for (int w = 0; w < b.model->report.warning_count; w++)
            told = told || strstr(b.model->report.warnings[w], said);
        assert_true(told);
        clear(&b);
        SlenderError err;
        Said of = {.sentence = said};
        SlenderScene *scene = slender_scene_parse(text, NULL, 0, &err);
        if (!scene) fail_msg("%s", err.text);
        SlenderRun def = {.output = NAME, .threads = 1, .force = true};
        def.host = (SlenderHost){.self = &of, .say = look_for};
        assert_int_equal(slender_run(scene, &def, &err), SLENDER_NOT_CONVERGED);
        assert_true(of.found);
        slender_scene_destroy(scene);
        mem_free(text);
    }
}

typedef struct Told {
    int count;
    char first[300];
} Told;

static void keep_warning(void *self, const char *sentence)
{
    Told *told = self;
    if (strstr(sentence, ": the body is in") && told->count++ == 0)
        snprintf(told->first, sizeof told->first, "%s", sentence);
}

/* One that comes to the body later: told once, by its name and when. */
static void test_meets(void **unused)
{
    (void)unused;
    static const struct {
        const char *scene, *said;
    } rows[] = {
        {"job: equilibrium\nflux_density: {name: ring, coil: {at: [20 mm, 0, 40 mm], radius: 20 mm, current: "
         "1 "
         "mA}, move: [\"0\", \"0\", \"-0.02*t\"]}\nsequence: [{time: 0}, {time: 1}, {time: 2}, {time: 2}]\n",
         "sequence, frame 2: the body is in the coil 'ring', at "},
        {"job: simulate\ntime: {step: 1 ms, steps: 8}\noutput: {every: 4}\n"
         "flux_density: {name: bar, magnet: {at: [50 mm, 0, 0], size: [12 mm, 20 mm, 9 mm], remanence: [0, "
         "0, 1 "
         "mT]}, move: [\"-1.5*t\", \"0\", \"0\"]}\n",
         "case1, t = 0.003 s: the body is in the magnet 'bar', at (0.04"}};
    for (int k = 0; k < 2; k++) {
        SlenderError err;
        Told told = {0};
        char *text = text_of(rows[k].scene);
        SlenderScene *scene = slender_scene_parse(text, NULL, 0, &err);
        if (!scene) fail_msg("%s", err.text);
        SlenderRun def = {.output = NAME, .threads = 1, .force = true};
        def.host = (SlenderHost){.self = &told, .warn = keep_warning};
        assert_int_equal(slender_run(scene, &def, &err), SLENDER_DONE);
        if (told.count != 1 || strncmp(told.first, rows[k].said, strlen(rows[k].said)) != 0)
            fail_msg("%d: %s", told.count, told.first);
        slender_scene_destroy(scene);
        mem_free(text);
    }
}

/* F and the sum of its gradient over the rows of the first coil's strength, of currents that change in time: all rows are the
 * same at the start, so that the sum is what the scene's current does. */
static double motion(double current, double *sum)
{
    char *more = mem_format(
        "job: trajectory\nflux_density:\n"
        "  - {name: below, coil: {at: [20 mm, 0, -20 mm], radius: 15 mm, current: %.17g, turns: 300}}\n"
        "  - {name: beyond, coil: {at: [60 mm, 0, 0], axis: [1, 0, 0], radius: 15 mm, current: 1, turns: "
        "300}}\n"
        "time: {step: 5 ms, steps: 8}\ndesign:\n"
        "  unknowns: {source_strength: {per: knot, knots: 3}, source_turn: {sources: [beyond]}}\n"
        "  objectives:\n    - waypoint: {vertex: tip, at: [38 mm, 2.5 mm, 8 mm]}\n"
        "  iterations: 0\n",
        current);
    Result *result = run_text(text_of(more));
    Array F = read_all(result, "slender/history/objective"),
          g = read_all(result, "slender/design/gradient/source_strength"),
          over = read_all(result, "slender/trajectory/source_strength");
    assert_true(array_is(&g, ARRAY_FLOAT64, 2, 2) && g.dims[0] == 3);
    assert_true(over.dims[0] == 8 && ((const double *)over.data)[15] == 1);
    double value = *(const double *)F.data;
    for (int r = 0; sum && r < 3; r++) *sum += ((const double *)g.data)[2 * r];
    array_clear(&F), array_clear(&g), array_clear(&over);
    result_close(result), mem_free(more);
    return value;
}

static void test_currents_over_time(void **unused)
{
    (void)unused;
    const double h = 1e-3;
    double sum = 0;
    motion(1, &sum);
    double difference = (motion(1 + h, NULL) - motion(1 - h, NULL)) / (2 * h);
    print_message("gradient %.9g, differences %.9g\n", sum, difference);
    assert_true(fabs(sum - difference) < 1e-5 * fabs(sum));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sum),    cmocka_unit_test(test_map),
        cmocka_unit_test(test_design), cmocka_unit_test(test_stages_of_time),
        cmocka_unit_test(test_within), cmocka_unit_test(test_infinite),
        cmocka_unit_test(test_meets),  cmocka_unit_test(test_currents_over_time)};
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
