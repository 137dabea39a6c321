#include "spline/drawn.h"
#include "base/memory.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double PAPER_MAX = 100; /* m */

bool drawn_has(Result *result)
{
    return result_has(result, "slender/spline/strokes");
}

/* A dataset of that type, and of so many numbers if count >= 0. */
static bool read_array(Result *result, const char *name, ArrayType type, int count, Array *array, Error *err)
{
    char path[64];
    snprintf(path, sizeof path, "slender/spline/%s", name);
    if (!result_read(result, path, array, err)) return false;
    if (array->type == type && (count < 0 || array_count(array) == (size_t)count)) return true;
    array_clear(array);
    return error_set(err, "%s is not as slender writes it", path);
}

static bool read_numbers(Result *result, const char *name, int count, double *values, Error *err)
{
    Array array;
    if (!read_array(result, name, ARRAY_FLOAT64, count, &array, err)) return false;
    memcpy(values, array.data, (size_t)count * sizeof *values);
    array_clear(&array);
    return true;
}

/* One for all in results of versions before. */
static bool read_margins(Result *result, double margin[2], Error *err)
{
    if (result_has(result, "slender/spline/margins")) return read_numbers(result, "margins", 2, margin, err);
    if (!read_numbers(result, "margin", 1, margin, err)) return false;
    margin[1] = margin[0];
    return true;
}

static bool read_page(Result *result, Drawn *drawn, Error *err)
{
    double paper[2], margin[2];
    if (!read_numbers(result, "paper", 2, paper, err) || !read_margins(result, margin, err)) return false;
    for (int k = 0; k < 2; k++)
        if (!(paper[k] > 2 * fmax(margin[k], 0) && paper[k] < PAPER_MAX && margin[k] >= 0))
            return error_set(err, "spline/paper and spline/margins leave no page");
    drawn->page = spline_page_margins(paper, margin[0], margin[1], 0);
    return true;
}

/* Two commands, a line each. */
static bool read_servo(Result *result, Plotter *plotter, Error *err)
{
    Array text;
    if (!read_array(result, "servo", ARRAY_TEXT, -1, &text, err)) return false;
    char *to[] = {plotter->servo_up, plotter->servo_down}, *rest = NULL;
    bool ok = true;
    for (int k = 0; ok && k < 2; k++) {
        const char *line = strtok_r(k ? NULL : (char *)text.data, "\n", &rest);
        ok = line && plotter_is_command(line);
        if (ok) strcpy(to[k], line);
    }
    array_clear(&text);
    return ok || error_set(err, "spline/servo is not as slender writes it");
}

/* Results of versions that knew no more of plotters than their speeds have the default's other numbers. */
static bool read_plotter(Result *result, Plotter *plotter, Error *err)
{
    double speed[2], z[3];
    *plotter = plotter_default();
    if (!read_numbers(result, "speed", 2, speed, err) ||
        !read_numbers(result, "lift", 1, &plotter->lift, err))
        return false;
    plotter->down = 1e3 * speed[0], plotter->up = 1e3 * speed[1];
    if (!result_has(result, "slender/spline/servo")) return plotter_check(plotter, err);
    if (!read_numbers(result, "z", 3, z, err) || !read_numbers(result, "pause", 1, &plotter->pause, err) ||
        !read_servo(result, plotter, err))
        return false;
    plotter->z_up = 1e3 * z[0], plotter->z_down = 1e3 * z[1], plotter->z_speed = 1e3 * z[2];
    return plotter_check(plotter, err);
}

/* Results of versions that knew no other have white paper and inks that are not opaque. */
static bool read_paper(Result *result, Drawn *drawn, Error *err)
{
    double color[] = {1, 1, 1};
    Array opaque;
    bool told = result_has(result, "slender/spline/paper_color");
    if (told && !read_numbers(result, "paper_color", 3, color, err)) return false;
    drawn->paper = (Color){color[0], color[1], color[2], 1};
    if (!told) return true;
    if (!read_array(result, "opaque", ARRAY_INT32, drawn->pen_count, &opaque, err)) return false;
    for (int k = 0; k < drawn->pen_count; k++) drawn->pens[k].opaque = ((const int *)opaque.data)[k];
    array_clear(&opaque);
    return true;
}

static bool read_pens(Result *result, Drawn *drawn, Error *err)
{
    Array names, width, color;
    if (!read_array(result, "width", ARRAY_FLOAT64, -1, &width, err)) return false;
    int count = (int)array_count(&width);
    drawn->pens = mem_alloc((size_t)count, sizeof *drawn->pens);
    drawn->pen_count = count;
    bool ok = read_array(result, "color", ARRAY_FLOAT64, 3 * count, &color, err);
    for (int k = 0; ok && k < count; k++) {
        const double *rgb = (const double *)color.data + 3 * k;
        drawn->pens[k].width = ((const double *)width.data)[k] / drawn->page.unit;
        drawn->pens[k].color = (Color){rgb[0], rgb[1], rgb[2], 1};
    }
    if (ok) array_clear(&color);
    array_clear(&width);
    if (!ok || !read_array(result, "names", ARRAY_TEXT, -1, &names, err)) return false;
    char *rest = NULL, *name = strtok_r((char *)names.data, "\n", &rest);
    for (int k = 0; k < count; k++, name = strtok_r(NULL, "\n", &rest)) {
        drawn->pens[k].name = mem_text(name ? name : "");
        ok = ok && spline_pen_is_name(drawn->pens[k].name);
    }
    array_clear(&names);
    return ok || error_set(err, "spline/names is not as slender writes it");
}

static bool check_layers(const int *layer, int strokes, int pens, Error *err)
{
    for (int k = 0; k < strokes; k++)
        if (layer[k] < 0 || layer[k] >= pens)
            return error_set(err, "spline/pen names pens that there are not");
    return true;
}

/* Offsets that grow from 0 to the number of nodes, two nodes a stroke at least. */
static bool check_offsets(const int *start, int strokes, int nodes, Error *err)
{
    bool ok = start[0] == 0 && start[strokes] == nodes;
    for (int k = 0; ok && k < strokes; k++) ok = start[k + 1] >= start[k] + 2 && start[k + 1] <= nodes;
    return ok || error_set(err, "the offsets spline/strokes do not fit its nodes");
}

static bool read_strokes(Result *result, const Drawn *drawn, Strokes *strokes, Error *err)
{
    Array start, nodes, pen;
    if (!read_array(result, "strokes", ARRAY_INT32, -1, &start, err)) return false;
    int count = (int)array_count(&start) - 1;
    if (count < 0)
        return array_clear(&start), error_set(err, "the offsets spline/strokes do not fit its nodes");
    strokes->start = (int *)start.data, start.data = NULL;
    array_clear(&start);
    if (!read_array(result, "nodes", ARRAY_FLOAT64, -1, &nodes, err)) return false;
    int node_count = (int)(array_count(&nodes) / 4);
    strokes->q = (double *)nodes.data, nodes.data = NULL;
    array_clear(&nodes);
    if (!read_array(result, "pen", ARRAY_INT32, count, &pen, err)) return false;
    strokes->layer = (int *)pen.data, pen.data = NULL;
    array_clear(&pen);
    if (!check_offsets(strokes->start, count, node_count, err) ||
        !check_layers(strokes->layer, count, drawn->pen_count, err))
        return false;
    const SplinePage *page = &drawn->page;
    strokes->count = count;
    for (int i = 0; i < node_count; i++) {
        double *q = strokes->q + 4 * i;
        q[0] = (q[0] - page->left) / page->unit, q[1] = (q[1] - page->top) / page->unit;
        q[2] /= page->unit, q[3] /= page->unit;
    }
    return true;
}

static bool read_picture(Result *result, SplineField *picture, Error *err)
{
    Array level;
    if (!read_array(result, "picture", ARRAY_INT32, -1, &level, err)) return false;
    int width = level.rank == 3 ? level.dims[2] : 1;
    bool ok = level.rank >= 2 && (width == 1 || width == 3) && level.dims[0] > 0 && level.dims[1] > 0;
    if (ok) {
        size_t count = array_count(&level);
        *picture = (SplineField){level.dims[1], level.dims[0], width, mem_alloc(count, sizeof(double))};
        for (size_t i = 0; i < count; i++) picture->values[i] = ((const int *)level.data)[i] / 255.0;
    }
    array_clear(&level);
    return ok || error_set(err, "spline/picture is not as slender writes it");
}

static bool read_profile(Result *result, char **profile, Error *err)
{
    Array text;
    if (!result_has(result, "slender/spline/profile")) return true;
    if (!read_array(result, "profile", ARRAY_TEXT, -1, &text, err)) return false;
    *profile = mem_text((const char *)text.data);
    array_clear(&text);
    return true;
}

bool drawn_read(Result *result, Drawn *drawn, Error *err)
{
    *drawn = (Drawn){0};
    if (!drawn_has(result)) return error_set(err, "the result has no drawing");
    bool ok = read_page(result, drawn, err) && read_plotter(result, &drawn->plotter, err) &&
              read_profile(result, &drawn->profile, err) && read_pens(result, drawn, err) &&
              read_paper(result, drawn, err) && read_picture(result, &drawn->picture, err) &&
              read_strokes(result, drawn, &drawn->strokes, err);
    if (ok)
        drawn->plot = spline_plot(&drawn->strokes, &drawn->page, drawn->pens, drawn->pen_count, drawn->paper);
    return ok;
}

void drawn_clear(Drawn *drawn)
{
    for (int k = 0; k < drawn->pen_count; k++) mem_free((char *)drawn->pens[k].name);
    mem_free(drawn->pens);
    strokes_clear(&drawn->strokes);
    spline_plot_clear(&drawn->plot);
    spline_field_clear(&drawn->picture);
    mem_free(drawn->profile);
    *drawn = (Drawn){0};
}

/* Names of languages have no dot. */
static bool is_profile_file(const char *language)
{
    return strchr(language, '.') || strchr(language, '/');
}

/* The words of a language; *owned: they are to be cleared. */
static bool profile_of(const Drawn *drawn, const char *language, PlotProfile *profile, bool *owned,
                       Error *err)
{
    bool own = !strcmp(language, "profile");
    *owned = own || is_profile_file(language);
    if (own && !drawn->profile) {
        *owned = false;
        return error_set(err, "the result has no profile of its own: its scene names none");
    }
    return own ? plot_profile_parse("spline/profile", drawn->profile, strlen(drawn->profile), profile, err)
           : *owned ? plot_profile_read(language, profile, err)
                    : plot_profile(language, profile, err);
}

bool drawn_check_language(const Drawn *drawn, const char *language, Error *err)
{
    PlotProfile profile;
    bool owned;
    if (!strcmp(language, "svg")) return true;
    bool ok = profile_of(drawn, language, &profile, &owned, err);
    if (owned) plot_profile_clear(&profile);
    return ok;
}

bool drawn_write(const Drawn *drawn, const char *language, const char *path, Error *err)
{
    return drawn_write_plot(drawn, &drawn->plot, language, path, err);
}

bool drawn_write_plot(const Drawn *drawn, const Plot *plot, const char *language, const char *path,
                      Error *err)
{
    PlotProfile profile;
    bool owned;
    if (!strcmp(language, "svg")) return plot_write_svg(path, plot, err);
    bool ok = profile_of(drawn, language, &profile, &owned, err) &&
              plot_write_machine(path, plot, &profile, &drawn->plotter, err);
    if (owned) plot_profile_clear(&profile);
    return ok;
}
