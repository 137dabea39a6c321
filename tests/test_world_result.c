/* What a result says of what the body met: forces that are known, obstacles, and where they are. */
#include "base/memory.h"
#include "io/result.h"
#include "slender.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#define NAME "test_world_result"

/* 40 x 20 x 1 mm of 1000 kg/m^3. */
#define PLATE                                                                                                \
    "shell:\n"                                                                                               \
    "  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [12, 6]}\n"                                         \
    "  thickness: 1 mm\n  young: 0.2 MPa\n  poisson: 0.3\n  density: 1000\n  gravity: [0, 0, -9.81]\n"

static const double WEIGHT = 0.04 * 0.02 * 0.001 * 1000 * 9.81; /* N */

static SlenderStatus run(const char *text, const char *setting, int resume)
{
    SlenderError err;
    SlenderScene *scene = slender_scene_parse(text, &setting, setting != NULL, &err);
    if (!scene) fail_msg("%s", err.text);
    SlenderRun def = {.output = NAME, .threads = 1, .resume = resume, .force = !resume};
    SlenderStatus status = slender_run(scene, &def, &err);
    if (status == SLENDER_REFUSED) fail_msg("%s", err.text);
    slender_scene_destroy(scene);
    return status;
}

static Result *open_result(void)
{
    Error err;
    Result *result = result_open(NAME ".vtkhdf", &err);
    if (!result) fail_msg("%s", err.text);
    return result;
}

static Array read_as(Result *result, const char *path, int rank, int d0, int d1, int d2)
{
    Array array;
    Error err;
    if (!result_read(result, path, &array, &err)) fail_msg("%s: %s", path, err.text);
    int dims[3] = {d0, d1, d2};
    assert_int_equal(array.rank, rank);
    for (int i = 0; i < rank; i++) assert_int_equal(array.dims[i], dims[i]);
    return array;
}

static double number(Result *result, const char *path)
{
    Array array = read_as(result, path, 0, 0, 0, 0);
    double value = *(const double *)array.data;
    array_clear(&array);
    return value;
}

/* ---- Statics ---- */

/* A plate that rests on a floor and on a ball's top, which is smaller than its edges are long. */
static const char RESTS[] =
    "slender: 1\njob: equilibrium\n" PLATE "fix: [{box: [[-1, -1, -1], [0.1 mm, 1, 1]], axes: xy}]\n"
    "obstacles:\n"
    "  - {name: floor, plane: {point: [0, 0, -0.5 mm]}}\n"
    "  - {name: stud, sphere: {center: [20 mm, 10 mm, -2 mm], radius: 1.6 mm}}\n";

static void test_weight(void **state)
{
    (void)state;
    assert_int_equal(run(RESTS, NULL, 0), SLENDER_DONE);
    Result *result = open_result();
    Array force = read_as(result, "slender/final/contact_force", 2, 2, 3, 0);
    const double *f = force.data;
    print_message("floor %.9f, stud %.9f of the weight\n", f[2] / WEIGHT, f[5] / WEIGHT);
    assert_true(fabs(f[2] + f[5] - WEIGHT) < 1e-9 * WEIGHT);
    assert_true(f[2] > 0.01 * WEIGHT && f[5] > 0.01 * WEIGHT);
    assert_true(number(result, "slender/final/contact_depth") < 1e-5);
    array_clear(&force);
    int points = 13 * 7;
    double sum[3] = {0};
    Array each = read_as(result, "VTKHDF/PointData/contact_force", 2, points, 3, 0);
    for (int i = 0; i < 3 * points; i++) sum[i % 3] += ((const double *)each.data)[i];
    assert_true(fabs(sum[2] - WEIGHT) < 1e-5 * WEIGHT); /* single precision */
    array_clear(&each);
    result_close(result);
}

/* A plane that reaches d into a flat body has the same energy at each sample: vertices and, for the ball's sake, the middles
 * of edges and faces. */
static void test_energy(void **state)
{
    (void)state;
    static const char FLAT[] = "slender: 1\njob: evaluate\n" PLATE "contact: {stiffness: 10, offset: 0}\n"
                               "obstacles:\n"
                               "  - {plane: {point: [0, 0, 0.1 mm]}}\n"
                               "  - {sphere: {center: [1, 0, 0], radius: 1 mm}}\n"; /* far away */
    run(FLAT, NULL, 0);
    Result *result = open_result();
    int samples = 13 * 7 + (13 * 6 + 12 * 7 + 72) + 144;
    double d = 1e-4, e = 1e-5, each = 10 * (d * d / 2 - e * d / 2 + e * e / 6);
    assert_true(number(result, "slender/final/contacts") == samples);
    assert_true(fabs(number(result, "slender/final/energy/contact") / (samples * each) - 1) < 1e-12);
    result_close(result);
}

/* ---- Obstacles ---- */

static const char MOVES[] = "slender: 1\njob: simulate\n" PLATE "obstacles:\n"
                            "  - {name: floor, plane: {point: [0, 0, -0.5 mm]}}\n"
                            "  - {box: {center: [-10 mm, 10 mm, 4 mm], half: [5 mm, 8 mm, 4 mm]},\n"
                            "     move: [\"0.1*t\", \"0\", \"0.2*t^2\"], turn: [\"0\", \"0\", \"2*t\"]}\n"
                            "contact: {friction: 0.2}\n"
                            "time: {at: 1, step: 2 ms, steps: 20}\noutput: {every: 5}\n";

/* x = R (X - c) + c + move. */
static void check_pose(const double pose[12], double t)
{
    double c = cos(2 * t), s = sin(2 * t), center[3] = {-0.01, 0.01, 0.004};
    double R[3][3] = {{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, move[3] = {0.1 * t, 0, 0.2 * t * t};
    for (int i = 0; i < 3; i++) {
        double shift = center[i] + move[i];
        for (int j = 0; j < 3; j++) {
            assert_true(fabs(pose[4 * i + j] - R[i][j]) < 1e-14);
            shift -= R[i][j] * center[j];
        }
        assert_true(fabs(pose[4 * i + 3] - shift) < 1e-14);
    }
}

static void check_poses(Result *result, int frames)
{
    static const double still[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    Array poses = read_as(result, "slender/frames/obstacle_pose", 3, frames, 2, 12);
    const double(*pose)[2][12] = (void *)poses.data;
    for (int k = 0; k < frames; k++) {
        assert_memory_equal(pose[k][0], still, sizeof still);
        check_pose(pose[k][1], 1 + 0.01 * k);
    }
    array_clear(&poses);
}

/* All of a plane's points are on it, and they reach beyond the body by its length at least. */
static void check_floor(Result *result, double reach)
{
    Array points = read_as(result, "slender/obstacles/floor/points", 2, 81, 3, 0),
          faces = read_as(result, "slender/obstacles/floor/faces", 2, 128, 3, 0);
    const double(*x)[3] = (void *)points.data;
    const int(*face)[3] = (void *)faces.data;
    double low = INFINITY, high = -INFINITY;
    for (int v = 0; v < 81; v++) {
        assert_true(fabs(x[v][2] + 5e-4) < 1e-15);
        low = fmin(low, x[v][0]), high = fmax(high, x[v][0]);
    }
    for (int f = 0; f < 128; f++) { /* free above */
        const double *a = x[face[f][0]], *b = x[face[f][1]], *c = x[face[f][2]];
        assert_true((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0);
    }
    assert_true(low < -0.04 && high > reach + 0.04);
    array_clear(&points);
    array_clear(&faces);
}

static void test_obstacles(void **state)
{
    (void)state;
    assert_int_equal(run(MOVES, NULL, 0), SLENDER_DONE);
    Result *result = open_result();
    check_floor(result, 0.04);
    check_poses(result, 5);
    Array names = read_as(result, "slender/obstacle_names", 1, 16, 0, 0), kind;
    assert_string_equal(names.data, "floor\nobstacle2\n");
    assert_true(result_read(result, "slender/obstacles/obstacle2/kind", &kind, NULL));
    assert_string_equal(kind.data, "box");
    array_clear(&names);
    array_clear(&kind);
    result_close(result);
}

/* The box follows from where the body went. */
static void test_way(void **state)
{
    (void)state;
    assert_int_equal(run(MOVES, "shell.velocity=[10, 0, 0]", 0), SLENDER_DONE);
    Result *result = open_result();
    check_floor(result, 0.4);
    result_close(result);
}

/* A run that is extended has what an undivided one has. */
static void test_extended(void **state)
{
    (void)state;
    static const char FORCE[] = "VTKHDF/PointData/contact_force";
    assert_int_equal(run(MOVES, NULL, 0), SLENDER_DONE);
    Result *result = open_result();
    Array whole = read_as(result, FORCE, 2, 5 * 91, 3, 0);
    result_close(result);
    assert_int_equal(run(MOVES, "time.steps=10", 0), SLENDER_DONE);
    assert_int_equal(run(MOVES, NULL, 1), SLENDER_DONE);
    result = open_result();
    Array parts = read_as(result, FORCE, 2, 5 * 91, 3, 0);
    assert_memory_equal(whole.data, parts.data, array_bytes(&whole));
    check_poses(result, 5);
    array_clear(&whole);
    array_clear(&parts);
    result_close(result);
}

/* Of a designed motion frames and the end have what a simulation's have: friction too. */
static void test_trajectory(void **state)
{
    (void)state;
    run("slender: 1\njob: trajectory\nshell:\n  mesh: {shape: strip, size: [20 mm, 5 mm], n: 8}\n"
        "  thickness: 0.5 mm\n  young: 0.1 MPa\n  poisson: 0.3\n  density: 1000\n"
        "  gravity: [3, 0, -9.81]\n  magnetization: [2.0e+4, 0, 0]\nflux_density: [0, 0, 1 mT]\n"
        "obstacles: [{name: floor, plane: {point: [0, 0, -0.25 mm]}, friction: 0.5}]\n"
        "time: {step: 1 ms, steps: 30}\noutput: {every: 10, precision: double}\n"
        "design:\n  unknowns: {flux_density: {per: knot, knots: 3}}\n  iterations: 1\n"
        "  objectives: [{waypoint: {vertex: 4, at: [15 mm, 0, 0.25 mm]}}]\n",
        NULL, 0);
    Result *result = open_result();
    Array all = read_as(result, "slender/trajectory/contact_force", 3, 30, 1, 3),
          end = read_as(result, "slender/final/contact_force", 2, 1, 3, 0);
    const double(*force)[3] = (const double(*)[3])all.data;
    assert_memory_equal(end.data, force[29], sizeof *force);
    assert_true(force[29][0] < -0.1 * force[29][2] && force[29][2] > 0);
    for (int frame = 1; frame < 4; frame++) {
        Array step;
        assert_true(result_read_step(result, "PointData/contact_force", frame, &step, NULL));
        double sum[3] = {0};
        for (size_t i = 0; i < array_count(&step); i++) sum[i % 3] += ((const double *)step.data)[i];
        for (int i = 0; i < 3; i++)
            assert_true(fabs(sum[i] - force[10 * frame - 1][i]) < 1e-12 * force[10 * frame - 1][2]);
        array_clear(&step);
    }
    array_clear(&all);
    array_clear(&end);
    result_close(result);
}

/* A motion of the library says of its steps what the program's history does, cut ones included. */
static void test_motion(void **state)
{
    (void)state;
    SlenderError err;
    SlenderStatus status;
    SlenderMotionDef def = {.steps = 20, .step = 2e-3};
    assert_int_equal(run(MOVES, NULL, 0), SLENDER_DONE);
    SlenderScene *scene = slender_scene_parse(MOVES, NULL, 0, &err);
    SlenderModel *model = slender_model_create(scene, 1, &err);
    SlenderState *start = slender_state_create(model, 0, &err);
    SlenderMotion *motion = slender_simulate(model, 0, start, &def, &status, &err);
    assert_int_equal(status, SLENDER_DONE);
    Result *result = open_result();
    SlenderArray met;
    int count = 0;
    for (;; count++) {
        assert_int_equal(slender_motion_met(motion, count, &met, &err), SLENDER_DONE);
        if (!met.name) break;
        char *path = mem_format("slender/history/%s", met.name);
        Array history = read_as(result, path, met.rank, met.dims[0], met.dims[1], met.dims[2]);
        const double *said = met.data, *is = history.data;
        for (size_t i = 0; i < array_count(&history); i++) assert_true(fabs(said[i] - is[i]) < 1e-9);
        array_clear(&history);
        mem_free(path);
        slender_array_free(&met);
    }
    assert_int_equal(count, 4);
    result_close(result);
    slender_motion_destroy(motion);
    slender_state_destroy(start);
    slender_model_destroy(model);
    slender_scene_destroy(scene);
}

/* ---- Rods ---- */

/* ---- What goes through ---- */

/* A needle that is thinner than a quarter of an edge, shot through the plate. */
static const char SHOT[] =
    "slender: 1\njob: simulate\n" PLATE "fix: [{box: [[-1, -1, -1], [0.1 mm, 1, 1]]}]\n"
    "obstacles: [{name: needle, move: [\"0\", \"0\", \"30*t\"],\n"
    "  box: {center: [21 mm, 11 mm, -21 mm], half: [0.3 mm, 0.3 mm, 20 mm], rounding: 0.3 mm}}]\n"
    "time: {step: 0.1 ms, steps: 6}\n";

typedef struct Heard {
    int count; /* warnings that name the needle, and where */
    char first[400];
} Heard;

static void hear(void *self, const char *sentence)
{
    Heard *heard = self;
    if (!strstr(sentence, "step ")) return;
    if (heard->count++ == 0) strncpy(heard->first, sentence, sizeof heard->first - 1);
}

static SlenderStatus shoot(const char *setting, int resume, Heard *heard)
{
    SlenderError err;
    SlenderScene *scene = slender_scene_parse(SHOT, &setting, setting != NULL, &err);
    if (!scene) fail_msg("%s", err.text);
    SlenderRun def = {.output = NAME,
                      .threads = 1,
                      .resume = resume,
                      .force = !resume,
                      .host = {.self = heard, .warn = hear}};
    SlenderStatus status = slender_run(scene, &def, &err);
    slender_scene_destroy(scene);
    return status;
}

/* It is said once, at the step in which it happens, stands in the history from then on, and is how the run ends: also of one
 * that goes on from there. */
static void test_shot(void **state)
{
    (void)state;
    Heard heard = {0}, again = {0};
    assert_int_equal(shoot("obstacles[0].move=[\"0\", \"0\", \"1*t\"]", 0, &heard), SLENDER_DONE);
    assert_int_equal(heard.count, 0);
    assert_int_equal(shoot("time.steps=3", 0, &heard), SLENDER_NOT_CONVERGED);
    assert_int_equal(heard.count, 1);
    print_message("%s\n", heard.first);
    assert_true(strstr(heard.first, "step 1: obstacle 'needle' goes through face "));
    assert_int_equal(shoot(NULL, 1, &again), SLENDER_NOT_CONVERGED);
    assert_int_equal(again.count, 0);
    Result *result = open_result();
    Array pierced = read_as(result, "slender/history/pierced", 1, 6, 0, 0), status;
    const double *count = pierced.data;
    for (int k = 0; k < 6; k++) assert_true(count[k] >= 1 && count[k] == count[0]);
    assert_true(result_read(result, "slender/status", &status, NULL));
    assert_string_equal(status.data, "pierced");
    array_clear(&pierced);
    array_clear(&status);
    result_close(result);
}

/* Frames of rods have points that stand still after those that move: each has its row. */
static void test_rod(void **state)
{
    (void)state;
    assert_int_equal(run("slender: 1\njob: simulate\n"
                         "rod: {natural_strain: [0, 0, 0], length: 0.1, elements: 10, radius: 1 mm,\n"
                         "      young: 1 MPa, poisson: 0.4, density: 1100, gravity: [0, 0, -9.81]}\n"
                         "obstacles: [{name: floor, plane: {point: [0, 0, -3 mm]}}]\n"
                         "time: {step: 2 ms, steps: 30}\noutput: {every: 10}\n",
                         NULL, 0),
                     SLENDER_DONE);
    Result *result = open_result();
    Array points = read_as(result, "VTKHDF/Points", 2, 4 * 22, 3, 0),
          force = read_as(result, "VTKHDF/PointData/contact_force", 2, 4 * 22, 3, 0), step;
    Array history = read_as(result, "slender/history/contact_force", 3, 30, 1, 3);
    assert_true(result_read_step(result, "PointData/contact_force", 3, &step, NULL));
    double sum = 0, total = ((const double(*)[3])history.data)[29][2];
    for (int i = 0; i < 22; i++) sum += ((const double(*)[3])step.data)[i][2];
    print_message("the floor bears %.4g N\n", sum);
    assert_true(total > 0 && fabs(sum - total) < 1e-6 * total);
    Array *arrays[] = {&points, &force, &step, &history};
    for (int k = 0; k < 4; k++) array_clear(arrays[k]);
    result_close(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weight), cmocka_unit_test(test_energy),   cmocka_unit_test(test_obstacles),
        cmocka_unit_test(test_way),    cmocka_unit_test(test_extended), cmocka_unit_test(test_trajectory),
        cmocka_unit_test(test_motion), cmocka_unit_test(test_shot),     cmocka_unit_test(test_rod)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
