/* The files of a scene, told by their contents: each key of the table that names one, wherever it stands. */
#include "base/memory.h"
#include "job/inputs.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

/* Files of these names; which of them are there is not looked at before their sums are. */
static const char SCENE[] = "slender: 1\n"
                            "job: design\n"
                            "shell:\n"
                            "  mesh: inputs_a\n"
                            "  thickness: 1 mm\n"
                            "  young: {file: inputs_b}\n"
                            "  poisson: 0.3\n"
                            "cases:\n"
                            "  - {name: up, target: {file: inputs_a}}\n"
                            "  - {name: down, flux_density: {file: inputs_c}}\n"
                            "design:\n"
                            "  unknowns: {magnetization: {start: {file: inputs_d}}}\n"
                            "  objectives: [{target: 1}]\n";

static YamlFile *load(Scene *scene)
{
    YamlFile *file = yaml_parse("scene.yaml", SCENE, strlen(SCENE));
    if (!yaml_load(file, scene_table(), scene)) fail_msg("%s", yaml_report(file));
    return file;
}

static void test_contents(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    static const char *const names[] = {"inputs_a", "inputs_b", "inputs_c", "inputs_d"};
    for (int k = 0; k < 4; k++) write_file(names[k], names[k]);
    write_file("inputs_c", "123456789"); /* whose CRC32 is 0xcbf43926, as that of every implementation */
    Scene scene;
    Error err;
    YamlFile *file = load(&scene);
    char *before = inputs_text(&scene, &err), **keys = inputs_keys(&scene);
    assert_non_null(strstr(before, "cbf43926 9 cases[1].flux_density.file\n"));
    static const char *const wanted[] = {"shell.mesh.file", "shell.young.file", "cases[0].target.file",
                                         "cases[1].flux_density.file",
                                         "design.unknowns.magnetization.start.file"};
    for (int k = 0; k < 5; k++) assert_string_equal(keys[k], wanted[k]);
    assert_null(keys[5]);
    assert_true(inputs_check(&scene, before, before, &err));
    static const char *const sentences[] = {
        "shell.mesh.file: ", "shell.young.file: ", "cases[1].flux_density.file: ",
        "design.unknowns.magnetization.start.file: "};
    for (int k = 0; k < 4; k++) {
        write_file(names[k], "inputs_x");
        char *now = inputs_text(&scene, &err);
        assert_false(inputs_check(&scene, before, now, &err));
        assert_true(strstr(err.text, sentences[k]) == err.text && strstr(err.text, names[k]) &&
                    strstr(err.text, "is not the file that the run began with"));
        mem_free(now);
        write_file(names[k], k == 2 ? "123456789" : names[k]);
    }
    unlink("inputs_b");
    assert_null(inputs_text(&scene, &err));
    assert_non_null(strstr(err.text, "inputs_b: cannot be read"));
    assert_int_equal(mkfifo("inputs_b", 0600), 0); /* can be read once: never the same for certain */
    char *now = inputs_text(&scene, &err);
    assert_false(inputs_check(&scene, now, now, &err));
    assert_non_null(strstr(err.text, "is no regular file"));
    for (int k = 0; k < 4; k++) unlink(names[k]);
    mem_free(now);
    mem_free(before);
    mem_free(keys);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    assert_int_equal(mem_live_count(), blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_contents)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
