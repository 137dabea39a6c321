#include "spline/spacing.h"
#include "base/cubic.h"
#include "base/memory.h"
#include "spline/near.h"
#include "spline/smooth.h"
#include <math.h>

static const double TARGET_SIGMA = 0.02, TARGET_LEAST = 0.03, CROWDED = 0.35;

enum { PIXELS_PER_SIGMA = 4 };

static int pixel_count(double length)
{
    return (int)fmax(2, ceil(PIXELS_PER_SIGMA * length / TARGET_SIGMA));
}

SplineSpacing spacing_create(const SplinePage *page, const SplineGrid *target)
{
    SplineSpacing spacing = {
        .page = *page, .columns = pixel_count(page->width), .rows = pixel_count(page->height)};
    spacing.density = mem_alloc((size_t)spacing.columns * (size_t)spacing.rows, sizeof(double));
    smooth_resample(target, spacing.columns, spacing.rows, spacing.density);
    double wide[2] = {TARGET_SIGMA * spacing.columns / page->width,
                      TARGET_SIGMA * spacing.rows / page->height};
    double sigma[2] = {sqrt(wide[0] * wide[0] - 1.0 / 12), sqrt(wide[1] * wide[1] - 1.0 / 12)};
    smooth_blur(spacing.density, spacing.columns, spacing.rows, sigma, SMOOTH_EXTEND);
    return spacing;
}

void spacing_clear(SplineSpacing *spacing)
{
    mem_free(spacing->density);
    *spacing = (SplineSpacing){0};
}

/* The distance of lines that gives the target's tone there. */
static double wanted_at(const SplineSpacing *spacing, Vec2 p)
{
    double x = fmin(fmax(p.x / spacing->page.width * spacing->columns - 0.5, 0), spacing->columns - 1);
    double y = fmin(fmax(p.y / spacing->page.height * spacing->rows - 0.5, 0), spacing->rows - 1);
    int i = (int)fmin(x, spacing->columns - 2), j = (int)fmin(y, spacing->rows - 2);
    const double *low = spacing->density + (size_t)j * (size_t)spacing->columns + i,
                 *high = low + spacing->columns;
    double u = x - i, v = y - j;
    double density = (1 - v) * ((1 - u) * low[0] + u * low[1]) + v * ((1 - u) * high[0] + u * high[1]);
    return spacing->page.pen / fmax(density, TARGET_LEAST);
}

/* Points along strokes, and whose they are. */
typedef struct Samples {
    int count, room;
    Vec2 *at;
    int *stroke;
} Samples;

static void add_sample(Samples *samples, Vec2 at, int stroke)
{
    if (samples->count == samples->room) {
        size_t old = (size_t)samples->count, room = 2 * old + 1024;
        samples->at = mem_resize(samples->at, old, room, sizeof *samples->at);
        samples->stroke = mem_resize(samples->stroke, old, room, sizeof *samples->stroke);
        samples->room = (int)room;
    }
    samples->at[samples->count] = at;
    samples->stroke[samples->count++] = stroke;
}

/* Points in equal steps of length from one end to the other, half a pen width or a little more. */
static void sample_stroke(Samples *samples, const Strokes *strokes, int stroke, double pen)
{
    double length = strokes_stroke_length(strokes, stroke), done = 0;
    int steps = (int)fmax(1, floor(length / (0.5 * pen))), next = 0;
    Vec2 c[4];
    for (int node = strokes->start[stroke]; node < strokes->start[stroke + 1] - 1; node++) {
        strokes_bezier(strokes, node, c);
        int chords = cubic_steps(c, 0.01 * pen);
        Vec2 at = c[0];
        for (int i = 1; i <= chords; i++) {
            Vec2 to = cubic_at(c, (double)i / chords);
            double chord = hypot(to.x - at.x, to.y - at.y);
            for (; next < steps && next * length / steps <= done + chord; next++) {
                double s = chord > 0 ? (next * length / steps - done) / chord : 0;
                add_sample(samples, (Vec2){at.x + s * (to.x - at.x), at.y + s * (to.y - at.y)}, stroke);
            }
            done += chord;
            at = to;
        }
    }
    add_sample(samples, c[3], stroke);
}

void spacing_measure(const SplineSpacing *spacing, const Strokes *strokes, double *mean, double *cv,
                     double *crowded)
{
    Samples samples = {0};
    double sum = 0, squares = 0, near_by = 0, count = 0;
    *mean = *cv = *crowded = 0;
    if (strokes->count < 2) return;
    for (int k = 0; k < strokes->count; k++) sample_stroke(&samples, strokes, k, spacing->page.pen);
    Near *near = near_create(samples.at, samples.stroke, samples.count);
    for (int k = 0; k < samples.count; k += 4) {
        int other;
        if (!near_find(near, samples.at[k], samples.stroke[k], INFINITY, 1, &other)) continue;
        double ratio = hypot(samples.at[other].x - samples.at[k].x, samples.at[other].y - samples.at[k].y) /
                       wanted_at(spacing, samples.at[k]);
        sum += ratio;
        squares += ratio * ratio;
        near_by += ratio < CROWDED;
        count++;
    }
    near_destroy(near);
    mem_free(samples.at);
    mem_free(samples.stroke);
    *mean = sum / count;
    if (*mean > 0) *cv = sqrt(fmax(squares / count - *mean * *mean, 0)) / *mean;
    *crowded = near_by / count;
}
