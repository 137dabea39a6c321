/* Linewise's boundary: psi = R n/d^2, d the distance to the nearest edge; infinite outside. It acts
 * everywhere, and has kinks where the nearest edge changes; `wall` has neither fault. */
#include "spline/walls.h"
#include <math.h>

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
    return wall_psi_of(term, weights->boundary, &near, s, order, psi);
}

static const TermOps boundary_ops = WALL_OPS("boundary");

Term spline_boundary_term(const SplineModel *model, SplineHessian hessian)
{
    return wall_term_create(&boundary_ops, model, &model->rule, hessian, boundary_psi);
}
