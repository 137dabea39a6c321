/* Strain, at each point: psi = S (n - L0)^2/(2 L0). It holds the length of a segment and the speed within it,
 * so that nodes and their v have no motion that costs nothing. */
#include "spline/segment_term.h"

static Pack strain_psi(const SegmentTerm *term, const SplineWeights *weights, const SegmentPoint *s,
                       int order, Psi *psi)
{
    Pack S = weights->strain / s->rest, e = s->n - s->rest;
    if (order > 0) psi->t = pack2_scale(S * e, s->u);
    if (order > 1) {
        Pack pull = term->positive ? pack_max(e, pack_set(0)) : e;
        Pack2 across = pack2_across(s->u);
        psi->tt = pack_mat2_add(pack_mat2_scale(S, pack_mat2_outer(s->u, s->u)),
                                pack_mat2_scale(S * pull / s->n, pack_mat2_outer(across, across)));
    }
    return S * e * e / 2;
}

static const TermOps strain_ops = SEGMENT_OPS("strain", segment_term_eval);

Term spline_strain_term(const SplineModel *model, SplineHessian hessian)
{
    return segment_term_create(&strain_ops, (SegmentTerm){.model = model,
                                                          .rule = &model->rule,
                                                          .positive = hessian != SPLINE_EXACT,
                                                          .psi = strain_psi,
                                                          .parts = PSI_T | PSI_TT});
}
