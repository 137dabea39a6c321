#include "cli/outputs.h"
#include "base/memory.h"
#include "cli/drawn.h"
#include "cli/verb.h"
#include "io/replace.h"
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
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

static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? mem_format("%.*s/", (int)(slash - path), path) : mem_text(".");
}

static bool is_one_place(const char *a, const char *b)
{
    struct stat x, y;
    return stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

/* One file, or one name in one folder. */
static bool is_same(const char *a, const char *b)
{
    const char *slash_a = strrchr(a, '/'), *slash_b = strrchr(b, '/');
    if (is_one_place(a, b)) return true;
    if (strcmp(slash_a ? slash_a + 1 : a, slash_b ? slash_b + 1 : b)) return false;
    char *folder_a = folder_of(a), *folder_b = folder_of(b);
    bool same = is_one_place(folder_a, folder_b);
    mem_free(folder_a);
    mem_free(folder_b);
    return same;
}

static bool is_map(const TargetScene *target, const char *output)
{
    return target && target->height_map && is_same(output, target->height_map);
}

/* A picture that the scene is made of. */
static bool is_source(const Scene *scene, const char *output)
{
    const SplineScene *spline = scene->spline;
    const char *const read[] = {spline ? spline->image : NULL, spline ? spline->direction.file : NULL};
    bool source = is_map(scene->target, output);
    for (int k = 0; k < scene->cases_count; k++) source = source || is_map(scene->cases[k].target, output);
    for (int k = 0; k < 2; k++) source = source || (read[k] && is_same(output, read[k]));
    return source;
}

/* face.yaml may be made of face.png: the picture of the result then goes beside it. */
char *outputs_picture(const Scene *scene, const char *result)
{
    char *path = path_of(result, scene->output.png, ".png");
    if (scene->output.png || !is_source(scene, path)) return path;
    mem_free(path);
    return path_of(result, NULL, "-picture.png");
}

static void files_of(const Scene *scene, const char *result, OutputFile files[FILES])
{
    const OutputScene *output = &scene->output;
    files[0] = (OutputFile){NULL, outputs_picture(scene, result)};
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
    char *folder = folder_of(path);
    bool ok = access(folder, W_OK) == 0 ||
              error_set(err, "'%s' cannot be written: its folder is not there, or is read-only", path);
    mem_free(folder);
    return ok;
}

static bool check_source(const Scene *scene, const char *path, const char *output, Error *err)
{
    if (!is_same(output, path) && !is_source(scene, output)) return true;
    return error_set(err,
                     "'%s' is to be written, but the scene is made of it; give another name by -o or in "
                     "`output`",
                     output);
}

/* What a run writes itself. */
static bool is_own(const char *result, const char *output)
{
    static const char *const endings[] = {".vtkhdf", ".xdmf", ".run", ".run-lock"};
    char *base = verb_without_ending(result, ".vtkhdf");
    bool own = false;
    for (int k = 0; k < 4; k++) {
        char *file = mem_format("%s%s", base, endings[k]);
        own = own || is_same(output, file);
        mem_free(file);
    }
    mem_free(base);
    return own;
}

static bool check_once(const OutputFile *files, int file, const char *result, Error *err)
{
    bool twice = is_own(result, files[file].path);
    for (int k = 0; k < file; k++)
        twice = twice || (files[k].path && is_same(files[k].path, files[file].path));
    return !twice ||
           error_set(err, "'%s' would be written twice; give another name in `output`", files[file].path);
}

/* The formats of canvas.h, before the work. */
static bool check_picture(const char *path, Error *err)
{
    static const char *const endings[] = {".png", ".svg", ".pdf"};
    const char *dot = strrchr(path, '.');
    for (int k = 0; k < 3; k++)
        if (dot && !strcasecmp(dot, endings[k])) return true;
    return error_set(err, "the picture '%s' must be a .png, .svg or .pdf", path);
}

bool outputs_check(const Scene *scene, const char *path, const char *result, bool picture, Error *err)
{
    OutputFile files[FILES];
    files_of(scene, result, files);
    if (!picture) mem_free(files[0].path), files[0].path = NULL;
    bool ok = !picture || check_picture(files[0].path, err);
    for (int k = 0; ok && k < FILES; k++)
        ok = !files[k].path ||
             (check_file(files[k].path, err) && replace_check(files[k].path, err) &&
              check_source(scene, path, files[k].path, err) && check_once(files, k, result, err));
    clear_files(files);
    return ok;
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
