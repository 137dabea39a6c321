/* slender info and slender export: what is in a result, or in the journal of a running job. */
#include "base/memory.h"
#include "base/plain.h"
#include "cli/export_drawing.h"
#include "cli/export_groups.h"
#include "cli/say.h"
#include "cli/verb.h"
#include "io/path.h"
#include "io/replace.h"
#include "io/result.h"
#include "io/table.h"
#include "job/outputs.h"
#include "model/stored.h"
#include "spline/drawn.h"
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- info ---- */

/* "4 x 3 m" */
static char *shape_text(const Array *array, const char *unit)
{
    char *shape = mem_text("");
    for (int r = 0; r < array->rank; r++) {
        char *longer = mem_format("%s%s%d", shape, r ? " x " : "", array->dims[r]);
        mem_free(shape);
        shape = longer;
    }
    return mem_join(shape, " ", unit);
}

static void print_array(const char *path, const Array *array)
{
    static const char *const types[] = {"real", "integer",
                                        "text"}; /* of whatever length they are in the file */
    const char *unit = array->unit ? array->unit : "";
    char *what;
    if (array->type == ARRAY_TEXT)
        what = strchr(array->data, '\n') ? mem_format("%d bytes", array->dims[0]) : mem_text(array->data);
    else if (array->rank == 0)
        what = array->type == ARRAY_FLOAT64 ? mem_format("%.9g %s", *(const double *)array->data, unit)
                                            : mem_format("%d %s", *(const int *)array->data, unit);
    else
        what = shape_text(array, unit);
    say(stdout, "  %-44s %-8s %s", path, types[array->type], what);
    mem_free(what);
}

static const char *plural(int count)
{
    return count == 1 ? "" : "s";
}

/* "a.vtkhdf: settled, 1 frame" */
static void print_title(Result *result, const char *path)
{
    Array status = {0};
    bool known = result_read(result, "slender/status", &status, NULL);
    int frames = result_step_count(result);
    say(stdout, "%s: %s%s%d frame%s", path, known ? (const char *)status.data : "", known ? ", " : "", frames,
        plural(frames));
    array_clear(&status);
    Array kernels = {0};
    if (result_read(result, "slender/kernels", &kernels, NULL))
        say(stdout, "  OpenBLAS's kernels: %s", (const char *)kernels.data);
    array_clear(&kernels);
}

static int info_result(const char *path)
{
    Error err;
    char **paths;
    int count;
    Result *result = result_open(path, &err);
    if (!result || !result_list(result, &paths, &count, &err)) {
        if (result) error_prefix(&err, "%s", path);
        result_close(result);
        return verb_fail(RUN_REFUSED, err.text);
    }
    print_title(result, path);
    for (int k = 0; k < count; k++) {
        Array array;
        if (!result_read(result, paths[k], &array, &err)) {
            say(stdout, "  %-44s %s", paths[k], err.text);
            continue;
        }
        print_array(paths[k], &array);
        array_clear(&array);
    }
    mem_free(paths);
    result_close(result);
    return RUN_DONE;
}

static double evaluation_number(Journal *journal, int index, const char *name)
{
    Array array;
    if (!journal_get(journal, "evaluation", index, name, &array, NULL)) return NAN;
    double value =
        array_count(&array) == 1 && array.type == ARRAY_FLOAT64 ? *(const double *)array.data : NAN;
    array_clear(&array);
    return value;
}

static void print_design(Journal *journal, int index)
{
    printf("  objective %.6e  gradient %.3e  %.1f s\n", evaluation_number(journal, index, "objective"),
           evaluation_number(journal, index, "gradient_norm"), evaluation_number(journal, index, "seconds"));
}

static void print_drawing(Journal *journal, int index)
{
    printf("  energy %.6e  %g strokes  %.1f s\n", evaluation_number(journal, index, "energy"),
           evaluation_number(journal, index, "strokes"), evaluation_number(journal, index, "seconds"));
}

/* Where it is known: a preview's steps have no iterations. */
static void print_count(Journal *journal, int index, const char *name, const char *noun)
{
    double count = evaluation_number(journal, index, name);
    if (!isnan(count)) printf("  %g %s%s", count, noun, count == 1 ? "" : "s");
}

static void print_step(Journal *journal, int index)
{
    printf("  t %.6g s", evaluation_number(journal, index, "time"));
    print_count(journal, index, "newton_iterations", "Newton iteration");
    print_count(journal, index, "factorizations", "factorization");
    printf("\n");
}

/* What "evaluations" of a journal are, by what they hold. */
typedef struct EvaluationKind {
    const char *has; /* NULL: anything else */
    const char *noun;
    void (*print)(Journal *journal, int index);
} EvaluationKind;

static const EvaluationKind *kind_of(Journal *journal, const int *indices, int count)
{
    static const EvaluationKind kinds[] = {{"objective", "evaluation", print_design},
                                           {"energy", "iteration", print_drawing},
                                           {NULL, "step", print_step}};
    const EvaluationKind *kind = kinds;
    for (bool has = false; kind->has && count > 0; kind++) {
        journal_has(journal, "evaluation", indices[0], kind->has, &has, NULL); /* journal_check says more */
        if (has) break;
    }
    return kind;
}

/* "b.run: not finished, 12 evaluations, 3 frames, 2 states". Once the result is safe, frames may be there only. */
static void print_journal(Journal *journal, const char *path, const char *noun, int count, int frames,
                          int states)
{
    bool finished = journal_is_finished(journal);
    char *done = count ? mem_format(", %d %s%s", count, noun, plural(count)) : mem_text("");
    say(stdout, "%s: %s%s, %d frame%s, %d state%s%s", path, finished ? "finished" : "not finished", done,
        frames, plural(frames), states, plural(states),
        finished && frames == 0 ? "; the frames are in the result" : "");
    mem_free(done);
}

static int info_journal(const char *path)
{
    Error err;
    Journal *journal = journal_open(path, JOURNAL_READ, &err);
    if (!journal) return verb_fail(RUN_REFUSED, err.text);
    int frames, states, *indices = NULL, count = 0;
    bool ok = journal_count(journal, "frame", &frames, &err) &&
              journal_count(journal, "state", &states, &err) &&
              journal_indices(journal, "evaluation", &indices, &count, &err);
    if (ok) {
        const EvaluationKind *kind = kind_of(journal, indices, count);
        print_journal(journal, path, kind->noun, count, frames, states);
        for (int k = 0; k < count; k++) {
            printf("  %4d", indices[k]);
            kind->print(journal, indices[k]);
        }
    }
    mem_free(indices);
    ok = ok && journal_check(journal, &err);
    if (!ok) say(stderr, "slender: %s", err.text);
    journal_close(journal, NULL);
    return ok ? RUN_DONE : RUN_REFUSED;
}

int verb_info(int argc, char **argv)
{
    static const char usage[] =
        "info NAME.vtkhdf | NAME.run\n  Lists what is in a result, or how far a run has come.";
    const char *path;
    int code;
    if (!options_parse(argc, argv, usage, NULL, 0, &path, &code)) return code;
    return path_has_ending(path, ".run") ? info_journal(path) : info_result(path);
}

/* ---- export ---- */

static bool are_numbers(const Array *array, Error *err)
{
    if (array->type == ARRAY_TEXT)
        return error_set(err, "'%s' is a text, not numbers; slender info shows it", array->name);
    return array_count(array) > 0 || error_set(err, "%s is empty: there are no numbers in it", array->name);
}

/* Integers as numbers, so that one writer serves both. */
static bool write_csv(const Array *array, const char *path, Error *err)
{
    size_t count = array_count(array);
    int columns = array->rank > 1 ? array->dims[array->rank - 1] : 1;
    double *values = mem_alloc(count, sizeof *values);
    for (size_t i = 0; i < count; i++)
        values[i] =
            array->type == ARRAY_INT32 ? ((const int *)array->data)[i] : ((const double *)array->data)[i];
    char *header = array->unit && array->unit[0] ? mem_format("# %s, %s", array->name, array->unit)
                                                 : mem_format("# %s", array->name);
    char *plain = plain_text(header, "");
    bool ok = table_write(path, plain, values, (int)(count / (size_t)columns), columns, err);
    mem_free(values);
    mem_free(header);
    mem_free(plain);
    return ok;
}

static RunStatus export_dataset(Result *result, const char *dataset, const char *path, Error *err)
{
    Array array;
    char *full = result_has(result, dataset) ? mem_text(dataset) : mem_format("slender/%s", dataset);
    bool ok = result_read(result, full, &array, err);
    mem_free(full);
    if (!ok) return RUN_REFUSED;
    RunStatus status = !are_numbers(&array, err)       ? RUN_REFUSED
                       : !write_csv(&array, path, err) ? RUN_CANNOT_WRITE
                                                       : RUN_DONE;
    array_clear(&array);
    return status;
}

typedef struct Export {
    const char *output, *dataset, *language;
    int frame, per; /* per: 1: group */
    DrawingSplit split;
} Export;

/* The scene may be made of meshes, numbers and drawings, too. */
static bool check_source(Result *result, const char *input, const char *output, Error *err)
{
    Scene scene;
    YamlFile *file;
    stored_result_scene(result, &file, &scene);
    bool ok = outputs_check_source(&scene, input, output, err);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return ok;
}

static const char *const endings[] = {".csv", ".obj",  ".svg", ".gcode",  ".ngc",
                                      ".nc",  ".hpgl", ".plt", ".vtkhdf", NULL};

/* What is asked for, in the right words: an ending that says what is to be written, and no option that it does not use. */
static bool check_request(const Export *what, bool run, Error *err)
{
    bool known = false, mesh = path_has_ending(what->output, ".obj");
    for (int k = 0; endings[k]; k++) known = known || path_has_ending(what->output, endings[k]);
    if (!known)
        return error_set(
            err,
            "%s: numbers are exported as .csv, with --dataset, a mesh as .obj, a drawing as .svg, "
            ".gcode, .ngc, .nc, .hpgl or .plt, a run as .vtkhdf; slender picture draws .png, .svg "
            "and .pdf",
            what->output);
    if (what->per && (run || what->dataset || what->frame >= 0 || !path_has_ending(what->output, ".csv")))
        return error_set(err,
                         "--per group is for a CSV of a result's groups, -o FILE.csv, and is not used here");
    if (what->dataset && run)
        return error_set(err, "--dataset is not used with a run: export its result first");
    if (what->frame >= 0 && (what->dataset || !mesh))
        return error_set(err, "--frame is for a mesh, -o FILE.obj, and is not used here");
    if (what->language && (what->dataset || mesh || run))
        return error_set(err, "--plotter is for a drawing, -o FILE.gcode, and is not used here");
    if ((what->split.pens || what->split.ink > 0) && (what->dataset || mesh || run))
        return error_set(err, "--split is for a drawing, -o FILE.gcode, and is not used here");
    return true;
}

static bool check_ending(const char *path, const char *what, const char *ending, Error *err)
{
    return path_has_ending(path, ending) || error_set(err, "%s: %s exported as %s", path, what, ending);
}

/* A file beside the one that was asked for. */
typedef struct Further {
    Result *result;
    const char *input;
} Further;

static bool check_further(void *self, const char *path, Error *err)
{
    const Further *further = self;
    return check_source(further->result, further->input, path, err) && replace_check(path, err);
}

static RunStatus write_export(Result *result, const char *input, const Export *what, Error *err)
{
    const char *path = what->output;
    if (what->per) return export_groups(result, path, err);
    if (what->dataset)
        return check_ending(path, "numbers are", ".csv", err)
                   ? export_dataset(result, what->dataset, path, err)
                   : RUN_CANNOT_WRITE;
    if (path_has_ending(path, ".csv")) {
        error_set(err, "%s: which numbers? --dataset names them; slender info lists what there is", path);
        return RUN_USAGE;
    }
    if (drawn_has(result))
        return export_drawing(result, what->language, what->split, path, check_further,
                              &(Further){result, input}, err);
    if (what->split.pens || what->split.ink > 0) {
        error_set(err, "--split is for a drawing, and the result has none");
        return RUN_USAGE;
    }
    return check_ending(path, "a mesh is", ".obj", err) ? export_frame(result, what->frame, path, err)
                                                        : RUN_CANNOT_WRITE;
}

static RunStatus export_result(const char *input, const Export *what, Error *err)
{
    Result *result = result_open(input, err);
    if (!result) return RUN_REFUSED;
    RunStatus status = RUN_CANNOT_WRITE;
    if (check_source(result, input, what->output, err) && replace_check(what->output, err)) {
        status = check_request(what, false, err) ? write_export(result, input, what, err) : RUN_USAGE;
        if (status != RUN_DONE) error_prefix(err, "%s", input);
    }
    result_close(result);
    return status;
}

/* As the run itself would write it; false where that would be over a file that its scene is made of. */
static bool result_def(Journal *journal, const char *input, const char *output, ResultDef *def, Error *err)
{
    Array text;
    Scene scene;
    YamlFile *file;
    *def = (ResultDef){0};
    if (!journal_find(journal, "meta", 0, "scene", &text, err)) return false;
    if (!text.data) return true;
    if (stored_scene(&text, &file, &scene)) def->double_frames = scene.output.precision == OUTPUT_DOUBLE;
    bool ok = outputs_check_source(&scene, input, output, err);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    array_clear(&text);
    return ok;
}

static RunStatus export_journal(const char *input, const Export *what, Error *err)
{
    const char *path = what->output;
    if (!path_has_ending(path, ".vtkhdf")) {
        error_set(err, "%s: a run is exported as .vtkhdf, and that as other files", path);
        return RUN_CANNOT_WRITE;
    }
    if (!check_request(what, true, err)) return RUN_USAGE;
    char *sidecar = result_sidecar(path);
    bool free = outputs_check_source(NULL, input, sidecar, err) && replace_check(sidecar, err);
    mem_free(sidecar);
    if (!free) return RUN_CANNOT_WRITE;
    Journal *journal = journal_open(input, JOURNAL_READ, err);
    if (!journal) return RUN_REFUSED;
    int frames;
    ResultDef def;
    bool ok = journal_count(journal, "frame", &frames, err) &&
              (!journal_is_finished(journal) || frames > 0 ||
               error_set(err, "%s: the run has finished; its frames are in its result", input));
    ok = ok && result_def(journal, input, path, &def, err) && result_write(journal, path, def, NULL, err);
    return journal_close(journal, ok ? err : NULL) && ok ? RUN_DONE : RUN_CANNOT_WRITE;
}

int verb_export(int argc, char **argv)
{
    static const char usage[] =
        "export NAME.vtkhdf -o FILE.csv --dataset PATH      numbers, e.g. --dataset design/magnetization\n"
        "       slender export NAME.vtkhdf -o FILE.csv --per group  of each named group |M|, azimuth, "
        "elevation\n"
        "       slender export NAME.vtkhdf -o FILE.obj [--frame N]  a mesh with its groups; default: the "
        "final "
        "state\n"
        "       slender export NAME.vtkhdf -o FILE.svg | .gcode | .hpgl [--plotter gcode | gcode_servo | "
        "hpgl | profile | PROFILE.yaml]  a "
        "drawing;\n"
        "              --split pen, or --split \"5 m\": a file for each pen, or for so much ink, "
        "FILE_1.gcode, ..\n"
        "       slender export NAME.run -o NAME.vtkhdf              the result of a running or interrupted "
        "job";
    Export what = {.frame = -1};
    const char *input;
    int code;
    const Option options[] = {
        {"output", .letter = 'o', .kind = OPTION_TEXT, .value = &what.output, .words = endings},
        {"dataset", .kind = OPTION_TEXT, .value = &what.dataset, .words = OPTION_WORDS("DATASET")},
        {"per", .kind = OPTION_CHOICE, .value = &what.per, .words = OPTION_WORDS("group")},
        {"frame", .kind = OPTION_INT, .value = &what.frame, .least = 0, .most = INT_MAX},
        {"plotter", .kind = OPTION_TEXT, .value = &what.language,
         .words = OPTION_WORDS("gcode", "gcode_servo", "hpgl", "profile", ".yaml")},
        {"split", .kind = OPTION_OTHER, .value = &what.split, .take = drawing_split_take,
         .allowed = DRAWING_SPLIT_ALLOWED, .words = OPTION_WORDS("pen")}};
    if (!options_parse(argc, argv, usage, options, sizeof options / sizeof *options, &input, &code))
        return code;
    if (what.per && what.dataset) return verb_fail(RUN_USAGE, "--per and --dataset exclude each other");
    if (!what.output) return verb_fail(RUN_USAGE, "-o FILE must be given; slender export --help says more");
    Error err;
    if (!outputs_check_source(NULL, input, what.output, &err)) return verb_fail(RUN_CANNOT_WRITE, err.text);
    RunStatus status = path_has_ending(input, ".run") ? export_journal(input, &what, &err)
                                                      : export_result(input, &what, &err);
    return status == RUN_DONE ? RUN_DONE : verb_fail(status, err.text);
}
