#include "job/record.h"
#include "base/memory.h"
#include "io/result.h"
#include "job/inputs.h"
#include "job/outputs.h"
#include "job/recall.h"
#include <string.h>

/* ---- The journal's beginning ---- */

/* "a, b and c", or "nothing". */
static char *list_of(const char *const *keys)
{
    char *list = mem_text(keys[0] ? keys[0] : "nothing");
    for (int k = 1; keys[0] && keys[k]; k++) list = mem_join(list, keys[k + 1] ? ", " : " and ", keys[k]);
    return list;
}

/* The free keys, and those of files, which are told by their contents; one block. */
static const char **ignored_keys(const char *const *free, char *const *files)
{
    size_t free_count = 0, count = 0;
    while (free[free_count]) free_count++;
    while (files[count]) count++;
    const char **keys = mem_alloc(free_count + count + 1, sizeof *keys);
    memcpy(keys, free, free_count * sizeof *keys);
    memcpy(keys + free_count, files, count * sizeof *keys);
    return keys;
}

/* `files`: keys whose paths need not be the same. */
static bool check_scene(Run *run, const char *scene, char *const *files, Error *err)
{
    const char *const *free = run->model->job->free_keys;
    Array old;
    if (!journal_get(run->journal, "meta", 0, "scene", &old, err)) return false;
    const char **keys = ignored_keys(free, files);
    char *difference = yaml_difference(old.data, scene, keys);
    array_clear(&old);
    mem_free(keys);
    if (!difference) return true;
    char *list = list_of(free);
    error_set(err,
              "the scene has changed since that run: %s is not the same; with --resume only %s may change",
              difference, list);
    mem_free(list);
    mem_free(difference);
    return false;
}

/* Is this the run that the journal holds: the same scene, made of the same files? */
static bool check_resumed(Run *run, const char *scene, const char *inputs, Error *err)
{
    static char *const none[] = {NULL};
    Array old;
    if (!journal_find(run->journal, "meta", 0, "inputs", &old, err)) return false;
    if (!old.data) { /* an older journal: files are told by their names */
        if (*inputs)
            host_say(run->host, "whether the files of the scene have changed since that run is not known");
        return check_scene(run, scene, none, err);
    }
    char **keys = inputs_keys(run->scene);
    bool ok = check_scene(run, scene, keys, err) && inputs_check(run->scene, old.data, inputs, err);
    mem_free(keys);
    array_clear(&old);
    return ok;
}

/* What is known from the start, in the place of what an earlier part of the run has put there; its end is
 * none now. */
static bool put_start(Run *run, const char *scene, const char *inputs, Error *err)
{
    Arrays statics = {0};
    char *kernels = run_kernels(run, err), *versions = kernels ? run_versions() : NULL;
    if (!kernels) return false;
    Array meta[] = {array_text("scene", scene), array_text("versions", versions),
                    array_text("kernels", kernels), array_text("inputs", inputs)};
    run->model->body->ops->add_static(run->model, &statics);
    bool ok = journal_replace(run->journal, "meta", 0, meta, *inputs ? 4 : 3, err) &&
              journal_replace(run->journal, "final", 0, NULL, 0, err);
    ok = arrays_replace(&statics, run->journal, "static", ok ? err : NULL) && ok;
    mem_free(versions);
    mem_free(kernels);
    return ok && journal_set_finished(run->journal, false, err);
}

/* A run that goes on must be the one that the journal holds, with its frames; a new one only has to be put.
 */
static RunStatus begin(Run *run, bool resume, Error *err)
{
    char *inputs = inputs_text(run->scene, err);
    if (!inputs) return RUN_REFUSED;
    char *scene = yaml_write(scene_table(), run->scene);
    bool exact = run->scene->output.precision == OUTPUT_DOUBLE,
         extended = resume && journal_is_finished(run->journal) && run->model->job->frames == FRAMES_MOVE;
    RunStatus status = RUN_DONE;
    if ((resume && !check_resumed(run, scene, inputs, err)) ||
        (extended && !recall_frames(run->journal, run->result, exact, err)))
        status = RUN_REFUSED;
    else if (!put_start(run, scene, inputs, err))
        status = RUN_CANNOT_WRITE;
    mem_free(scene);
    mem_free(inputs);
    return status;
}

/* ---- The result ---- */

static bool write_result(Run *run, bool finished, Error *err)
{
    ResultDef def = {.double_frames = run->scene->output.precision == OUTPUT_DOUBLE};
    uint32_t sum;
    if (!journal_flush(run->journal, err) || !result_write(run->journal, run->result, def, &sum, err))
        return false;
    if (!finished) return true;
    if (!recall_keep(run->journal, sum, err) || !journal_set_finished(run->journal, true, err)) return false;
    if (run->model->job->frames != FRAMES_STAY) journal_forget(run->journal, "frame", NULL);
    return true;
}

/* ---- The whole ---- */

RunStatus record_run(Run *run, bool resume, Error *err)
{
    RunStatus status = begin(run, resume, err);
    if (status == RUN_DONE) status = job_run(run, err);
    if (status == RUN_CANNOT_WRITE || status == RUN_REFUSED) return status;
    if (!write_result(run, status != RUN_INTERRUPTED, err)) return RUN_CANNOT_WRITE;
    host_say(run->host, "result: %s", run->result);
    return outputs_write(run, err) ? status : RUN_CANNOT_WRITE;
}
