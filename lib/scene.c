/* Scenes, and their jobs. */
#include "base/memory.h"
#include "io/path.h"
#include "job/record.h"
#include "lib/objects.h"
#include "solve/kernels.h"
#include <string.h>

typedef struct Reading {
    const char *path, *text; /* one of them */
    const char *const *settings;
    int count;
    SlenderScene *scene; /* made */
} Reading;

/* The first error, and how many there are; of a program's text with its key, which many sentences begin with. */
static SlenderStatus refuse(const SlenderScene *scene, Error *err)
{
    int count = yaml_error_count(scene->file), shown;
    const YamlError *first = yaml_errors(scene->file, &shown);
    char *key = scene->path ? NULL : yaml_key_at(scene->file, first->line, first->column);
    bool said = key && *key && !strncmp(first->sentence, key, strcspn(key, ".["));
    char *where = scene->path && first->line
                      ? mem_format("%s:%d:%d: ", scene->path, first->line, first->column)
                  : scene->path   ? mem_format("%s: ", scene->path)
                  : said || !*key ? mem_text("")
                                  : mem_format("%s: ", key);
    char *more = count > 1 ? mem_format(" (and %d more)", count - 1) : mem_text("");
    lib_refuse(err, "%s%s%s", where, first->sentence, more);
    mem_free(key);
    mem_free(where);
    mem_free(more);
    return SLENDER_REFUSED;
}

static SlenderStatus read_scene(void *self, Error *err)
{
    Reading *reading = self;
    if (reading->count < 0) return lib_refuse(err, "%d settings; they must be 0 or more", reading->count);
    SlenderScene *scene = mem_alloc(1, sizeof *scene);
    scene->path = mem_text(reading->path);
    scene->file =
        reading->path ? yaml_read(reading->path) : yaml_parse("scene", reading->text, strlen(reading->text));
    for (int k = 0; k < reading->count; k++) yaml_override(scene->file, reading->settings[k]);
    if (yaml_load(scene->file, scene_table(), &scene->scene)) {
        reading->scene = scene;
        return SLENDER_DONE;
    }
    refuse(scene, err);
    slender_scene_destroy(scene);
    return SLENDER_REFUSED;
}

SlenderScene *slender_scene_read(const char *path, const char *const *settings, int count, SlenderError *err)
{
    Reading reading = {.path = path, .settings = settings, .count = count};
    lib_call(read_scene, &reading, err);
    return reading.scene;
}

SlenderScene *slender_scene_parse(const char *text, const char *const *settings, int count, SlenderError *err)
{
    Reading reading = {.text = text, .settings = settings, .count = count};
    lib_call(read_scene, &reading, err);
    return reading.scene;
}

typedef struct Writing {
    const SlenderScene *scene;
    char *text;
} Writing;

static SlenderStatus write_scene(void *self, Error *err)
{
    (void)err;
    Writing *writing = self;
    writing->text = yaml_write(scene_table(), &writing->scene->scene);
    return SLENDER_DONE;
}

char *slender_scene_text(const SlenderScene *scene)
{
    Writing writing = {.scene = scene};
    lib_call(write_scene, &writing, NULL);
    return writing.text;
}

void slender_scene_destroy(SlenderScene *scene)
{
    if (!scene) return;
    yaml_clear(scene_table(), &scene->scene);
    yaml_destroy(scene->file);
    mem_free(scene->path);
    mem_free(scene);
}

/* ---- Models ---- */

enum { THREADS_MAX = 64 };

/* Refusals are added to the file's list: the scene can be used again. */
SlenderStatus lib_build(SlenderScene *scene, int threads, bool general, Model **model, Error *err)
{
    if (threads < 1 || threads > THREADS_MAX)
        return lib_refuse(err, "threads is %d; it must be from 1 to %d", threads, THREADS_MAX);
    if (kernels_reserve(1) < 1) mem_exhausted("OpenBLAS, which works in 128 MB");
    *model =
        general ? model_create_general(&scene->scene, scene->file) : model_create(&scene->scene, scene->file);
    if (*model) return SLENDER_DONE;
    refuse(scene, err);
    yaml_forget_errors(scene->file);
    return SLENDER_REFUSED;
}

/* ---- Jobs ---- */

typedef struct Job {
    SlenderScene *scene;
    const SlenderRun *def;
} Job;

static SlenderStatus do_run(void *self, Error *err)
{
    const Job *job = self;
    const SlenderRun *run = job->def;
    Host host = lib_host(&run->host);
    Model *model = NULL;
    if (run->resume && run->force)
        return lib_refuse(err, "resume goes on with a run and force discards it: one of them can be given");
    SlenderStatus status = lib_build(job->scene, run->threads, false, &model, err);
    if (status != SLENDER_DONE) return status;
    for (int k = 0; k < model->report.warning_count; k++) host_warn(&host, "%s", model->report.warnings[k]);
    char *name = path_without_ending(run->output, ".vtkhdf");
    RecordDef def = {.scene = &job->scene->scene,
                     .model = model,
                     .host = &host,
                     .path = job->scene->path,
                     .name = name,
                     .journal = run->resume  ? JOURNAL_RESUME
                                : run->force ? JOURNAL_FORCE
                                             : JOURNAL_NEW,
                     .in_memory = run->no_journal != 0,
                     .threads = run->threads};
    bool drawable;
    error_set(err, "the job's result says how it ended");
    status = (SlenderStatus)record_run(&def, &drawable, err);
    if (status == SLENDER_INTERRUPTED) error_set(err, "interrupted; resume goes on with it");
    mem_free(name);
    model_destroy(model);
    return status;
}

SlenderStatus slender_run(const SlenderScene *scene, const SlenderRun *def, SlenderError *err)
{
    Job job = {(SlenderScene *)scene, def};
    return lib_call(do_run, &job, err);
}
