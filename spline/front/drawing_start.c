#include "spline/front/drawing_start.h"
#include "base/memory.h"
#include "io/polyline_file.h"
#include "io/result.h"
#include "spline/along.h"
#include "spline/drawn.h"
#include <math.h>
#include <string.h>
#include <strings.h>

/* ---- Lines of an SVG file ---- */

/* A file's y goes up, the page's down. */
static void add_lines(const PolylineFile *lines, const SplinePage *page, double segment, Strokes *strokes)
{
    Vec2 *points = mem_alloc((size_t)lines->point_count, sizeof *points);
    for (int k = 0; k < lines->point_count; k++)
        points[k] = (Vec2){(lines->points[k].x - page->left) / page->unit,
                           (-lines->points[k].y - page->top) / page->unit};
    for (int k = 0; k < lines->strand_count; k++)
        strokes_along(points + lines->first[k], lines->first[k + 1] - lines->first[k], segment, 0, strokes);
    mem_free(points);
}

static bool read_svg(const Drawing *d, const char *path, Strokes *strokes, Error *err)
{
    SplineGrid tone = spline_grid(&d->parts[0].tone);
    double rest = d->relax.rest > 0 ? d->relax.rest : relax_default().rest;
    PolylineFile lines;
    if (d->pen_count > 1)
        return error_set(err, "%s: lines of an SVG file have no pens; several start from a result", path);
    if (!polyline_file_read(path, &lines, err)) return false;
    add_lines(&lines, &d->page, spline_segment_length(rest, spline_line_distance(&tone, &d->parts[0].page)),
              strokes);
    polyline_file_clear(&lines);
    return true;
}

/* ---- A result ---- */

static bool check_pens(const Drawing *d, const Strokes *strokes, const char *path, Error *err)
{
    for (int k = 0; k < strokes->count; k++)
        if (strokes->layer[k] >= d->layer_count) /* contours are made anew */
            return error_set(err, "%s: it has strokes of pen %d, the scene has %d pen%s", path,
                             strokes->layer[k] + 1, d->layer_count, d->layer_count == 1 ? "" : "s");
    return true;
}

/* From its page to this one: both are places on paper. */
static void move_strokes(const Drawn *drawn, const SplinePage *page, Strokes *strokes)
{
    const SplinePage *old = &drawn->page;
    *strokes = strokes_copy(&drawn->strokes);
    for (int i = 0; i < 4 * strokes_node_count(strokes); i += 4) {
        double *q = strokes->q + i;
        q[0] = (old->left + old->unit * q[0] - page->left) / page->unit;
        q[1] = (old->top + old->unit * q[1] - page->top) / page->unit;
        for (int k = 2; k < 4; k++) q[k] *= old->unit / page->unit;
    }
}

static bool read_result(const Drawing *d, const char *path, Strokes *strokes, Error *err)
{
    Drawn drawn;
    Result *result = result_open(path, err);
    if (!result) return false;
    bool ok = drawn_read(result, &drawn, err);
    if (!ok) error_prefix(err, "%s", path);
    ok = ok && check_pens(d, &drawn.strokes, path, err);
    if (ok) move_strokes(&drawn, &d->page, strokes);
    drawn_clear(&drawn);
    result_close(result);
    return ok;
}

/* ---- Whose strokes they are ---- */

static double depth_in(const DrawingPart *part, Vec2 at)
{
    double depth = 0;
    if (!part->outline) return 0;
    SplineGrid outline = spline_grid(part->outline);
    spline_grid_sample(&outline, &part->page, at, &depth);
    return depth;
}

/* Of the parts of a stroke's pen the one whose region its middle is deepest in. */
static int part_of(const Drawing *d, const Strokes *strokes, int stroke)
{
    const double *q = strokes->q + 4 * ((strokes->start[stroke] + strokes->start[stroke + 1]) / 2);
    int best = -1;
    double most = -INFINITY;
    for (int k = 0; k < d->part_count; k++) {
        double depth = d->parts[k].pen == strokes->layer[stroke] ? depth_in(&d->parts[k], (Vec2){q[0], q[1]})
                                                                 : -INFINITY;
        if (depth > most) most = depth, best = k;
    }
    return best;
}

bool drawing_read_start(Drawing *d, const SplineScene *scene, YamlFile *file)
{
    const char *path = scene->start.file, *ending = strrchr(path, '.');
    bool svg = ending && !strcasecmp(ending, ".svg");
    Strokes all = {0};
    Error err;
    if (scene->cross)
        return yaml_refuse(file, "spline.start.file",
                           "strokes of a file do not say which of the crossed sets they are of");
    if (!svg && (!ending || strcasecmp(ending, ".vtkhdf")))
        return yaml_refuse(file, "spline.start.file", "%s: strokes are read from .svg and .vtkhdf files",
                           path);
    if (!(svg ? read_svg : read_result)(d, path, &all, &err))
        return yaml_refuse(file, "spline.start.file", "%s", err.text);
    for (int k = 0; k < all.count; k++) {
        int part = part_of(d, &all, k);
        if (part >= 0) strokes_add_from(&d->parts[part].given, &all, k);
    }
    strokes_clear(&all);
    d->start_given = true;
    return true;
}
