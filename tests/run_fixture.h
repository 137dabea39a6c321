/* run_fixture.h - whole runs of scenes by the library, for tests, which define NAME, the output, before. */
#pragma once
#include "io/result.h"
#include "slender.h"
#include "tests/scene_fixture.h"
#include <unistd.h>

/* The scene is destroyed; it may end as badly as that. */
static inline Result *run_to(SlenderScene *scene, const SlenderError *err, bool resume, SlenderStatus worst)
{
    SlenderError trouble;
    Error unread;
    if (!scene) fail_msg("%s", err->text);
    SlenderRun def = {.output = NAME, .threads = 1, .resume = resume, .force = !resume};
    SlenderStatus status = slender_run(scene, &def, &trouble);
    if (status > worst) fail_msg("status %d: %s", (int)status, trouble.text);
    slender_scene_destroy(scene);
    Result *result = result_open(NAME ".vtkhdf", &unread);
    if (!result) fail_msg("%s", unread.text);
    return result;
}

static inline Result *run(SlenderScene *scene, const SlenderError *err, bool resume)
{
    return run_to(scene, err, resume, SLENDER_DONE);
}

static inline Result *run_text(char *text)
{
    SlenderError err;
    Result *result = run(slender_scene_parse(text, NULL, 0, &err), &err, false);
    mem_free(text);
    return result;
}

static inline Result *run_file(const char *path, const char *const *settings, int count, bool resume)
{
    SlenderError err;
    return run(slender_scene_read(path, settings, count, &err), &err, resume);
}

static inline Array read_all(Result *result, const char *path)
{
    Array array;
    Error err;
    if (!result_read(result, path, &array, &err)) fail_msg("%s: %s", path, err.text);
    return array;
}

/* What a run leaves under a name, and what a test may have put beside it. */
static inline void remove_files(const char *name)
{
    static const char *const endings[] = {".vtkhdf", ".xdmf", ".run", ".run-lock", "_probes.csv",
                                          ".csv",    ".h5",   ".obj", ".html"};
    for (size_t k = 0; k < sizeof endings / sizeof *endings; k++) {
        char *path = mem_format("%s%s", name, endings[k]);
        unlink(path);
        mem_free(path);
    }
}

/* The same of NAME, for the group's setup and teardown. */
static inline int remove_run(void **state)
{
    (void)state;
    remove_files(NAME);
    return 0;
}
