#include "spline/walls.h"
#include <math.h>

static const double FRACTION = 0.9;

Pack wall_barrier(Pack d, double reach, Pack *slope, Pack *curvature)
{
    Pack value = {0}, zero = {0};
    *slope = *curvature = zero;
    for (int l = 0; l < PACK_LANES; l++) {
        if (d[l] >= reach) continue;
        double part = d[l] / reach, left = 1 - part, log_part = part > 0 ? log(part) : -INFINITY;
        value[l] = -left * left * log_part;
        (*slope)[l] = (2 * left * log_part - left * left / part) / reach;
        (*curvature)[l] = (-2 * log_part + 4 * left / part + left * left / (part * part)) / (reach * reach);
    }
    return value;
}

void wall_curve(Barrier *b, Pack slope, Pack curvature, const GridSample *d, bool positive)
{
    b->xx = curvature * d->x[0] * d->x[0];
    b->xy = curvature * d->x[0] * d->y[0];
    b->yy = curvature * d->y[0] * d->y[0];
    if (positive) return;
    b->xx += slope * d->xx[0];
    b->xy += slope * d->xy[0];
    b->yy += slope * d->yy[0];
}

Pack wall_psi_of(const SegmentTerm *term, double weight, const Barrier *barrier, const SegmentPoint *s,
                 int order, Psi *psi)
{
    Pack R = pack_set(weight), Rn = R * s->n;
    if (order > 0) {
        psi->r = pack2_scale(Rn, barrier->slope);
        psi->t = pack2_scale(R * barrier->value, s->u);
    }
    if (order > 1) {
        Pack2 across = pack2_across(s->u);
        psi->rr = (PackMat2){Rn * barrier->xx, Rn * barrier->xy, Rn * barrier->xy, Rn * barrier->yy};
        psi->tt = pack_mat2_scale(R * barrier->value / s->n, pack_mat2_outer(across, across));
        if (!term->positive) psi->rt = pack_mat2_scale(R, pack_mat2_outer(barrier->slope, s->u));
    }
    return Rn * barrier->value;
}

/* Largest part of a move by which a coordinate from a to b stays on its side of both walls, with a reserve.
 */
static double part_of(double a, double b, double size)
{
    double part = 1;
    if (b < a) part = FRACTION * a / (a - b);
    if (b > a) part = FRACTION * (size - a) / (b - a);
    return fmin(part, 1);
}

static double coordinate(const double basis[4], const double *x, int axis)
{
    double r = 0;
    for (int k = 0; k < 4; k++) r += basis[k] * x[2 * k + axis];
    return r;
}

/* Are all control points of a segment so far inside that no limit applies? */
static bool is_far_inside(const SplinePage *page, const double *q)
{
    double size[2] = {page->width, page->height};
    bool inside = true;
    for (int i = 0; i < 8; i += 4)
        for (int axis = 0; axis < 2; axis++) {
            double p = q[i + axis], v = fabs(q[i + 2 + axis]);
            inside &= p - v > (1 - FRACTION) * size[axis] && p + v < FRACTION * size[axis];
        }
    return inside;
}

/* r(s) is linear in the dofs, so this is exact. */
static double allowed_part(const SegmentTerm *term, int node, const double *from, const double *to)
{
    const double size[2] = {term->model->target->page.width, term->model->target->page.height};
    double part = 1;
    if (is_far_inside(&term->model->target->page, to + 4 * node)) return part;
    for (int k = 0; k < term->rule->count; k++)
        for (int axis = 0; axis < 2; axis++)
            part = fmin(part, part_of(coordinate(term->rule->value[k], from + 4 * node, axis),
                                      coordinate(term->rule->value[k], to + 4 * node, axis), size[axis]));
    return part;
}

void wall_shorten(const SplineModel *model, int stroke, const double *from, double *x, double part)
{
    if (!(part < 1)) return;
    for (int i = 4 * model->start[stroke]; i < 4 * model->start[stroke + 1]; i++)
        x[i] = from[i] + part * (x[i] - from[i]);
}

typedef struct Project {
    const SegmentTerm *term;
    const double *from;
    double *x;
} Project;

static void project_stroke(const Project *p, int stroke)
{
    const SplineModel *model = p->term->model;
    double part = 1;
    for (int node = model->start[stroke]; node < model->start[stroke + 1] - 1; node++)
        part = fmin(part, allowed_part(p->term, node, p->from, p->x));
    wall_shorten(model, stroke, p->from, p->x, part);
}

static void project_task(void *self, int group)
{
    const Project *p = self;
    const SplineModel *model = p->term->model;
    for (int k = model->group[group]; k < model->group[group + 1]; k++) project_stroke(p, k);
}

void wall_project(const void *self, const double *from, double *x)
{
    const SegmentTerm *term = self;
    const SplineModel *model = term->model;
    workers_run(model->workers, model->group_count, project_task, &(Project){term, from, x});
}

Term wall_term_create(const TermOps *ops, const SplineModel *model, const SplineRule *rule,
                      SplineHessian hessian, SegmentPsi *psi)
{
    bool positive = hessian != SPLINE_EXACT;
    return segment_term_create(
        ops, (SegmentTerm){.model = model,
                           .rule = rule,
                           .positive = positive,
                           .psi = psi,
                           .parts = PSI_R | PSI_T | PSI_RR | PSI_TT | (positive ? 0 : PSI_RT)});
}
