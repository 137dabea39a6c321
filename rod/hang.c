/* Weight and dead loads of a rod without positions: E = -sum_e T_e.(chord of e, stretched), T_e the sum of the loads
 * beyond the element, which is the potential of the nodes' weights and loads but for that of the first node.
 */
#include "rod/chord.h"

/* Mass beyond the element's middle, kg. */
static Pack beyond(const RodTerm *term, int pack)
{
    const Rod *rod = term->rod;
    Pack elements, h = rod_term_length(term, pack);
    for (int l = 0; l < PACK_LANES; l++) {
        int e = segment_lane(&term->layout, pack, l) % term->layout.each;
        elements[l] = term->layout.each - e - 0.5;
    }
    return rod_term_section(term, pack, &rod->unit->mass) * h * elements +
           rod_term_number(term, pack, rod->heavier, 1, 0) * h;
}

/* T with the numbers of p, or its change with those of dp. */
static Pack3 pull(const RodTerm *term, int pack, const double *p)
{
    const Rod *rod = term->rod;
    return pack3_axpy(beyond(term, pack), rod_term_uniform(p + rod->gravity),
                      rod_term_vector(term, pack, p + rod->pull));
}

static int hang_size(const void *self)
{
    return ((const RodTerm *)self)->layout.strain >= 0 ? 9 : 6;
}

static void hang_dofs(const void *self, int e, int *dof)
{
    rod_term_turn_dofs(self, e, dof);
    rod_term_strain_dofs(self, e, dof + 6);
}

static void gradient(const Chord *chord, Pack3 T, Pack *g)
{
    rod_term_clear(g, chord->stretches ? 9 : 6);
    chord_gradient(chord, T, g);
    rod_term_turn_gradient(&chord->s, g);
}

static void hessian(const Chord *chord, Pack3 T, Pack *H)
{
    PackMat block[3];
    chord_hessian(chord, T, block);
    element_clear(H, chord->stretches ? 9 : 6);
    rod_term_add_blocks(H, 0, block);
    if (!chord->stretches) return;
    chord_mixed_hessian(chord, T, block);
    for (int k = 0; k < 2; k++) element_add_block(H, 2, k, block[k]);
}

static Pack hang_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    Chord chord = chord_at(self, pack, at->x, x);
    Pack3 T = pull(self, pack, at->p);
    if (g) gradient(&chord, T, g);
    if (H) hessian(&chord, T, H);
    return -pack3_dot(T, chord_world(&chord));
}

static void hang_param(const void *self, int pack, int lanes, const Point *at, const Pack *x, const Pack *w,
                       double *dp)
{
    const RodTerm *term = self;
    Chord chord = chord_at(term, pack, at->x, x);
    Pack3 rate = chord_rate(&chord, pack3_load(w), pack3_load(w + 3));
    if (chord.stretches) rate = pack3_add(rate, chord_strain_rate(&chord, pack3_load(w + 6)));
    Pack mass = beyond(term, pack);
    for (int l = 0; l < lanes; l++) {
        double *to = dp + term->rod->pull + 3 * (pack * PACK_LANES + l), *gravity = dp + term->rod->gravity;
        double moved[3] = {rate.x[l], rate.y[l], rate.z[l]};
        for (int i = 0; i < 3; i++) to[i] -= moved[i], gravity[i] -= mass[l] * moved[i];
    }
}

static void hang_param_forward(const void *self, int pack, const Point *at, const Pack *x, const double *dp,
                               Pack *r)
{
    Chord chord = chord_at(self, pack, at->x, x);
    gradient(&chord, pull(self, pack, dp), r);
}

static const TermOps hang_ops = {
    .name = "gravity",
    .count = rod_term_count,
    .size = hang_size,
    .dofs = hang_dofs,
    .eval = hang_eval,
    .param = hang_param,
    .param_forward = hang_param_forward,
    .destroy = mem_free,
};

Term rod_hang_term(const Rod *rod, RodLayout layout, double hold)
{
    return rod_term_make(&hang_ops, rod, layout, hold);
}
