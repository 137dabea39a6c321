/* A leash: no energy, but no stroke gets further in one step than some distance from where it was accepted
 * last, be it by a node or by a control point beside it. Each is held for itself, so that one that would leap
 * does not hold up all others. */
#include "spline/relax_private.h"
#include "base/memory.h"
#include <math.h>

typedef struct Leash {
    const SplineModel *model;
    double length;
    double *accepted; /* [4 node_count] */
} Leash;

static int leash_count(const void *self)
{
    return (void)self, 0;
}

static int leash_size(const void *self)
{
    return (void)self, 0;
}

static void leash_project(void *self, double *x)
{
    const Leash *leash = self;
    const SplineModel *model = leash->model;
    for (int k = 0; k < model->stroke_count; k++) {
        const double *from = leash->accepted;
        double way = 0;
        for (int i = 4 * model->start[k]; i < 4 * model->start[k + 1]; i += 2) {
            double dx = x[i] - from[i], dy = x[i + 1] - from[i + 1];
            way = fmax(way, dx * dx + dy * dy);
        }
        way = sqrt(way);
        if (!(way > leash->length)) continue;
        for (int i = 4 * model->start[k]; i < 4 * model->start[k + 1]; i++)
            x[i] = from[i] + leash->length / way * (x[i] - from[i]);
    }
}

static void leash_accept(void *self, double *x)
{
    const Leash *leash = self;
    memcpy(leash->accepted, x, 4 * (size_t)leash->model->node_count * sizeof *x);
}

static void leash_destroy(void *self)
{
    mem_free(((Leash *)self)->accepted);
    mem_free(self);
}

static const TermOps leash_ops = {.name = "leash",
                                  .count = leash_count,
                                  .size = leash_size,
                                  .project = leash_project,
                                  .accept = leash_accept,
                                  .destroy = leash_destroy};

Term spline_leash_term(const SplineModel *model, double length)
{
    Leash *leash = mem_alloc(1, sizeof *leash);
    *leash = (Leash){model, length, mem_alloc(4 * (size_t)model->node_count, sizeof(double))};
    return (Term){&leash_ops, leash};
}
