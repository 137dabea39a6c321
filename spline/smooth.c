#include "spline/smooth.h"
#include "base/memory.h"
#include <math.h>

enum { SAMPLES = 4 }; /* at least so many per new pixel, and per old one */

static int clamp(int k, int count)
{
    return k < 0 ? 0 : k >= count ? count - 1 : k;
}

/* Resamples one line; the numbers of a line are `stride` apart. */
static void resample_line(const double *from, int count, int stride, double *to, int new_count,
                          int new_stride)
{
    int samples = SAMPLES * (1 + count / new_count);
    for (int i = 0; i < new_count; i++) {
        double sum = 0;
        for (int s = 0; s < samples; s++) {
            double at = (i + (s + 0.5) / samples) / new_count * count - 0.5, below = floor(at);
            int k = (int)below;
            double low = from[clamp(k, count) * stride], high = from[clamp(k + 1, count) * stride];
            sum += low + (at - below) * (high - low);
        }
        to[i * new_stride] = sum / samples;
    }
}

void smooth_resample(const SplineGrid *grid, int columns, int rows, double *to)
{
    double *half = mem_alloc((size_t)columns * (size_t)grid->rows, sizeof *half); /* columns are new */
    for (int j = 0; j < grid->rows; j++)
        resample_line(grid->values + (size_t)j * (size_t)grid->columns * (size_t)grid->width, grid->columns,
                      grid->width, half + (size_t)j * (size_t)columns, columns, 1);
    for (int i = 0; i < columns; i++) resample_line(half + i, grid->rows, columns, to + i, rows, columns);
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
