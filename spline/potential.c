/* Linewise's potential: psi = Q n Phi(r). Without a pair energy that fits it, everything falls into the least
 * Phi. */
#include "spline/segment_term.h"

static Pack potential_psi(const SegmentTerm *term, const SplineWeights *weights, const SegmentPoint *s,
                          int order, Psi *psi)
{
    GridSample Phi;
    grid_spline_sample(term->model->target->potential, s->r, order, &Phi);
    Pack Q = pack_set(weights->potential), Qn = Q * s->n, value = Phi.value[0];
    if (order > 0) {
        psi->r = pack2_scale(Qn, pack2(Phi.x[0], Phi.y[0]));
        psi->t = pack2_scale(Q * value, s->u);
    }
    if (order > 1) {
        Pack pull = term->positive ? pack_max(value, pack_set(0)) : value;
        Pack2 across = pack2_across(s->u);
        psi->tt = pack_mat2_scale(Q * pull / s->n, pack_mat2_outer(across, across));
        psi->rr = (PackMat2){Qn * Phi.xx[0], Qn * Phi.xy[0], Qn * Phi.xy[0], Qn * Phi.yy[0]};
        psi->rt = pack_mat2_scale(Q, pack_mat2_outer(pack2(Phi.x[0], Phi.y[0]), s->u));
    }
    return Qn * value;
}

static const TermOps potential_ops = SEGMENT_OPS("potential", segment_term_eval);

Term spline_potential_term(const SplineModel *model, SplineHessian hessian)
{
    bool positive = hessian != SPLINE_EXACT;
    return segment_term_create(
        &potential_ops, (SegmentTerm){.model = model,
                                      .rule = &model->rule,
                                      .positive = positive,
                                      .psi = potential_psi,
                                      .parts = PSI_R | PSI_T | PSI_TT | (positive ? 0 : PSI_RR | PSI_RT)});
}
