/* Probes and what stages keep: against frames, closed forms, sums of forces, and runs that went on. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#define NAME "test_probe_tables"
#include "tests/run_fixture.h"

/* A sheet of 40 x 10 mm and 1 mm: 0.4 g. */
#define SHEET                                                                                                \
    "slender: 1\noutput: {precision: double}\n"                                                              \
    "shell:\n  mesh: {shape: sheet, size: [40 mm, 10 mm], cells: [8, 2]}\n  thickness: 1 mm\n"               \
    "  young: 1 MPa\n  poisson: 0.3\n  density: 1000\n"

static const double WEIGHT = 0.4e-3 * 9.81;

static double *numbers(Array *array)
{
    assert_int_equal(array->type, ARRAY_FLOAT64);
    return (double *)array->data;
}

static void assert_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance)) fail_msg("%.17g, not %.17g", value, wanted);
}

/* Of the sheet with its root's middle and its tip's: vertices 9 and 17. */
static const char POINTS[] = "  tip: {group: tip}\n  root: {group: root}\n  gap: {distance: [\"9\", tip]}\n"
                             "  height: {height: \"17\"}\n  slope: {angle: [\"9\", tip], axis: [2, 0, 0]}\n"
                             "  corner: {angle: [\"0\", \"9\", tip]}\n  centre: {mass_center: true}\n";

/* Turned about y: a closed form for each kind, of a small angle to rounding, too. */
static void test_closed_forms(void **state)
{
    (void)state;
    static const double turns[] = {0.3, 1e-9, 2.5};
    for (int k = 0; k < 3; k++) {
        double a = turns[k];
        Result *result =
            run_text(mem_format("%s  pose: [\"%.17g*x\", \"y\", \"%.17g*x\"]\njob: evaluate\nprobes:\n%s",
                                SHEET, cos(a), sin(a), POINTS));
        Array tip = read_all(result, "slender/probes/tip"), gap = read_all(result, "slender/probes/gap"),
              height = read_all(result, "slender/probes/height"),
              slope = read_all(result, "slender/probes/slope"),
              corner = read_all(result, "slender/probes/corner"),
              centre = read_all(result, "slender/probes/centre");
        assert_true(tip.rank == 2 && tip.dims[0] == 1 && gap.rank == 1 && !strcmp(slope.unit, "rad"));
        assert_near(numbers(&tip)[0], 0.04 * cos(a), 1e-15);
        assert_near(numbers(&tip)[1], 0.005, 1e-15);
        assert_near(numbers(&height)[0], 0.04 * sin(a), 1e-15);
        assert_near(numbers(&gap)[0], 0.04, 1e-15);
        assert_near(numbers(&slope)[0], a, 1e-15 + 1e-15 * a);
        assert_near(numbers(&corner)[0], acos(0), 1e-15);
        assert_near(numbers(&centre)[0], 0.02 * cos(a), 1e-14);
        assert_near(numbers(&centre)[2], 0.02 * sin(a), 1e-14);
        Array *all[] = {&tip, &gap, &height, &slope, &corner, &centre};
        for (int i = 0; i < 6; i++) array_clear(all[i]);
        result_close(result);
    }
}

/* The mean of some points in each frame, bit by bit; a row per frame. */
static void check_mean(Result *result, const char *path, const int *points, int count)
{
    Array x = read_all(result, "slender/frames/x"), rows = read_all(result, path);
    assert_true(rows.rank == 2 && rows.dims[0] == x.dims[0] && rows.dims[1] == 3);
    for (int n = 0; n < x.dims[0]; n++)
        for (int i = 0; i < 3; i++) {
            double mean = 0;
            for (int k = 0; k < count; k++)
                mean += 1.0 / count * numbers(&x)[3 * (n * x.dims[1] + points[k]) + i];
            assert_near(numbers(&rows)[3 * n + i], mean, 1e-17);
        }
    array_clear(&x);
    array_clear(&rows);
}

static const int root[] = {0, 9, 18};

/* Each stage: where its points are, what holds it, its energies and its status. */
static void test_stages(void **state)
{
    (void)state;
    Result *result = run_text(
        mem_format("%s  gravity: [0, 0, -9.81]\njob: equilibrium\n"
                   "fix: [{group: root, clamp: true}, {group: tip, axes: y}, {vertices: [9, 18], axes: z}]\n"
                   "sequence:\n  - {time: 1 s}\n  - {loads: [{force: [1 mN, 0, 0.2 mN], on: {vertices: "
                   "[26]}}], time: 3 s}\n"
                   "probes:\n%s  support: {force: all}\n  entry: {force: {fix: 1}}\n  part: {force: root}\n",
                   SHEET, POINTS));
    check_mean(result, "slender/probes/tip", (const int[]){17}, 1);
    check_mean(result, "slender/probes/root", root, 3);
    Array stage = read_all(result, "slender/probes/stage"), time = read_all(result, "slender/stages/time"),
          all = read_all(result, "slender/probes/support"), entry = read_all(result, "slender/probes/entry"),
          part = read_all(result, "slender/probes/part"),
          force = read_all(result, "slender/stages/support_force"),
          status = read_all(result, "slender/stages/status");
    assert_true(stage.dims[0] == 2 && numbers(&stage)[1] == 1 && numbers(&time)[1] == 3);
    assert_string_equal(status.data, "converged\nconverged\n");
    assert_true(force.rank == 3 && force.dims[0] == 2 && force.dims[1] == 3 && force.dims[2] == 3);
    for (int n = 0; n < 2; n++)
        for (int i = 0; i < 3; i++) {
            const double wanted[2][3] = {{0, 0, WEIGHT}, {-1e-3, 0, WEIGHT - 0.2e-3}};
            const double *own = numbers(&force) + 9 * n;
            assert_near(numbers(&all)[3 * n + i], wanted[n][i], 1e-9);
            assert_near(own[i] + own[3 + i], numbers(&all)[3 * n + i], 1e-18);
            assert_near(own[6 + i], 0, 0); /* what it holds is held before */
            assert_true(numbers(&entry)[3 * n + i] == own[3 + i]);
            assert_near(numbers(&part)[3 * n + i], own[i], 1e-18);
        }
    assert_true(fabs(numbers(&entry)[4]) > 1e-12 && numbers(&entry)[3] == 0 && numbers(&entry)[5] == 0);
    static const char *const terms[] = {"membrane", "bending", "gravity", "load"};
    for (int k = 0; k < 4; k++) {
        char path[64];
        snprintf(path, sizeof path, "slender/stages/energy/%s", terms[k]);
        Array energy = read_all(result, path);
        snprintf(path, sizeof path, "slender/final/energy/%s", terms[k]);
        Array last = read_all(result, path);
        assert_true(energy.dims[0] == 2 && numbers(&energy)[1] == *numbers(&last));
        assert_true(numbers(&energy)[0] != numbers(&energy)[1]);
        array_clear(&energy);
        array_clear(&last);
    }
    Array *read[] = {&stage, &time, &all, &entry, &part, &force, &status};
    for (int i = 0; i < 7; i++) array_clear(read[i]);
    result_close(result);
}

/* What holds a body, of a scene of one state with the probe `support`. */
static void check_support(char *text, const double wanted[3], double tolerance)
{
    Result *result = run_text(text);
    Array force = read_all(result, "slender/probes/support");
    for (int i = 0; i < 3; i++) assert_near(numbers(&force)[i], wanted[i], tolerance);
    array_clear(&force);
    result_close(result);
}

/* Rods in both forms, solids, and what an obstacle does. */
static void test_forces(void **state)
{
    (void)state;
    static const char rod[] =
        "slender: 1\njob: equilibrium\n"
        "rod: {natural_strain: [1, 5, 3], length: 0.2, elements: 20, radius: 1 mm, young: 10 "
        "MPa, poisson: 0.4, density: 1000, gravity: [0, 0, -10]%s}\n%s"
        "probes: {support: {force: %s}}\n",
                      loads[] = ", loads: [{point: 0.1, force: [0, 1 mN, 0]}, {line: [0.1, 0, 0]}]",
                      far[] = "obstacles: [{name: floor, plane: {point: [0, 0, -9], normal: [0, 0, 1]}}]\n";
    double weight = 1000 * acos(-1) * 1e-6 * 0.2 * 10;
    check_support(mem_format(rod, loads, "", "all"), (const double[]){-0.02, -1e-3, weight}, 1e-12);
    check_support(mem_format(rod, loads, "", "{fix: 0}"), (const double[]){-0.02, -1e-3, weight}, 1e-12);
    check_support(mem_format(rod, loads, far, "all"), (const double[]){-0.02, -1e-3, weight}, 1e-7 * weight);
    check_support(mem_format(rod, ", end: {position: [0.18, 0, 0], hold: pinned}", "", "all"),
                  (const double[]){0, 0, weight}, 1e-6 * weight);
    check_support(
        mem_text("slender: 1\njob: equilibrium\n"
                 "solid: {mesh: {shape: box, size: [20 mm, 4 mm, 4 mm], cells: [4, 1, 1]}, young: 1 MPa,\n"
                 "        poisson: 0.3, density: 1000, gravity: [0, 0, -9.81]}\n"
                 "fix: [{box: [[-1, -1, -1], [0, 1, 1]]}]\nprobes: {support: {force: {fix: 0}}}\n"),
        (const double[]){0, 0, 0.32e-3 * 9.81}, 1e-9);
    check_support(mem_format("%s  gravity: [0, 0, -9.81]\njob: equilibrium\nfix: [{group: root, axes: xy}]\n"
                             "obstacles: [{name: floor, plane: {point: [0, 0, -1 mm], normal: [0, 0, 1]}}]\n"
                             "probes: {support: {force: {obstacle: floor}}}\n",
                             SHEET),
                  (const double[]){0, 0, WEIGHT}, 1e-6 * WEIGHT);
}

static char *file_text(const char *path)
{
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    char *text = mem_alloc(1 << 20, 1);
    text[fread(text, 1, (1 << 20) - 1, file)] = 0;
    fclose(file);
    return text;
}

/* So many runs of a scene, each with a setting and from where the one before ended, leave this table. */
static char *table_of(const char *path, const char *const *settings, int common, const char *const *then,
                      int runs)
{
    for (int k = 0; k < runs; k++) {
        const char *now[8];
        memcpy(now, settings, (size_t)common * sizeof *now);
        now[common] = then[k];
        result_close(run_file(path, now, common + 1, k > 0));
    }
    return file_text(NAME "_probes.csv");
}

/* Tables of stages end with what acts in them, what is 0 in all left out; every bit of it. */
static void test_stage_columns(void **state)
{
    (void)state;
    result_close(run_text(mem_format("%sjob: equilibrium\nfix: [{group: root, clamp: true}]\n"
                                     "sequence: {flux_density: {from: [0, 0, 0], to: [0, 0.3 mT, 0], count: "
                                     "3}, time: {from: 1, to: 2}}\n"
                                     "probes: {z: {height: tip}}\n",
                                     SHEET)));
    char *text = file_text(NAME "_probes.csv");
    assert_string_equal(text, "stage,z,t,B.x,B.y,B.z\n0,0,1,0,0,0\n1,0,1.5,0,0.00014999999999999999,0\n"
                              "2,0,2,0,0.00029999999999999997,0\n");
    mem_free(text);
}

/* A motion: the start first, its table as the result, and the same when the run goes on. */
static void test_motion(void **state)
{
    (void)state;
    static const char scene[] = SOURCE_DIR "/tests/scene_simulate.yaml";
    const char *settings[] = {"output.precision=double",
                              "probes={tip: {vertex: 5}, z: {height: mass_center}}", "output.every=2"},
               *whole[] = {"time.steps=8"}, *parts[] = {"time.steps=3", "time.steps=6", "time.steps=8"};
    char *parted = table_of(scene, settings, 3, parts, 3), *text = table_of(scene, settings, 3, whole, 1);
    assert_string_equal(text, parted);
    Error err;
    Result *result = result_open(NAME ".vtkhdf", &err);
    check_mean(result, "slender/probes/tip", (const int[]){5}, 1);
    Array time = read_all(result, "slender/probes/time"), tip = read_all(result, "slender/probes/tip"),
          z = read_all(result, "slender/probes/z");
    assert_true(time.dims[0] == 5 && numbers(&time)[0] == 0 && !strcmp(time.unit, "s"));
    char *rest = NULL, *line = strtok_r(text, "\n", &rest);
    assert_string_equal(line, "time,tip.x,tip.y,tip.z,z");
    for (int n = 0; n < 5; n++) {
        double row[5];
        line = strtok_r(NULL, "\n", &rest);
        for (int i = 0; i < 5; i++) row[i] = strtod(line + (i > 0), &line);
        assert_true(row[0] == numbers(&time)[n] && row[4] == numbers(&z)[n]);
        assert_memory_equal(row + 1, numbers(&tip) + 3 * n, 3 * sizeof *row);
    }
    array_clear(&time);
    array_clear(&tip);
    array_clear(&z);
    result_close(result);
    mem_free(text);
    mem_free(parted);
}

/* A design: a row for each evaluation and case, the best one where its cases end, the same when the run goes on. */
static void test_design(void **state)
{
    (void)state;
    static const char scene[] = SOURCE_DIR "/tests/scene_small.yaml";
    const char *settings[] = {"shell.mesh.n=5",
                              "probes={tip: {vertex: 30}, span: {distance: [\"0\", \"30\"]}}"},
               *whole[] = {"design.iterations=6"}, *parts[] = {"design.iterations=2", "design.iterations=6"};
    char *parted = table_of(scene, settings, 2, parts, 2), *text = table_of(scene, settings, 2, whole, 1);
    assert_string_equal(text, parted);
    assert_true(!strncmp(text, "evaluation,case,tip.x,tip.y,tip.z,span\n0,0,", 42));
    Error err;
    Result *result = result_open(NAME ".vtkhdf", &err);
    Array objective = read_all(result, "slender/history/objective"),
          tip = read_all(result, "slender/probes/tip"),
          number = read_all(result, "slender/probes/evaluation"),
          span = read_all(result, "slender/probes/span"), up = read_all(result, "slender/cases/up/x");
    int best = 0, count = objective.dims[0];
    for (int k = 0; k < count; k++)
        if (numbers(&objective)[k] < numbers(&objective)[best]) best = k;
    assert_true(tip.rank == 3 && tip.dims[0] == count && tip.dims[1] == 2 && tip.dims[2] == 3);
    assert_true(number.rank == 1 && span.rank == 2 && numbers(&number)[count - 1] == count - 1);
    assert_true(numbers(&tip)[6 * best + 2] != numbers(&tip)[2]);
    assert_memory_equal(numbers(&tip) + 6 * best, numbers(&up) + 90, 3 * sizeof(double));
    Array *read[] = {&objective, &tip, &number, &span, &up};
    for (int i = 0; i < 5; i++) array_clear(read[i]);
    result_close(result);
    mem_free(text);
    mem_free(parted);
}

/* Frames of a sequence, to be cleared. */
static Array frames_of(const char *sequence)
{
    Result *result = run_text(
        mem_format("%s  magnetization: [1000, 0, 500]\n  gravity: [0, 0, -9.81]\njob: equilibrium\n"
                   "fix: [{group: root, clamp: true}, {group: tip, axes: y, move: [0, \"y + 0.001*t\", 0]}]\n"
                   "sequence: %s\n",
                   SHEET, sequence));
    Array x = read_all(result, "slender/frames/x");
    result_close(result);
    return x;
}

/* A range is the list of its stages, to rounding: fields, loads, gravity and what moves in time, side by side. */
static void test_ranges(void **state)
{
    (void)state;
    Array range = frames_of(
              "{flux_density: {from: [0, 0, 0], to: [0, 0, 8 mT], count: 5}, gravity: {from: [0, 0, "
              "-8], to: [0, 0, 0]},\n  time: {from: 0, to: 4 s, count: 5}, loads: {from: {force: [0, "
              "0, 0], on: tip}, to: [{force: [0, 0, 4 mN], on: tip}]}}"),
          list = frames_of("[{flux_density: [0, 0, 0], gravity: [0, 0, -8], time: 0, loads: [{force: [0, 0, "
                           "0], on: tip}]},\n"
                           "  {flux_density: [0, 0, 2 mT], gravity: [0, 0, -6], time: 1, loads: [{force: [0, "
                           "0, 1 mN], on: tip}]},\n"
                           "  {flux_density: [0, 0, 4 mT], gravity: [0, 0, -4], time: 2, loads: [{force: [0, "
                           "0, 2 mN], on: tip}]},\n"
                           "  {flux_density: [0, 0, 6 mT], gravity: [0, 0, -2], time: 3, loads: [{force: [0, "
                           "0, 3 mN], on: tip}]},\n"
                           "  {flux_density: [0, 0, 8 mT], gravity: [0, 0, 0], time: 4, loads: [{force: [0, "
                           "0, 4 mN], on: tip}]}]");
    assert_true(range.dims[0] == 5 && list.dims[0] == 5);
    for (size_t i = 0; i < array_count(&list); i++) assert_near(numbers(&range)[i], numbers(&list)[i], 1e-12);
    const double *x = numbers(&range);
    for (int n = 0; n < 5; n++) assert_near(x[3 * (n * 27 + 17) + 1], 0.005 + 0.001 * n, 1e-15);
    assert_true(x[3 * 17 + 2] < 0 && x[3 * (4 * 27 + 17) + 2] > 0.01);
    array_clear(&range);
    array_clear(&list);
}

/* ---- Load steps that are frames ---- */

/* What holds a body, and what stretches: bodies of each kind under a weight of 1 in parts of the load. */
static const char ROD[] =
    "slender: 1\njob: equilibrium\noutput: {precision: double}\n"
    "rod: {natural_strain: [1, 5, 3], length: 0.2, elements: 20, radius: 1 mm, young: 10 "
    "MPa, poisson: 0.4, density: 1000, gravity: [0, 0, -10]}\n",
                  SOLID[] =
                      "slender: 1\njob: equilibrium\noutput: {precision: double}\n"
                      "solid: {mesh: {shape: box, size: [20 mm, 4 mm, 4 mm], cells: [4, 1, 1]}, young: 1 "
                      "MPa, poisson: 0.3, density: 1000, gravity: [0, 0, -9.81]}\n"
                      "fix: [{box: [[-1, -1, -1], [0, 1, 1]]}]\n",
                  STRIP[] =
                      SHEET "  gravity: [0, 0, -9.81]\njob: equilibrium\nfix: [{group: root, clamp: true}, "
                            "{group: tip, axes: y, move: [0, \"y + 0.001*t\", 0]}]\ntime: 4 s\n";

static char *stepped(const char *scene, const char *steps)
{
    return mem_format("%sprobes: {support: {force: all}}\nload_steps: %s\n", scene, steps);
}

/* Each frame bears its part of the weight; the last one has the bits of the run that keeps none of them. */
static void test_load_steps(void **state)
{
    (void)state;
    const char *scenes[] = {ROD, SOLID, STRIP};
    const double weights[] = {1000 * acos(-1) * 1e-6 * 0.2 * 10, 0.32e-3 * 9.81, WEIGHT};
    for (int k = 0; k < 3; k++) {
        Result *last = run_text(stepped(scenes[k], "4"));
        Array alone = read_all(last, "slender/state/x");
        result_close(last);
        Result *result = run_text(stepped(scenes[k], "{count: 4, frames: true}"));
        Array x = read_all(result, "slender/state/x"), force = read_all(result, "slender/probes/support"),
              part = read_all(result, "slender/stages/load_part"),
              status = read_all(result, "slender/stages/status"),
              own = read_all(result, "slender/stages/support_force");
        assert_memory_equal(x.data, alone.data, array_count(&x) * sizeof(double));
        assert_string_equal(status.data, "converged\nconverged\nconverged\nconverged\n");
        assert_true(force.dims[0] == 4 && own.dims[0] == 4);
        for (int n = 0; n < 4; n++) {
            assert_true(numbers(&part)[n] == (n + 1) / 4.0);
            assert_near(numbers(&force)[3 * n + 2], (n + 1) / 4.0 * weights[k], 1e-6 * weights[k]);
        }
        Array *read[] = {&alone, &x, &force, &part, &status, &own};
        for (int i = 0; i < 6; i++) array_clear(read[i]);
        result_close(result);
    }
}

/* A step that fails ends its case: the part of the loads, these loads, and the forces and energies are of one state. */
static void test_failed_step(void **state)
{
    (void)state;
    SlenderError err;
    char *text =
        mem_text(SHEET "  gravity: [0, 0, -9.81]\njob: equilibrium\nfix: [{group: root, clamp: true}]\n"
                       "sequence: [{gravity: [0, 0, 0]}, {gravity: [0, 0, -1.0e+6]}]\n"
                       "load_steps: {count: 4, frames: true}\nsolver: {max_iterations: 5}\n");
    for (int again = 0; again < 2; again++) {
        Result *result = run_to(slender_scene_parse(text, NULL, 0, &err), &err, again, SLENDER_NOT_CONVERGED);
        Array part = read_all(result, "slender/stages/load_part"),
              gravity = read_all(result, "slender/stages/gravity"),
              stage = read_all(result, "slender/stages/support_force"),
              last = read_all(result, "slender/final/support_force");
        assert_int_equal(part.dims[0], 5); /* the first of the second stage is its last */
        assert_true(numbers(&part)[4] == 0.25 && numbers(&gravity)[3 * 4 + 2] == -0.25e6);
        for (int i = 0; i < 3; i++) assert_true(numbers(&stage)[3 * 4 + i] == numbers(&last)[i]);
        Array *read[] = {&part, &gravity, &stage, &last};
        for (int i = 0; i < 4; i++) array_clear(read[i]);
        result_close(result);
    }
    mem_free(text);
}

/* Stops a run after so many frames. */
static void count_frame(void *self, double time, int points, const double *place)
{
    (void)time, (void)points, (void)place;
    --*(int *)self;
}

static int stop(void *self)
{
    return *(int *)self <= 0;
}

/* A sequence of which each stage comes on in frames, stopped and gone on with: the bytes of the one in one go. */
static void test_stopped_steps(void **state)
{
    (void)state;
    char *said = mem_format("%ssequence: [{time: 2 s}, {gravity: [0, 0, 0]}]\n", STRIP),
         *text = stepped(said, "{count: 3, frames: true}"), *scene = strstr(text, "time: 4 s\n");
    memset(scene, ' ', 9);
    Result *whole = run_text(mem_text(text));
    Array x = read_all(whole, "slender/frames/x"), part = read_all(whole, "slender/stages/load_part"),
          force = read_all(whole, "slender/probes/support");
    assert_true(x.dims[0] == 6 && numbers(&part)[3] == 1.0 / 3 && numbers(&part)[5] == 1);
    assert_near(numbers(&force)[3 * 3 + 2], 2 * WEIGHT / 3, 1e-9);
    result_close(whole);
    for (int stops = 1; stops < 6; stops += 3) {
        SlenderError err;
        int left = stops;
        SlenderScene *again = slender_scene_parse(text, NULL, 0, &err);
        SlenderRun def = {.output = NAME, .threads = 1, .force = true};
        def.host = (SlenderHost){.self = &left, .frame = count_frame, .stop = stop};
        assert_int_equal(slender_run(again, &def, &err), SLENDER_INTERRUPTED);
        Result *result = run(again, &err, true);
        Array parted = read_all(result, "slender/frames/x"),
              held = read_all(result, "slender/probes/support");
        assert_memory_equal(parted.data, x.data, array_count(&x) * sizeof(double));
        assert_memory_equal(held.data, force.data, array_count(&force) * sizeof(double));
        array_clear(&parted);
        array_clear(&held);
        result_close(result);
    }
    array_clear(&x);
    array_clear(&part);
    array_clear(&force);
    mem_free(said);
    mem_free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_forms),  cmocka_unit_test(test_stages),
        cmocka_unit_test(test_forces),        cmocka_unit_test(test_motion),
        cmocka_unit_test(test_design),        cmocka_unit_test(test_ranges),
        cmocka_unit_test(test_stage_columns), cmocka_unit_test(test_load_steps),
        cmocka_unit_test(test_failed_step),   cmocka_unit_test(test_stopped_steps)};
    return cmocka_run_group_tests(tests, remove_run, remove_run);
}
