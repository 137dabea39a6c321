#include "job/outputs.h"
#include "base/memory.h"
#include "io/canvas.h"
#include "io/mark.h"
#include "io/path.h"
#include "io/replace.h"
#include "io/safe_file.h"
#include "job/probe_table.h"
#include "model/stored.h"
#include <dirent.h>
#include <string.h>
#include <unistd.h>

#define PROBE_TABLE "_probes.csv" /* RESULT_probes.csv */

enum { FILES = 6, OWN = 7, WRITTEN = 3 };

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
    char *base = path_without_ending(result, ".vtkhdf"), *path = mem_format("%s%s", base, ending);
    mem_free(base);
    return path;
}

/* A file that the scene is made of. */
static bool is_source(const Scene *scene, const char *output)
{
    return yaml_find_file(scene_table(), scene, replace_is_same, output) != NULL;
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
    files[1] =
        (OutputFile){"svg", path_of(result, output->svg, scene_body(scene)->ops->write ? ".svg" : NULL)};
    files[2] = (OutputFile){"gcode", path_of(result, output->gcode, NULL)};
    files[3] = (OutputFile){"gcode_servo", path_of(result, output->gcode_servo, NULL)};
    files[4] = (OutputFile){"hpgl", path_of(result, output->hpgl, NULL)};
    files[5] = (OutputFile){"profile", path_of(result, output->plotter, NULL)};
}

static void clear_files(OutputFile files[FILES])
{
    for (int k = 0; k < FILES; k++) mem_free(files[k].path);
}

static bool check_file(const char *path, Error *err)
{
    char *folder = replace_folder(path);
    bool ok = access(folder, W_OK) == 0 ||
              error_set(err, "'%s' cannot be written: its folder is not there, or is read-only", path);
    mem_free(folder);
    return ok;
}

bool outputs_check_source(const Scene *scene, const char *input, const char *output, Error *err)
{
    if (input && replace_is_same(output, input))
        return error_set(err, "'%s' is to be written, but it is read here; give another name", output);
    return !scene || !is_source(scene, output) ||
           error_set(
               err,
               "'%s' is to be written, but the scene is made of it; give another name, by -o or in `output`",
               output);
}

/* Those that a run writes itself. */
typedef struct OwnFiles {
    int count;
    const char *const *names;
} OwnFiles;

static bool is_own(const OwnFiles *own, const char *output)
{
    for (int k = 0; k < own->count; k++)
        if (replace_is_same(own->names[k], output)) return true;
    return false;
}

/* Is it of the name of a drawing's iteration, as job_draw.c writes them: NAME-000020.svg? */
static bool is_iteration(const char *file, const char *base)
{
    const char *dash = strrchr(file, '-');
    size_t digits = dash ? strspn(dash + 1, "0123456789") : 0;
    if (digits < 6 || strcmp(dash + 1 + digits, ".svg") != 0) return false;
    char *iteration = mem_format("%s%s", base, dash);
    bool is = replace_is_same(iteration, file);
    mem_free(iteration);
    return is;
}

/* None of them replaces what the scene is made of, or another output. */
static bool check_iterations(const Scene *scene, const char *path, const char *base, const OutputFile *files,
                             Error *err)
{
    if (!scene_body(scene)->ops->write || scene->output.every == 0) return true;
    const char *lost =
        path && is_iteration(path, base) ? path : yaml_find_file(scene_table(), scene, is_iteration, base);
    for (int k = 0; !lost && k < FILES; k++)
        if (files[k].path && is_iteration(files[k].path, base)) lost = files[k].path;
    return !lost ||
           error_set(
               err,
               "'%s' would be written over by an iteration's drawing (`output.every`); give another name",
               lost);
}

static bool check_once(const OutputFile *files, int file, const OwnFiles *own, Error *err)
{
    bool twice = is_own(own, files[file].path);
    for (int k = 0; k < file; k++)
        twice = twice || (files[k].path && replace_is_same(files[k].path, files[file].path));
    return !twice ||
           error_set(err, "'%s' would be written twice; give another name in `output`", files[file].path);
}

/* The formats of canvas.h, before the work. */
static bool check_picture(const char *path, Error *err)
{
    return canvas_check_path(path, NULL) ||
           error_set(err, "the picture '%s' must be a .png, .svg or .pdf", path);
}

static bool check_files(const OutputFile *files, const OwnFiles *own, const Scene *scene, const char *path,
                        Error *err)
{
    bool ok = true;
    for (int k = 0; ok && k < FILES; k++)
        ok = !files[k].path ||
             (check_file(files[k].path, err) && replace_check(files[k].path, err) &&
              outputs_check_source(scene, path, files[k].path, err) && check_once(files, k, own, err));
    return ok;
}

bool outputs_check(const Scene *scene, const char *path, const char *result, bool picture, Error *err)
{
    static const char *const endings[OWN] = {PROBE_TABLE, ".vtkhdf",  ".xdmf",    ".run",
                                             ".run-wal",  ".run-shm", ".run-lock"};
    OutputFile files[FILES];
    char *names[OWN], *base = path_without_ending(result, ".vtkhdf");
    int first = scene->probes_count ? 0 : 1;
    OwnFiles own = {OWN - first, (const char *const *)names + first};
    bool ok = check_file(result, err);
    for (int k = 0; k < OWN; k++) {
        names[k] = mem_format("%s%s", base, endings[k]);
        ok = ok && (k < first || outputs_check_source(scene, path, names[k], err));
    }
    for (int k = first; ok && k < WRITTEN; k++) { /* the others are the journal's */
        ok = replace_check(names[k], err);
        if (ok) safe_file_sweep(names[k]);
    }
    files_of(scene, result, files);
    if (!picture) mem_free(files[0].path), files[0].path = NULL;
    ok = ok && (!picture || check_picture(files[0].path, err)) &&
         check_files(files, &own, scene, path, err) && check_iterations(scene, path, base, files, err);
    for (int k = 0; ok && k < FILES; k++)
        if (files[k].path) safe_file_sweep(files[k].path);
    clear_files(files);
    for (int k = 0; k < OWN; k++) mem_free(names[k]);
    mem_free(base);
    return ok;
}

bool outputs_check_folders(const Scene *scene, const char *result, Error *err)
{
    OutputFile files[FILES];
    bool ok = true;
    files_of(scene, result, files);
    for (int k = 1; ok && k < FILES; k++) {
        char *folder = files[k].path ? replace_folder(files[k].path) : NULL;
        if (folder && access(folder, W_OK) != 0)
            ok = error_set(err, "the folder '%s', where `output` has files, is not there, or is read-only",
                           folder);
        mem_free(folder);
    }
    clear_files(files);
    return ok;
}

/* ---- Files that are there already ---- */

static bool makes_iterations(const Scene *scene)
{
    return scene_body(scene)->ops->write && scene->output.every > 0;
}

/* Visits the drawings of iterations that stand by that name, until a visit says false. */
static void visit_iterations(const char *base, bool (*visit)(void *self, const char *path), void *self)
{
    char *folder = replace_folder(base);
    const char *before = strchr(base, '/') ? folder : "";
    DIR *files = opendir(folder);
    bool more = files != NULL;
    for (struct dirent *file; more && (file = readdir(files));) {
        char *path = mem_format("%s%s", before, file->d_name);
        more = !is_iteration(path, base) || visit(self, path);
        mem_free(path);
    }
    if (files) closedir(files);
    mem_free(folder);
}

typedef bool CheckFile(const char *path, const char *result, Error *err);

static bool check_new(const char *path, const char *result, Error *err)
{
    return access(path, F_OK) != 0 ||
           error_set(err,
                     "'%s' is there, and no '%s' that it would belong to: give another name, or replace it "
                     "with --force",
                     path, result);
}

static bool check_mark(const char *path, const char *result, Error *err)
{
    (void)result;
    return mark_check(path, false, err);
}

/* --force would discard the run. */
static bool check_mark_resumed(const char *path, const char *result, Error *err)
{
    (void)result;
    return !mark_is_foreign(path) ||
           error_set(err, "'%s' is there, and slender has not made it: move it, then go on with --resume",
                     path);
}

typedef struct Checking {
    CheckFile *check;
    const char *result;
    bool ok;
    Error *err;
} Checking;

static bool check_drawn_file(void *self, const char *path)
{
    Checking *c = self;
    return c->ok = c->check(path, c->result, c->err);
}

/* The files that the scene names, and drawings of iterations. */
static bool check_drawn(const Scene *scene, const char *result, bool picture, CheckFile *check, Error *err)
{
    OutputFile files[FILES];
    Checking checking = {check, result, true, err};
    char *base = path_without_ending(result, ".vtkhdf");
    files_of(scene, result, files);
    for (int k = picture ? 0 : 1; checking.ok && k < FILES; k++)
        if (files[k].path) check_drawn_file(&checking, files[k].path);
    if (checking.ok && makes_iterations(scene)) visit_iterations(base, check_drawn_file, &checking);
    clear_files(files);
    mem_free(base);
    return checking.ok;
}

bool outputs_check_new(const Scene *scene, const char *result, bool picture, Error *err)
{
    char *table = path_of(result, NULL, PROBE_TABLE), *sidecar = path_of(result, NULL, ".xdmf");
    bool ok = (!scene->probes_count || check_new(table, result, err)) && check_new(sidecar, result, err) &&
              check_drawn(scene, result, picture, check_new, err);
    mem_free(table);
    mem_free(sidecar);
    return ok;
}

bool outputs_check_marks(const Scene *scene, const char *result, bool picture, bool resumed, Error *err)
{
    return check_drawn(scene, result, picture, resumed ? check_mark_resumed : check_mark, err);
}

/* ---- Files of an earlier run ---- */

/* Takes the path. */
static void remove_old(const Scene *scene, char *path)
{
    if (!is_source(scene, path)) unlink(path);
    mem_free(path);
}

static bool remove_iteration(void *scene, const char *path)
{
    remove_old(scene, mem_text(path));
    return true;
}

static void remove_all_old(const Scene *scene, const Scene *old, const char *result)
{
    char *base = path_without_ending(result, ".vtkhdf");
    if (old->probes_count) remove_old(scene, path_of(result, NULL, PROBE_TABLE));
    if (scene_body(old)->ops->write && !old->output.svg) remove_old(scene, path_of(result, NULL, ".svg"));
    if (makes_iterations(old)) visit_iterations(base, remove_iteration, (void *)scene);
    mem_free(base);
}

void outputs_remove_old(const Scene *scene, const char *result)
{
    Scene old;
    YamlFile *file;
    Result *before = access(result, F_OK) == 0 ? result_open(result, NULL) : NULL;
    if (!before) return;
    bool known = stored_result_scene(before, &file, &old);
    result_close(before);
    if (known) remove_all_old(scene, &old, result);
    yaml_clear(scene_table(), &old);
    yaml_destroy(file);
}

/* ---- Writing ---- */

static bool write_drawing(Run *run, Result *result, Error *err)
{
    const BodyOps *ops = run->model->body->ops;
    OutputFile files[FILES];
    bool written, ok = true;
    files_of(run->scene, run->result, files);
    for (int k = 1; ok && k < FILES; k++) {
        if (!files[k].path) continue;
        ok = ops->write(result, files[k].language, files[k].path, &written, err);
        if (ok && written) host_say(run->host, "%s: %s", files[k].language, files[k].path);
    }
    clear_files(files);
    return ok;
}

static bool write_probes(Run *run, Result *result, Error *err)
{
    char *path = path_of(run->result, NULL, PROBE_TABLE);
    bool ok = probe_table_write(run->model, result, path, err);
    if (ok) host_say(run->host, "probes: %s", path);
    mem_free(path);
    return ok;
}

bool outputs_write(Run *run, Error *err)
{
    bool drawing = run->model->body->ops->write != NULL, probes = run->model->probe_count > 0;
    if (!drawing && !probes) return true;
    Result *result = result_open(run->result, err);
    bool ok = result != NULL;
    if (ok && probes) ok = write_probes(run, result, err);
    if (ok && drawing) ok = write_drawing(run, result, err);
    result_close(result);
    return ok;
}
