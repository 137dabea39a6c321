#include "spline/ink_seen.h"
#include "base/memory.h"
#include "spline/coverage.h"
#include <math.h>

static const double SIGMA = 1.5; /* mean distances of lines, as of metrics.h */

/* The mean colour of a block, over all of its pixels. */
static Vec3 block_color(const InkSet *set, const Coverage *layers, int row, int column)
{
    int side = layers->block, across = layers->columns * side;
    Vec3 sum = vec3(0, 0, 0);
    for (int i = 0; i < side * side; i++) {
        size_t pixel = (size_t)(row * side + i / side) * (size_t)across + (size_t)(column * side + i % side);
        double cover[INK_MAX];
        for (int k = 0; k < set->count; k++) cover[k] = layers[k].ink[pixel] / 255.0;
        sum = vec3_add(sum, ink_mix(set, cover));
    }
    return vec3_scale(1.0 / (side * side), sum);
}

/* What the strokes show, in the pixels of `like`, less the paper. */
static SplineField shown(const InkSet *set, const SplinePage *page, const double *widths,
                         const Strokes *strokes, const SplineField *like)
{
    Coverage layers[INK_MAX];
    SplineField field = spline_field_like(like, 3);
    for (int k = 0; k < set->count; k++) {
        Strokes own = strokes_of_layer(strokes, k);
        layers[k] = coverage_create(page, like->columns, like->rows);
        coverage_draw(&layers[k], &own, widths[k]);
        strokes_clear(&own);
    }
    for (int i = 0; i < like->rows; i++)
        for (int j = 0; j < like->columns; j++)
            vec3_store(spline_field_pixel(&field, i, j),
                       vec3_sub(block_color(set, layers, i, j), set->paper));
    for (int k = 0; k < set->count; k++) coverage_clear(&layers[k]);
    return field;
}

double ink_seen_error(const InkSet *set, const SplinePage *page, const double *widths, const Strokes *strokes,
                      const SplineField *light)
{
    SplineField want = spline_field_copy(light), got = shown(set, page, widths, strokes, light);
    double length = strokes_length(strokes), sum = 0;
    int pixels = light->columns * light->rows;
    if (length > 0) {
        double sigma = fmin(SIGMA / length, fmin(page->width, page->height) / 4);
        spline_field_blur(&want, page, sigma);
        spline_field_blur(&got, page, sigma);
    }
    for (int i = 0; i < pixels; i++)
        sum += ink_difference(vec3_add(set->paper, vec3_load(want.values + 3 * i)),
                              vec3_add(set->paper, vec3_load(got.values + 3 * i)));
    spline_field_clear(&want);
    spline_field_clear(&got);
    return sum / pixels;
}
