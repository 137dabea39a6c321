#include "spline/diffuse.h"
#include "base/memory.h"

enum { SWEEPS = 8, COARSEST = 4 };

/* Means of 2 x 2 pixels; where half of them would jut out, the last ones count twice. */
static SplineField coarsen(const SplineField *fine)
{
    SplineField coarse = {(fine->columns + 1) / 2, (fine->rows + 1) / 2, fine->width, NULL};
    size_t width = (size_t)fine->width;
    coarse.values = mem_alloc((size_t)coarse.columns * (size_t)coarse.rows * width, sizeof *coarse.values);
    for (int i = 0; i < 2 * coarse.rows; i++)
        for (int j = 0; j < 2 * coarse.columns; j++) {
            int row = i < fine->rows ? i : fine->rows - 1, column = j < fine->columns ? j : fine->columns - 1;
            const double *from = spline_field_pixel(fine, row, column);
            double *to = spline_field_pixel(&coarse, i / 2, j / 2);
            for (size_t k = 0; k < width; k++) to[k] += from[k] / 4;
        }
    return coarse;
}

static void prolong(const SplineField *coarse, SplineField *fine)
{
    SplinePage page = {.width = 2 * coarse->columns, .height = 2 * coarse->rows}; /* in fine pixels */
    SplineGrid grid = spline_grid(coarse);
    for (int i = 0; i < fine->rows; i++)
        for (int j = 0; j < fine->columns; j++)
            spline_grid_sample(&grid, &page, (Vec2){j + 0.5, i + 0.5}, spline_field_pixel(fine, i, j));
}

static void relax(const SplineField *source, double stiffness, SplineField *u)
{
    int columns = u->columns, rows = u->rows;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            double *value = spline_field_pixel(u, i, j), around[2] = {0};
            const double *near[4] = {j > 0 ? value - 2 : NULL, j + 1 < columns ? value + 2 : NULL,
                                     i > 0 ? value - 2 * columns : NULL,
                                     i + 1 < rows ? value + 2 * columns : NULL};
            for (int k = 0; k < 4; k++)
                if (near[k]) around[0] += near[k][0], around[1] += near[k][1];
            const double *b = spline_field_pixel(source, i, j);
            double x = b[0] + stiffness * around[0], y = b[1] + stiffness * around[1];
            double length = sqrt(x * x + y * y), scale = length > 0 ? 1 / length : 0;
            value[0] = x * scale;
            value[1] = y * scale;
        }
}

void spline_diffuse(const SplineField *source, double stiffness, SplineField *u)
{
    if (source->columns > COARSEST || source->rows > COARSEST) {
        SplineField coarse_source = coarsen(source), coarse = spline_field_like(&coarse_source, 2);
        spline_diffuse(&coarse_source, stiffness / 4, &coarse);
        prolong(&coarse, u);
        spline_field_clear(&coarse_source);
        spline_field_clear(&coarse);
    }
    for (int k = 0; k < SWEEPS; k++) relax(source, stiffness, u);
}
