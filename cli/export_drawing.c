#include "cli/export_drawing.h"
#include "base/memory.h"
#include "cli/say.h"
#include "io/path.h"
#include "io/plot_split.h"
#include "io/yaml.h"
#include "spline/drawn.h"
#include <string.h>

bool drawing_split_take(void *self, const char *text)
{
    DrawingSplit *split = self;
    double length = 0;
    split->pens = !strcmp(text, "pen");
    if (!split->pens && (!yaml_number(text, "m", &length) || !(length > 0))) return false;
    split->ink = 1e3 * length;
    return true;
}

/* Of the endings a language, and the others of it. */
static const struct {
    const char *ending, *language, *all;
} endings[] = {{".svg", "svg", ".svg"},
               {".gcode", "gcode", ".gcode, .ngc or .nc"},
               {".ngc", "gcode", ".gcode, .ngc or .nc"},
               {".nc", "gcode", ".gcode, .ngc or .nc"},
               {".hpgl", "hpgl", ".hpgl or .plt"},
               {".plt", "hpgl", ".hpgl or .plt"}};

enum { ENDINGS = sizeof endings / sizeof *endings };

static const char *usual_language(const char *path)
{
    for (int k = 0; k < ENDINGS; k++)
        if (path_has_ending(path, endings[k].ending)) return endings[k].language;
    return NULL;
}

static bool is_kind_of(const char *language, const char *usual)
{
    return !strcmp(language, usual) || (!strcmp(language, "gcode_servo") && !strcmp(usual, "gcode"));
}

/* No language under another one's ending; a profile's words are any but SVG's. */
static bool check_ending(const char *language, const char *usual, const char *path, Error *err)
{
    const char *all = NULL;
    for (int k = 0; k < ENDINGS; k++)
        if (is_kind_of(language, endings[k].language)) all = endings[k].all;
    if (all ? is_kind_of(language, usual) : strcmp(usual, "svg") != 0) return true;
    return error_set(err, "%s: --plotter %s is for a file of another ending: %s", path, language,
                     all ? all : ".gcode, .ngc, .nc, .hpgl or .plt");
}

/* ---- Several files ---- */

/* "a_2.gcode: black, contours: 12 strokes, 3.1 m of ink, about 4.2 min" */
static void say_part(const char *path, const Plot *plot, const Plotter *plotter)
{
    PlotEstimate sum = {0};
    char *pens = mem_text("");
    int strokes = 0;
    for (int k = 0; k < plot->layer_count; k++) {
        const PlotLayer *layer = &plot->layers[k];
        if (!layer->count) continue;
        PlotEstimate one = plot_estimate(layer, plotter);
        sum.ink += one.ink, sum.seconds += one.seconds, strokes += layer->count;
        char *next = mem_format("%s%s", *pens ? ", " : "", layer->name);
        pens = mem_join(pens, next, "");
        mem_free(next);
    }
    say(stdout, "%s: %s: %d stroke%s, %.3g m of ink, about %.2g min", path, pens, strokes,
        strokes == 1 ? "" : "s", 1e-3 * sum.ink, sum.seconds / 60);
    mem_free(pens);
}

static RunStatus write_parts(const Drawn *drawn, const PlotParts *parts, const char *language,
                             const char *path, FurtherFiles further, Error *err)
{
    bool ok = parts->count > 0 || error_set(err, "the drawing has no strokes to --split");
    if (parts->count > FURTHER_FILES_MOST) {
        error_set(err, "--split would make %d files, and %d are the most: say more ink for each",
                  parts->count, FURTHER_FILES_MOST);
        return RUN_USAGE;
    }
    ok = ok && further_files_allow(further, path, parts->count, err);
    for (int k = 0; ok && k < parts->count; k++) {
        char *name = path_numbered(path, k + 1);
        ok = drawn_write_plot(drawn, &parts->plots[k], language, name, err);
        if (ok) say_part(name, &parts->plots[k], &drawn->plotter);
        mem_free(name);
    }
    return ok ? RUN_DONE : RUN_CANNOT_WRITE;
}

static RunStatus write_split(const Drawn *drawn, const char *language, DrawingSplit split, const char *path,
                             FurtherFiles further, Error *err)
{
    PlotParts parts = split.pens ? plot_split_pens(&drawn->plot) : plot_split_ink(&drawn->plot, split.ink);
    RunStatus status = write_parts(drawn, &parts, language, path, further, err);
    plot_parts_clear(&parts);
    return status;
}

RunStatus export_drawing(Result *result, const char *language, DrawingSplit split, const char *path,
                         FurtherFiles further, Error *err)
{
    Drawn drawn = {0};
    const char *usual = usual_language(path);
    if (!usual) {
        error_set(
            err,
            "%s: a drawing is exported as .svg, .gcode or .hpgl, numbers as .csv, with --dataset, and .npz",
            path);
        return RUN_REFUSED;
    }
    if (!language) language = usual;
    RunStatus status = RUN_CANNOT_WRITE;
    if (!drawn_read(result, &drawn, err))
        status = RUN_REFUSED;
    else if (!drawn_check_language(&drawn, language, err) || !check_ending(language, usual, path, err))
        status = RUN_USAGE;
    else if (split.pens || split.ink > 0)
        status = write_split(&drawn, language, split, path, further, err);
    else if (drawn_write_plot(&drawn, &drawn.plot, language, path, err))
        status = RUN_DONE;
    drawn_clear(&drawn);
    return status;
}
