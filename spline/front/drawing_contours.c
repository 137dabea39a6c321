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
    bool edges = !scene->levels_count && scene->kind == CONTOURS_EDGES,
         outlines = !scene->levels_count && scene->kind == CONTOURS_OUTLINES;
    SplineEdgeDef def = {.detail = outlines ? d->page.pen / 2 : spline_direction_default(&d->page).detail,
                         .contrast = edges ? scene->contrast : 0,
                         .shortest = SHORTEST * pen,
                         .margin = pen / 2};
    if (!isnan(scene->detail)) def.detail = scene->detail / unit;
    if (!isnan(scene->shortest)) def.shortest = scene->shortest / unit;
    if (d->region_count && !outlines) def.outline = spline_grid(&d->outline);
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

/* Half a line inside, so that all of it is within its region. */
void drawing_find_outlines(Drawing *d, const SplineEdgeDef *def)
{
    for (int k = 0; k < d->region_count; k++)
        spline_level_strokes(&d->regions[k].outline, &d->page, def, d->pens[d->pen_count].width / 2,
                             d->pen_count, &d->contours);
    if (d->contours.count) cover_contours(d);
}

/* The pen with the most tone in a pixel; the first one where there is none. */
static int pen_at(const Drawing *d, int pixel)
{
    int most = 0;
    for (int k = 1; k < d->pen_count; k++)
        if (d->tones[k].values[pixel] > d->tones[most].values[pixel]) most = k;
    return most;
}

SplineField drawing_contours_counted(const Drawing *d, const SplineScene *scene, int pen,
                                     const DrawingRegion *region, int sets)
{
    if (!scene->separation && !region && sets == 1) return (SplineField){0};
    bool cmyk = scene->separation && scene->separation->kind == SEPARATE_CMYK,
         black = !strcmp(d->pens[pen].name, "black");
    SplineField counts = spline_field_like(&d->tones[pen], 1);
    for (int i = 0; i < counts.columns * counts.rows; i++) {
        bool own = cmyk ? black : !scene->separation || pen_at(d, i) == pen;
        counts.values[i] = own * (region ? region->cover.values[i] : 1) / sets;
    }
    return counts;
}
