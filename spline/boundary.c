/* Linewise's boundary: psi = R n/d^2, d the distance to the nearest edge, or to the region's outline where that
 * is nearer; infinite outside. It acts everywhere, and has kinks where the nearest edge changes; `wall` and
 * `outline` have neither fault. */
#include "spline/walls.h"
#include <math.h>

/* Where the outline is nearer than the edge. */
static void take_outline(const SegmentTerm *term, Pack2 at, int order, Barrier *near)
{
    GridSample d;
    grid_spline_sample(term->model->target->outline, at, order, &d);
    Pack inverse = 1 / d.value[0], square = inverse * inverse, slope = -2 * square * inverse;
    PackMask in = d.value[0] > 0, nearer = ~in | (square > near->value);
    Barrier b = {.value = pack_select(in, square, pack_set(INFINITY))};
    near->value = pack_select(nearer, b.value, near->value);
    if (order < 1) return;
    near->slope.x = pack_select(nearer, slope * d.x[0], near->slope.x);
    near->slope.y = pack_select(nearer, slope * d.y[0], near->slope.y);
    if (order < 2) return;
    wall_curve(&b, slope, 6 * square * square, &d, term->positive);
    near->xx = pack_select(nearer, b.xx, near->xx);
    near->xy = pack_select(nearer, b.xy, near->xy);
    near->yy = pack_select(nearer, b.yy, near->yy);
}

static Pack boundary_psi(const SegmentTerm *term, const SplineWeights *weights, const SegmentPoint *s,
                         int order, Psi *psi)
{
    Barrier near = {0};
    Pack distance[4];
    wall_distances(&term->model->target->page, s->r, distance);
    for (int l = 0; l < PACK_LANES; l++) {
        int nearest = 0;
        for (int k = 1; k < 4; k++)
            if (distance[k][l] < distance[nearest][l]) nearest = k;
        double d = distance[nearest][l], sign = nearest % 2 ? -1 : 1;
        near.value[l] = d > 0 ? 1 / (d * d) : INFINITY;
        (nearest < 2 ? &near.slope.x : &near.slope.y)[0][l] = -2 * sign / (d * d * d);
        (nearest < 2 ? &near.xx : &near.yy)[0][l] = 6 / (d * d * d * d);
    }
    if (term->model->target->outline) take_outline(term, s->r, order, &near);
    return wall_psi_of(term, weights->boundary, &near, s, order, psi);
}

static const TermOps boundary_ops = WALL_OPS("boundary");

Term spline_boundary_term(const SplineModel *model, SplineHessian hessian)
{
    return wall_term_create(&boundary_ops, model, &model->rule, hessian, boundary_psi);
}
