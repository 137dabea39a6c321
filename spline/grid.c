#include "spline/grid.h"
#include "base/memory.h"
#include "spline/smooth.h"

enum { SIDE_LEAST = 4, SIDE_MOST = 4000 };

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

SplineField spline_field_copy(const SplineField *field)
{
    SplineField copy = *field;
    copy.values = mem_copy(field->values, (size_t)copy.columns * (size_t)copy.rows * (size_t)copy.width,
                           sizeof *copy.values);
    return copy;
}

void spline_field_clear(SplineField *field)
{
    mem_free(field->values);
    *field = (SplineField){0};
}

static size_t value_count(const SplineField *field)
{
    return (size_t)field->columns * (size_t)field->rows * (size_t)field->width;
}

void spline_field_add(SplineField *field, const SplineField *other)
{
    size_t each = (size_t)(field->width / other->width);
    for (size_t i = 0; i < value_count(field); i++) field->values[i] += other->values[i / each];
}

void spline_field_multiply(SplineField *field, const SplineField *other)
{
    size_t each = (size_t)(field->width / other->width);
    for (size_t i = 0; i < value_count(field); i++) field->values[i] *= other->values[i / each];
}

void spline_field_scale(SplineField *field, double factor)
{
    for (size_t i = 0; i < value_count(field); i++) field->values[i] *= factor;
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

/* Number k of every pixel, side by side; and back. */
static void take_plane(const SplineField *field, int k, double *plane)
{
    size_t count = (size_t)field->columns * (size_t)field->rows, width = (size_t)field->width;
    for (size_t i = 0; i < count; i++) plane[i] = field->values[i * width + (size_t)k];
}

static void put_plane(SplineField *field, int k, const double *plane)
{
    size_t count = (size_t)field->columns * (size_t)field->rows, width = (size_t)field->width;
    for (size_t i = 0; i < count; i++) field->values[i * width + (size_t)k] = plane[i];
}

void spline_field_blur(SplineField *field, const SplinePage *page, double deviation)
{
    double sigma[2] = {deviation * field->columns / page->width, deviation * field->rows / page->height};
    double *plane = mem_alloc((size_t)field->columns * (size_t)field->rows, sizeof *plane);
    for (int k = 0; k < field->width; k++) {
        take_plane(field, k, plane);
        smooth_blur(plane, field->columns, field->rows, sigma, SMOOTH_MIRROR);
        put_plane(field, k, plane);
    }
    mem_free(plane);
}

SplineField spline_field_resize(const SplineField *field, const SplinePage *page, double pixel)
{
    SplineField resized = spline_field_create(page, pixel, field->width);
    SplineGrid grid = spline_grid(field);
    double *plane = mem_alloc((size_t)resized.columns * (size_t)resized.rows, sizeof *plane);
    for (int k = 0; k < field->width; k++, grid.values++) {
        smooth_resample(&grid, resized.columns, resized.rows, plane);
        put_plane(&resized, k, plane);
    }
    mem_free(plane);
    return resized;
}
