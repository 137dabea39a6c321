/* grid.h - numbers on a raster over the drawable part of a page: target density, directions, grey values. */
#pragma once

typedef struct SplineGrid {
    int columns, rows;
    int width;            /* numbers per pixel */
    const double *values; /* [rows][columns][width], at pixel centres: column i is x = (i + 0.5)/columns *
                             page.width, row j is y = (j + 0.5)/rows * page.height */
} SplineGrid;
