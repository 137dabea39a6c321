/* Wall: psi = R n sum of b(d) over the edges, b a barrier two pens wide (walls.h). The distances are those of
 * the control points, so that no part of a stroke can slip through between two points. */
#include "spline/walls.h"

static Pack wall_psi(const SegmentTerm *term, const SplineWeights *weights, const SegmentPoint *s, int order,
                     Psi *psi)
{
    const SplinePage *page = &term->model->target->page;
    Barrier sum = {0};
    Pack d[4], slope, curvature;
    wall_distances(page, s->r, d);
    for (int k = 0; k < 4; k++) {
        sum.value += wall_barrier(d[k], 2 * page->pen, &slope, &curvature);
        *(k < 2 ? &sum.slope.x : &sum.slope.y) += k % 2 ? -slope : slope;
        *(k < 2 ? &sum.xx : &sum.yy) += curvature;
    }
    return wall_psi_of(term, weights->wall, &sum, s, order, psi);
}

static const TermOps wall_ops = WALL_OPS("wall");

Term spline_wall_term(const SplineModel *model, SplineHessian hessian)
{
    return wall_term_create(&wall_ops, model, &model->wall_rule, hessian, wall_psi);
}
