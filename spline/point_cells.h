/* point_cells.h - points sorted into square cells, so that those near a point lie in three short runs of
 * memory. */
#pragma once
#include "spline/points.h"
#include <math.h>

/* The column or row of cells that x is in; beyond the page the outermost one. */
static inline int point_cell(double x, double size, int count)
{
    return (int)fmin(fmax(x / size, 0), count - 1);
}

typedef struct PointCells {
    double size; /* of a cell: points nearer than that are in cells that touch */
    int columns, rows;
    int *start;             /* [columns rows + 1] of each cell, row by row                              */
    int *point;             /* [points] number of each                                                  */
    double *x, *y, *amount; /* [points + PACK_LANES] of each: place, length of ink; far away at the end */
    int count;
} PointCells;

PointCells point_cells_create(const SplinePage *page, double size, int points);
void point_cells_clear(PointCells *cells);
void point_cells_update(PointCells *cells, const SplinePoints *points);

/* A run of points in cells around (x, y), in row -1, 0 or 1 from its own: sorted places [first, end). */
typedef struct PointRun {
    int first, end;
} PointRun;

PointRun point_cells_near(const PointCells *cells, double x, double y, int row);
