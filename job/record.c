#include "job/record.h"
#include "base/memory.h"
#include "io/result_groups.h"
#include "io/result.h"
#include "job/inputs.h"
#include "job/obstacles.h"
#include "job/sources.h"
#include "job/outputs.h"
#include "job/recall.h"
#include "model/stored.h"
#include "model/world_report.h"
#include "solve/kernels.h"
#include "solve/ranks.h"
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* The scene that the journal has, with defaults for keys that have come since: a run of an older slender goes on. */
static char *scene_of_journal(const Array *text)
{
    Scene scene;
    YamlFile *file;
    bool known = stored_scene(text, &file, &scene);
    char *effective = known ? yaml_write(scene_table(), &scene) : mem_text(text->data);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return effective;
}

/* Which key of the scene is not as it was there, but for some keys; NULL: none. The caller frees. */
static char *difference(const Array *text, const char *scene, const char *const *keys)
{
    char *before = scene_of_journal(text), *key = yaml_difference(before, scene, keys);
    mem_free(before);
    return key;
}

/* `files`: keys whose paths need not be the same. */
static bool check_scene(Run *run, const char *scene, char *const *files, Error *err)
{
    const char *const *free = run->model->job->free_keys;
    Array old;
    if (!journal_get(run->journal, "meta", 0, "scene", &old, err)) return false;
    const char **keys = ignored_keys(free, files);
    char *changed = difference(&old, scene, keys);
    array_clear(&old);
    mem_free(keys);
    if (!changed) return true;
    char *list = list_of(free);
    error_set(err,
              "the scene has changed since that run: %s is not the same; with --resume only %s may change",
              changed, list);
    mem_free(list);
    mem_free(changed);
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

/* ---- The result of an earlier run ---- */

/* That a finished run left: what an unfinished one did, its journal keeps. */
static bool is_finished(Result *result)
{
    Array status;
    if (!result_read(result, "slender/status", &status, NULL)) return false;
    bool unfinished = !strcmp(status.data, "unfinished") || !strcmp(status.data, "interrupted");
    array_clear(&status);
    return !unfinished;
}

/* `files`: keys whose paths need not be the same. */
static bool is_of_scene(const Scene *of, const Array *text, const char *scene, char *const *files, Error *err)
{
    static const char *const none[] = {NULL};
    const char **keys = ignored_keys(none, files), **free = ignored_keys(scene_job(of)->free_keys, files);
    char *changed = difference(text, scene, keys), *fixed = difference(text, scene, free);
    if (changed)
        error_set(
            err,
            "it is the result of another scene: %s is not the same; give another name with -o, replace it "
            "with --force%s",
            changed, fixed ? "" : ", or go on with it with --resume");
    bool same = !changed;
    mem_free(changed);
    mem_free(fixed);
    mem_free(keys);
    mem_free(free);
    return same;
}

/* Of the same scene, made of the same files? An older result does not tell files by what was in them. */
static bool is_same_run(const Scene *of, Result *result, const char *scene, const char *inputs, Error *err)
{
    static char *const none[] = {NULL};
    Array text, before = {0};
    if (!result_read(result, "slender/scene", &text, err)) return false;
    bool told = result_has(result, "slender/inputs");
    char **keys = told ? inputs_keys(of) : NULL;
    bool ok = (!told || result_read(result, "slender/inputs", &before, err)) &&
              is_of_scene(of, &text, scene, keys ? keys : none, err) &&
              (!told || inputs_check(of, before.data, inputs, err));
    array_clear(&text);
    array_clear(&before);
    mem_free(keys);
    return ok;
}

/* NULL and a sentence, with what helps. */
static Result *open_earlier(const char *path, Error *err)
{
    Error why;
    Result *result = result_open(path, &why);
    if (!result) error_set(err, "%.900s; with --force it is replaced", why.text);
    return result;
}

/* A finished result is replaced by one of the same scene, of the same files, only. */
static bool check_result(const Run *run, Error *err)
{
    Result *result = open_earlier(run->result, err);
    if (!result) return false;
    char *scene = yaml_write(scene_table(), run->scene), *inputs = inputs_text(run->scene, err);
    bool ok = inputs != NULL;
    if (ok && is_finished(result))
        ok = is_same_run(run->scene, result, scene, inputs, err) || error_prefix(err, "%s", run->result);
    mem_free(scene);
    mem_free(inputs);
    result_close(result);
    return ok;
}

/* NULL where there is none, or a finished one. */
static Journal *open_unfinished(const char *path)
{
    Journal *journal = access(path, F_OK) == 0 ? journal_open(path, JOURNAL_READ, NULL) : NULL;
    if (!journal || !journal_is_finished(journal)) return journal;
    journal_close(journal, NULL);
    return NULL;
}

/* Files beside a result go together with it, but none that is not slender's. An unfinished run is left to journal_open, which
 * says what helps. */
static bool check_earlier(const Run *run, const char *path, bool picture, Error *err)
{
    bool there = access(run->result, F_OK) == 0;
    if (there && !check_result(run, err)) return false;
    Journal *unfinished = open_unfinished(path);
    journal_close(unfinished, NULL);
    if (unfinished) return true;
    return outputs_check_marks(run->scene, run->result, picture, false, err) &&
           (there || access(path, F_OK) == 0 || outputs_check_new(run->scene, run->result, picture, err));
}

static bool check_before(const Run *run, JournalMode mode, const char *journal, bool picture, Error *err)
{
    if (mode == JOURNAL_NEW) return check_earlier(run, journal, picture, err);
    return mode == JOURNAL_FORCE || outputs_check_marks(run->scene, run->result, picture, true, err);
}

/* ---- What there is of a run ---- */

/* How long runs are; what a resumed run has done is not undone, so that they can only be raised. */
static const char *const LENGTHS[] = {"design.iterations", "time.steps", "spline.rounds", NULL};

static bool has_key(const char *const *keys, const char *key)
{
    while (*keys && strcmp(*keys, key) != 0) keys++;
    return *keys != NULL;
}

/* Is a run of that scene (text) this one but for a length that a resumed run may raise, and that is raised now? */
static bool is_shorter(const Array *text, const Scene *of, const char *scene, char *const *files)
{
    const char *lengths[sizeof LENGTHS / sizeof *LENGTHS] = {NULL};
    double had, wanted;
    int count = 0;
    bool raised = true;
    char *before = scene_of_journal(text);
    for (int k = 0; LENGTHS[k]; k++) {
        if (!has_key(scene_job(of)->free_keys, LENGTHS[k])) continue;
        lengths[count++] = LENGTHS[k];
        raised = raised && (!yaml_number_at(before, LENGTHS[k], &had) ||
                            (yaml_number_at(scene, LENGTHS[k], &wanted) && wanted >= had));
    }
    const char **keys = ignored_keys(lengths, files);
    char *changed = yaml_difference(before, scene, keys);
    bool shorter = raised && !changed;
    mem_free(keys);
    mem_free(changed);
    mem_free(before);
    return shorter;
}

/* Of an unfinished one, which nobody could go on with where nothing was put. */
static RecordState journal_state(Journal *journal, const Scene *of, const char *scene, Error *err)
{
    static const char *const none[] = {NULL};
    Array text;
    if (!journal_find(journal, "meta", 0, "scene", &text, err)) return RECORD_OTHER;
    if (!text.data) return RECORD_ABSENT;
    char **files = inputs_keys(of), *changed;
    const char **keys = ignored_keys(none, files);
    changed = difference(&text, scene, keys);
    if (changed) error_set(err, "it is an unfinished run of another scene: %s is not the same", changed);
    RecordState state = !changed                              ? RECORD_UNFINISHED
                        : is_shorter(&text, of, scene, files) ? RECORD_SHORT
                                                              : RECORD_OTHER;
    mem_free(changed);
    mem_free(keys);
    mem_free(files);
    array_clear(&text);
    return state;
}

/* Whether its files are the same is asked when it goes on. */
static RecordState other_state(Result *result, const Scene *of, const char *scene)
{
    Array text;
    if (!result_read(result, "slender/scene", &text, NULL)) return RECORD_OTHER;
    char **files = inputs_keys(of);
    bool shorter = is_shorter(&text, of, scene, files);
    mem_free(files);
    array_clear(&text);
    return shorter ? RECORD_SHORT : RECORD_OTHER;
}

static RecordState result_state(Result *result, const Scene *of, const char *scene, Error *err)
{
    if (!is_finished(result)) return RECORD_ABSENT;
    char *inputs = inputs_text(of, err);
    RecordState state = !inputs                                       ? RECORD_OTHER
                        : is_same_run(of, result, scene, inputs, err) ? RECORD_FINISHED
                                                                      : other_state(result, of, scene);
    mem_free(inputs);
    return state;
}

RecordState record_state(const Scene *of, const char *name, Error *err)
{
    char *path = mem_format("%s.run", name), *file = mem_format("%s.vtkhdf", name),
         *scene = yaml_write(scene_table(), of);
    RecordState state = RECORD_ABSENT;
    Journal *journal = open_unfinished(path);
    bool unfinished = journal != NULL;
    if (unfinished) state = journal_state(journal, of, scene, err);
    journal_close(journal, NULL);
    if (!unfinished && access(file, F_OK) == 0) {
        Result *result = open_earlier(file, err);
        state = result ? result_state(result, of, scene, err) : RECORD_DAMAGED;
        result_close(result);
    }
    if (state == RECORD_OTHER) error_prefix(err, "%s", unfinished ? path : file);
    mem_free(path);
    mem_free(file);
    mem_free(scene);
    return state;
}

/* ---- The beginning ---- */

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
    sources_add(run->model, &statics);
    if (run->model->mesh)
        result_groups_add(&statics, run->model->mesh->groups, run->model->mesh->group_count);
    bool ok = journal_replace(run->journal, "meta", 0, meta, *inputs ? 4 : 3, err) &&
              journal_replace(run->journal, "final", 0, NULL, 0, err);
    ok = arrays_replace(&statics, run->journal, "static", ok ? err : NULL) && ok;
    ok = ok && obstacles_put(run, err);
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
    if (!obstacles_put(run, err) || !journal_flush(run->journal, err) ||
        !result_write(run->journal, run->result, def, &sum, err))
        return false;
    if (!finished) return true;
    if (!recall_keep(run->journal, sum, err) || !journal_set_finished(run->journal, true, err)) return false;
    if (run->model->job->frames != FRAMES_STAY) journal_forget(run->journal, "frame", NULL);
    return true;
}

/* ---- The whole ---- */

static bool is_folder(const char *path)
{
    struct stat info;
    size_t length = strlen(path);
    return length == 0 || path[length - 1] == '/' || (stat(path, &info) == 0 && S_ISDIR(info.st_mode));
}

/* A folder where a file is to be written is refused before hours of work, not after. */
static bool check_output(const char *name, const char *result, const char *journal, Error *err)
{
    if (is_folder(name))
        return error_set(err, "the output '%s' is a folder; give the name of a result in it", name);
    if (is_folder(result)) return error_set(err, "the result '%s' is a folder; give another name", result);
    if (is_folder(journal)) return error_set(err, "the journal '%s' is a folder; give another name", journal);
    return true;
}

static void warn_sidecar(const Run *run)
{
    if (result_has_sidecar(run->result)) return;
    host_warn(
        run->host,
        "'%s': no .xdmf (for ParaView 5.11) is written beside it, since XDMF cannot name this file: a name "
        "without : and |, control characters, and blanks at its ends can be",
        run->result);
}

/* What the body is to meet, a line each. */
static void say_world(const Run *run)
{
    char *text = world_describe(run->model, run->scene), *rest = NULL;
    if (!text) return;
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
        host_say(run->host, "%s", line);
    mem_free(text);
}

/* What spread factors took of the processes' memory; the first one has all else, too. */
static void say_processes(const Run *run)
{
    const double MB = 1e6;
    SparseInfo most = {0};
    if (!direct_is_spread(run->model->direct)) return;
    for (int c = 0; c < run->model->case_count; c++) {
        SparseInfo info = system_info(run->model->cases[c].sys);
        if (info.all_bytes >= most.all_bytes) most = info;
    }
    host_say(run->host, "factors over %d process%s: %.0f MB in all, at most %.0f MB in one", ranks_count(),
             ranks_count() > 1 ? "es" : "", (double)most.all_bytes / MB, (double)most.process_bytes / MB);
}

static RunStatus run_job(Run *run, bool resume, Error *err)
{
    RunStatus status = begin(run, resume, err);
    if (status == RUN_DONE) status = job_run(run, err);
    if (status == RUN_CANNOT_WRITE || status == RUN_REFUSED) return status;
    say_processes(run);
    if (!write_result(run, status != RUN_INTERRUPTED, err)) return RUN_CANNOT_WRITE;
    host_say(run->host, "result: %s", run->result);
    return outputs_write(run, err) ? status : RUN_CANNOT_WRITE;
}

static RunStatus open_and_run(const RecordDef *def, Run *run, Error *err)
{
    char *journal = mem_format("%s.run", def->name);
    RunStatus status = RUN_CANNOT_WRITE;
    if (check_output(def->name, run->result, journal, err) &&
        outputs_check(def->scene, def->path, run->result, def->picture, err) &&
        check_before(run, def->journal, journal, def->picture, err))
        run->journal = journal_open(def->in_memory ? NULL : journal, def->journal, err);
    if (run->journal) {
        if (def->journal == JOURNAL_FORCE) outputs_remove_old(def->scene, run->result);
        warn_sidecar(run);
        say_world(run);
        run_share_threads(run, 1);
        status = run_job(run, def->journal == JOURNAL_RESUME, err);
        run_release_threads(run);
        Error last;
        if (!journal_close(run->journal, status == RUN_CANNOT_WRITE ? &last : err)) status = RUN_CANNOT_WRITE;
    }
    mem_free(journal);
    return status;
}

RunStatus record_run(const RecordDef *def, bool *drawable, Error *err)
{
    char *result = mem_format("%s.vtkhdf", def->name);
    Run run = {.scene = def->scene,
               .model = def->model,
               .host = def->host,
               .result = result,
               .threads = kernels_reserve(def->threads)}; /* the same numbers come out */
    RunStatus status = open_and_run(def, &run, err);
    *drawable = !run.unsolved;
    mem_free(result);
    return status;
}
