/* Alignment: psi = P t.M t/n = P n u.M(r) u. M = c (I - v v^T) asks for the direction v with the confidence
 * c; the price is per length, and turning a line around changes nothing. */
#include "spline/segment_term.h"

/* t.D t of a symmetric matrix given by (xx, xy, yy). */
static Pack form(const Pack D[3], Pack2 t)
{
    return D[0] * t.x * t.x + 2 * D[1] * t.x * t.y + D[2] * t.y * t.y;
}

static Pack2 times(const Pack D[3], Pack2 t)
{
    return pack2(D[0] * t.x + D[1] * t.y, D[1] * t.x + D[2] * t.y);
}

/* d(t.D t/n)/dt = 2 D u - (u.D u) u */
static Pack2 slope(const Pack D[3], Pack2 u)
{
    return pack2_axpy(-form(D, u), u, pack2_scale(pack_set(2), times(D, u)));
}

/* Across u only: psi_tt = (2 m.M m - u.M u)/n m m^T, m normal to u, because psi is homogeneous of degree 1 in
 * t. */
static Pack across_stiffness(const Pack M[3], const SegmentPoint *s, bool positive)
{
    Pack stiffness = 2 * form(M, pack2_across(s->u)) - form(M, s->u);
    if (positive) stiffness = pack_max(stiffness, pack_set(0));
    return stiffness / s->n;
}

static Pack align_psi(const SegmentTerm *term, const SplineWeights *weights, const SegmentPoint *s, int order,
                      Psi *psi)
{
    GridSample M;
    bool exact = order > 1 && !term->positive;
    Pack P = pack_set(weights->align);
    grid_spline_sample(term->model->target->align, s->r, order > 0 ? exact ? 2 : 1 : 0, &M);
    if (order > 0) {
        psi->r = pack2_scale(P * s->n, pack2(form(M.x, s->u), form(M.y, s->u)));
        psi->t = pack2_scale(P, slope(M.value, s->u));
    }
    if (order > 1) {
        Pack2 across = pack2_across(s->u);
        psi->tt = pack_mat2_scale(P * across_stiffness(M.value, s, term->positive),
                                  pack_mat2_outer(across, across));
    }
    if (exact) {
        Pack2 x = slope(M.x, s->u), y = slope(M.y, s->u);
        Pack Pn = P * s->n, xy = Pn * form(M.xy, s->u);
        psi->rt = pack_mat2_scale(P, (PackMat2){x.x, x.y, y.x, y.y});
        psi->rr = (PackMat2){Pn * form(M.xx, s->u), xy, xy, Pn * form(M.yy, s->u)};
    }
    return P * s->n * form(M.value, s->u);
}

static const TermOps align_ops = SEGMENT_OPS("align", segment_term_eval);

Term spline_align_term(const SplineModel *model, SplineHessian hessian)
{
    bool positive = hessian != SPLINE_EXACT;
    return segment_term_create(
        &align_ops, (SegmentTerm){.model = model,
                                  .rule = &model->rule,
                                  .positive = positive,
                                  .psi = align_psi,
                                  .parts = PSI_R | PSI_T | PSI_TT | (positive ? 0 : PSI_RR | PSI_RT)});
}
