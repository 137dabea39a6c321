/* Stretch and shear of a Cosserat rod: E = h/2 young G.K G, G the strain of an element, K the section's (stretch, shear1,
 * shear2) of a Young's modulus of 1 Pa. */
#include "rod/term.h"

static int stretch_size(const void *self)
{
    (void)self;
    return 3;
}

/* f K */
static Pack3 stiffness(const RodTerm *term, int pack, Pack f)
{
    const RodSection *unit = term->rod->unit;
    return pack3_scale(f, pack3(rod_term_section(term, pack, &unit->stretch),
                                rod_term_section(term, pack, &unit->shear1),
                                rod_term_section(term, pack, &unit->shear2)));
}

/* h K G; the energy is young G.(that)/2. */
static Pack3 stress(const RodTerm *term, int pack, Pack3 G)
{
    Pack3 K = stiffness(term, pack, rod_term_length(term, pack));
    return pack3(K.x * G.x, K.y * G.y, K.z * G.z);
}

static Pack stretch_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const RodTerm *term = self;
    Pack young = rod_term_number(term, pack, at->p + term->rod->young, 1, 0);
    Pack3 G = pack3_load(x), force = pack3_scale(young, stress(term, pack, G));
    if (g) pack3_store(g, force);
    if (H) {
        Pack3 K = stiffness(term, pack, young * rod_term_length(term, pack));
        element_clear(H, 3);
        H[TERM_LOWER(0, 0)] = K.x, H[TERM_LOWER(1, 1)] = K.y, H[TERM_LOWER(2, 2)] = K.z;
    }
    return pack3_dot(force, G) / 2;
}

/* The law is linear: pushed by EA and more, an element has no length, and then one that goes backwards. */
static bool stretch_tangles(const void *self, const Point *at)
{
    const RodTerm *term = self;
    return rod_is_tangled(rod_least_stretch(&term->layout, at->x, NULL));
}

static void stretch_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                          const Pack *w, double *dp)
{
    (void)at;
    const RodTerm *term = self;
    Pack young = pack3_dot(pack3_load(w), stress(term, pack, pack3_load(x)));
    for (int l = 0; l < lanes; l++) dp[term->rod->young + pack * PACK_LANES + l] += young[l];
}

static void stretch_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                  const double *dp, Pack *r)
{
    (void)at;
    const RodTerm *term = self;
    Pack young = rod_term_number(term, pack, dp + term->rod->young, 1, 0);
    pack3_store(r, pack3_scale(young, stress(term, pack, pack3_load(x))));
}

static const TermOps stretch_ops = {
    .name = "stretch",
    .count = rod_term_count,
    .size = stretch_size,
    .dofs = rod_term_strain_dofs,
    .eval = stretch_eval,
    .tangles = stretch_tangles,
    .param = stretch_param,
    .param_forward = stretch_param_forward,
    .destroy = mem_free,
};

Term rod_stretch_term(const Rod *rod, RodLayout layout, double hold)
{
    return rod_term_make(&stretch_ops, rod, layout, hold);
}
