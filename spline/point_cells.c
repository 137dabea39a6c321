#include "spline/point_cells.h"
#include "base/memory.h"
#include <math.h>

PointCells point_cells_create(const SplinePage *page, double size, int points)
{
    size_t room = (size_t)points + PACK_LANES;
    PointCells cells = {.size = size, .count = points};
    cells.columns = (int)ceil(page->width / size);
    cells.rows = (int)ceil(page->height / size);
    cells.start = mem_alloc((size_t)cells.columns * (size_t)cells.rows + 1, sizeof *cells.start);
    cells.point = mem_alloc((size_t)points, sizeof *cells.point);
    cells.x = mem_alloc(3 * room, sizeof *cells.x);
    cells.y = cells.x + room;
    cells.amount = cells.y + room;
    for (int k = points; k < (int)room; k++) cells.x[k] = 1e9;
    return cells;
}

void point_cells_clear(PointCells *cells)
{
    mem_free(cells->start);
    mem_free(cells->point);
    mem_free(cells->x);
}

static int cell_of(const PointCells *cells, double x, double y)
{
    return point_cell(y, cells->size, cells->rows) * cells->columns +
           point_cell(x, cells->size, cells->columns);
}

void point_cells_update(PointCells *cells, const SplinePoints *points)
{
    int *start = cells->start, count = cells->columns * cells->rows, Q = points->rule->count;
    memset(start, 0, ((size_t)count + 1) * sizeof *start);
    for (int p = 0; p < points->count; p++) start[cell_of(cells, points->x[p], points->y[p])]++;
    for (int c = 0, sum = 0; c <= count; c++) {
        int here = start[c];
        start[c] = sum;
        sum += here;
    }
    for (int p = 0; p < points->count; p++) {
        int k = start[cell_of(cells, points->x[p], points->y[p])]++;
        cells->point[k] = p;
        cells->x[k] = points->x[p];
        cells->y[k] = points->y[p];
        cells->amount[k] = points->rule->weight[p % Q] * points->n[p];
    }
    memmove(start + 1, start, (size_t)count * sizeof *start);
    start[0] = 0;
}

PointRun point_cells_near(const PointCells *cells, double x, double y, int row)
{
    int j = point_cell(y, cells->size, cells->rows) + row, i = point_cell(x, cells->size, cells->columns);
    if (j < 0 || j >= cells->rows) return (PointRun){0, 0};
    int left = i > 0 ? i - 1 : 0, right = i + 1 < cells->columns ? i + 1 : i;
    return (PointRun){cells->start[j * cells->columns + left], cells->start[j * cells->columns + right + 1]};
}
