/* energy_fixture.h - fields and random strokes for tests of energies and relaxation. */
#pragma once
#include "base/memory.h"
#include "base/random.h"
#include "spline/terms.h"
#include <math.h>

typedef double Surface(double x, double y);

/* A grid of so many pixels each way with `width` surfaces on it; the caller frees values. */
static inline SplineGrid grid_of(const SplinePage *page, int pixels, int width, Surface *const surface[])
{
    double *values = mem_alloc((size_t)(pixels * pixels * width), sizeof *values);
    for (int j = 0; j < pixels; j++)
        for (int i = 0; i < pixels; i++)
            for (int k = 0; k < width; k++)
                values[(j * pixels + i) * width + k] =
                    surface[k]((i + 0.5) / pixels * page->width, (j + 0.5) / pixels * page->height);
    return (SplineGrid){pixels, pixels, width, values};
}

static inline void clear_fields(SplineFields *fields)
{
    mem_free((void *)fields->density.values);
    mem_free((void *)fields->align.values);
    mem_free((void *)fields->potential.values);
    mem_free((void *)fields->flow.values);
    mem_free((void *)fields->outline.values);
}

/* Strokes of `segments` segments of length `rest` at random places and in random directions, slightly bent,
 * all on the page. */
static inline Strokes random_strokes(const SplinePage *page, int count, int segments, double rest,
                                     Random *random)
{
    Strokes strokes = {0};
    double(*q)[4] = mem_alloc((size_t)segments + 1, sizeof *q);
    while (strokes.count < count) {
        double x = page->width * random_uniform(random), y = page->height * random_uniform(random);
        double angle = M_PI * random_signed(random), turn = 0.2 * random_signed(random);
        bool inside = true;
        for (int k = 0; k <= segments; k++, angle += turn) {
            double c = rest * cos(angle), s = rest * sin(angle);
            q[k][0] = x, q[k][1] = y, q[k][2] = c / 3, q[k][3] = s / 3;
            inside = inside && fmin(x, page->width - x) > 0.01 && fmin(y, page->height - y) > 0.01;
            x += c, y += s;
        }
        if (inside) strokes_add(&strokes, segments + 1, (const double(*)[4])q, 0);
    }
    mem_free(q);
    return strokes;
}

static inline double *same_rest(const Strokes *strokes, double rest)
{
    int count = strokes_segment_count(strokes);
    double *values = mem_alloc((size_t)count, sizeof *values);
    for (int k = 0; k < count; k++) values[k] = rest;
    return values;
}
