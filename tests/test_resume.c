/* Runs that a journal of an older slender holds: what its scene does not say is as it is by default. */
#include "base/memory.h"
#include "io/journal.h"
#include "slender.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#define NAME "test_resume"

static const char SCENE[] =
    "slender: 1\n"
    "job: simulate\n"
    "rod: {natural_strain: [1, 20, 3], length: 0.2, elements: 10, radius: 1 mm, young: 1 MPa,\n"
    "      poisson: 0.4, density: 1100}\n"
    "time: {step: 1 ms, steps: 2}\n";

/* They lie on a floor. */
static const char *const RESTING[] = {
    "slender: 1\n"
    "job: simulate\n"
    "rod: {natural_strain: [0, 0, 0], length: 0.2, elements: 10, radius: 1 mm, young: 1 MPa, poisson: 0.4,\n"
    "      density: 1100}\n"
    "obstacles: [{plane: {point: [0, 0, -1 mm]}}]\n"
    "time: {step: 1 ms, steps: 2}\n",
    "slender: 1\n"
    "job: simulate\n"
    "shell: {mesh: {shape: sheet, size: [0.02, 0.02], cells: [2, 2]}, thickness: 1 mm, young: 1 MPa,\n"
    "        poisson: 0.4, gravity: [0, 0, -9.81]}\n"
    "obstacles: [{plane: {point: [0, 0, -0.5 mm]}}]\n"
    "time: {step: 1 ms, steps: 2}\n"};

static SlenderStatus run_scene(const char *text, const char *setting, int resume, SlenderError *err)
{
    SlenderScene *scene = slender_scene_parse(text, &setting, 1, err);
    assert_non_null(scene);
    SlenderRun def = {.output = NAME, .threads = 1, .resume = resume, .force = !resume};
    SlenderStatus status = slender_run(scene, &def, err);
    slender_scene_destroy(scene);
    return status;
}

static SlenderStatus run(const char *setting, int resume, SlenderError *err)
{
    return run_scene(SCENE, setting, resume, err);
}

/* Takes the line of a key out of the scene that the journal has, or puts another in its place. */
static void change_journal(const char *key, const char *line)
{
    Error err;
    Array old;
    Journal *journal = journal_open(NAME ".run", JOURNAL_RESUME, &err);
    assert_non_null(journal);
    assert_true(journal_get(journal, "meta", 0, "scene", &old, &err));
    const char *text = old.data, *at = strstr(text, key);
    assert_non_null(at);
    char *changed = mem_format("%.*s%s%s", (int)(at - text), text, line, at + strcspn(at, "\n"));
    Array scene = array_text("scene", changed);
    assert_true(journal_put(journal, "meta", 0, &scene, 1, &err));
    assert_true(journal_close(journal, &err));
    mem_free(changed);
    array_clear(&old);
}

static void test_older(void **state)
{
    (void)state;
    SlenderError err;
    assert_int_equal(run("time.steps=2", 0, &err), SLENDER_DONE);
    change_journal("states: ", "");
    if (run("time.steps=4", 1, &err) != SLENDER_DONE) fail_msg("%s", err.text);
    change_journal("states: ", "states: all");
    assert_int_equal(run("time.steps=6", 1, &err), SLENDER_REFUSED);
    assert_non_null(strstr(err.text, "output.states is not the same"));
    change_journal("job: ", "job: juggle"); /* what cannot be read is another scene */
    assert_int_equal(run("time.steps=6", 1, &err), SLENDER_REFUSED);
    assert_non_null(strstr(err.text, "the scene has changed since that run: job is not the same"));
}

/* N, of the result. */
static double lifting_force(void)
{
    SlenderError err;
    SlenderArray force;
    SlenderResult *result = slender_result_open(NAME ".vtkhdf", &err);
    assert_non_null(result);
    assert_int_equal(slender_result_read(result, "slender/final/contact_force", -1, &force, &err),
                     SLENDER_DONE);
    double up = ((const double *)force.data)[2];
    slender_array_free(&force);
    slender_result_close(result);
    return up;
}

/* A finished run that goes on has what its obstacles did, also where there is no step left to do. */
static void test_resting(void **state)
{
    (void)state;
    SlenderError err;
    for (int k = 0; k < 2; k++) {
        assert_int_equal(run_scene(RESTING[k], "time.steps=4", 0, &err), SLENDER_DONE);
        double whole = lifting_force();
        assert_true(whole > 0);
        if (run_scene(RESTING[k], "time.steps=4", 1, &err) != SLENDER_DONE) fail_msg("%s", err.text);
        assert_true(lifting_force() == whole);
        assert_int_equal(run_scene(RESTING[k], "time.steps=2", 0, &err), SLENDER_DONE);
        if (run_scene(RESTING[k], "time.steps=4", 1, &err) != SLENDER_DONE) fail_msg("%s", err.text);
        assert_true(lifting_force() == whole);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_older), cmocka_unit_test(test_resting)};
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    static const char *const made[] = {NAME ".vtkhdf", NAME ".xdmf", NAME ".run", NAME ".run-lock"};
    for (size_t k = 0; k < sizeof made / sizeof *made; k++) unlink(made[k]);
    return failed;
}
