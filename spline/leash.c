/* A leash: no energy, but no stroke gets further in one step than some distance, be it by a node or by a
 * control point beside it. Each is held for itself, so that one that would leap does not hold up all others. */
#include "base/memory.h"
#include "spline/relax_private.h"
#include <math.h>

typedef struct Leash {
    const SplineModel *model;
    double length;
} Leash;

static int leash_count(const void *self)
{
    return (void)self, 0;
}

static int leash_size(const void *self)
{
    return (void)self, 0;
}

static void leash_project(const void *self, const double *from, double *x)
{
    const Leash *leash = self;
    const SplineModel *model = leash->model;
    for (int k = 0; k < model->stroke_count; k++) {
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

static const TermOps leash_ops = {
    .name = "leash", .count = leash_count, .size = leash_size, .project = leash_project, .destroy = mem_free};

Term spline_leash_term(const SplineModel *model, double length)
{
    Leash *leash = mem_alloc(1, sizeof *leash);
    *leash = (Leash){model, length};
    return (Term){&leash_ops, leash};
}
