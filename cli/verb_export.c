/* slender export: what is in a result as other files, or a running job's journal as a result. */
#include "base/memory.h"
#include "base/plain.h"
#include "cli/export_drawing.h"
#include "cli/export_files.h"
#include "cli/verb.h"
#include "io/mark.h"
#include "io/path.h"
#include "io/replace.h"
#include "io/result.h"
#include "io/safe_file.h"
#include "io/table.h"
#include "job/outputs.h"
#include "job/probe_table.h"
#include "model/stored.h"
#include "spline/drawn.h"
#include <limits.h>
#include <string.h>

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

/* What is asked for. */
typedef struct Export {
    const char *input, *output, *dataset, *language;
    int per; /* 1: group */
    bool probes, force;
    ExportDef how; /* of a .glb; others take its frame */
    int levels;
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

/* ---- Formats ---- */

/* A result, and the file that it is. */
typedef struct Source {
    Result *result;
    const char *input;
    bool force;
} Source;

static bool may_write(const void *self, const char *path, Error *err)
{
    const Source *source = self;
    return check_source(source->result, source->input, path, err) && mark_check(path, source->force, err);
}

static RunStatus export_probes(Result *result, const char *path, Error *err)
{
    Scene scene;
    YamlFile *file;
    stored_result_scene(result, &file, &scene);
    char *text = probe_table_text(&scene, result, err);
    RunStatus status = !text                                                   ? RUN_REFUSED
                       : safe_file_write(path, text, strlen(text), false, err) ? RUN_DONE
                                                                               : RUN_CANNOT_WRITE;
    mem_free(text);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    return status;
}

static RunStatus write_numbers(Result *result, const Export *what, Error *err)
{
    if (what->per) return export_file_groups(result, what->output, err);
    if (what->probes) return export_probes(result, what->output, err);
    if (what->dataset) return export_dataset(result, what->dataset, what->output, err);
    error_set(err, "%s: which numbers? --dataset names them; slender info lists what there is", what->output);
    return RUN_USAGE;
}

static RunStatus write_npz(Result *result, const Export *what, Error *err)
{
    return export_file_npz(result, what->output, err);
}

static RunStatus write_obj(Result *result, const Export *what, Error *err)
{
    return export_file_obj(result, what->how.frame, what->output, err);
}

static RunStatus write_ply(Result *result, const Export *what, Error *err)
{
    return export_file_ply(result, what->how.frame, what->output, err);
}

static RunStatus write_glb(Result *result, const Export *what, Error *err)
{
    ExportDef def = what->how;
    if (!def.frames) def.frames = EXPORT_FRAMES;
    return export_file_glb(result, &def, what->output, err);
}

static RunStatus write_parts(Result *result, const Export *what, Error *err)
{
    PartsDef def = {what->how.frame, what->levels, what->per != 0};
    FurtherFiles further = {may_write, &(Source){result, what->input, what->force}};
    return export_file_parts(result, &def, what->output, further, err);
}

static RunStatus write_drawing(Result *result, const Export *what, Error *err)
{
    FurtherFiles further = {may_write, &(Source){result, what->input, what->force}};
    return export_drawing(result, what->language, what->split, what->output, further, err);
}

/* The options that say what of a result, and how. */
enum {
    DATASET = 1,
    PER = 2,
    FRAME = 4,
    FRAMES = 8,
    FIELD = 16,
    LEVELS = 32,
    PLOTTER = 64,
    SPLIT = 128,
    PROBES = 256
};

/* Of an ending: what it is of, and which options it takes. */
typedef struct Format {
    const char *ending;
    enum { OF_ALL, OF_BODY, OF_DRAWING, OF_RUN } of;
    unsigned takes;
    RunStatus (*write)(Result *result, const Export *what, Error *err);
} Format;

static const Format formats[] = {{".csv", OF_ALL, DATASET | PER | PROBES, write_numbers},
                                 {".npz", OF_ALL, 0, write_npz},
                                 {".obj", OF_BODY, FRAME, write_obj},
                                 {".ply", OF_BODY, FRAME, write_ply},
                                 {".glb", OF_BODY, FRAME | FRAMES | FIELD, write_glb},
                                 {".stl", OF_BODY, FRAME | LEVELS | PER, write_parts},
                                 {".3mf", OF_BODY, FRAME | LEVELS | PER, write_parts},
                                 {".svg", OF_DRAWING, PLOTTER | SPLIT, write_drawing},
                                 {".gcode", OF_DRAWING, PLOTTER | SPLIT, write_drawing},
                                 {".ngc", OF_DRAWING, PLOTTER | SPLIT, write_drawing},
                                 {".nc", OF_DRAWING, PLOTTER | SPLIT, write_drawing},
                                 {".hpgl", OF_DRAWING, PLOTTER | SPLIT, write_drawing},
                                 {".plt", OF_DRAWING, PLOTTER | SPLIT, write_drawing},
                                 {".vtkhdf", OF_RUN, 0, NULL}};

enum { FORMATS = sizeof formats / sizeof *formats };

static const Format *format_of(const char *path, Error *err)
{
    for (int k = 0; k < FORMATS; k++)
        if (path_has_ending(path, formats[k].ending)) return &formats[k];
    error_set(
        err,
        "%s: numbers are exported as .csv, with --dataset, a mesh as .obj, a drawing as .svg, "
        ".gcode, .ngc, .nc, .hpgl or .plt, a run as .vtkhdf; further .glb, .ply, .stl, .3mf (bodies) and "
        ".npz (all numbers); slender picture draws .png, .svg and .pdf",
        path);
    return NULL;
}

static unsigned options_given(const Export *what)
{
    return (what->probes ? PROBES : 0) | (what->dataset ? DATASET : 0) | (what->per ? PER : 0) |
           (what->how.frame >= 0 ? FRAME : 0) | (what->how.frames ? FRAMES : 0) |
           (what->how.field ? FIELD : 0) | (what->levels ? LEVELS : 0) | (what->language ? PLOTTER : 0) |
           (what->split.pens || what->split.ink > 0 ? SPLIT : 0);
}

/* False and a sentence for an option that the format does not use, and for two that exclude each other. */
static bool check_options(const Export *what, const Format *format, Error *err)
{
    static const struct {
        unsigned option;
        const char *is;
    } uses[] = {
        {PER, "--per group is for a CSV of a result's groups, -o FILE.csv, or parts to print, .stl or .3mf,"},
        {PROBES, "--probes is for a table of them, -o FILE.csv,"},
        {DATASET, "--dataset is for numbers, -o FILE.csv,"},
        {FRAME, "--frame is for a mesh, -o FILE.obj, .ply, .glb, .stl or .3mf,"},
        {FRAMES, "--frames is for a body that moves, -o FILE.glb,"},
        {FIELD, "--field is for a body in colours, -o FILE.glb,"},
        {LEVELS, "--levels is for parts to print, -o FILE.stl or .3mf,"},
        {PLOTTER, "--plotter is for a drawing, -o FILE.gcode,"},
        {SPLIT, "--split is for a drawing, -o FILE.gcode,"}};
    static const struct {
        unsigned both;
        const char *names;
    } pairs[] = {{PER | DATASET, "--per and --dataset"},
                 {PER | PROBES, "--per and --probes"},
                 {DATASET | PROBES, "--dataset and --probes"},
                 {PER | LEVELS, "--per and --levels"},
                 {FRAME | FRAMES, "--frame and --frames"}};
    unsigned given = options_given(what);
    for (size_t k = 0; k < sizeof pairs / sizeof *pairs; k++)
        if ((given & pairs[k].both) == pairs[k].both)
            return error_set(err, "%s exclude each other", pairs[k].names);
    for (size_t k = 0; k < sizeof uses / sizeof *uses; k++)
        if (given & uses[k].option & ~format->takes)
            return error_set(err, "%s and is not used here", uses[k].is);
    return true;
}

/* A body's formats, and a drawing's; a drawing's own code says what a drawing can be. */
static RunStatus write_export(Result *result, const Format *format, const Export *what, Error *err)
{
    if (format->of != OF_ALL && drawn_has(result)) return write_drawing(result, what, err);
    if (format->of == OF_ALL || format->of == OF_BODY) return format->write(result, what, err);
    if (options_given(what) & SPLIT) {
        error_set(err, "--split is for a drawing, and the result has none");
        return RUN_USAGE;
    }
    error_set(err, "%s: a mesh is exported as .obj, .ply, .glb, .stl or .3mf", what->output);
    return RUN_REFUSED;
}

static RunStatus export_result(const Export *what, Error *err)
{
    const char *input = what->input;
    Result *result = result_open(input, err);
    if (!result) return RUN_REFUSED;
    RunStatus status = RUN_CANNOT_WRITE;
    if (may_write(&(Source){result, input, what->force}, what->output, err)) {
        const Format *format = format_of(what->output, err);
        bool ok = format && check_options(what, format, err);
        status = ok ? write_export(result, format, what, err) : RUN_USAGE;
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

static RunStatus export_journal(const Export *what, Error *err)
{
    const char *input = what->input, *path = what->output;
    const Format *format = format_of(path, NULL);
    if (!format || format->of != OF_RUN) {
        error_set(err, "%s: a run is exported as .vtkhdf, and that as other files", path);
        return RUN_CANNOT_WRITE;
    }
    if (what->dataset) {
        error_set(err, "--dataset is not used with a run: export its result first");
        return RUN_USAGE;
    }
    if (!check_options(what, format, err)) return RUN_USAGE;
    char *sidecar = result_sidecar(path);
    bool free = outputs_check_source(NULL, input, sidecar, err) && replace_check(sidecar, err);
    mem_free(sidecar);
    if (!free || !mark_check(path, what->force, err)) return RUN_CANNOT_WRITE;
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
        "       slender export NAME.vtkhdf -o FILE.csv --probes     the table of the scene's probes\n"
        "       slender export NAME.vtkhdf -o FILE.csv --per group  of each named group |M|, azimuth, "
        "elevation\n"
        "       slender export NAME.vtkhdf -o FILE.npz              all numbers and frames, for numpy.load\n"
        "       slender export NAME.vtkhdf -o FILE.obj [--frame N]  a mesh with its groups; default: the "
        "final "
        "state\n"
        "       slender export NAME.vtkhdf -o FILE.ply [--frame N]  a mesh with the frame's numbers\n"
        "       slender export NAME.vtkhdf -o FILE.glb [--field NAME] [--frames N | --frame N]  a mesh or "
        "rods, moving, with what is\n"
        "              around, for viewers and Blender; colours as those of slender picture; 60 frames at "
        "most, "
        "or N\n"
        "       slender export NAME.vtkhdf -o FILE.stl | .3mf [--levels N | --per group] [--frame N]  a "
        "closed "
        "volume to print, mm; at\n"
        "              rest, or in a frame; with --levels one for each of N levels of |M|, with --per group "
        "for "
        "each group:\n"
        "              FILE_1.stl, .., or parts of one .3mf\n"
        "       slender export NAME.vtkhdf -o FILE.svg | .gcode | .hpgl [--plotter gcode | gcode_servo | "
        "hpgl | profile | PROFILE.yaml]  a "
        "drawing;\n"
        "              --split pen, or --split \"5 m\": a file for each pen, or for so much ink, "
        "FILE_1.gcode, ..\n"
        "       slender export NAME.run -o NAME.vtkhdf              the result of a running or interrupted "
        "job\n"
        "  --force    replaces files of these names that slender has not made; .csv, .gcode and .hpgl are "
        "replaced "
        "without";
    Export what = {.how = {.frame = -1}};
    int code;
    const char *endings[FORMATS + 1] = {NULL};
    for (int k = 0; k < FORMATS; k++) endings[k] = formats[k].ending;
    const Option options[] = {
        {"output", .letter = 'o', .kind = OPTION_TEXT, .value = &what.output, .words = endings},
        {"dataset", .kind = OPTION_TEXT, .value = &what.dataset, .words = OPTION_WORDS("DATASET")},
        {"probes", .value = &what.probes},
        {"per", .kind = OPTION_CHOICE, .value = &what.per, .words = OPTION_WORDS("group")},
        {"frame", .kind = OPTION_INT, .value = &what.how.frame, .least = 0, .most = INT_MAX},
        {"frames", .kind = OPTION_INT, .value = &what.how.frames, .least = 1, .most = 10000},
        {"field", .kind = OPTION_TEXT, .value = &what.how.field, .words = OPTION_WORDS("FIELD", "none")},
        {"levels", .kind = OPTION_INT, .value = &what.levels, .least = 1, .most = 100},
        {"plotter", .kind = OPTION_TEXT, .value = &what.language,
         .words = OPTION_WORDS("gcode", "gcode_servo", "hpgl", "profile", ".yaml")},
        {"split", .kind = OPTION_OTHER, .value = &what.split, .take = drawing_split_take,
         .allowed = DRAWING_SPLIT_ALLOWED, .words = OPTION_WORDS("pen")},
        {"force", .value = &what.force}};
    if (!options_parse(argc, argv, usage, options, sizeof options / sizeof *options, &what.input, &code))
        return code;
    if (!what.output) return verb_fail(RUN_USAGE, "-o FILE must be given; slender export --help says more");
    Error err;
    if (!outputs_check_source(NULL, what.input, what.output, &err))
        return verb_fail(RUN_CANNOT_WRITE, err.text);
    bool run = path_has_ending(what.input, ".run");
    RunStatus status = run ? export_journal(&what, &err) : export_result(&what, &err);
    return status == RUN_DONE ? RUN_DONE : verb_fail(status, err.text);
}
