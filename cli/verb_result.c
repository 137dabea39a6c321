/* slender info and slender export: what is in a result, or in the journal of a running job. */
#include "base/memory.h"
#include "base/plain.h"
#include "cli/export_groups.h"
#include "cli/say.h"
#include "cli/verb.h"
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

static bool has_ending(const char *path, const char *ending)
{
    size_t length = strlen(path), size = strlen(ending);
    return length > size && !strcmp(path + length - size, ending);
}

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
    static const char *const types[] = {"float64", "int32", "text"};
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

/* "a.vtkhdf: settled, 1 frames" */
static void print_title(Result *result, const char *path)
{
    Array status = {0};
    bool known = result_read(result, "slender/status", &status, NULL);
    say(stdout, "%s: %s%s%d frames", path, known ? (const char *)status.data : "", known ? ", " : "",
        result_step_count(result));
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

/* An evaluation of a design, an iteration of a drawing, or a step of a simulation. */
static void print_evaluation(Journal *journal, int index)
{
    bool design = false, drawing = false;
    journal_has(journal, "evaluation", index, "objective", &design, NULL); /* journal_check says more */
    journal_has(journal, "evaluation", index, "energy", &drawing, NULL);
    if (design)
        printf("  %4d  objective %.6e  gradient %.3e  %.1f s\n", index,
               evaluation_number(journal, index, "objective"),
               evaluation_number(journal, index, "gradient_norm"),
               evaluation_number(journal, index, "seconds"));
    else if (drawing)
        printf("  %4d  energy %.6e  %g strokes  %.1f s\n", index, evaluation_number(journal, index, "energy"),
               evaluation_number(journal, index, "strokes"), evaluation_number(journal, index, "seconds"));
    else
        printf("  %4d  t %.6g s  %g Newton iterations  %g factorizations\n", index,
               evaluation_number(journal, index, "time"),
               evaluation_number(journal, index, "newton_iterations"),
               evaluation_number(journal, index, "factorizations"));
}

static int info_journal(const char *path)
{
    Error err;
    Journal *journal = journal_open(path, JOURNAL_READ, &err);
    if (!journal) return verb_fail(RUN_REFUSED, err.text);
    int evaluations, frames, states, *indices = NULL, count = 0;
    bool ok = journal_count(journal, "evaluation", &evaluations, &err) &&
              journal_count(journal, "frame", &frames, &err) &&
              journal_count(journal, "state", &states, &err);
    if (ok)
        say(stdout, "%s: %s, %d evaluations, %d frames, %d states", path,
            journal_is_finished(journal) ? "finished" : "not finished", evaluations, frames, states);
    ok = ok && journal_indices(journal, "evaluation", &indices, &count, &err);
    for (int k = 0; ok && k < count; k++) print_evaluation(journal, indices[k]);
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
    return has_ending(path, ".run") ? info_journal(path) : info_result(path);
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

/* In that plotter's language, or as the name's ending says. */
static RunStatus export_drawing(Result *result, const char *language, const char *path, Error *err)
{
    static const struct {
        const char *ending, *language;
    } endings[] = {{".svg", "svg"},  {".gcode", "gcode"}, {".ngc", "gcode"},
                   {".nc", "gcode"}, {".hpgl", "hpgl"},   {".plt", "hpgl"}};
    Drawn drawn = {0};
    const char *usual = NULL;
    for (size_t k = 0; k < sizeof endings / sizeof *endings; k++)
        if (has_ending(path, endings[k].ending)) usual = endings[k].language;
    if (!usual) {
        error_set(err, "%s: a drawing is exported as .svg, .gcode or .hpgl, or numbers with --dataset", path);
        return RUN_CANNOT_WRITE;
    }
    RunStatus status = !drawn_read(result, &drawn, err)                               ? RUN_REFUSED
                       : !drawn_write(&drawn, language ? language : usual, path, err) ? RUN_CANNOT_WRITE
                                                                                      : RUN_DONE;
    drawn_clear(&drawn);
    return status;
}

typedef struct Export {
    const char *output, *dataset, *language, *per;
    int frame;
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

/* A scene's path is not in its result: what is written is at least never named like one. */
static bool check_ending(const char *path, const char *what, const char *ending, Error *err)
{
    return has_ending(path, ending) || error_set(err, "%s: %s exported as %s", path, what, ending);
}

static RunStatus write_export(Result *result, const Export *what, Error *err)
{
    const char *path = what->output;
    if (what->per)
        return check_ending(path, "groups are", ".csv", err) ? export_groups(result, path, err)
                                                             : RUN_CANNOT_WRITE;
    if (what->dataset)
        return check_ending(path, "numbers are", ".csv", err)
                   ? export_dataset(result, what->dataset, path, err)
                   : RUN_CANNOT_WRITE;
    if (has_ending(path, ".csv")) {
        error_set(err, "%s: which numbers? --dataset names them; slender info lists what there is", path);
        return RUN_USAGE;
    }
    if (drawn_has(result)) return export_drawing(result, what->language, path, err);
    return check_ending(path, "a mesh is", ".obj", err) ? export_frame(result, what->frame, path, err)
                                                        : RUN_CANNOT_WRITE;
}

static RunStatus export_result(const char *input, const Export *what, Error *err)
{
    Result *result = result_open(input, err);
    if (!result) return RUN_REFUSED;
    RunStatus status = RUN_CANNOT_WRITE;
    if (check_source(result, input, what->output, err) && replace_check(what->output, err)) {
        status = write_export(result, what, err);
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

static RunStatus export_journal(const char *input, const char *path, Error *err)
{
    if (!has_ending(path, ".vtkhdf")) {
        error_set(err, "%s: a run is exported as .vtkhdf, and that as other files", path);
        return RUN_CANNOT_WRITE;
    }
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
        "hpgl]  a "
        "drawing\n"
        "       slender export NAME.run -o NAME.vtkhdf              the result of a running or interrupted "
        "job";
    Export what = {.frame = -1};
    const char *input;
    int code;
    const Option options[] = {
        {"output", .letter = 'o', .kind = OPTION_TEXT, .value = &what.output},
        {"dataset", .kind = OPTION_TEXT, .value = &what.dataset},
        {"per", .kind = OPTION_TEXT, .value = &what.per},
        {"frame", .kind = OPTION_INT, .value = &what.frame, .least = 0, .most = INT_MAX},
        {"plotter", .kind = OPTION_TEXT, .value = &what.language}};
    if (!options_parse(argc, argv, usage, options, 5, &input, &code)) return code;
    if (what.per && strcmp(what.per, "group"))
        return verb_fail(RUN_USAGE, "--per must be group: slender export --help says more");
    if (what.per && what.dataset) return verb_fail(RUN_USAGE, "--per and --dataset exclude each other");
    if (!what.output) return verb_fail(RUN_USAGE, "-o FILE must be given; slender export --help says more");
    Error err;
    if (!outputs_check_source(NULL, input, what.output, &err)) return verb_fail(RUN_CANNOT_WRITE, err.text);
    RunStatus status = has_ending(input, ".run") ? export_journal(input, what.output, &err)
                                                 : export_result(input, &what, &err);
    return status == RUN_DONE ? RUN_DONE : verb_fail(status, err.text);
}
