#include "spline/grid.h"
#include "base/memory.h"

enum { GRID_MAX_WIDTH = 4, SIDE_LEAST = 4, SIDE_MOST = 4000 };

static int clamp(int i, int low, int high)
{
    return i < low ? low : i > high ? high : i;
}

SplineField spline_field_create(const SplinePage *page, double pixel, int width)
{
    SplineField field = {.columns = (int)lround(fmin(fmax(page->width / pixel, SIDE_LEAST), SIDE_MOST)),
                         .rows = (int)lround(fmin(fmax(page->height / pixel, SIDE_LEAST), SIDE_MOST)),
                         .width = width};
    field.values =
        mem_alloc((size_t)field.columns * (size_t)field.rows * (size_t)width, sizeof *field.values);
    return field;
}

SplineField spline_field_like(const SplineField *field, int width)
{
    SplineField copy = {field->columns, field->rows, width, NULL};
    copy.values = mem_alloc((size_t)copy.columns * (size_t)copy.rows * (size_t)width, sizeof *copy.values);
    return copy;
}

void spline_field_clear(SplineField *field)
{
    mem_free(field->values);
    *field = (SplineField){0};
}

void spline_grid_sample(const SplineGrid *grid, const SplinePage *page, Vec2 at, double *values)
{
    double x = fmin(fmax(at.x / page->width * grid->columns - 0.5, 0), grid->columns - 1);
    double y = fmin(fmax(at.y / page->height * grid->rows - 0.5, 0), grid->rows - 1);
    int j = (int)x, i = (int)y, width = grid->width;
    int right = j + 1 < grid->columns ? width : 0, below = i + 1 < grid->rows;
    const double *row = grid->values + ((size_t)i * (size_t)grid->columns + (size_t)j) * (size_t)width;
    const double *next = row + (below ? (size_t)grid->columns * (size_t)width : 0);
    double s = x - j, t = y - i;
    double a = (1 - t) * (1 - s), b = (1 - t) * s, c = t * (1 - s), d = t * s;
    for (int k = 0; k < width; k++)
        values[k] = a * row[k] + b * row[right + k] + c * next[k] + d * next[right + k];
}

double spline_grid_mean(const SplineGrid *grid, int value)
{
    size_t count = (size_t)grid->columns * (size_t)grid->rows;
    double sum = 0;
    for (size_t i = 0; i < count; i++) sum += grid->values[i * (size_t)grid->width + (size_t)value];
    return sum / (double)count;
}

/* Convolves `count` values that lie `stride` apart with the half kernel weight[radius + 1]. */
static void blur_line(double *line, int count, size_t stride, const double *weight, int radius,
                      double *padded)
{
    for (int i = -radius; i < count + radius; i++) {
        int mirrored = i < 0 ? -1 - i : i >= count ? 2 * count - 1 - i : i;
        padded[i + radius] = line[(size_t)clamp(mirrored, 0, count - 1) * stride];
    }
    for (int i = 0; i < count; i++) {
        const double *middle = padded + i + radius;
        double sum = weight[0] * middle[0];
        for (int k = 1; k <= radius; k++) sum += weight[k] * (middle[-k] + middle[k]);
        line[(size_t)i * stride] = sum;
    }
}

void spline_field_blur(SplineField *field, const SplinePage *page, double deviation)
{
    int columns = field->columns, rows = field->rows, width = field->width;
    int longest = columns > rows ? columns : rows;
    for (int along = 0; along < 2; along++) {
        double pixels = deviation * (along ? rows / page->height : columns / page->width), sum = 1;
        int radius = clamp((int)ceil(4 * pixels), 0, longest), count = along ? columns : rows;
        double *weight = mem_alloc((size_t)radius + 1, sizeof *weight);
        double *padded = mem_alloc((size_t)(longest + 2 * radius), sizeof *padded);
        weight[0] = 1;
        for (int k = 1; k <= radius; k++) sum += 2 * (weight[k] = exp(-0.5 * k * k / (pixels * pixels)));
        for (int k = 0; k <= radius; k++) weight[k] /= sum;
        size_t step = (size_t)width * (along ? (size_t)columns : 1);
        for (int i = 0; i < count; i++) {
            double *line = field->values + (size_t)i * (size_t)width * (along ? 1 : (size_t)columns);
            for (int k = 0; k < width; k++)
                blur_line(line + k, along ? rows : columns, step, weight, radius, padded);
        }
        mem_free(padded);
        mem_free(weight);
    }
}

/* Adds the mean over the pixel around `center`, of samples as close as the grid's own pixels. */
static void pixel_mean(const SplineGrid *grid, const SplinePage *page, Vec2 center,
                       const SplineField *resized, double *mean)
{
    int down = (grid->rows + resized->rows - 1) / resized->rows;
    int across = (grid->columns + resized->columns - 1) / resized->columns;
    double value[GRID_MAX_WIDTH];
    for (int i = 0; i < down; i++)
        for (int j = 0; j < across; j++) {
            Vec2 at = {center.x + ((j + 0.5) / across - 0.5) * page->width / resized->columns,
                       center.y + ((i + 0.5) / down - 0.5) * page->height / resized->rows};
            spline_grid_sample(grid, page, at, value);
            for (int k = 0; k < grid->width; k++) mean[k] += value[k] / (down * across);
        }
}

SplineField spline_field_resize(const SplineField *field, const SplinePage *page, double pixel)
{
    SplineField resized = spline_field_create(page, pixel, field->width);
    SplineGrid grid = spline_grid(field);
    for (int i = 0; i < resized.rows; i++)
        for (int j = 0; j < resized.columns; j++)
            pixel_mean(&grid, page, spline_field_center(&resized, page, i, j), &resized,
                       spline_field_pixel(&resized, i, j));
    return resized;
}
