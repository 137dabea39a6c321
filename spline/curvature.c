/* Linewise's bending: psi = B k^2 n = B c^2/n^5, c = t x a. A stroke can fold with n near 0 at a quadrature
 * point, where the energy stays finite and its gradient is huge: relaxations stall there. `bend` has not this
 * fault. */
#include "spline/segment_term.h"

/* c = t.al = a.be with al = (a.y, -a.x), be = (-t.y, t.x). */
static void exact_hessian(Pack B, Pack c, const SegmentPoint *s, Pack2 al, Pack2 be, Psi *psi)
{
    Pack i2 = 1 / (s->n * s->n), i5 = i2 * i2 / s->n, i7 = i5 * i2, i9 = i7 * i2, Bc = B * c, Bc2 = Bc * c;
    PackMat2 mixed = pack_mat2_add(pack_mat2_outer(al, s->t), pack_mat2_outer(s->t, al));
    psi->tt = pack_mat2_add(pack_mat2_scale(2 * B * i5, pack_mat2_outer(al, al)),
                            pack_mat2_scale(-10 * Bc * i7, mixed));
    psi->tt = pack_mat2_add(psi->tt, pack_mat2_diagonal(-5 * Bc2 * i7));
    psi->tt = pack_mat2_add(psi->tt, pack_mat2_scale(35 * Bc2 * i9, pack_mat2_outer(s->t, s->t)));
    psi->ta = pack_mat2_add(pack_mat2_scale(2 * B * i5, pack_mat2_outer(al, be)),
                            pack_mat2_scale(-10 * Bc * i7, pack_mat2_outer(s->t, be)));
    psi->ta.xy += 2 * Bc * i5;
    psi->ta.yx -= 2 * Bc * i5;
    psi->aa = pack_mat2_scale(2 * B * i5, pack_mat2_outer(be, be));
}

/* Of the square of c/n^2.5, whose derivatives are al/n^2.5 - 2.5 c t/n^4.5 and be/n^2.5. */
static void positive_hessian(Pack B, Pack c, const SegmentPoint *s, Pack2 al, Pack2 be, Psi *psi)
{
    Pack i2 = 1 / (s->n * s->n), i5 = i2 * i2 / s->n;
    Pack2 by_t = pack2_axpy(-2.5 * c * i2, s->t, al);
    psi->tt = pack_mat2_scale(2 * B * i5, pack_mat2_outer(by_t, by_t));
    psi->ta = pack_mat2_scale(2 * B * i5, pack_mat2_outer(by_t, be));
    psi->aa = pack_mat2_scale(2 * B * i5, pack_mat2_outer(be, be));
}

static Pack curvature_psi(const SegmentTerm *term, const SplineWeights *weights, const SegmentPoint *s,
                          int order, Psi *psi)
{
    Pack B = pack_set(weights->curvature), c = s->t.x * s->a.y - s->t.y * s->a.x;
    Pack i2 = 1 / (s->n * s->n), i5 = i2 * i2 / s->n;
    Pack2 al = pack2(s->a.y, -s->a.x), be = pack2(-s->t.y, s->t.x);
    if (order > 0) {
        psi->t = pack2_axpy(-5 * B * c * c * i5 * i2, s->t, pack2_scale(2 * B * c * i5, al));
        psi->a = pack2_scale(2 * B * c * i5, be);
    }
    if (order > 1) (term->positive ? positive_hessian : exact_hessian)(B, c, s, al, be, psi);
    return B * c * c * i5;
}

static const TermOps curvature_ops = SEGMENT_OPS("curvature", segment_term_eval);

Term spline_curvature_term(const SplineModel *model, SplineHessian hessian)
{
    return segment_term_create(&curvature_ops,
                               (SegmentTerm){.model = model,
                                             .rule = &model->rule,
                                             .positive = hessian != SPLINE_EXACT,
                                             .psi = curvature_psi,
                                             .parts = PSI_T | PSI_A | PSI_TT | PSI_TA | PSI_AA});
}
