/* Tone: the ink around each probe against what the picture asks for there (tone.h).
 *
 * All pairs of strokes act on each other through it: with one radius everywhere it is the same as a repulsion
 * between strokes and a potential that fit each other [electrostatic halftoning, Schmaltz 2010]. */
#include "base/memory.h"
#include "spline/terms.h"
#include "spline/tone_hessian.h"

typedef struct ToneTerm {
    const SplineModel *model;
    SplineHessian hessian;
    Tone tone;
    SplinePoints points;
    PointForces forces;
    double *gradient; /* of the evaluation at hand */
    double K;
    ToneCoupling coupling;
    bool coupled; /* the present list was handed out */
} ToneTerm;

static const double MARGIN =
    0.02; /* of the mean line distance: how far points may go before lists are made anew */

/* What acts on the points of a group of strokes, and from them on its dofs. */
static void gradient_task(void *self, int group)
{
    const ToneTerm *t = self;
    SplineRange points = spline_group_points(&t->points, t->model, group);
    for (int p = points.first; p < points.end; p++) {
        ProbeSums sums = tone_sums(&t->tone, &t->points, p, 1);
        t->forces.S[p] = t->K * sums.value;
        t->forces.x[p] = t->K * sums.x;
        t->forces.y[p] = t->K * sums.y;
    }
    spline_points_add_group(&t->points, t->model, &t->forces, group, t->gradient);
}

static void couple_now(ToneTerm *t)
{
    if (t->hessian == SPLINE_OWN) return;
    if (tone_couple(&t->coupling, &t->tone, t->model, &t->points)) t->coupled = false;
}

static void add_hessian(ToneTerm *t, const BulkMatrix *H)
{
    if (t->hessian == SPLINE_OWN) {
        tone_add_own(&t->tone, t->model, &t->points, t->K, H);
        return;
    }
    couple_now(t);
    tone_add_coupled(&t->coupling, &t->tone, t->model, &t->points, t->K, H);
    if (t->hessian == SPLINE_EXACT) tone_add_curvature(&t->tone, t->model, &t->points, t->K, H);
}

static double tone_eval(void *self, const Point *at, double *g, const BulkMatrix *H)
{
    ToneTerm *t = self;
    t->K = ((const SplineWeights *)at->p)->tone;
    spline_points_update(&t->points, t->model, at->x);
    double energy = t->K * tone_update(&t->tone, &t->points);
    if (g) {
        t->gradient = g;
        workers_run(t->model->workers, t->model->group_count, gradient_task, t);
    }
    if (H) add_hessian(t, H);
    return energy;
}

static bool tone_couple_bulk(void *self, const double *x, BulkCoupling *coupling)
{
    ToneTerm *t = self;
    spline_points_update(&t->points, t->model, x);
    couple_now(t);
    if (t->coupled) return false;
    t->coupled = true;
    if (t->hessian == SPLINE_OWN)
        for (int m = 0; m < t->model->segment_count; m++) spline_pairs_add(&t->coupling.pairs, m, m);
    *coupling = spline_pairs_coupling(&t->coupling.pairs, t->model);
    return true;
}

static void tone_destroy(void *self)
{
    ToneTerm *t = self;
    tone_clear(&t->tone);
    spline_points_clear(&t->points);
    point_forces_clear(&t->forces);
    tone_coupling_clear(&t->coupling);
    mem_free(t);
}

static const BulkOps tone_ops = {
    .name = "tone", .eval = tone_eval, .couple = tone_couple_bulk, .destroy = tone_destroy};

Bulk spline_tone_bulk(const SplineModel *model, SplineHessian hessian)
{
    ToneTerm *t = mem_alloc(1, sizeof *t);
    *t = (ToneTerm){.model = model,
                    .hessian = hessian,
                    .tone = tone_create(model->target, model->workers),
                    .points = spline_points_create(&model->rule, model->segment_count,
                                                   spline_pen_cap(&model->target->page)),
                    .coupling = {.margin = MARGIN * model->target->spacing}};
    t->forces = point_forces_create(t->points.count);
    return (Bulk){&tone_ops, t};
}
