/* Every file in tests/broken is refused with the sentence that expected.txt has for it. */
#include "base/memory.h"
#include "io/mesh_file.h"
#include "model/model.h"
#include "surface/mesh.h"
#include <glob.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

static bool has_ending(const char *path, const char *ending)
{
    const char *dot = strrchr(path, '.');
    return dot && !strcmp(dot, ending);
}

/* Paths in scenes are made absolute: "/.../tests/broken/three.csv" as "three.csv". */
static void strip_folder(char *text)
{
    char folder[4096];
    assert_non_null(getcwd(folder, sizeof folder - 1));
    strcat(folder, "/");
    for (char *at; (at = strstr(text, folder));)
        memmove(at, at + strlen(folder), strlen(at + strlen(folder)) + 1);
}

static char *scene_sentence(const char *path)
{
    Scene scene;
    YamlFile *file = yaml_read(path);
    Model *model = yaml_load(file, scene_table(), &scene) ? model_create(&scene, file) : NULL;
    char *report = yaml_report(file);
    assert_null(model);
    assert_true(yaml_error_count(file) > 0);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return report;
}

static char *mesh_sentence(const char *path)
{
    MeshFile file;
    Error err;
    if (mesh_file_read(path, &file, &err)) {
        Mesh *mesh = mesh_file_check_triangles(&file, &err) ? mesh_create(&file, 0, NULL, &err) : NULL;
        assert_null(mesh);
        mesh_file_clear(&file);
    }
    return mem_text(err.text);
}

static void test_sentences(void **state)
{
    (void)state;
    char line[4096];
    int count = 0;
    FILE *expected = fopen("expected.txt", "r");
    assert_non_null(expected);
    while (fgets(line, sizeof line, expected)) {
        line[strcspn(line, "\n")] = 0;
        char *sentence = strstr(line, " | ");
        assert_non_null(sentence);
        *sentence = 0;
        sentence += 3;
        long blocks = mem_live_count();
        char *said = has_ending(line, ".yaml") ? scene_sentence(line) : mesh_sentence(line);
        strip_folder(said);
        if (!strstr(said, sentence)) fail_msg("%s says\n%swhich lacks\n%s", line, said, sentence);
        mem_free(said);
        if (mem_live_count() != blocks) fail_msg("%s leaks %ld blocks", line, mem_live_count() - blocks);
        count++;
    }
    fclose(expected);
    assert_true(count >= 70);
}

/* A key that is misspelt is not missing, too. */
static void test_misspelt(void **state)
{
    (void)state;
    static const char *const scenes[] = {"misspelt_key.yaml", "misspelt_body.yaml", "misspelt_version.yaml"};
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) {
        Scene scene;
        YamlFile *file = yaml_read(scenes[k]);
        assert_false(yaml_load(file, scene_table(), &scene));
        assert_int_equal(yaml_error_count(file), 1);
        yaml_destroy(file);
    }
}

/* No broken file without its sentence. */
static void test_complete(void **state)
{
    (void)state;
    static const char *const patterns[] = {"*.yaml", "*.obj", "*.ply", "*.msh", "*.stl", "*.off"};
    static char all[65536];
    FILE *expected = fopen("expected.txt", "r");
    assert_non_null(expected);
    all[fread(all, 1, sizeof all - 1, expected)] = 0;
    fclose(expected);
    for (size_t p = 0; p < sizeof patterns / sizeof *patterns; p++) {
        glob_t found;
        assert_int_equal(glob(patterns[p], 0, NULL, &found), 0);
        for (size_t k = 0; k < found.gl_pathc; k++) {
            char line[256];
            snprintf(line, sizeof line, "%s | ", found.gl_pathv[k]);
            if (!strstr(all, line)) fail_msg("%s is not in expected.txt", found.gl_pathv[k]);
        }
        globfree(&found);
    }
}

int main(void)
{
    setenv("PATH", "/nowhere", 1); /* TetGen is not there */
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sentences), cmocka_unit_test(test_misspelt),
                                       cmocka_unit_test(test_complete)};
    if (chdir(SOURCE_DIR "/tests/broken")) return 1;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
