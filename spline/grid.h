/* grid.h - values on a regular grid over the page: tones, directions.
 *
 * Pixel (row i, column j) has its centre at x = (j + 0.5)/columns * page.width, y = (i + 0.5)/rows *
 * page.height. */
#pragma once
#include "base/vec3.h"
#include "spline/page.h"
#include <stddef.h>

typedef struct SplineGrid {
    int columns, rows;
    int width;            /* values of a pixel             */
    const double *values; /* [rows][columns][width]; borrowed */
} SplineGrid;

/* A grid that owns its values. */
typedef struct SplineField {
    int columns, rows, width;
    double *values; /* [rows][columns][width]; owned */
} SplineField;

/* Zeros in square pixels of about that size; from 4 to 4000 of them a side. */
SplineField spline_field_create(const SplinePage *page, double pixel, int width);
SplineField spline_field_like(const SplineField *field, int width);
SplineField spline_field_copy(const SplineField *field);
void spline_field_clear(SplineField *field);

static inline SplineGrid spline_grid(const SplineField *field)
{
    return (SplineGrid){field->columns, field->rows, field->width, field->values};
}

static inline double *spline_field_pixel(const SplineField *field, int row, int column)
{
    return field->values + ((size_t)row * (size_t)field->columns + (size_t)column) * (size_t)field->width;
}

static inline Vec2 spline_field_center(const SplineField *field, const SplinePage *page, int row, int column)
{
    return (Vec2){(column + 0.5) / field->columns * page->width, (row + 0.5) / field->rows * page->height};
}

/* Each value plus, or times, that of another field of the same pixels and width, or of width 1. */
void spline_field_add(SplineField *field, const SplineField *other);
void spline_field_multiply(SplineField *field, const SplineField *other);
void spline_field_scale(SplineField *field, double factor);

/* values[width] at (x, y), bilinear; the outermost pixels' values continue to the page's edges and beyond. */
void spline_grid_sample(const SplineGrid *grid, const SplinePage *page, Vec2 at, double *values);

double spline_grid_mean(const SplineGrid *grid, int value);

/* Convolves every value with a Gaussian of that standard deviation, in units of the page; what is beyond the
 * page mirrors what is on it. */
void spline_field_blur(SplineField *field, const SplinePage *page, double deviation);

/* The same in pixels of about that size: means over larger ones, bilinear between smaller ones. */
SplineField spline_field_resize(const SplineField *field, const SplinePage *page, double pixel);
