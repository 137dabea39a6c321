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

static const TermOps boundary_ops = {.name = "boundary",
                                     .count = segment_term_count,
                                     .size = segment_term_size,
                                     .dofs = segment_term_dofs,
                                     .eval = segment_term_eval,
                                     .project = wall_project,
                                     .accept = wall_accept,
                                     .destroy = wall_destroy};

Term spline_boundary_term(const SplineModel *model, SplineHessian hessian)
{
    bool positive = hessian != SPLINE_EXACT;
    return wall_term_create(
        &boundary_ops, (SegmentTerm){.model = model,
                                     .rule = &model->rule,
                                     .positive = positive,
                                     .psi = boundary_psi,
                                     .parts = PSI_R | PSI_T | PSI_RR | PSI_TT | (positive ? 0 : PSI_RT)});
}
