#include "spline/local_pair.h"
#include "base/memory.h"
#include "spline/pair.h"
#include "spline/point_cells.h"
#include <math.h>

LocalPair local_pair_create(const SplineModel *model, double C)
{
    const SplinePage *page = &model->target->page;
    LocalPair pair = {.model = model, .C = C};
    pair.columns = (int)ceil(page->width / model->pair_reach);
    pair.rows = (int)ceil(page->height / model->pair_reach);
    pair.points = model->segment_count * model->rule.count;
    size_t cells = (size_t)pair.columns * (size_t)pair.rows, points = (size_t)pair.points;
    pair.head = mem_alloc(cells, sizeof *pair.head);
    for (size_t k = 0; k < cells; k++) pair.head[k] = -1;
    pair.next = mem_alloc(2 * points, sizeof *pair.next);
    pair.previous = pair.next + points;
    pair.x = mem_alloc(3 * points, sizeof *pair.x);
    pair.y = pair.x + points;
    pair.amount = pair.y + points;
    return pair;
}

void local_pair_clear(LocalPair *pair)
{
    mem_free(pair->head);
    mem_free(pair->next);
    mem_free(pair->x);
}

void local_pair_insert(LocalPair *pair, int first, const SplinePoints *points)
{
    double size = pair->model->pair_reach;
    for (int k = 0; k < points->count; k++) {
        int p = first + k, column = point_cell(points->x[k], size, pair->columns);
        int cell = point_cell(points->y[k], size, pair->rows) * pair->columns + column;
        pair->x[p] = points->x[k];
        pair->y[p] = points->y[k];
        pair->amount[p] = points->rule->weight[k % points->rule->count] * points->n[k];
        pair->next[p] = pair->head[cell];
        pair->previous[p] = -1 - cell;
        if (pair->head[cell] >= 0) pair->previous[pair->head[cell]] = p;
        pair->head[cell] = p;
    }
}

void local_pair_remove(LocalPair *pair, int first, int count)
{
    for (int p = first; p < first + count; p++) {
        int next = pair->next[p], previous = pair->previous[p];
        if (next >= 0) pair->previous[next] = previous;
        if (previous >= 0)
            pair->next[previous] = next;
        else
            pair->head[-1 - previous] = next;
    }
}

static double kernel(const LocalPair *pair, double dx, double dy)
{
    double R = pair->model->pair_radius, reach = pair->model->pair_reach, d2 = dx * dx + dy * dy;
    return d2 < reach * reach ? pair_kernel_at(pair->model->pair_kernel, d2, R).g : 0;
}

static double sum_others(const LocalPair *pair, double x, double y)
{
    double size = pair->model->pair_reach, sum = 0;
    int i = point_cell(x, size, pair->columns), j = point_cell(y, size, pair->rows);
    for (int row = j - 1; row <= j + 1; row++)
        for (int column = i - 1; column <= i + 1; column++) {
            if (row < 0 || column < 0 || row >= pair->rows || column >= pair->columns) continue;
            for (int p = pair->head[row * pair->columns + column]; p >= 0; p = pair->next[p])
                sum += pair->amount[p] * kernel(pair, x - pair->x[p], y - pair->y[p]);
        }
    return sum;
}

double local_pair_energy(const LocalPair *pair, const SplinePoints *points)
{
    double energy = 0;
    const SplineRule *rule = points->rule;
    bool own = pair_kernel_has_own(pair->model->pair_kernel);
    for (int a = 0; a < points->count; a++) {
        double sum = sum_others(pair, points->x[a], points->y[a]);
        for (int b = 0; own && b < points->count; b++)
            sum += rule->weight[b % rule->count] * points->n[b] / 2 *
                   kernel(pair, points->x[a] - points->x[b], points->y[a] - points->y[b]);
        energy += rule->weight[a % rule->count] * points->n[a] * sum;
    }
    return pair->C * energy;
}
