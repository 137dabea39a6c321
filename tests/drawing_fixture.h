/* drawing_fixture.h - drawings as scenes say them. */
#pragma once
#include "spline/front/drawing.h"
#include "tests/leaks.h"
#include <stdio.h>
#include <string.h>

/* The drawing of a scene's spline entry in flow style; the refused sentence in place of it fails. */
static inline Drawing *drawing_of(const char *entry)
{
    char text[1000];
    Scene scene;
    snprintf(text, sizeof text, "slender: 1\njob: draw\nspline: {%s}\n", entry);
    YamlFile *file = yaml_parse("test_drawing.yaml", text, strlen(text));
    Drawing *drawing =
        yaml_load(file, scene_table(), &scene) ? drawing_create(spline_scene(&scene), file) : NULL;
    if (!drawing) fail_msg("%s", yaml_report(file));
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return drawing;
}

static inline void write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_true(file && fputs(text, file) >= 0 && fclose(file) == 0);
}
