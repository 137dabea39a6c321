/* Bending, linear: psi = B |a|^2/L0^3, which is B k^2 per length where n = L0. Unlike the curvature it is
 * convex, and a fold whose speed vanishes at a quadrature point cannot hide from it. */
#include "spline/segment_term.h"

static Pack bend_psi(const SegmentTerm *term, const SplineWeights *weights, const SegmentPoint *s, int order,
                     Psi *psi)
{
    (void)term;
    Pack B = weights->bend / (s->rest * s->rest * s->rest);
    if (order > 0) psi->a = pack2_scale(2 * B, s->a);
    if (order > 1) psi->aa = pack_mat2_diagonal(2 * B);
    return B * pack2_dot(s->a, s->a);
}

static const TermOps bend_ops = SEGMENT_OPS("bend", segment_term_eval);

Term spline_bend_term(const SplineModel *model, SplineHessian hessian)
{
    (void)hessian;
    return segment_term_create(
        &bend_ops,
        (SegmentTerm){.model = model, .rule = &model->rule, .psi = bend_psi, .parts = PSI_A | PSI_AA});
}
