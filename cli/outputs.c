#include "cli/outputs.h"
#include "base/memory.h"
#include "cli/drawn.h"
#include "cli/verb.h"
#include <string.h>
#include <unistd.h>

enum { FILES = 5 };

typedef struct OutputFile {
    const char *language; /* of drawn_write; NULL: the picture */
    char *path;           /* owned; NULL: not asked for        */
} OutputFile;

/* The result's name with another ending, or a name of the scene's in its folder. */
static char *path_of(const char *result, const char *name, const char *ending)
{
    const char *slash = strrchr(result, '/');
    if (name && (name[0] == '/' || !slash)) return mem_text(name);
    if (name) return mem_format("%.*s%s", (int)(slash + 1 - result), result, name);
    if (!ending) return NULL;
    char *base = verb_without_ending(result, ".vtkhdf"), *path = mem_format("%s%s", base, ending);
    mem_free(base);
    return path;
}

static void files_of(const Scene *scene, const char *result, OutputFile files[FILES])
{
    const OutputScene *output = &scene->output;
    files[0] = (OutputFile){NULL, path_of(result, output->png, ".png")};
    files[1] = (OutputFile){"svg", path_of(result, output->svg, scene->spline ? ".svg" : NULL)};
    files[2] = (OutputFile){"gcode", path_of(result, output->gcode, NULL)};
    files[3] = (OutputFile){"gcode_servo", path_of(result, output->gcode_servo, NULL)};
    files[4] = (OutputFile){"hpgl", path_of(result, output->hpgl, NULL)};
}

static void clear_files(OutputFile files[FILES])
{
    for (int k = 0; k < FILES; k++) mem_free(files[k].path);
}

static bool check_file(const char *path, Error *err)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? mem_format("%.*s/", (int)(slash - path), path) : mem_text(".");
    bool ok = access(folder, W_OK) == 0 ||
              error_set(err, "'%s' cannot be written: its folder is not there, or is read-only", path);
    mem_free(folder);
    return ok;
}

bool outputs_check(const Scene *scene, const char *result, Error *err)
{
    OutputFile files[FILES];
    bool ok = true;
    files_of(scene, result, files);
    for (int k = 0; ok && k < FILES; k++) ok = !files[k].path || check_file(files[k].path, err);
    clear_files(files);
    return ok;
}

char *outputs_picture(const Scene *scene, const char *result)
{
    return path_of(result, scene->output.png, ".png");
}

bool outputs_write(Run *run, Error *err)
{
    if (!run->scene->spline) return true;
    OutputFile files[FILES];
    Drawn drawn = {0};
    Result *result = result_open(run->result, err);
    bool ok = result && (!drawn_has(result) || drawn_read(result, &drawn, err));
    files_of(run->scene, run->result, files);
    for (int k = 1; ok && k < FILES && drawn.pens; k++) {
        if (!files[k].path) continue;
        ok = drawn_write(&drawn, files[k].language, files[k].path, err);
        if (ok) progress_say(run->progress, "%s: %s", files[k].language, files[k].path);
    }
    clear_files(files);
    drawn_clear(&drawn);
    result_close(result);
    return ok;
}
