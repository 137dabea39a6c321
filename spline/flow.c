/* Linewise's field energy: psi = P v(r).t. It changes sign with the sense of the stroke and, where v is a
 * gradient, depends on the ends alone; `align` is what one wants. Nothing of its Hessian is semidefinite. */
#include "spline/segment_term.h"

static Pack flow_psi(const SegmentTerm *term, const SplineWeights *weights, const SegmentPoint *s, int order,
                     Psi *psi)
{
    GridSample v;
    if (order > 1 && term->positive) order = 1;
    grid_spline_sample(term->model->target->flow, s->r, order, &v);
    Pack P = pack_set(weights->flow);
    if (order > 0) {
        psi->r = pack2_scale(P, pack2(v.x[0] * s->t.x + v.x[1] * s->t.y, v.y[0] * s->t.x + v.y[1] * s->t.y));
        psi->t = pack2_scale(P, pack2(v.value[0], v.value[1]));
    }
    if (order > 1) {
        Pack xy = P * (v.xy[0] * s->t.x + v.xy[1] * s->t.y);
        psi->rr = (PackMat2){P * (v.xx[0] * s->t.x + v.xx[1] * s->t.y), xy, xy,
                             P * (v.yy[0] * s->t.x + v.yy[1] * s->t.y)};
        psi->rt = pack_mat2_scale(P, (PackMat2){v.x[0], v.x[1], v.y[0], v.y[1]});
    }
    return P * (v.value[0] * s->t.x + v.value[1] * s->t.y);
}

static const TermOps flow_ops = SEGMENT_OPS("flow", segment_term_eval);

Term spline_flow_term(const SplineModel *model, SplineHessian hessian)
{
    return segment_term_create(
        &flow_ops, (SegmentTerm){.model = model,
                                 .rule = &model->rule,
                                 .positive = hessian != SPLINE_EXACT,
                                 .psi = flow_psi,
                                 .parts = PSI_R | PSI_T | (hessian == SPLINE_EXACT ? PSI_RR | PSI_RT : 0)});
}
