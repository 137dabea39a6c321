#include "spline/segment_term.h"

int segment_term_count(const void *self)
{
    return ((const SegmentTerm *)self)->model->segment_count;
}

int segment_term_size(const void *self)
{
    (void)self;
    return 8;
}

void segment_term_dofs(const void *self, int segment, int *dof)
{
    int node = ((const SegmentTerm *)self)->model->segment_node[segment];
    for (int i = 0; i < 8; i++) dof[i] = 4 * node + i;
}

static Pack2 combine(const double basis[4], const Pack *x)
{
    Pack2 sum = {x[0] * basis[0], x[1] * basis[0]};
    for (int k = 1; k < 4; k++) sum = pack2_axpy(pack_set(basis[k]), pack2(x[2 * k], x[2 * k + 1]), sum);
    return sum;
}

SegmentPoint segment_point(const SegmentTerm *term, int pack, int k, const Pack *x)
{
    const SplineRule *rule = term->rule;
    SegmentPoint s = {.r = combine(rule->value[k], x),
                      .t = combine(rule->first[k], x),
                      .a = combine(rule->second[k], x),
                      .rest = term->model->rest_pack[pack]};
    s.n = pack_sqrt(pack2_dot(s.t, s.t));
    s.u = pack2_scale(1 / s.n, s.t);
    return s;
}

static void add_vector(Pack *g, Pack w, const double basis[4], Pack2 v)
{
    for (int k = 0; k < 4; k++) {
        g[2 * k] += w * basis[k] * v.x;
        g[2 * k + 1] += w * basis[k] * v.y;
    }
}

void segment_add_gradient(const SegmentTerm *term, int k, Pack w, const Psi *psi, Pack *g)
{
    const SplineRule *rule = term->rule;
    if (term->parts & PSI_R) add_vector(g, w, rule->value[k], psi->r);
    if (term->parts & PSI_T) add_vector(g, w, rule->first[k], psi->t);
    if (term->parts & PSI_A) add_vector(g, w, rule->second[k], psi->a);
}

/* The 2x2 block (k, l), k >= l, of an element Hessian. */
static void add_block(Pack *H, int k, int l, PackMat2 m)
{
    H[TERM_LOWER(2 * k, 2 * l)] += m.xx;
    H[TERM_LOWER(2 * k + 1, 2 * l)] += m.yx;
    H[TERM_LOWER(2 * k + 1, 2 * l + 1)] += m.yy;
    if (k > l) H[TERM_LOWER(2 * k, 2 * l + 1)] += m.xy;
}

/* w basis_k basis_l m, m symmetric. */
static void add_same(Pack *H, Pack w, const double basis[4], PackMat2 m)
{
    for (int k = 0; k < 4; k++)
        for (int l = 0; l <= k; l++) add_block(H, k, l, pack_mat2_scale(w * basis[k] * basis[l], m));
}

/* w (a_k b_l m + b_k a_l m^T). */
static void add_mixed(Pack *H, Pack w, const double a[4], const double b[4], PackMat2 m)
{
    PackMat2 transposed = {m.xx, m.yx, m.xy, m.yy};
    for (int k = 0; k < 4; k++)
        for (int l = 0; l <= k; l++) {
            add_block(H, k, l, pack_mat2_scale(w * a[k] * b[l], m));
            add_block(H, k, l, pack_mat2_scale(w * b[k] * a[l], transposed));
        }
}

void segment_add_hessian(const SegmentTerm *term, int k, Pack w, const Psi *psi, Pack *H)
{
    const SplineRule *rule = term->rule;
    const double *r = rule->value[k], *t = rule->first[k], *a = rule->second[k];
    if (term->parts & PSI_RR) add_same(H, w, r, psi->rr);
    if (term->parts & PSI_RT) add_mixed(H, w, r, t, psi->rt);
    if (term->parts & PSI_TT) add_same(H, w, t, psi->tt);
    if (term->parts & PSI_TA) add_mixed(H, w, t, a, psi->ta);
    if (term->parts & PSI_AA) add_same(H, w, a, psi->aa);
}

Pack segment_term_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const SegmentTerm *term = self;
    int order = H ? 2 : g ? 1 : 0;
    Pack energy = {0};
    if (g) memset(g, 0, 8 * sizeof *g);
    if (H) memset(H, 0, TERM_LOWER(8, 0) * sizeof *H);
    for (int k = 0; k < term->rule->count; k++) {
        Psi psi;
        SegmentPoint s = segment_point(term, pack, k, x);
        Pack w = pack_set(term->rule->weight[k]);
        energy += w * term->psi(term, (const SplineWeights *)at->p, &s, order, &psi);
        if (g) segment_add_gradient(term, k, w, &psi, g);
        if (H) segment_add_hessian(term, k, w, &psi, H);
    }
    return energy;
}

Term segment_term_create(const TermOps *ops, SegmentTerm term)
{
    return (Term){ops, mem_copy(&term, 1, sizeof term)};
}
