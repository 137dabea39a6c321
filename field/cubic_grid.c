#include "field/cubic_grid.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

static int width(int nodes)
{
    return nodes > 1 ? nodes + 2 : 1;
}

/* ---- Coefficients ---- */

/* c[k] stands for the B-spline around node k. The inner ones: c[k - 1] + 4 c[k] + c[k + 1] = 6 f[k] between two that are
 * known, by elimination. */
static void solve_between(double *c, const double *f, int from, int to, double *ratio)
{
    ratio[from] = 0;
    for (int k = from + 1; k < to; k++) {
        ratio[k] = 1 / (4 - ratio[k - 1]);
        c[k] = (6 * f[k] - c[k - 1]) * ratio[k];
    }
    for (int k = to - 1; k > from; k--) c[k] -= ratio[k] * c[k + 1];
}

/* Fourth differences of the coefficients vanish at the second node and the last but one: that gives the coefficients
 * there, and then all others. c[-1..n], f[n], ratio[n]. */
static void fit(double *c, const double *f, int n, double *ratio)
{
    if (n == 2) {
        c[0] = f[0], c[1] = f[1];
        c[-1] = 2 * f[0] - f[1], c[2] = 2 * f[1] - f[0];
        return;
    }
    c[1] = (8 * f[1] - f[0] - f[2]) / 6;
    if (n == 3) { /* a parabola */
        c[0] = f[0] + c[1] - f[1], c[2] = f[2] + c[1] - f[1];
    } else {
        c[n - 2] = (8 * f[n - 2] - f[n - 3] - f[n - 1]) / 6;
        solve_between(c, f, 1, n - 2, ratio);
        c[0] = 6 * f[1] - 4 * c[1] - c[2];
        c[n - 1] = 6 * f[n - 2] - 4 * c[n - 2] - c[n - 3];
    }
    c[-1] = 6 * f[0] - 4 * c[0] - c[1];
    c[n] = 6 * f[n - 1] - 4 * c[n - 1] - c[n - 2];
}

/* A line of the array, from its values to its coefficients. */
static void fit_line(double *line, long stride, int n, double *work)
{
    double *values = work, *c = work + n + 1, *ratio = work + 2 * n + 2;
    for (int k = 0; k < n; k++) values[k] = line[(k + 1) * stride];
    fit(c, values, n, ratio);
    for (int k = -1; k <= n; k++) line[(k + 1) * stride] = c[k];
}

static void fit_axis(CubicGrid *grid, int axis)
{
    int n = grid->nodes[axis];
    if (n == 1) return;
    long inner = 1, outer = 1;
    for (int k = axis + 1; k < 3; k++) inner *= width(grid->nodes[k]);
    for (int k = 0; k < axis; k++) outer *= width(grid->nodes[k]);
    double *work = mem_alloc(3 * (size_t)n + 2, sizeof *work);
    for (long i = 0; i < outer; i++)
        for (long j = 0; j < inner; j++)
            fit_line(grid->coefficients + i * inner * width(n) + j, inner, n, work);
    mem_free(work);
}

CubicGrid cubic_grid_create(const int nodes[3], const double low[3], const double step[3],
                            const double *values, bool linear)
{
    CubicGrid grid = {.linear = linear};
    memcpy(grid.nodes, nodes, sizeof grid.nodes);
    memcpy(grid.low, low, sizeof grid.low);
    memcpy(grid.step, step, sizeof grid.step);
    long size[3];
    for (int k = 0; k < 3; k++) size[k] = width(nodes[k]);
    grid.coefficients = mem_alloc((size_t)(size[0] * size[1] * size[2]), sizeof(double));
    for (int i = 0; i < nodes[0]; i++)
        for (int j = 0; j < nodes[1]; j++) {
            long row = (i + (size[0] > 1)) * size[1] + j + (size[1] > 1);
            memcpy(grid.coefficients + row * size[2] + (size[2] > 1),
                   values + ((long)i * nodes[1] + j) * nodes[2], (size_t)nodes[2] * sizeof *values);
        }
    for (int axis = 0; axis < 3; axis++) fit_axis(&grid, axis);
    return grid;
}

void cubic_grid_clear(CubicGrid *grid)
{
    mem_free(grid->coefficients);
    *grid = (CubicGrid){0};
}

/* ---- Values ---- */

/* Along one axis: the first coefficient, and the weights of so many with so many derivatives (0 counted). */
typedef struct Taps {
    int first, count, orders;
    double weight[3][4]; /* [derivative] */
} Taps;

/* The cubic B-splines at a part f of a cell, and their derivatives; beyond 0..1 as polynomials. */
static void splines(double f, double w[3][4])
{
    double g = 1 - f;
    double values[3][4] = {
        {g * g * g / 6, (4 - 3 * f * f * (2 - f)) / 6, (4 - 3 * g * g * (2 - g)) / 6, f * f * f / 6},
        {-g * g / 2, f * (1.5 * f - 2), g * (2 - 1.5 * g), f * f / 2},
        {g, 3 * f - 2, 3 * g - 2, f}};
    memcpy(w, values, sizeof values);
}

/* Where the spline is evaluated, in cells from its first node, and the derivatives of that. The slope falls from 1 to 0
 * within two cells as 1 - 3 t^2 + 2 t^3. */
static double place(double u, int last, double *slope, double *bend)
{
    double beyond = u < 0 ? -u : u > last ? u - last : 0, side = u < 0 ? -1 : 1;
    double t = fmin(beyond / 2, 1);
    *slope = 1 - t * t * (3 - 2 * t);
    *bend = side * 3 * t * (t - 1);
    double rest = 2 * t * (1 - t * t * (1 - t / 2));
    return beyond > 0 ? (u < 0 ? 0 : last) + side * rest : u;
}

void cubic_grid_beyond(const CubicGrid *grid, int axis, double x, double beyond[3])
{
    double step = grid->step[axis], u = (x - grid->low[axis]) / step, slope, bend;
    beyond[0] = step * (u - place(u, grid->nodes[axis] - 1, &slope, &bend));
    beyond[1] = 1 - slope;
    beyond[2] = -bend / step;
}

static Taps find_taps(const CubicGrid *grid, int axis, double x)
{
    int last = grid->nodes[axis] - 1;
    if (last == 0) return (Taps){.count = 1, .orders = 1, .weight = {{1}}};
    double u = (x - grid->low[axis]) / grid->step[axis], slope, bend, w[3][4], end[3][4] = {0};
    double v = place(u, last, &slope, &bend), scale = 1 / grid->step[axis], left = 0;
    Taps taps = {.first = (int)fmax(0, fmin(floor(v), last - 1)), .count = 4, .orders = 3};
    splines(v - taps.first, w);
    if (grid->linear && v != u) {
        splines(u < 0 ? -1 : 2, end);
        left = u - v;
    }
    for (int k = 0; k < 4; k++) {
        taps.weight[0][k] = w[0][k] + left * end[1][k];
        taps.weight[1][k] = scale * (slope * w[1][k] + (1 - slope) * end[1][k]);
        taps.weight[2][k] = scale * scale * (slope * slope * w[2][k] + bend * (w[1][k] - end[1][k]));
    }
    return taps;
}

/* sum[i][j][k] of the derivatives d^(i + j + k)/dx^i dy^j dz^k up to the second. */
static void sum_taps(const CubicGrid *grid, const Taps *x, const Taps *y, const Taps *z, double sum[3][3][3])
{
    long columns = width(grid->nodes[1]), depth = width(grid->nodes[2]);
    for (int a = 0; a < x->count; a++) {
        double plane[3][3] = {0};
        for (int b = 0; b < y->count; b++) {
            const double *c =
                grid->coefficients + ((x->first + a) * columns + y->first + b) * depth + z->first;
            for (int k = 0; k < z->orders; k++) {
                double line = 0;
                for (int e = 0; e < z->count; e++) line += z->weight[k][e] * c[e];
                for (int j = 0; j < y->orders && j + k < 3; j++) plane[j][k] += y->weight[j][b] * line;
            }
        }
        for (int i = 0; i < x->orders; i++)
            for (int j = 0; j < y->orders && i + j < 3; j++)
                for (int k = 0; k < z->orders && i + j + k < 3; k++)
                    sum[i][j][k] += x->weight[i][a] * plane[j][k];
    }
}

void cubic_grid_at(const CubicGrid *grid, const double x[3], SpaceSample *sample)
{
    double sum[3][3][3] = {0};
    Taps taps[3];
    for (int axis = 0; axis < 3; axis++) taps[axis] = find_taps(grid, axis, x[axis]);
    sum_taps(grid, &taps[0], &taps[1], &taps[2], sum);
    *sample = (SpaceSample){.value = sum[0][0][0],
                            .gradient = {sum[1][0][0], sum[0][1][0], sum[0][0][1]},
                            .hessian = {{sum[2][0][0], sum[1][1][0], sum[1][0][1]},
                                        {sum[1][1][0], sum[0][2][0], sum[0][1][1]},
                                        {sum[1][0][1], sum[0][1][1], sum[0][0][2]}}};
}
