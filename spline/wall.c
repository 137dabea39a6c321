/* Wall: psi = R n sum of b(d) over the edges, b = -(1 - d/dh)^2 ln(d/dh) for d < dh = two pens, else 0: C2,
 * convex, and infinite at the edge [Li 2020, incremental potential contact]. The distances are those of the
 * control points, so that no part of a stroke can slip through between two points. */
#include "spline/walls.h"
#include <math.h>

/* b and its derivatives in d; not finite outside. */
static Pack barrier_of(Pack d, double reach, Pack *slope, Pack *curvature)
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

static Pack wall_psi(const SegmentTerm *term, const SplineWeights *weights, const SegmentPoint *s, int order,
                     Psi *psi)
{
    const SplinePage *page = &term->model->target->page;
    Barrier sum = {0};
    Pack d[4], slope, curvature;
    wall_distances(page, s->r, d);
    for (int k = 0; k < 4; k++) {
        sum.value += barrier_of(d[k], 2 * page->pen, &slope, &curvature);
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
