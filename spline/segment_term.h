/* segment_term.h - what terms over single segments share: eight dofs (two nodes), quadrature, and the way
 * from a density of energy psi(r, t, a), t = r', a = r'', to gradient and Hessian.
 *
 * With the basis N of r, N' of t and N'' of a at a point, dE/dx_k = w (N_k psi_r + N'_k psi_t + N''_k psi_a),
 * and the Hessian has w N^x_k N^y_l psi_xy for each pair (x, y) of r, t and a. */
#pragma once
#include "base/memory.h"
#include "spline/terms.h"

/* Rows x and y. */
typedef struct PackMat2 {
    Pack xx, xy, yx, yy;
} PackMat2;

static inline Pack2 pack2(Pack x, Pack y)
{
    return (Pack2){x, y};
}
static inline Pack2 pack2_scale(Pack s, Pack2 a)
{
    return pack2(s * a.x, s * a.y);
}
static inline Pack2 pack2_axpy(Pack s, Pack2 a, Pack2 b)
{
    return pack2(s * a.x + b.x, s * a.y + b.y);
}
static inline Pack pack2_dot(Pack2 a, Pack2 b)
{
    return a.x * b.x + a.y * b.y;
}
static inline PackMat2 pack_mat2_outer(Pack2 a, Pack2 b)
{
    return (PackMat2){a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y};
}
static inline PackMat2 pack_mat2_add(PackMat2 a, PackMat2 b)
{
    return (PackMat2){a.xx + b.xx, a.xy + b.xy, a.yx + b.yx, a.yy + b.yy};
}
static inline PackMat2 pack_mat2_scale(Pack s, PackMat2 a)
{
    return (PackMat2){s * a.xx, s * a.xy, s * a.yx, s * a.yy};
}
static inline PackMat2 pack_mat2_diagonal(Pack a)
{
    return (PackMat2){a, pack_set(0), pack_set(0), a};
}
static inline Pack pack_max(Pack a, Pack b)
{
    return pack_select(a > b, a, b);
}

/* A quadrature point of a pack of segments. */
typedef struct SegmentPoint {
    Pack2 r, t, a, u; /* u = t/n */
    Pack n, rest;     /* |t|, L0 */
} SegmentPoint;

/* a across u, for outer products: I - u u^T = across(u) across(u)^T. */
static inline Pack2 pack2_across(Pack2 u)
{
    return pack2(-u.y, u.x);
}

/* Derivatives of psi; those that a term does not name in `parts` are not looked at. */
typedef struct Psi {
    Pack2 r, t, a;
    PackMat2 rr, rt, tt, ta, aa;
} Psi;

enum { PSI_R = 1, PSI_T = 2, PSI_A = 4, PSI_RR = 8, PSI_RT = 16, PSI_TT = 32, PSI_TA = 64, PSI_AA = 128 };

typedef struct SegmentTerm SegmentTerm;

/* psi at a point; derivatives up to `order` go to psi. */
typedef Pack SegmentPsi(const SegmentTerm *term, const SplineWeights *weights, const SegmentPoint *s,
                        int order, Psi *psi);

struct SegmentTerm {
    const SplineModel *model;
    const SplineRule *rule;
    bool positive; /* second derivatives are to be semidefinite */
    SegmentPsi *psi;
    int parts;
};

/* The term borrows the model; ops are made by SEGMENT_OPS. */
Term segment_term_create(const TermOps *ops, SegmentTerm term);

/* For these, eval may be another one that uses the functions below. */
int segment_term_count(const void *self);
int segment_term_size(const void *self);
void segment_term_dofs(const void *self, int segment, int *dof);
Pack segment_term_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H);

#define SEGMENT_OPS(row_name, eval_function)                                                                 \
    {                                                                                                        \
        .name = row_name, .count = segment_term_count, .size = segment_term_size, .dofs = segment_term_dofs, \
        .eval = eval_function, .destroy = mem_free,                                                          \
    }

/* Point k of the rule. */
SegmentPoint segment_point(const SegmentTerm *term, int pack, int k, const Pack *x);

/* g += w times the first derivatives in `parts`, H += w times the second ones. */
void segment_add_gradient(const SegmentTerm *term, int k, Pack w, const Psi *psi, Pack *g);
void segment_add_hessian(const SegmentTerm *term, int k, Pack w, const Psi *psi, Pack *H);
