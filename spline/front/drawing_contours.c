#include "spline/front/drawing_contours.h"
#include "spline/coverage.h"
#include "spline/direction.h"
#include "model/build.h"
#include <math.h>
#include <string.h>

static const double SHORTEST = 10; /* pens */

/* Segments as of the first part's strokes: those that the tone sees well. */
SplineEdgeDef drawing_contours_def(const Drawing *d, const ContoursScene *scene)
{
    double unit = d->page.unit, pen = d->pens[d->pen_count].width;
    SplineGrid tone = spline_grid(&d->tones[0]);
    SplineEdgeDef def = {.detail = spline_direction_default(&d->page).detail,
                         .contrast = scene->levels_count ? 0 : scene->contrast,
                         .shortest = SHORTEST * pen,
                         .margin = pen / 2};
    if (!isnan(scene->detail)) def.detail = scene->detail / unit;
    if (!isnan(scene->shortest)) def.shortest = scene->shortest / unit;
    if (d->region_count) def.outline = spline_grid(&d->outline);
    def.segment = spline_segment_length(relax_default().rest, spline_line_distance(&tone, &d->page));
    return def;
}

bool drawing_check_levels(const ContoursScene *scene, YamlFile *file)
{
    for (int k = 0; k < scene->levels_count; k++)
        for (int other = 0; other < k; other++)
            if (scene->levels[other] == scene->levels[k])
                return yaml_refuse(file, key("spline.contours.levels[%d]", k).text,
                                   "%g is there twice, and would draw its lines twice", scene->levels[k]);
    return true;
}

static void cover_contours(Drawing *d)
{
    const SplineField *tone = &d->tones[0];
    Coverage coverage = coverage_create(&d->page, tone->columns, tone->rows);
    coverage_draw(&coverage, &d->contours, d->pens[d->pen_count].width);
    d->contoured = spline_field_like(tone, 1);
    memcpy(d->contoured.values, coverage.mean,
           (size_t)tone->columns * (size_t)tone->rows * sizeof *coverage.mean);
    coverage_clear(&coverage);
}

void drawing_find_contours(Drawing *d, const ContoursScene *scene, const SplineEdgeDef *def,
                           const SplineField *tone)
{
    if (!scene->levels_count) spline_edge_strokes(tone, &d->page, def, d->pen_count, &d->contours);
    for (int k = 0; k < scene->levels_count; k++)
        spline_level_strokes(tone, &d->page, def, scene->levels[k], d->pen_count, &d->contours);
    if (d->contours.count) cover_contours(d);
}
