#include "spline/points.h"
#include "base/memory.h"
#include <math.h>

SplinePoints spline_points_create(const SplineRule *rule, int segments, double cap)
{
    int count = segments * rule->count;
    size_t n = (size_t)count;
    double *work = mem_alloc(6 * n, sizeof *work);
    return (SplinePoints){.rule = rule,
                          .count = count,
                          .cap = cap,
                          .x = work,
                          .y = work + n,
                          .tx = work + 2 * n,
                          .ty = work + 3 * n,
                          .n = work + 4 * n,
                          .ink = work + 5 * n};
}

void spline_points_clear(SplinePoints *points)
{
    mem_free(points->x);
}

PointForces point_forces_create(int count)
{
    size_t n = (size_t)count;
    double *work = mem_alloc(3 * n, sizeof *work);
    return (PointForces){work, work + n, work + 2 * n};
}

void point_forces_clear(PointForces *forces)
{
    mem_free(forces->S);
}

void spline_points_set(const SplinePoints *points, int segment, bool first, bool last, const double x[8])
{
    const SplineRule *rule = points->rule;
    for (int q = 0; q < rule->count; q++) {
        const double *N = rule->value[q], *T = rule->first[q];
        int k = segment * rule->count + q;
        points->x[k] = N[0] * x[0] + N[1] * x[2] + N[2] * x[4] + N[3] * x[6];
        points->y[k] = N[0] * x[1] + N[1] * x[3] + N[2] * x[5] + N[3] * x[7];
        points->tx[k] = T[0] * x[0] + T[1] * x[2] + T[2] * x[4] + T[3] * x[6];
        points->ty[k] = T[0] * x[1] + T[1] * x[3] + T[2] * x[5] + T[3] * x[7];
        points->n[k] = sqrt(points->tx[k] * points->tx[k] + points->ty[k] * points->ty[k]);
        points->ink[k] = rule->weight[q] * points->n[k];
    }
    if (first) points->ink[segment * rule->count] += points->cap;
    if (last) points->ink[(segment + 1) * rule->count - 1] += points->cap;
}

typedef struct Update {
    const SplinePoints *points;
    const SplineModel *model;
    const double *x;
} Update;

static void update_task(void *self, int group)
{
    const Update *u = self;
    for (int k = u->model->group[group]; k < u->model->group[group + 1]; k++) {
        int first = spline_first_segment(u->model, k), end = spline_first_segment(u->model, k + 1);
        for (int m = first; m < end; m++)
            spline_points_set(u->points, m, m == first, m == end - 1, u->x + 4 * u->model->segment_node[m]);
    }
}

void spline_points_update(const SplinePoints *points, const SplineModel *model, const double *x)
{
    Update u = {points, model, x};
    workers_run(model->workers, model->group_count, update_task, &u);
}

SplineRange spline_group_points(const SplinePoints *points, const SplineModel *model, int group)
{
    int Q = points->rule->count;
    return (SplineRange){Q * spline_first_segment(model, model->group[group]),
                         Q * spline_first_segment(model, model->group[group + 1])};
}

static void add_point(const SplinePoints *points, const PointForces *forces, int p, double *to)
{
    const SplineRule *rule = points->rule;
    int q = p % rule->count;
    double along = rule->weight[q] * forces->S[p] / points->n[p], ink = points->ink[p];
    double x = ink * forces->x[p], y = ink * forces->y[p];
    for (int k = 0; k < 4; k++) {
        to[2 * k] += rule->value[q][k] * x + rule->first[q][k] * along * points->tx[p];
        to[2 * k + 1] += rule->value[q][k] * y + rule->first[q][k] * along * points->ty[p];
    }
}

void spline_points_add_group(const SplinePoints *points, const SplineModel *model, const PointForces *forces,
                             int group, double *g)
{
    SplineRange range = spline_group_points(points, model, group);
    for (int p = range.first; p < range.end; p++)
        add_point(points, forces, p, g + 4 * model->segment_node[p / points->rule->count]);
}

typedef struct Scatter {
    const SplinePoints *points;
    const SplineModel *model;
    const PointForces *forces;
    double *g;
} Scatter;

static void scatter_task(void *self, int group)
{
    const Scatter *s = self;
    spline_points_add_group(s->points, s->model, s->forces, group, s->g);
}

void spline_points_add_gradient(const SplinePoints *points, const SplineModel *model,
                                const PointForces *forces, double *g)
{
    Scatter s = {points, model, forces, g};
    workers_run(model->workers, model->group_count, scatter_task, &s);
}

/* block rows 4 i .., columns 4 j .. of 8x8, transposed or not, to a 4x4. */
static void take_quarter(const double block[64], int i, int j, double to[16])
{
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) to[4 * r + c] = block[8 * (4 * i + r) + 4 * j + c];
}

static void add_transposed(double m[16])
{
    for (int r = 0; r < 4; r++)
        for (int c = 0; c <= r; c++) m[4 * r + c] = m[4 * c + r] = m[4 * r + c] + m[4 * c + r];
}

void spline_add_block(const BulkMatrix *H, const SplineModel *model, int a, int b, const double block[64])
{
    double quarter[16];
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < (a == b ? i + 1 : 2); j++) {
            int row = model->segment_node[a] + i, column = model->segment_node[b] + j;
            take_quarter(block, i, j, quarter);
            if (a != b && row == column) add_transposed(quarter);
            H->add(H->self, 4 * row, 4 * column, 4, quarter);
        }
}

void spline_pairs_add(SegmentPairs *pairs, int a, int b)
{
    if (pairs->count == pairs->room) {
        long room = 2 * pairs->room + 1024;
        pairs->pairs = mem_resize(pairs->pairs, (size_t)pairs->room, (size_t)room, sizeof *pairs->pairs);
        pairs->room = room;
    }
    pairs->pairs[pairs->count][0] = a;
    pairs->pairs[pairs->count++][1] = b;
}

BulkCoupling spline_pairs_coupling(SegmentPairs *pairs, const SplineModel *model)
{
    mem_free(pairs->start);
    mem_free(pairs->dofs);
    pairs->start = mem_alloc((size_t)pairs->count + 1, sizeof *pairs->start);
    pairs->dofs = mem_alloc(16 * (size_t)pairs->count, sizeof *pairs->dofs);
    for (long k = 0; k < pairs->count; k++) {
        for (int i = 0; i < 16; i++)
            pairs->dofs[16 * k + i] = 4 * model->segment_node[pairs->pairs[k][i / 8]] + i % 8;
        pairs->start[k + 1] = 16 * (k + 1);
    }
    return (BulkCoupling){(int)pairs->count, pairs->start, pairs->dofs};
}

void spline_pairs_clear(SegmentPairs *pairs)
{
    mem_free(pairs->pairs);
    mem_free(pairs->start);
    mem_free(pairs->dofs);
    *pairs = (SegmentPairs){0};
}
