/* page_fixture.h - runs of scenes, and their pictures read back. */
#pragma once
#include "base/memory.h"
#include "png_fixture.h"
#include "slender.h"
#include "view/show.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <unistd.h>
#include <cmocka.h>

typedef struct Page {
    int width, height;
    unsigned char *rgb; /* owned */
} Page;

/* Leaves NAME.vtkhdf. */
static inline void page_run(const char *name, const char *text)
{
    SlenderError err;
    SlenderScene *scene = slender_scene_parse(text, NULL, 0, &err);
    if (!scene) fail_msg("%s", err.text);
    SlenderRun def = {.output = name, .threads = 1, .force = 1};
    if (slender_run(scene, &def, &err) == SLENDER_REFUSED) fail_msg("%s", err.text);
    slender_scene_destroy(scene);
}

/* Of NAME.vtkhdf, in NAME.png. */
static inline ShowStatus page_show(const char *name, const ShowDef *def, Error *err)
{
    char result[64], picture[64];
    snprintf(result, sizeof result, "%s.vtkhdf", name);
    snprintf(picture, sizeof picture, "%s.png", name);
    return show_result(result, picture, def, err);
}

static inline Page page_draw(const char *name, const ShowDef *def)
{
    Page page;
    char picture[64];
    Error err = {""};
    snprintf(picture, sizeof picture, "%s.png", name);
    if (page_show(name, def, &err) != SHOW_DONE ||
        !png_read(picture, &page.rgb, &page.width, &page.height, &err))
        fail_msg("%s", err.text);
    return page;
}

/* A file's text, which mem_free frees; NULL where there is none. */
static inline char *page_text(const char *path)
{
    FILE *file = fopen(path, "r");
    if (!file) return NULL;
    fseek(file, 0, SEEK_END);
    size_t size = (size_t)ftell(file);
    rewind(file);
    char *text = mem_alloc(size + 1, 1);
    assert_int_equal(fread(text, 1, size, file), size);
    fclose(file);
    return text;
}

static inline void page_remove_files(const char *name)
{
    static const char *const endings[] = {"vtkhdf", "run", "run-lock", "xdmf", "png"};
    for (int k = 0; k < 5; k++) {
        char path[64];
        snprintf(path, sizeof path, "%s.%s", name, endings[k]);
        unlink(path);
    }
}
