/* libslender by its public header alone; examples/tutorial.c has its numbers. */
#include "slender.h"
#include "tests/leaks.h"
#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

/* As json.dump writes it: quantities in quotes. */
static const char strip[] =
    "{\"slender\": 1, \"job\": \"%s\", \"shell\": {\"mesh\": {\"shape\": \"sheet\", \"size\": "
    "[\"30 mm\", \"10 mm\"], \"cells\": [\"6\", 2]}, \"thickness\": \"1 mm\", \"young\": \"0.1 MPa\", "
    "\"poisson\": \"0.5\", \"magnetization\": [\"20 kA/m\", 0, 0]}, \"flux_density\": [0, 0, \"5 mT\"], "
    "\"fix\": [{\"group\": \"root\", \"clamp\": \"true\"}]%s}";

static SlenderScene *scene_of(const char *job, const char *more)
{
    char text[1024];
    SlenderError err;
    snprintf(text, sizeof text, strip, job, more);
    SlenderScene *scene = slender_scene_parse(text, NULL, 0, &err);
    if (!scene) fail_msg("%s", err.text);
    return scene;
}

static SlenderModel *model_of(const SlenderScene *scene, int threads)
{
    SlenderError err;
    SlenderModel *model = slender_model_create(scene, threads, &err);
    if (!model) fail_msg("%s", err.text);
    return model;
}

static SlenderState *rest_of(SlenderModel *model, int load_case)
{
    SlenderError err;
    SlenderState *state = slender_state_create(model, load_case, &err);
    if (slender_equilibrium(model, load_case, state, NULL, &err) != SLENDER_DONE) fail_msg("%s", err.text);
    return state;
}

/* ---- What goes wrong is one sentence ---- */

static void refused(const char *text, const char *sentence)
{
    SlenderError err;
    SlenderScene *scene = slender_scene_parse(text, NULL, 0, &err);
    SlenderModel *model = scene ? slender_model_create(scene, 1, &err) : NULL;
    assert_null(model);
    assert_int_equal(err.status, SLENDER_REFUSED);
    assert_string_equal(err.text, sentence);
    slender_scene_destroy(scene);
}

static void test_sentences(void **state)
{
    (void)state;
    long before = mem_live_count();
    SlenderError err;
    refused("nothing", "a scene is a mapping with the key `slender: 1`");
    refused("{\"slender\": 1, \"job\": \"draw\", \"spline\": {\"density\": \"0.3\"}}",
            "a scene with a drawing and `job: draw` has no load cases; it can be run");
    char text[1024];
    snprintf(text, sizeof text, strip, "equilibrium", ", \"target\": {\"file\": \"nowhere.obj\"}");
    SlenderScene *scene = slender_scene_parse(text, NULL, 0, &err);
    for (int k = 0; k < 2; k++) { /* a scene can be used again */
        assert_null(slender_model_create(scene, 1, &err));
        assert_non_null(strstr(err.text, "target"));
        assert_non_null(strstr(err.text, "nowhere.obj: cannot be read"));
        assert_null(strstr(err.text, "more"));
    }
    slender_scene_destroy(scene);
    assert_null(slender_scene_read("nowhere.yaml", NULL, 0, &err));
    assert_non_null(strstr(err.text, "nowhere.yaml"));
    scene = scene_of("equilibrium", "");
    assert_null(slender_model_create(scene, 65, &err));
    assert_string_equal(err.text, "threads is 65; it must be from 1 to 64");
    slender_scene_destroy(scene);
    assert_null(slender_result_open("nowhere.vtkhdf", &err));
    assert_int_equal(mem_live_count(), before);
}

/* Derivatives of what is no equilibrium of these parameters are refused, not wrong. */
static void test_stale(void **unused)
{
    (void)unused;
    SlenderScene *scene = scene_of("equilibrium", "");
    SlenderModel *model = model_of(scene, 1);
    SlenderModelInfo info = slender_model_info(model);
    SlenderState *state = rest_of(model, 0), *copy = slender_state_copy(state);
    double *dx = calloc((size_t)info.dofs, sizeof *dx), *dp = calloc((size_t)info.params, sizeof *dp);
    SlenderError err;
    dx[info.dofs / 2] = 1;
    assert_int_equal(slender_vjp(model, 0, copy, dx, dp, &err), SLENDER_DONE);
    slender_state_info(copy).x[5] += 1e-9;
    assert_int_equal(slender_vjp(model, 0, copy, dx, dp, &err), SLENDER_REFUSED);
    slender_model_params(model, 0)[0] *= 1.01;
    assert_int_equal(slender_vjp(model, 0, state, dx, dp, &err), SLENDER_REFUSED);
    assert_int_equal(slender_vjp(model, 1, state, dx, dp, &err), SLENDER_REFUSED);
    assert_string_equal(err.text, "there is no load case 1: there are 1, from 0 on");
    free(dx);
    free(dp);
    slender_state_destroy(state);
    slender_state_destroy(copy);
    slender_model_destroy(model);
    slender_scene_destroy(scene);
}

/* ---- Cases ---- */

/* Shared parameters are written once; each case has its field. */
static void test_cases(void **unused)
{
    (void)unused;
    SlenderScene *scene = scene_of(
        "equilibrium", ", \"cases\": [{\"name\": \"up\", \"flux_density\": [0, 0, \"5 mT\"]}, {\"name\": "
                       "\"down\", \"flux_density\": [0, 0, \"-5 mT\"]}]");
    SlenderModel *model = model_of(scene, 2);
    SlenderModelInfo info = slender_model_info(model);
    assert_int_equal(info.cases, 2);
    assert_string_equal(slender_model_case(model, 1), "down");
    assert_null(slender_model_case(model, 2));
    for (int half = 0; half < 2; half++) {
        SlenderState *up = rest_of(model, 0), *down = rest_of(model, 1);
        const double *x = slender_state_info(up).x, *y = slender_state_info(down).x;
        for (int v = 0; v < info.points; v++) {
            assert_true(fabs(x[3 * v] - y[3 * v]) < 1e-9);
            assert_true(fabs(x[3 * v + 2] + y[3 * v + 2]) < 1e-9);
        }
        slender_state_destroy(up);
        slender_state_destroy(down);
        for (int k = 0; k < info.blocks; k++) {
            SlenderBlock block = slender_model_block(model, k);
            bool field = !strcmp(block.name, "flux_density"), M = !strcmp(block.name, "magnetization");
            if (field || M) assert_int_equal(block.per_case, field);
            for (int i = 0; M && i < 3 * block.count; i++)
                slender_model_params(model, 0)[block.offset + i] /= 2;
        }
    }
    slender_model_destroy(model);
    slender_scene_destroy(scene);
}

/* A rod has its places as dofs, whatever its job. */
static void test_rod(void **unused)
{
    (void)unused;
    static const char text[] =
        "slender: 1\njob: equilibrium\nrod: {natural_strain: [0, 0, 20], length: 0.1, elements: 20, "
        "radius: 1 mm, young: 1 MPa, poisson: 0.4, density: 1000}\n";
    SlenderError err;
    SlenderStatus status;
    SlenderScene *scene = slender_scene_parse(text, NULL, 0, &err);
    SlenderModel *model = model_of(scene, 1);
    SlenderModelInfo info = slender_model_info(model);
    SlenderState *state = rest_of(model, 0);
    assert_int_equal(info.points, 21);
    const double *x = slender_state_info(state).x;
    for (int i = 0; i < 20; i++) /* a chord is little shorter than its element */
        assert_true(fabs(hypot(hypot(x[3 * i + 3] - x[3 * i], x[3 * i + 4] - x[3 * i + 1]),
                               x[3 * i + 5] - x[3 * i + 2]) -
                         0.005) < 1e-4);
    SlenderMotionDef def = {.steps = 3, .step = 1e-3};
    SlenderMotion *motion = slender_simulate(model, 0, state, &def, &status, &err);
    assert_int_equal(status, SLENDER_DONE);
    SlenderState *end = slender_motion_state(motion, 3, &err);
    const double *y = slender_state_info(end).x; /* it rests */
    for (int i = 0; i < 3 * info.points; i++) assert_true(fabs(x[i] - y[i]) < 1e-6);
    assert_null(slender_motion_state(motion, 4, &err));
    slender_state_destroy(end);
    slender_motion_destroy(motion);
    slender_state_destroy(state);
    slender_model_destroy(model);
    slender_scene_destroy(scene);
}

/* Energies are those of statics, also where the scene's job is a motion. */
static void test_terms(void **unused)
{
    (void)unused;
    SlenderError err;
    SlenderScene *scene = scene_of("simulate", ", \"time\": {\"step\": \"1 ms\", \"steps\": 3}");
    SlenderModel *model = model_of(scene, 1);
    SlenderState *state = slender_state_create(model, 0, &err);
    double energies[16], sum = 0;
    int terms = slender_model_info(model).terms;
    for (int k = 0; k < 16; k++) energies[k] = 1e30;
    double energy = slender_energy(model, 0, state, energies, NULL, &err);
    for (int k = 0; k < terms; k++) sum += energies[k];
    assert_true(fabs(sum - energy) <= 1e-12 * fabs(energy));
    assert_true(energies[terms] == 1e30);
    assert_non_null(slender_model_term(model, terms - 1));
    assert_null(slender_model_term(model, terms));
    slender_state_destroy(state);
    slender_model_destroy(model);
    slender_scene_destroy(scene);
}

/* ---- Many, and at once ---- */

static void test_growth(void **unused)
{
    (void)unused;
    SlenderScene *scene = scene_of("equilibrium", "");
    long before = mem_live_count();
    for (int k = 0; k < 1000; k++) {
        SlenderModel *model = model_of(scene, 1);
        SlenderState *state = rest_of(model, 0);
        slender_state_destroy(state);
        slender_model_destroy(model);
        assert_int_equal(mem_live_count(), before);
    }
    slender_scene_destroy(scene);
}

typedef struct Task {
    int number;
    double energy, x[3000];
    SlenderScene *scene;
} Task;

static void *solve(void *self)
{
    Task *task = self;
    SlenderModel *model = model_of(task->scene, 1);
    for (int k = 0; k < 20; k++) {
        SlenderModelInfo info = slender_model_info(model);
        SlenderState *state = rest_of(model, 0);
        memcpy(task->x, slender_state_info(state).x, (size_t)info.dofs * sizeof(double));
        task->energy = slender_energy(model, 0, state, NULL, NULL, NULL);
        slender_state_destroy(state);
    }
    slender_model_destroy(model);
    return NULL;
}

static void test_threads(void **unused)
{
    (void)unused;
    static Task tasks[4];
    pthread_t threads[4];
    for (int k = 0; k < 4; k++) tasks[k].scene = scene_of("equilibrium", "");
    solve(&tasks[0]);
    for (int k = 1; k < 4; k++) pthread_create(&threads[k], NULL, solve, &tasks[k]);
    for (int k = 1; k < 4; k++) pthread_join(threads[k], NULL);
    for (int k = 1; k < 4; k++) assert_memory_equal(tasks[k].x, tasks[0].x, sizeof tasks[0].x);
    for (int k = 0; k < 4; k++) slender_scene_destroy(tasks[k].scene);
}

/* A child of fork has none of its parent's threads: it goes on without, and lets go without waiting for them. */
static void test_fork(void **unused)
{
    (void)unused;
    SlenderScene *scene = scene_of("equilibrium", "");
    SlenderModel *model = model_of(scene, 3);
    SlenderState *state = rest_of(model, 0);
    pid_t child = fork();
    if (child == 0) {
        alarm(20);
        SlenderState *again = slender_state_create(model, 0, NULL);
        bool good = slender_equilibrium(model, 0, again, NULL, NULL) == SLENDER_DONE &&
                    slender_state_info(again).energy == slender_state_info(state).energy;
        slender_state_destroy(again);
        slender_model_destroy(model);
        _exit(good ? 0 : 1);
    }
    int status;
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    slender_state_destroy(state);
    slender_model_destroy(model);
    slender_scene_destroy(scene);
}

/* ---- Hosts and jobs ---- */

typedef struct Watch {
    int steps, frames, stop_at;
} Watch;

static void count_step(void *self, int step, int total, const char *detail)
{
    (void)step, (void)total, (void)detail;
    ((Watch *)self)->steps++;
}

static void count_frame(void *self, double time, int points, const double *place)
{
    assert_true(time >= 0 && points == 21 && isfinite(place[0]));
    ((Watch *)self)->frames++;
}

static int stop(void *self)
{
    Watch *watch = self;
    return watch->stop_at > 0 && watch->steps >= watch->stop_at;
}

static void test_stopped(void **unused)
{
    (void)unused;
    SlenderError err;
    SlenderStatus status;
    Watch watch = {.stop_at = 3};
    SlenderScene *scene = scene_of("equilibrium", "");
    SlenderModel *model = model_of(scene, 1);
    SlenderState *state = slender_state_create(model, 0, &err);
    SlenderMotionDef def = {
        .steps = 100, .step = 1e-3, .host = {&watch, count_step, NULL, NULL, stop, count_frame}};
    SlenderMotion *motion = slender_simulate(model, 0, state, &def, &status, &err);
    assert_int_equal(status, SLENDER_INTERRUPTED);
    assert_int_equal(slender_motion_steps(motion), 3);
    assert_int_equal(watch.frames, 3);
    slender_motion_destroy(motion);
    slender_state_destroy(state);
    slender_model_destroy(model);
    slender_scene_destroy(scene);
}

/* A run that its host stops is kept, and goes on to the end of an undivided one. */
static void test_run(void **unused)
{
    (void)unused;
    SlenderError err;
    SlenderScene *scene = scene_of("simulate", ", \"time\": {\"step\": \"1 ms\", \"steps\": 12}");
    Watch watch = {.stop_at = 5};
    SlenderRun run = {.output = "test_library_run", .threads = 1, .force = 1};
    run.host = (SlenderHost){&watch, count_step, NULL, NULL, stop, NULL};
    double *x[2];
    assert_int_equal(slender_run(scene, &run, &err), SLENDER_INTERRUPTED);
    run.force = 0, run.resume = 1, watch.stop_at = 0;
    assert_int_equal(slender_run(scene, &run, &err), SLENDER_DONE);
    run = (SlenderRun){.output = "test_library_whole", .threads = 2, .no_journal = 1};
    unlink("test_library_whole.run");
    assert_int_equal(slender_run(scene, &run, &err), SLENDER_DONE);
    assert_int_equal(access("test_library_whole.run", F_OK), -1);
    static const char *const paths[] = {"test_library_run.vtkhdf", "test_library_whole.vtkhdf"};
    for (int k = 0; k < 2; k++) {
        SlenderArray array;
        SlenderResult *result = slender_result_open(paths[k], &err);
        assert_int_equal(slender_result_frames(result), 13);
        assert_int_equal(slender_result_read(result, "slender/state/x", -1, &array, &err), SLENDER_DONE);
        assert_int_equal(array.type, SLENDER_DOUBLE);
        assert_true(array.rank == 2 && array.dims[0] == 21 && array.dims[1] == 3);
        x[k] = malloc(63 * sizeof(double));
        memcpy(x[k], array.data, 63 * sizeof(double));
        slender_array_free(&array);
        assert_int_equal(slender_result_read(result, "Points", 13, &array, &err), SLENDER_REFUSED);
        slender_result_close(result);
    }
    assert_memory_equal(x[0], x[1], 63 * sizeof(double));
    free(x[0]);
    free(x[1]);
    slender_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sentences), cmocka_unit_test(test_stale), cmocka_unit_test(test_cases),
        cmocka_unit_test(test_rod),       cmocka_unit_test(test_terms), cmocka_unit_test(test_growth),
        cmocka_unit_test(test_threads),   cmocka_unit_test(test_fork),  cmocka_unit_test(test_stopped),
        cmocka_unit_test(test_run),
    };
    return cmocka_run_group_tests(tests, NULL, nothing_leaks);
}
