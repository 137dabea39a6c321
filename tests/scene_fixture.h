/* scene_fixture.h - a model of a scene's text, for tests. */
#pragma once
#include "base/memory.h"
#include "model/model.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

typedef struct Built {
    YamlFile *file;
    Scene scene;
    Model *model; /* NULL: refused, and the file says why */
} Built;

static inline Built scene_try(const char *text)
{
    Built b;
    b.file = yaml_parse("test.yaml", text, strlen(text));
    b.model = yaml_load(b.file, scene_table(), &b.scene) ? model_create(&b.scene, b.file) : NULL;
    return b;
}

/* A refusal fails the test. Takes the text. */
static inline Built scene_build(char *text)
{
    Built b = scene_try(text);
    if (!b.model) fail_msg("%s", yaml_report(b.file));
    mem_free(text);
    return b;
}

static inline void clear(Built *b)
{
    model_destroy(b->model);
    yaml_clear(scene_table(), &b->scene);
    yaml_destroy(b->file);
}
