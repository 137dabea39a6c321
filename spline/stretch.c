/* Linewise's strain, of each segment by its whole length: E = S (L - L0)^2 L/L0^2, so E' = S (L - L0)(3 L -
 * L0)/L0^2 and E'' = S (6 L - 4 L0)/L0^2. It is zero at L = 0 too: short segments collapse. `strain` has not
 * this fault. */
#include "spline/segment_term.h"

/* Length, its gradient and Hessian. */
static Pack length_of(const SegmentTerm *term, int pack, const Pack *x, Pack *g, Pack *H)
{
    Pack length = {0};
    memset(g, 0, 8 * sizeof *g);
    if (H) memset(H, 0, TERM_LOWER(8, 0) * sizeof *H);
    for (int k = 0; k < term->rule->count; k++) {
        SegmentPoint s = segment_point(term, pack, k, x);
        Pack w = pack_set(term->rule->weight[k]);
        Pack2 across = pack2_across(s.u);
        Psi psi = {.t = s.u, .tt = pack_mat2_scale(1 / s.n, pack_mat2_outer(across, across))};
        length += w * s.n;
        segment_add_gradient(term, k, w, &psi, g);
        if (H) segment_add_hessian(term, k, w, &psi, H);
    }
    return length;
}

static Pack stretch_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const SegmentTerm *term = self;
    Pack slope[8], zero = {0}, L0 = term->model->rest_pack[pack], L = length_of(term, pack, x, slope, H);
    Pack S = ((const SplineWeights *)at->p)->stretch / (L0 * L0);
    Pack first = S * (L - L0) * (3 * L - L0), second = S * (6 * L - 4 * L0);
    for (int i = 0; g && i < 8; i++) g[i] = first * slope[i];
    if (H && term->positive) first = pack_max(first, zero), second = pack_max(second, zero);
    for (int i = 0; H && i < 8; i++)
        for (int j = 0; j <= i; j++) {
            Pack *h = &H[TERM_LOWER(i, j)];
            *h = first * *h + second * slope[i] * slope[j];
        }
    return S * (L - L0) * (L - L0) * L;
}

static const TermOps stretch_ops = SEGMENT_OPS("stretch", stretch_eval);

Term spline_stretch_term(const SplineModel *model, SplineHessian hessian)
{
    return segment_term_create(&stretch_ops, (SegmentTerm){.model = model,
                                                           .rule = &model->rule,
                                                           .positive = hessian != SPLINE_EXACT,
                                                           .parts = PSI_T | PSI_TT});
}
