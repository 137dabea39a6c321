#include "spline/smooth.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

enum { SAMPLES = 4 }; /* at least so many per new pixel, and per old one */

static int clamp(int k, int count)
{
    return k < 0 ? 0 : k >= count ? count - 1 : k;
}

/* A sample along a line, low + part (high - low). */
typedef struct Tap {
    int low, high;
    double part;
} Tap;

/* `samples` for each new pixel. */
static Tap *find_taps(int count, int new_count, int samples)
{
    Tap *taps = mem_alloc((size_t)new_count * (size_t)samples, sizeof *taps);
    for (int i = 0; i < new_count; i++)
        for (int s = 0; s < samples; s++) {
            double at = (i + (s + 0.5) / samples) / new_count * count - 0.5, below = floor(at);
            int k = (int)below;
            taps[i * samples + s] = (Tap){clamp(k, count), clamp(k + 1, count), at - below};
        }
    return taps;
}

static int sample_count(int count, int new_count)
{
    return SAMPLES * (1 + count / new_count);
}

/* to[grid->rows][columns] */
static void resample_across(const SplineGrid *grid, int columns, double *to)
{
    int samples = sample_count(grid->columns, columns), width = grid->width;
    Tap *taps = find_taps(grid->columns, columns, samples);
    for (int j = 0; j < grid->rows; j++) {
        const double *from = grid->values + (size_t)j * (size_t)grid->columns * (size_t)width;
        for (int i = 0; i < columns; i++) {
            double sum = 0;
            for (const Tap *t = taps + i * samples; t < taps + (i + 1) * samples; t++) {
                double low = from[t->low * width], high = from[t->high * width];
                sum += low + t->part * (high - low);
            }
            to[(size_t)j * (size_t)columns + (size_t)i] = sum / samples;
        }
    }
    mem_free(taps);
}

/* from[count][columns] to to[rows][columns] */
static void resample_down(const double *from, int columns, int count, int rows, double *to)
{
    int samples = sample_count(count, rows);
    Tap *taps = find_taps(count, rows, samples);
    memset(to, 0, (size_t)rows * (size_t)columns * sizeof *to);
    for (int i = 0; i < rows; i++, to += columns) {
        for (const Tap *t = taps + i * samples; t < taps + (i + 1) * samples; t++) {
            const double *low = from + (size_t)t->low * (size_t)columns,
                         *high = from + (size_t)t->high * (size_t)columns;
            for (int j = 0; j < columns; j++) to[j] += low[j] + t->part * (high[j] - low[j]);
        }
        for (int j = 0; j < columns; j++) to[j] /= samples;
    }
    mem_free(taps);
}

void smooth_resample(const SplineGrid *grid, int columns, int rows, double *to)
{
    double *half = mem_alloc((size_t)columns * (size_t)grid->rows, sizeof *half); /* columns are new */
    resample_across(grid, columns, half);
    resample_down(half, columns, grid->rows, rows, to);
    mem_free(half);
}

/* Which of `count` numbers is at k, inside or beyond. */
static int edge_index(int k, int count, SmoothEdge edge)
{
    if (edge == SMOOTH_EXTEND) return clamp(k, count);
    k %= 2 * count;
    if (k < 0) k += 2 * count;
    return k < count ? k : 2 * count - 1 - k;
}

/* weight[radius + 1] from the middle outwards; the sum of all is 1. */
static double *gaussian(double sigma, int radius)
{
    double *weight = mem_alloc((size_t)radius + 1, sizeof *weight), sum = 0;
    for (int k = 0; k <= radius; k++) {
        weight[k] = k ? exp(-0.5 * k * k / (sigma * sigma)) : 1; /* where sigma squared is 0, too */
        sum += k ? 2 * weight[k] : weight[k];
    }
    for (int k = 0; k <= radius; k++) weight[k] /= sum;
    return weight;
}

/* Blurs along the lines of a raster of `lines` lines and turns it over: to[count][lines]. */
static void blur_lines(const double *from, int lines, int count, double sigma, SmoothEdge edge, double *to)
{
    int radius = sigma < 0.1 ? 0 : (int)(4 * sigma + 0.5), wide = count + 2 * radius;
    double *weight = gaussian(sigma, radius), *line = mem_alloc((size_t)wide, sizeof *line);
    double *sum = mem_alloc((size_t)count, sizeof *sum);
    for (int j = 0; j < lines; j++) {
        for (int i = 0; i < wide; i++) line[i] = from[j * count + edge_index(i - radius, count, edge)];
        for (int i = 0; i < count; i++) sum[i] = weight[0] * line[i + radius];
        for (int k = 1; k <= radius; k++) {
            const double *left = line + radius - k, *right = line + radius + k;
            for (int i = 0; i < count; i++) sum[i] += weight[k] * (left[i] + right[i]);
        }
        for (int i = 0; i < count; i++) to[i * lines + j] = sum[i];
    }
    mem_free(weight);
    mem_free(line);
    mem_free(sum);
}

void smooth_blur(double *values, int columns, int rows, const double sigma[2], SmoothEdge edge)
{
    double *turned = mem_alloc((size_t)columns * (size_t)rows, sizeof *turned);
    blur_lines(values, rows, columns, sigma[0], edge, turned);
    blur_lines(turned, columns, rows, sigma[1], edge, values);
    mem_free(turned);
}
