/* slender run: scene -> journal -> result and picture. */
#include "base/memory.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "cli/say.h"
#include "cli/verb.h"
#include "io/path.h"
#include "io/result.h"
#include "job/outputs.h"
#include "job/record.h"
#include "solve/kernels.h"
#include "view/show.h"
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { THREADS_MAX = 64 };

typedef struct RunOptions {
    const char *scene, *output;
    Settings settings;
    int threads;
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
    "  --threads N      that share the work, 1 to 64; the same numbers come out; default: as many as there "
    "are "
    "processors\n"
    "  --quiet          says nothing but errors; --log=json: one JSON object per line\n"
    "  --no-picture     draws none";

static bool take_page(void *settings, const char *text)
{
    return settings_put(settings, "spline.page.size=", text);
}

static bool take_margin(void *settings, const char *text)
{
    return settings_put(settings, "spline.page.margin=", text);
}

static bool take_log(void *mode, const char *text)
{
    *(ProgressMode *)mode = PROGRESS_JSON;
    return !strcmp(text, "json");
}

/* A machine may have more processors than are of use, or not know how many. */
static int default_threads(void)
{
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    return processors < 1 ? 1 : processors > THREADS_MAX ? THREADS_MAX : (int)processors;
}

static bool parse(int argc, char **argv, RunOptions *o, int *code)
{
    bool quiet = false;
    const Option options[] = {
        {"output", .letter = 'o', .kind = OPTION_TEXT, .value = &o->output},
        {"set", .kind = OPTION_OTHER, .value = &o->settings, .take = settings_take,
         .allowed = SETTINGS_ALLOWED},
        {"page", .kind = OPTION_OTHER, .value = &o->settings, .take = take_page,
         .allowed = "a size of paper"},
        {"margin", .kind = OPTION_OTHER, .value = &o->settings, .take = take_margin, .allowed = "a length"},
        {"resume", .value = &o->resume},
        {"force", .value = &o->force},
        {"threads", .kind = OPTION_INT, .value = &o->threads, .least = 1, .most = THREADS_MAX},
        {"quiet", .value = &quiet},
        {"log", .kind = OPTION_OTHER, .value = &o->mode, .take = take_log, .allowed = "json"},
        {"no-picture", .value = &o->no_picture},
    };
    o->threads = default_threads();
    if (!options_parse(argc, argv, usage, options, sizeof options / sizeof *options, &o->scene, code))
        return false;
    if (quiet && o->mode == PROGRESS_NORMAL) o->mode = PROGRESS_QUIET;
    if (!o->resume || !o->force) return true;
    *code =
        verb_fail(RUN_USAGE, "--resume goes on with a run and --force discards it: one of them can be given");
    return false;
}

/* ---- The run ---- */

static bool draw(Run *run, Error *err)
{
    char *picture = outputs_picture(run->scene, run->result);
    ShowDef def = show_default();
    bool ok = show_result(run->result, picture, &def, err) == SHOW_DONE;
    if (ok) host_say(run->host, "picture: %s", picture);
    mem_free(picture);
    return ok || error_prefix(err, "no picture");
}

/* With --log=json also as an object. */
static int fail(const RunOptions *options, int code, const char *sentence)
{
    progress_tell(options->mode, "error", sentence);
    return verb_fail(code, sentence);
}

static int do_job(Run *run, const RunOptions *options)
{
    Error err;
    RunStatus status = record_run(run, options->resume, &err);
    if (status == RUN_CANNOT_WRITE || status == RUN_REFUSED) return fail(options, status, err.text);
    bool drawn = options->no_picture || run->unsolved || draw(run, &err);
    if (status == RUN_INTERRUPTED) host_say(run->host, "interrupted; all is saved: run again with --resume");
    if (drawn) return status;
    return fail(options, status == RUN_INTERRUPTED ? RUN_INTERRUPTED : RUN_CANNOT_WRITE, err.text);
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

static void warn_sidecar(const Run *run)
{
    if (result_has_sidecar(run->result)) return;
    host_warn(
        run->host,
        "'%s': no .xdmf (for ParaView 5.11) is written beside it, since XDMF cannot name this file: a name "
        "without : and |, control characters, and blanks at its ends can be",
        run->result);
}

static int run_model(const RunOptions *options, const Scene *scene, Model *model)
{
    Error err;
    Progress progress = progress_start(options->mode);
    Host host = progress_host(&progress);
    char *name =
        options->output ? path_without_ending(options->output, ".vtkhdf") : path_base_name(options->scene);
    char *result = mem_format("%s.vtkhdf", name), *journal = mem_format("%s.run", name);
    Run run = {.scene = scene,
               .model = model,
               .host = &host,
               .result = result,
               .threads = kernels_reserve(options->threads)}; /* the same numbers come out */
    JournalMode mode = options->resume ? JOURNAL_RESUME : options->force ? JOURNAL_FORCE : JOURNAL_NEW;
    if (check_output(options->output, result, &err) &&
        outputs_check(scene, options->scene, result, !options->no_picture, &err))
        run.journal = journal_open(journal, mode, &err);
    if (run.journal) warn_sidecar(&run);
    run_share_threads(&run, 1);
    int code = run.journal ? do_job(&run, options) : fail(options, RUN_CANNOT_WRITE, err.text);
    if (run.journal && !journal_close(run.journal, &err) && code != RUN_CANNOT_WRITE)
        code = fail(options, RUN_CANNOT_WRITE, err.text);
    run_release_threads(&run);
    mem_free(name);
    mem_free(result);
    mem_free(journal);
    return code;
}

/* What the verb has printed about the scene, as objects. */
static void tell_scene(const RunOptions *options, const YamlFile *file, const Model *model)
{
    int count;
    const YamlError *errors = yaml_errors(file, &count);
    for (int k = 0; k < count; k++) {
        char *sentence = errors[k].line ? mem_format("%s:%d:%d: %s", options->scene, errors[k].line,
                                                     errors[k].column, errors[k].sentence)
                                        : mem_format("%s: %s", options->scene, errors[k].sentence);
        progress_tell(options->mode, "error", sentence);
        mem_free(sentence);
    }
    for (int k = 0; model && k < model->report.warning_count; k++)
        progress_tell(options->mode, "warning", model->report.warnings[k]);
}

int verb_run(int argc, char **argv)
{
    RunOptions options = {0};
    int code;
    if (!parse(argc, argv, &options, &code)) {
        settings_clear(&options.settings);
        return code;
    }
    YamlFile *file;
    Scene scene;
    bool loaded = verb_load_scene(options.scene, &options.settings, &file, &scene);
    Model *model = loaded ? verb_build_model(&scene, file) : NULL;
    tell_scene(&options, file, model);
    code = model ? run_model(&options, &scene, model) : RUN_REFUSED;
    model_destroy(model);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    settings_clear(&options.settings);
    return code;
}
