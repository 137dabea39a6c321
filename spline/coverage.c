#include "spline/coverage.h"
#include "base/cubic.h"
#include "base/memory.h"
#include <string.h>

static const double PIXELS_PER_PEN = 4;

enum { SIDE_MOST = 8000 }; /* pixels of the fine raster */

Coverage coverage_create(const SplinePage *page, int columns, int rows)
{
    double block = fmax(page->width / columns, page->height / rows);
    int pixels = (int)ceil(PIXELS_PER_PEN * block / page->pen), longer = columns > rows ? columns : rows;
    if (pixels > SIDE_MOST / longer) pixels = SIDE_MOST / longer;
    if (pixels < 1) pixels = 1;
    size_t blocks = (size_t)columns * (size_t)rows;
    return (Coverage){.columns = columns,
                      .rows = rows,
                      .block = pixels,
                      .pixel = {page->width / (columns * pixels), page->height / (rows * pixels)},
                      .ink = mem_alloc(blocks * (size_t)pixels, (size_t)pixels),
                      .mean = mem_alloc(blocks, sizeof(double))};
}

void coverage_clear(Coverage *coverage)
{
    mem_free(coverage->ink);
    mem_free(coverage->mean);
    *coverage = (Coverage){0};
}

static int clamp(double value, int high)
{
    return (int)fmin(fmax(value, 0), high);
}

/* Along a row of pixels: inks those between `first` and `last` by their distance from a chord. x, y: the
 * first one's middle from the chord's start; (dx, dy): the chord; all in units of a pixel's size, as r, half
 * the pen. */
static void draw_row(unsigned char *ink, int count, float x, float y, float step, float dx, float dy, float r)
{
    float square = dx * dx + dy * dy, inverse = square > 0 ? 1 / square : 0;
    float most = fminf(1, 2 * r);
    for (int i = 0; i < count; i++) {
        float at = x + step * (float)i, t = (at * dx + y * dy) * inverse;
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        float ex = at - t * dx, ey = y - t * dy;
        float cover = r + 0.5f - sqrtf(ex * ex + ey * ey);
        cover = cover < 0 ? 0 : cover > most ? most : cover;
        unsigned char level = (unsigned char)(int)(255 * cover + 0.5f);
        if (level > ink[i]) ink[i] = level;
    }
}

/* The pixels of a row that may be nearer than `reach` to the line of the chord: from first to last. */
static void narrow_row(Vec2 a, Vec2 d, double reach, double y, double *first, double *last)
{
    double length = sqrt(d.x * d.x + d.y * d.y);
    if (fabs(d.y) <= 1e-3 * length) return;
    double middle = a.x + (y - a.y) * d.x / d.y, half = reach * length / fabs(d.y);
    *first = fmax(*first, middle - half);
    *last = fmin(*last, middle + half);
}

/* A chord with round ends. */
static void draw_chord(Coverage *coverage, Vec2 a, Vec2 b, double pen)
{
    int columns = coverage->columns * coverage->block, rows = coverage->rows * coverage->block;
    double px = coverage->pixel[0], py = coverage->pixel[1], size = sqrt(px * py);
    double reach = 0.5 * pen + 0.5 * size;
    Vec2 d = {b.x - a.x, b.y - a.y};
    double left = fmin(a.x, b.x) - reach, right = fmax(a.x, b.x) + reach;
    int top = clamp(floor((fmin(a.y, b.y) - reach) / py), rows),
        bottom = clamp(ceil((fmax(a.y, b.y) + reach) / py), rows);
    for (int j = top; j < bottom; j++) {
        double y = (j + 0.5) * py, first = left, last = right;
        narrow_row(a, d, reach, y, &first, &last);
        int from = clamp(floor(first / px), columns), to = clamp(ceil(last / px), columns);
        if (from >= to) continue;
        draw_row(coverage->ink + (size_t)j * (size_t)columns + from, to - from,
                 (float)(((from + 0.5) * px - a.x) / size), (float)((y - a.y) / size), (float)(px / size),
                 (float)(d.x / size), (float)(d.y / size), (float)(0.5 * pen / size));
    }
}

static void draw_stroke(Coverage *coverage, const Strokes *strokes, int stroke, double pen)
{
    double tolerance = 0.2 * fmin(coverage->pixel[0], coverage->pixel[1]);
    for (int node = strokes->start[stroke]; node < strokes->start[stroke + 1] - 1; node++) {
        Vec2 c[4];
        strokes_bezier(strokes, node, c);
        int steps = cubic_steps(c, tolerance);
        Vec2 at = c[0];
        for (int i = 1; i <= steps; i++) {
            Vec2 next = cubic_at(c, (double)i / steps);
            draw_chord(coverage, at, next, pen);
            at = next;
        }
    }
}

static void find_means(Coverage *coverage)
{
    int block = coverage->block;
    const unsigned char *ink = coverage->ink;
    memset(coverage->mean, 0, (size_t)coverage->columns * (size_t)coverage->rows * sizeof(double));
    for (int j = 0; j < coverage->rows * block; j++) {
        double *mean = coverage->mean + (size_t)(j / block) * (size_t)coverage->columns;
        for (int i = 0; i < coverage->columns; i++, ink += block) {
            int sum = 0;
            for (int k = 0; k < block; k++) sum += ink[k];
            mean[i] += sum / (255.0 * block * block);
        }
    }
}

void coverage_draw(Coverage *coverage, const Strokes *strokes, double pen)
{
    size_t pixels = (size_t)coverage->columns * (size_t)coverage->rows * (size_t)coverage->block *
                    (size_t)coverage->block;
    memset(coverage->ink, 0, pixels);
    for (int k = 0; k < strokes->count; k++) draw_stroke(coverage, strokes, k, pen);
    find_means(coverage);
}
