/* slender run: scene -> journal -> result and picture. */
#include "base/memory.h"
#include "cli/job.h"
#include "cli/outputs.h"
#include "cli/recall.h"
#include "cli/show.h"
#include "cli/verb.h"
#include "io/result.h"
#include <getopt.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SET_MAX = 64, THREADS_MAX = 64 };

typedef struct RunOptions {
    const char *scene, *output;
    char *set[SET_MAX]; /* owned */
    int set_count, threads;
    bool resume, force, no_picture;
    ProgressMode mode;
} RunOptions;

static const char usage[] =
    "run SCENE [-o NAME] [--set key=value].. [--page SIZE] [--margin LENGTH] [--resume | --force] "
    "[--threads N]\n"
    "          [--quiet | --log=json] [--no-picture]\n"
    "  Writes NAME.vtkhdf and NAME.xdmf (the result), NAME.png (a picture) and NAME.run (the journal); of a "
    "drawing\n"
    "  NAME.svg too, and what else its key `output` names.\n"
    "  -o NAME          default: the scene's name, here\n"
    "  --set key=value  overrides a value of the scene: --set shell.thickness=1mm; may be repeated\n"
    "  --page SIZE      of a drawing: a4, a3, .., 'a4 landscape', 210x297mm\n"
    "  --margin LENGTH  of a drawing: 10mm\n"
    "  --resume         goes on with a run that was interrupted, or extends one that has finished\n"
    "  --force          discards an unfinished run of that name\n"
    "  --threads N      load cases at once, parts of a drawing's tone; default: as many as there are "
    "processors\n"
    "  --quiet          says nothing but errors; --log=json: one JSON object per line";

/* key=value, over what the scene says. */
static bool add_setting(RunOptions *options, const char *key, const char *value)
{
    if (options->set_count == SET_MAX) return false;
    options->set[options->set_count++] = mem_format("%s%s", key, value);
    return true;
}

static bool parse(int argc, char **argv, RunOptions *options)
{
    enum { SET = 256, PAGE, MARGIN, RESUME, FORCE, THREADS, QUIET, LOG, NO_PICTURE, HELP };
    static const struct option table[] = {{"output", required_argument, NULL, 'o'},
                                          {"set", required_argument, NULL, SET},
                                          {"page", required_argument, NULL, PAGE},
                                          {"margin", required_argument, NULL, MARGIN},
                                          {"resume", no_argument, NULL, RESUME},
                                          {"force", no_argument, NULL, FORCE},
                                          {"threads", required_argument, NULL, THREADS},
                                          {"quiet", no_argument, NULL, QUIET},
                                          {"log", required_argument, NULL, LOG},
                                          {"no-picture", no_argument, NULL, NO_PICTURE},
                                          {"help", no_argument, NULL, HELP},
                                          {0}};
    char end;
    options->threads = (int)sysconf(_SC_NPROCESSORS_ONLN);
    for (int c; (c = getopt_long(argc, argv, "o:", table, NULL)) >= 0;) {
        if (c == 'o')
            options->output = optarg;
        else if (c == SET && add_setting(options, "", optarg))
            continue;
        else if (c == PAGE && add_setting(options, "spline.page.size=", optarg))
            continue;
        else if (c == MARGIN && add_setting(options, "spline.page.margin=", optarg))
            continue;
        else if (c == RESUME)
            options->resume = true;
        else if (c == FORCE)
            options->force = true;
        else if (c == THREADS && sscanf(optarg, "%d%c", &options->threads, &end) == 1)
            continue;
        else if (c == QUIET)
            options->mode = PROGRESS_QUIET;
        else if (c == LOG && !strcmp(optarg, "json"))
            options->mode = PROGRESS_JSON;
        else if (c == NO_PICTURE)
            options->no_picture = true;
        else
            return false;
    }
    options->scene = argv[optind];
    return optind == argc - 1 && options->threads >= 1 && options->threads <= THREADS_MAX &&
           !(options->resume && options->force);
}

/* ---- The journal's beginning ---- */

/* Keys that a resumed run may change: how far it goes (a trajectory's steps are part of its problem), and
 * what it writes. */
static const char *const free_keys[] = {
    "design.iterations", "design.tolerance", "output.precision", "modes", "time.steps", NULL};
static const char *const free_keys_trajectory[] = {"design.iterations", "design.tolerance",
                                                   "output.precision", "modes", NULL};

static const char *const free_keys_draw[] = {"output", "spline.rounds", "spline.order", "spline.plotter",
                                             NULL};

/* "a, b and c" */
static char *list_of(const char *const *keys)
{
    char *list = mem_text(keys[0]);
    for (int k = 1; keys[k]; k++) list = mem_join(list, keys[k + 1] ? ", " : " and ", keys[k]);
    return list;
}

static bool check_scene(Journal *journal, int job, const char *scene, Error *err)
{
    const char *const *keys = job == JOB_TRAJECTORY ? free_keys_trajectory
                              : job == JOB_DRAW     ? free_keys_draw
                                                    : free_keys;
    Array old;
    if (!journal_get(journal, "meta", 0, "scene", &old, err)) return false;
    char *difference = yaml_difference(old.data, scene, keys);
    array_clear(&old);
    if (!difference) return true;
    char *list = list_of(keys);
    error_set(err,
              "the scene has changed since that run: %s is not the same; with --resume only %s may change",
              difference, list);
    mem_free(list);
    mem_free(difference);
    return false;
}

static bool begin(Run *run, const RunOptions *options, Error *err)
{
    Arrays statics = {0};
    run->model->body->add_static(run->model, &statics);
    char *scene = yaml_write(&scene_table, run->scene), *versions = run_versions();
    bool ok = !options->resume || check_scene(run->journal, run->scene->job, scene, err);
    Array meta[] = {array_text("scene", scene), array_text("versions", versions)};
    if (ok && options->resume && journal_is_finished(run->journal) && run->scene->job == JOB_SIMULATE)
        ok = recall_frames(run->journal, run->result, err);
    ok = ok && journal_put(run->journal, "meta", 0, meta, 2, err) &&
         arrays_put(&statics, run->journal, "static", 0, err);
    arrays_clear(&statics);
    if (ok && options->resume && journal_is_finished(run->journal))
        ok = journal_set_finished(run->journal, false, err);
    mem_free(scene);
    mem_free(versions);
    return ok;
}

/* ---- The result ---- */

static bool write_result(Run *run, const char *path, bool finished, Error *err)
{
    ResultDef def = {.double_frames = run->scene->output.precision == OUTPUT_DOUBLE};
    if (!journal_flush(run->journal, err) || !result_write(run->journal, path, def, err)) return false;
    if (!finished) return true;
    if (!journal_set_finished(run->journal, true, err)) return false;
    bool made_again = run->scene->job == JOB_TRAJECTORY; /* from the best motion's states */
    if (made_again || run->scene->job == JOB_SIMULATE) journal_forget(run->journal, "frame", NULL);
    return true;
}

static void draw(Run *run)
{
    Error err;
    char *picture = outputs_picture(run->scene, run->result);
    ShowDef def = show_default();
    if (show_result(run->result, picture, &def, &err))
        progress_say(run->progress, "picture: %s", picture);
    else
        progress_say(run->progress, "no picture: %s", err.text);
    mem_free(picture);
}

static int do_job(Run *run, const RunOptions *options)
{
    Error err;
    if (!begin(run, options, &err))
        return verb_fail(options->resume ? RUN_REFUSED : RUN_CANNOT_WRITE, err.text);
    RunStatus status = job_run(run, &err);
    if (status == RUN_CANNOT_WRITE || status == RUN_REFUSED) return verb_fail(status, err.text);
    if (!write_result(run, run->result, status != RUN_INTERRUPTED, &err))
        return verb_fail(RUN_CANNOT_WRITE, err.text);
    progress_say(run->progress, "result: %s", run->result);
    if (!outputs_write(run, &err)) return verb_fail(RUN_CANNOT_WRITE, err.text);
    if (!options->no_picture) draw(run);
    if (status == RUN_INTERRUPTED)
        progress_say(run->progress, "interrupted; all is saved: run again with --resume");
    return status;
}

static bool is_folder(const char *path)
{
    struct stat info;
    size_t length = strlen(path);
    return length == 0 || path[length - 1] == '/' || (stat(path, &info) == 0 && S_ISDIR(info.st_mode));
}

/* A folder where a file is to be written is refused before hours of work, not after. */
static bool check_output(const char *output, const char *result, Error *err)
{
    if (output && is_folder(output))
        return error_set(err, "the output '%s' is a folder; give the name of a result in it", output);
    if (is_folder(result))
        return error_set(err, "the result '%s' is a folder; give another name by -o", result);
    return true;
}

static int run_model(const RunOptions *options, const Scene *scene, Model *model)
{
    Error err;
    Progress progress = progress_start(options->mode);
    char *name =
        options->output ? verb_without_ending(options->output, ".vtkhdf") : verb_base_name(options->scene);
    char *result = mem_format("%s.vtkhdf", name), *journal = mem_format("%s.run", name);
    Run run = {
        .scene = scene, .model = model, .progress = &progress, .result = result, .threads = options->threads};
    JournalMode mode = options->resume ? JOURNAL_RESUME : options->force ? JOURNAL_FORCE : JOURNAL_NEW;
    if (check_output(options->output, result, &err) &&
        outputs_check(scene, options->scene, result, !options->no_picture, &err))
        run.journal = journal_open(journal, mode, &err);
    int code = run.journal ? do_job(&run, options) : verb_fail(RUN_CANNOT_WRITE, err.text);
    if (run.journal && !journal_close(run.journal, &err) && code != RUN_CANNOT_WRITE)
        code = verb_fail(RUN_CANNOT_WRITE, err.text);
    mem_free(name);
    mem_free(result);
    mem_free(journal);
    return code;
}

int verb_run(int argc, char **argv)
{
    RunOptions options = {0};
    if (!parse(argc, argv, &options)) return verb_usage(usage);
    YamlFile *file;
    Scene scene;
    int code = RUN_REFUSED;
    if (verb_load_scene(options.scene, options.set, options.set_count, &file, &scene)) {
        Model *model = verb_build_model(&scene, file);
        if (model) code = run_model(&options, &scene, model);
        model_destroy(model);
    }
    yaml_clear(&scene_table, &scene);
    yaml_destroy(file);
    for (int k = 0; k < options.set_count; k++) mem_free(options.set[k]);
    return code;
}
