/* Every scene in scenes/ loads, builds and takes its first steps; the field tables are sound. */
#include "base/memory.h"
#include "job/run.h"
#include "solve/march.h"
#include <glob.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static void test_table(void **state)
{
    (void)state;
    yaml_check_table(scene_table());
}

static void take_step_of_time(const Model *model, const Scene *scene)
{
    Case *c = &model->cases[0];
    MarchDef def = march_default();
    MarchInfo info;
    def.implicit = model->world && model->world->implicit;
    assert_true(march_step(c->sys, &def, scene->time.step, c->stages[0].p, &c->state, &info));
}

static void take_steps(Model *model)
{
    NewtonDef def = newton_default();
    def.max_iterations = 2;
    for (int c = 0; c < model->case_count; c++) {
        Case *load = &model->cases[c];
        Point at = {.p = load->stages[0].p, .time = load->stages[0].time};
        NewtonInfo info = newton_minimize(load->sys, &def, &at, &load->state, NULL);
        assert_true(info.status == NEWTON_MAX_ITERATIONS || info.status == NEWTON_CONVERGED);
    }
}

static void check_scene(const char *path)
{
    Scene scene, again;
    long blocks = mem_live_count();
    YamlFile *file = yaml_read(path);
    Model *model = yaml_load(file, scene_table(), &scene) ? model_create(&scene, file) : NULL;
    char *report = yaml_report(file);
    if (!model) fail_msg("%s", report);
    if (model->job->motion && model->case_count)
        take_step_of_time(model, &scene);
    else
        take_steps(model);
    /* The effective scene is the same scene. */
    char *text = yaml_write(scene_table(), &scene);
    YamlFile *effective = yaml_parse(path, text, strlen(text));
    if (!yaml_load(effective, scene_table(), &again)) fail_msg("%s", yaml_report(effective));
    char *text_again = yaml_write(scene_table(), &again);
    assert_string_equal(text, text_again);
    mem_free(text);
    mem_free(text_again);
    mem_free(report);
    yaml_clear(scene_table(), &again);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(effective);
    yaml_destroy(file);
    model_destroy(model);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_scenes(void **state)
{
    (void)state;
    glob_t found;
    assert_int_equal(glob(SOURCE_DIR "/scenes/*.yaml", 0, NULL, &found), 0);
    assert_true(found.gl_pathc >= 8);
    for (size_t k = 0; k < found.gl_pathc; k++) check_scene(found.gl_pathv[k]);
    globfree(&found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_table), cmocka_unit_test(test_scenes)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
