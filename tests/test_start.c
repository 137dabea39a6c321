/* Models of scenes with the key `start`, by the library: their states are those that the result keeps. What runs make of
 * them is in tests/start.sh. */
#include "slender.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

static const char SHELL[] =
    "slender: 1\n"
    "job: simulate\n"
    "shell: {mesh: {shape: sheet, size: [30 mm, 10 mm], cells: [6, 2]}, thickness: 1 mm, young: 0.1 MPa,\n"
    "        poisson: 0.5, magnetization: [50 kA/m, 0, 0]}\n"
    "flux_density: [\"0\", \"0\", \"0.02*sin(300*t)\"]\n"
    "fix: [{group: root, clamp: true}]\n"
    "time: {step: 1 ms, steps: 12}\n";

static const char ROD[] =
    "slender: 1\n"
    "job: simulate\n"
    "rod: {natural_strain: [1, 20, 3], length: 0.2, elements: 20, radius: 1 mm, young: 1 MPa,\n"
    "      poisson: 0.4, density: 1100}\n"
    "time: {step: 1 ms, steps: 12}\n";

#define FIRST "test_start_first"
#define WHOLE "test_start_whole"

static SlenderScene *scene_of(const char *text, const char *const *settings, int count)
{
    SlenderError err;
    SlenderScene *scene = slender_scene_parse(text, settings, count, &err);
    if (!scene) fail_msg("%s", err.text);
    return scene;
}

static void run(const char *text, const char *setting, const char *output)
{
    SlenderError err;
    SlenderScene *scene = scene_of(text, &setting, 1);
    SlenderRun def = {.output = output, .threads = 1, .force = 1, .no_journal = 1};
    if (slender_run(scene, &def, &err) != SLENDER_DONE) fail_msg("%s", err.text);
    slender_scene_destroy(scene);
}

/* Are these the numbers of that dataset, bit by bit? */
static bool is_kept(const char *path, const char *name, const double *values, int count)
{
    SlenderError err;
    SlenderArray array;
    SlenderResult *result = slender_result_open(path, &err);
    assert_non_null(result);
    assert_int_equal(slender_result_read(result, name, -1, &array, &err), SLENDER_DONE);
    bool same = !memcmp(array.data, values, (size_t)count * sizeof *values);
    slender_array_free(&array);
    slender_result_close(result);
    return same;
}

typedef struct Started {
    SlenderScene *scene;
    SlenderModel *model;
    SlenderState *state;
} Started;

/* From what run has left. */
static Started start(const char *text, const char *job)
{
    const char *const settings[] = {"start=" FIRST ".vtkhdf", job};
    SlenderError err;
    Started s = {.scene = scene_of(text, settings, 2)};
    s.model = slender_model_create(s.scene, 1, &err);
    if (!s.model) fail_msg("%s", err.text);
    s.state = slender_state_create(s.model, 0, &err);
    assert_non_null(s.state);
    return s;
}

static void end(Started *s)
{
    slender_state_destroy(s->state);
    slender_model_destroy(s->model);
    slender_scene_destroy(s->scene);
}

static void check_state(const char *text, const char *job, bool remembers)
{
    Started s = start(text, job);
    SlenderStateInfo now = slender_state_info(s.state);
    assert_true(is_kept(FIRST ".vtkhdf", "slender/state/dofs", now.x, now.dofs));
    assert_true(is_kept(FIRST ".vtkhdf", "slender/state/velocities", now.v, now.dofs));
    assert_true(is_kept(FIRST ".vtkhdf", "slender/state/time", now.time, 1));
    assert_true((now.memory_count > 0) == remembers);
    if (remembers)
        assert_true(is_kept(FIRST ".vtkhdf", "slender/state/memory", now.memory, now.memory_count));
    end(&s);
}

/* A motion from there ends where the undivided one does, to its tolerance: it begins without its factor. */
static void check_motion(const char *text)
{
    Started s = start(text, "time.steps=12");
    SlenderError err;
    SlenderStatus status;
    SlenderMotionDef def = {.steps = 12, .step = 1e-3};
    SlenderMotion *motion = slender_simulate(s.model, 0, s.state, &def, &status, &err);
    assert_int_equal(status, SLENDER_DONE);
    SlenderState *last = slender_motion_state(motion, 12, &err);
    SlenderResult *result = slender_result_open(WHOLE ".vtkhdf", &err);
    SlenderArray whole;
    assert_int_equal(slender_result_read(result, "slender/state/x", -1, &whole, &err), SLENDER_DONE);
    const double *x = whole.data;
    for (int i = 0; i < whole.dims[0] * 3; i++)
        assert_true(fabs(slender_state_info(last).x[i] - x[i]) < 1e-9);
    slender_array_free(&whole);
    slender_result_close(result);
    slender_state_destroy(last);
    slender_motion_destroy(motion);
    end(&s);
}

static void test_shell(void **state)
{
    (void)state;
    run(SHELL, "time.steps=24", WHOLE);
    run(SHELL, "time.steps=12", FIRST);
    check_state(SHELL, "job=simulate", true);
    check_state(SHELL, "job=equilibrium", true);
    check_motion(SHELL);
}

static void test_rod(void **state)
{
    (void)state;
    run(ROD, "time.steps=24", WHOLE);
    run(ROD, "time.steps=12", FIRST);
    check_state(ROD, "job=simulate", false);
    check_state(ROD, "job=equilibrium", false);
    check_motion(ROD);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_shell), cmocka_unit_test(test_rod)};
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    static const char *const made[] = {FIRST ".vtkhdf", FIRST ".xdmf", WHOLE ".vtkhdf", WHOLE ".xdmf"};
    for (size_t k = 0; k < sizeof made / sizeof *made; k++) unlink(made[k]);
    return failed;
}
