/* Couples C on nodes, N m, that keep their direction in the world while the node turns: they have no potential. What acts on a
 * turn phi from the reference R is R^T C where the turn is 0, and there the derivative's symmetric part is none, the skew one
 * phi x R^T C/2; so
 *
 *     E = -C.R phi
 *
 * has force and Hessian where turns are 0, which is where states stand: the references take the accepted turns, E is 0
 * there, and what is lacking is TermOps.circulate. */
#include "rod/term.h"

static void couple_dofs(const void *self, int node, int *dof)
{
    const RodLayout *layout = &((const RodTerm *)self)->layout;
    for (int i = 0; i < 3; i++) dof[i] = layout->turn + 3 * node + i;
}

/* R^T C of the nodes, with the couples of values laid out as p. */
static Pack3 couple_of(const RodTerm *term, int pack, const Point *at, const double *values)
{
    Pack3 c;
    for (int l = 0; l < PACK_LANES; l++) {
        int node = rod_term_node(term, pack, l);
        Quat q = rod_reference(&term->layout, at->x, node);
        Vec3 own = quat_rotate(quat_conj(q), vec3_load(values + term->rod->couple + 3 * node));
        c.x[l] = own.x, c.y[l] = own.y, c.z[l] = own.z;
    }
    return c;
}

static Pack couple_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    Pack3 c = couple_of(self, pack, at, at->p);
    if (g) pack3_store(g, pack3_neg(c));
    if (H) element_clear(H, 3);
    return -pack3_dot(c, pack3_load(x));
}

static void couple_circulate(const void *self, int pack, const Point *at, const Pack *x, const Pack *d,
                             Pack *r)
{
    (void)x;
    pack3_store(r, pack3_scale(pack_set(0.5), pack3_cross(pack3_load(d), couple_of(self, pack, at, at->p))));
}

static void couple_param(const void *self, int pack, int lanes, const Point *at, const Pack *x, const Pack *w,
                         double *dp)
{
    (void)x;
    const RodTerm *term = self;
    for (int l = 0; l < lanes; l++) {
        int node = rod_term_node(term, pack, l);
        Vec3 turn = quat_rotate(rod_reference(&term->layout, at->x, node), vec3(w[0][l], w[1][l], w[2][l]));
        double *to = dp + term->rod->couple + 3 * node;
        to[0] -= turn.x, to[1] -= turn.y, to[2] -= turn.z;
    }
}

static void couple_param_forward(const void *self, int pack, const Point *at, const Pack *x, const double *dp,
                                 Pack *r)
{
    (void)x;
    pack3_store(r, pack3_neg(couple_of(self, pack, at, dp)));
}

static const TermOps couple_ops = {
    .name = "couple",
    .count = rod_term_nodes,
    .size = rod_term_three,
    .dofs = couple_dofs,
    .eval = couple_eval,
    .circulate = couple_circulate,
    .param = couple_param,
    .param_forward = couple_param_forward,
    .destroy = mem_free,
};

Term rod_couple_term(const Rod *rod, RodLayout layout, double hold)
{
    return rod_term_make(&couple_ops, rod, layout, hold);
}
