/* slender run: scene -> journal -> result and picture. */
#include "base/memory.h"
#include "cli/options.h"
#include "cli/progress.h"
#include "cli/say.h"
#include "cli/verb.h"
#include "io/path.h"
#include "job/outputs.h"
#include "job/record.h"
#include "view/show.h"
#include <stdio.h>
#include <string.h>
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
    "  --force          discards an unfinished run of that name, or replaces the result of another scene, or "
    "files of its names\n"
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

/* A machine may have more processors than are of use, or not know how many. */
static int default_threads(void)
{
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    return processors < 1 ? 1 : processors > THREADS_MAX ? THREADS_MAX : (int)processors;
}

static bool parse(int argc, char **argv, RunOptions *o, int *code)
{
    bool quiet = false;
    int json = 0;
    const Option options[] = {
        {"output", .letter = 'o', .kind = OPTION_TEXT, .value = &o->output},
        {"set", .kind = OPTION_OTHER, .value = &o->settings, .take = settings_take,
         .allowed = SETTINGS_ALLOWED, .words = SETTINGS_WORDS},
        {"page", .kind = OPTION_OTHER, .value = &o->settings, .take = take_page, .allowed = "a size of paper",
         .words = OPTION_WORDS("a5", "a4", "a3", "a2", "letter")},
        {"margin", .kind = OPTION_OTHER, .value = &o->settings, .take = take_margin, .allowed = "a length"},
        {"resume", .value = &o->resume},
        {"force", .value = &o->force},
        {"threads", .kind = OPTION_INT, .value = &o->threads, .least = 1, .most = THREADS_MAX},
        {"quiet", .value = &quiet},
        {"log", .kind = OPTION_CHOICE, .value = &json, .words = OPTION_WORDS("json")},
        {"no-picture", .value = &o->no_picture},
    };
    o->threads = default_threads();
    if (!options_parse(argc, argv, usage, options, sizeof options / sizeof *options, &o->scene, code))
        return false;
    o->mode = json ? PROGRESS_JSON : quiet ? PROGRESS_QUIET : PROGRESS_NORMAL;
    if (!o->resume || !o->force) return true;
    *code =
        verb_fail(RUN_USAGE, "--resume goes on with a run and --force discards it: one of them can be given");
    return false;
}

/* ---- The run ---- */

static bool draw(const Scene *scene, const Host *host, const char *result, Error *err)
{
    char *picture = outputs_picture(scene, result);
    ShowDef def = show_default();
    ShowStatus shown = show_result(result, picture, &def, err);
    if (shown == SHOW_DONE) host_say(host, "picture: %s", picture);
    if (shown == SHOW_HAS_NOT) host_say(host, "no picture: %s", err->text);
    mem_free(picture);
    return shown != SHOW_CANNOT_WRITE || error_prefix(err, "no picture");
}

/* With --log=json also as an object. */
static int fail(const RunOptions *options, int code, const char *sentence)
{
    progress_tell(options->mode, "error", sentence);
    return verb_fail(code, sentence);
}

static int run_model(const RunOptions *options, const Scene *scene, Model *model)
{
    Error err;
    Progress progress = progress_start(options->mode);
    Host host = progress_host(&progress);
    char *name =
        options->output ? path_without_ending(options->output, ".vtkhdf") : path_base_name(options->scene);
    char *result = mem_format("%s.vtkhdf", name);
    RecordDef def = {.scene = scene,
                     .model = model,
                     .host = &host,
                     .path = options->scene,
                     .name = name,
                     .journal = options->resume  ? JOURNAL_RESUME
                                : options->force ? JOURNAL_FORCE
                                                 : JOURNAL_NEW,
                     .threads = options->threads,
                     .picture = !options->no_picture};
    bool drawable;
    int code = record_run(&def, &drawable, &err);
    bool failed = code == RUN_CANNOT_WRITE || code == RUN_REFUSED,
         drawn = failed || !drawable || options->no_picture || draw(scene, &host, result, &err);
    if (code == RUN_INTERRUPTED) host_say(&host, "interrupted; all is saved: run again with --resume");
    if (failed || !drawn)
        code = fail(options, drawn || code == RUN_INTERRUPTED ? code : RUN_CANNOT_WRITE, err.text);
    mem_free(name);
    mem_free(result);
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
