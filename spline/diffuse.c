#include "spline/diffuse.h"
#include "base/memory.h"

enum { SWEEPS = 8, COARSEST = 4 };

static SplineField coarsen(const SplineField *fine)
{
    SplineField coarse = {(fine->columns + 1) / 2, (fine->rows + 1) / 2, fine->width, NULL};
    size_t width = (size_t)fine->width;
    coarse.values = mem_alloc((size_t)coarse.columns * (size_t)coarse.rows * width, sizeof *coarse.values);
    for (int i = 0; i < 2 * coarse.rows; i++)
        for (int j = 0; j < 2 * coarse.columns; j++) {
            int row = i < fine->rows ? i : fine->rows - 1, column = j < fine->columns ? j : fine->columns - 1;
            const double *from =
                fine->values + ((size_t)row * (size_t)fine->columns + (size_t)column) * width;
            double *to = coarse.values + ((size_t)(i / 2) * (size_t)coarse.columns + (size_t)(j / 2)) * width;
            for (size_t k = 0; k < width; k++) to[k] += from[k] / 4;
        }
    return coarse;
}

static void prolong(const SplineField *coarse, SplineField *fine)
{
    SplinePage page = {.width = fine->columns,
                       .height = fine->rows}; /* pixels; half a coarse one may jut out */
    SplineGrid grid = spline_grid(coarse);
    page.width = 2 * coarse->columns;
    page.height = 2 * coarse->rows;
    for (int i = 0; i < fine->rows; i++)
        for (int j = 0; j < fine->columns; j++)
            spline_grid_sample(&grid, &page, (Vec2){j + 0.5, i + 0.5},
                               fine->values + 2 * ((size_t)i * (size_t)fine->columns + (size_t)j));
}

static void relax(const SplineField *source, double stiffness, SplineField *u)
{
    int columns = u->columns, rows = u->rows;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            size_t at = (size_t)i * (size_t)columns + (size_t)j;
            double *value = u->values + 2 * at, sum[2] = {0}, neighbours = 0;
            const double *near[4] = {j > 0 ? value - 2 : NULL, j + 1 < columns ? value + 2 : NULL,
                                     i > 0 ? value - 2 * (size_t)columns : NULL,
                                     i + 1 < rows ? value + 2 * (size_t)columns : NULL};
            for (int k = 0; k < 4; k++)
                if (near[k]) sum[0] += near[k][0], sum[1] += near[k][1], neighbours++;
            const double *b = source->values + 3 * at;
            double u0 = b[0] + stiffness * sum[0], u1 = b[1] + stiffness * sum[1];
            double scale = 1 / (b[2] + stiffness * neighbours);
            value[0] = u0 * scale, value[1] = u1 * scale;
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
