#include "spline/grid_spline.h"
#include "base/memory.h"
#include <math.h>
#include <stdlib.h>

/* Four taps reach one pixel beyond the pixel left of a point and two beyond it. */
enum { BORDER = 2 };

/* The numbers of a point, filled up. */
typedef double Quad __attribute__((vector_size(4 * sizeof(double))));

struct GridSpline {
    int columns, rows, width, stride;
    double scale_x, scale_y; /* pixels per unit of the page */
    Quad *values;            /* [rows + 2 BORDER][stride] coefficients of the B-splines */
};

/* From values to coefficients along a line, in place: the two recursive filters with pole sqrt(3) - 2 [Unser
 * 1999, fig. 3]. */
static void filter_line(Quad *c, int n, int step)
{
    double z = sqrt(3) - 2, power = z, last = pow(z, n - 1);
    if (n == 1) return;
    Quad sum = c[0] + last * c[(n - 1) * step];
    for (int k = 1; k < n - 1 && fabs(power) > 1e-20; k++, power *= z)
        sum += (power + last * last / power) * c[k * step];
    c[0] = 6 * sum / (1 - last * last);
    for (int k = 1; k < n; k++) c[k * step] = 6 * c[k * step] + z * c[(k - 1) * step];
    c[(n - 1) * step] = z / (z * z - 1) * (c[(n - 1) * step] + z * c[(n - 2) * step]);
    for (int k = n - 2; k >= 0; k--) c[k * step] = z * (c[(k + 1) * step] - c[k * step]);
}

static int mirrored(int k, int n)
{
    if (n == 1) return 0;
    k = abs(k) % (2 * n - 2);
    return k < n ? k : 2 * n - 2 - k;
}

static Quad *at_pixel(const GridSpline *spline, int column, int row)
{
    return spline->values + (row + BORDER) * spline->stride + column + BORDER;
}

static void fill_border(GridSpline *spline)
{
    int columns = spline->columns, rows = spline->rows;
    for (int j = -BORDER; j < rows + BORDER; j++)
        for (int i = -BORDER; i < columns + BORDER; i++)
            if (i < 0 || j < 0 || i >= columns || j >= rows)
                *at_pixel(spline, i, j) = *at_pixel(spline, mirrored(i, columns), mirrored(j, rows));
}

GridSpline *grid_spline_create(const SplineGrid *grid, const SplinePage *page)
{
    if (!grid->values) return NULL;
    GridSpline *spline = mem_alloc(1, sizeof *spline);
    *spline = (GridSpline){.columns = grid->columns,
                           .rows = grid->rows,
                           .width = grid->width,
                           .stride = grid->columns + 2 * BORDER,
                           .scale_x = grid->columns / page->width,
                           .scale_y = grid->rows / page->height};
    spline->values = mem_alloc((size_t)spline->stride * (size_t)(grid->rows + 2 * BORDER), sizeof(Quad));
    for (int j = 0; j < grid->rows; j++)
        for (int i = 0; i < grid->columns; i++)
            for (int k = 0; k < grid->width; k++)
                (*at_pixel(spline, i, j))[k] = grid->values[((long)j * grid->columns + i) * grid->width + k];
    for (int j = 0; j < grid->rows; j++) filter_line(at_pixel(spline, 0, j), grid->columns, 1);
    for (int i = 0; i < grid->columns; i++) filter_line(at_pixel(spline, i, 0), grid->rows, spline->stride);
    fill_border(spline);
    return spline;
}

void grid_spline_destroy(GridSpline *spline)
{
    if (!spline) return;
    mem_free(spline->values);
    mem_free(spline);
}

/* Along one axis: the pixel left of each point, and the weights of the four taps with their derivatives. */
typedef struct Taps {
    int first[PACK_LANES];
    Pack weight[3][4]; /* [derivative][tap] */
} Taps;

static Taps find_taps(Pack x, double scale, int n)
{
    Taps taps;
    Pack u = x * scale - 0.5, low = pack_set(-0.5), high = pack_set(n - 0.5), one = pack_set(1), zero = {0};
    Pack inside = pack_select((u >= low) & (u <= high), one, zero), f;
    u = pack_select(u < low, low, pack_select(u > high, high, u));
    for (int l = 0; l < PACK_LANES; l++) {
        taps.first[l] = u[l] == u[l] ? (int)floor(u[l]) : 0;
        f[l] = u[l] - taps.first[l];
    }
    Pack g = 1 - f, d = inside * scale, dd = d * scale;
    Pack weight[4] = {g * g * g / 6, (4 - 3 * f * f * (2 - f)) / 6, (4 - 3 * g * g * (2 - g)) / 6,
                      f * f * f / 6};
    Pack first[4] = {-g * g / 2, f * (1.5 * f - 2), g * (2 - 1.5 * g), f * f / 2};
    Pack second[4] = {g, 3 * f - 2, 3 * g - 2, f};
    for (int k = 0; k < 4; k++)
        taps.weight[0][k] = weight[k], taps.weight[1][k] = d * first[k], taps.weight[2][k] = dd * second[k];
    return taps;
}

static void store(Pack *to, int lane, int width, Quad from)
{
    for (int k = 0; k < width; k++) to[k][lane] = from[k];
}

static void sample_lane(const GridSpline *spline, const Taps *h, const Taps *v, int l, int order,
                        GridSample *sample)
{
    Quad value = {0}, x = value, y = value, xx = value, xy = value, yy = value;
    const Quad *row = at_pixel(spline, h->first[l] - 1, v->first[l] - 1);
    for (int j = 0; j < 4; j++, row += spline->stride) {
        Quad a = {0}, b = a, c = a;
        for (int i = 0; i < 4; i++) {
            a += h->weight[0][i][l] * row[i];
            if (order > 0) b += h->weight[1][i][l] * row[i];
            if (order > 1) c += h->weight[2][i][l] * row[i];
        }
        double w = v->weight[0][j][l], d = v->weight[1][j][l];
        value += w * a;
        if (order > 0) x += w * b, y += d * a;
        if (order > 1) xx += w * c, xy += d * b, yy += v->weight[2][j][l] * a;
    }
    store(sample->value, l, spline->width, value);
    if (order > 0) store(sample->x, l, spline->width, x), store(sample->y, l, spline->width, y);
    if (order < 2) return;
    store(sample->xx, l, spline->width, xx);
    store(sample->xy, l, spline->width, xy);
    store(sample->yy, l, spline->width, yy);
}

void grid_spline_sample(const GridSpline *spline, Pack2 at, int order, GridSample *sample)
{
    Taps h = find_taps(at.x, spline->scale_x, spline->columns),
         v = find_taps(at.y, spline->scale_y, spline->rows);
    for (int l = 0; l < PACK_LANES; l++) sample_lane(spline, &h, &v, l, order, sample);
}
