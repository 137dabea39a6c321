#include "spline/front/drawing_regions.h"
#include "base/memory.h"
#include "io/canvas.h"
#include "io/polyline_file.h"
#include "model/build.h"
#include "spline/contour.h"
#include "spline/smooth.h"
#include <math.h>
#include <string.h>
#include <strings.h>

/* Where a region comes from, and the pixels that it becomes. */
typedef struct Reader {
    const RegionScene *from;
    const SplinePage *page;
    const SplineToneDef *tone;
    double pixel;
} Reader;

/* ---- From files ---- */

/* Of the shapes of a file: places in pixels of the cover, by x' = scale (x - middle) + shift. */
typedef struct Placement {
    double middle[2], scale, shift[2];
} Placement;

/* A file's y goes up, the page's down. */
static Placement place_shapes(const Reader *r, const PolylineFile *lines, double per_unit)
{
    const SplinePage *page = r->page;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    if (r->from->fit == REGION_PAPER)
        return (Placement){{0, 0},
                           per_unit / page->unit,
                           {-per_unit * page->left / page->unit, -per_unit * page->top / page->unit}};
    for (int k = 0; k < lines->point_count; k++) {
        double at[2] = {lines->points[k].x, -lines->points[k].y};
        for (int i = 0; i < 2; i++) low[i] = fmin(low[i], at[i]), high[i] = fmax(high[i], at[i]);
    }
    double scale = per_unit * fmin(page->width / (high[0] - low[0]), page->height / (high[1] - low[1]));
    return (Placement){{(low[0] + high[0]) / 2, (low[1] + high[1]) / 2},
                       scale,
                       {per_unit * page->width / 2, per_unit * page->height / 2}};
}

/* Cairo counts how much of each pixel the shapes cover. */
static bool draw_shapes(const Reader *r, const PolylineFile *lines, SplineField *cover, Error *err)
{
    *cover = spline_field_create(r->page, r->pixel, 1);
    Placement to = place_shapes(r, lines, cover->columns / r->page->width);
    Canvas *canvas = canvas_create("region.png", cover->columns, cover->rows, 1, err);
    if (!canvas) return false;
    Vec2 *points = mem_alloc((size_t)lines->point_count, sizeof *points);
    for (int k = 0; k < lines->point_count; k++)
        points[k] = (Vec2){to.scale * (lines->points[k].x - to.middle[0]) + to.shift[0],
                           to.scale * (-lines->points[k].y - to.middle[1]) + to.shift[1]};
    canvas_rings(canvas, points, lines->first, lines->strand_count, (Color){0, 0, 0, 1});
    int width, height, stride;
    const unsigned char *pixels = canvas_pixels(canvas, &width, &height, &stride);
    for (int i = 0; i < height; i++)
        for (int j = 0; j < width; j++)
            *spline_field_pixel(cover, i, j) = 1 - pixels[(size_t)i * (size_t)stride + 4 * (size_t)j] / 255.0;
    mem_free(points);
    canvas_destroy(canvas);
    return true;
}

static bool read_svg(const Reader *r, SplineField *cover, Error *err)
{
    const char *path = r->from->svg, *ending = strrchr(path, '.');
    PolylineFile lines;
    if (!ending || strcasecmp(ending, ".svg"))
        return error_set(err, "%s: an .svg file is expected here; a picture is a `mask`", path);
    bool ok = polyline_file_read(path, &lines, err) && draw_shapes(r, &lines, cover, err);
    polyline_file_clear(&lines);
    for (int i = 0; ok && r->from->invert && i < cover->columns * cover->rows; i++)
        cover->values[i] = 1 - cover->values[i];
    return ok;
}

/* As a picture whose white is drawn; beside it is nothing. */
static bool read_mask(const Reader *r, SplineField *cover, Error *err)
{
    SplineToneDef def = spline_tone_default();
    Image grey;
    double useful[2];
    memcpy(def.crop, r->tone->crop, sizeof def.crop);
    def.cover = r->tone->cover;
    def.invert = !r->from->invert;
    def.density = 1;
    spline_tone_useful(r->page, &def, r->pixel, useful);
    if (!image_read_useful(r->from->mask, useful, &grey, NULL, err)) return false;
    *cover = spline_tone(&grey, r->page, &def, r->pixel);
    image_clear(&grey);
    return true;
}

/* ---- All of them ---- */

static double largest(const SplineField *field)
{
    double most = 0;
    for (int i = 0; i < field->columns * field->rows; i++) most = fmax(most, field->values[i]);
    return most;
}

/* The number of the pen that it names; -1: none. */
static int find_pen(const Drawing *d, const char *name)
{
    int pen = d->pen_count - 1;
    while (pen >= 0 && strcmp(d->pens[pen].name, name)) pen--;
    return pen;
}

static bool read_pen(const Drawing *d, const RegionScene *from, Key at, YamlFile *file, DrawingRegion *region)
{
    region->pen = from->pen ? find_pen(d, from->pen) : -1;
    if (from->pen && region->pen < 0)
        return yaml_refuse(file, at.text, "no pen is called '%s'; the first one is '%s'", from->pen,
                           d->pens[0].name);
    return true;
}

/* What is inside, to a pixel: soft edges of a mask are none of the region's. */
static void sharpen(SplineField *cover, const SplineField *outline, const SplinePage *page)
{
    for (int i = 0; i < cover->columns * cover->rows; i++)
        cover->values[i] = fmin(fmax(0.5 + outline->values[i] * cover->columns / page->width, 0), 1);
}

/* `taken`: what earlier regions have of each pixel, and then this one too. */
static bool read_region(Drawing *d, const Reader *r, Key at, YamlFile *file, SplineField *taken)
{
    DrawingRegion *region = &d->regions[d->region_count++];
    Error err;
    if (!read_pen(d, r->from, at, file, region)) return false;
    if (!(r->from->svg ? read_svg : read_mask)(r, &region->cover, &err))
        return yaml_refuse(file, key("%s.%s", at.text, r->from->svg ? "svg" : "mask").text, "%s", err.text);
    if (!taken->columns) *taken = spline_field_like(&region->cover, 1);
    for (int i = 0; i < taken->columns * taken->rows; i++)
        region->cover.values[i] = fmin(region->cover.values[i], 1 - taken->values[i]);
    region->outline = spline_contour_distance(&region->cover, r->page);
    sharpen(&region->cover, &region->outline, r->page);
    spline_field_add(taken, &region->cover);
    return largest(&region->cover) >= 0.5 ||
           yaml_refuse(file, at.text, "nothing of the page is in this region%s",
                       d->region_count > 1 ? " that is not in an earlier one" : "");
}

/* Inside any of them. */
static void join_outlines(Drawing *d)
{
    d->outline = spline_field_copy(&d->regions[0].outline);
    for (int k = 1; k < d->region_count; k++)
        for (int i = 0; i < d->outline.columns * d->outline.rows; i++)
            d->outline.values[i] = fmax(d->outline.values[i], d->regions[k].outline.values[i]);
}

bool drawing_read_regions(Drawing *d, const SplineScene *scene, YamlFile *file, const SplineToneDef *tone,
                          double pixel)
{
    SplineField taken = {0};
    bool ok = true;
    d->regions = mem_alloc((size_t)scene->regions_count, sizeof *d->regions);
    for (int k = 0; ok && k < scene->regions_count; k++) {
        Reader reader = {&scene->regions[k], &d->page, tone, pixel};
        ok = read_region(d, &reader, key("spline.regions[%d]", k), file, &taken);
    }
    if (ok && d->region_count) join_outlines(d);
    spline_field_clear(&taken);
    return ok;
}

void drawing_mask(const Drawing *d, SplineField *field)
{
    SplineField drawn = spline_field_like(&d->regions[0].cover, 1);
    for (int k = 0; k < d->region_count; k++) spline_field_add(&drawn, &d->regions[k].cover);
    SplineField small = spline_field_like(field, 1);
    SplineGrid grid = spline_grid(&drawn);
    smooth_resample(&grid, small.columns, small.rows, small.values);
    spline_field_multiply(field, &small);
    spline_field_clear(&drawn);
    spline_field_clear(&small);
}
