/* Bending and twist: E = h/2 (k - kbar).K (k - kbar), k = theta/h the strain of an element in its frame, K =
 * young times the section's (twist, bend1, bend2). The accepted turns go into the references here. */
#include "rod/term.h"

typedef struct Strained {
    Segment s;
    Pack h, young;
    Pack3 unit, off; /* K of young 1; k - kbar */
} Strained;

static Pack3 times(Pack3 a, Pack3 b)
{
    return pack3(a.x * b.x, a.y * b.y, a.z * b.z);
}

static Strained strained(const RodTerm *term, int pack, const Point *at, const Pack *x)
{
    const Rod *rod = term->rod;
    const RodSection *unit = rod->unit;
    Strained o = {.s = segment_at(&term->layout, pack, at->x, x), .h = rod_term_length(term, pack)};
    o.young = rod_term_number(term, pack, at->p + rod->young, 1, 0);
    o.unit = pack3(rod_term_section(term, pack, &unit->twist), rod_term_section(term, pack, &unit->bend1),
                   rod_term_section(term, pack, &unit->bend2));
    Pack3 natural = rod_term_vector(term, pack, at->p + rod->natural_strain);
    o.off = pack3_sub(pack3_scale(1 / o.h, segment_theta(&o.s)), natural);
    return o;
}

/* d theta of the three turns of a or of b, as the rows of the transposed matrix. */
static PackMat theta_rows(const Segment *s, bool b)
{
    Pack3 zero = {{0}, {0}, {0}}, row[3];
    for (int i = 0; i < 3; i++) {
        Pack3 unit = pack3(pack_set(i == 0), pack_set(i == 1), pack_set(i == 2));
        row[i] = segment_theta_rate(s, b ? segment_rate(s, zero, unit) : segment_rate(s, unit, zero));
    }
    return (PackMat){row[0], row[1], row[2]};
}

/* The blocks rows K/h rows^T, and what the moment does. */
static void hessian(const Strained *o, Pack3 moment, Pack *H)
{
    PackMat block[3], a = theta_rows(&o->s, false), b = theta_rows(&o->s, true);
    Pack3 K = pack3_scale(o->young / o->h, o->unit);
    PackMat Ka = {times(K, a.r0), times(K, a.r1), times(K, a.r2)},
            Kb = {times(K, b.r0), times(K, b.r1), times(K, b.r2)};
    Jet jet = segment_theta_jet(&o->s, moment, true);
    segment_pull_hessian(&o->s, &jet, block);
    block[0] = pack_mat_add(block[0], pack_mat_product(a, pack_mat_transpose(Ka)));
    block[1] = pack_mat_add(block[1], pack_mat_product(a, pack_mat_transpose(Kb)));
    block[2] = pack_mat_add(block[2], pack_mat_product(b, pack_mat_transpose(Kb)));
    element_clear(H, 6);
    rod_term_add_blocks(H, 0, block);
}

/* The gradient of moment.theta, on the turns. */
static void gradient(const Segment *s, Pack3 moment, Pack *g)
{
    Jet jet = segment_theta_jet(s, moment, false);
    rod_term_clear(g, 6);
    segment_pull_gradient(s, &jet, g);
    rod_term_turn_gradient(s, g);
}

static Pack strain_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    Strained o = strained(self, pack, at, x);
    Pack3 moment = pack3_scale(o.young, times(o.unit, o.off));
    if (g) gradient(&o.s, moment, g);
    if (H) hessian(&o, moment, H);
    return o.h / 2 * pack3_dot(moment, o.off);
}

/* The force is moment.d theta, and moment = young unit (k - kbar). */
static void strain_param(const void *self, int pack, int lanes, const Point *at, const Pack *x, const Pack *w,
                         double *dp)
{
    const RodTerm *term = self;
    Strained o = strained(term, pack, at, x);
    Pack3 rate = segment_theta_rate(&o.s, segment_rate(&o.s, pack3_load(w), pack3_load(w + 3)));
    Pack young = pack3_dot(rate, times(o.unit, o.off));
    Pack3 natural = pack3_scale(-o.young, times(o.unit, rate));
    for (int l = 0; l < lanes; l++) {
        int e = pack * PACK_LANES + l;
        double *to = dp + term->rod->natural_strain + 3 * e;
        dp[term->rod->young + e] += young[l];
        to[0] += natural.x[l], to[1] += natural.y[l], to[2] += natural.z[l];
    }
}

static void strain_param_forward(const void *self, int pack, const Point *at, const Pack *x, const double *dp,
                                 Pack *r)
{
    const RodTerm *term = self;
    Strained o = strained(term, pack, at, x);
    Pack young = rod_term_number(term, pack, dp + term->rod->young, 1, 0);
    Pack3 natural = rod_term_vector(term, pack, dp + term->rod->natural_strain);
    gradient(&o.s, times(o.unit, pack3_sub(pack3_scale(young, o.off), pack3_scale(o.young, natural))), r);
}

static void strain_accept(const void *self, double *x, double *memory)
{
    (void)memory;
    const RodLayout *layout = &((const RodTerm *)self)->layout;
    for (int i = 0; i < layout->nodes; i++) {
        double *turn = x + layout->turn + 3 * i, *to = x + layout->reference + 4 * i;
        Quat q =
            quat_unit(quat_mul(rod_reference(layout, x, i), (Quat){1, vec3_scale(0.5, vec3_load(turn))}));
        to[0] = q.w;
        vec3_store(to + 1, q.v);
        vec3_store(turn, vec3(0, 0, 0));
    }
}

static const TermOps strain_ops = {
    .name = "strain",
    .count = rod_term_count,
    .size = rod_term_turns,
    .dofs = rod_term_turn_dofs,
    .eval = strain_eval,
    .param = strain_param,
    .param_forward = strain_param_forward,
    .accept = strain_accept,
    .destroy = mem_free,
};

Term rod_strain_term(const Rod *rod, RodLayout layout, double hold)
{
    return rod_term_make(&strain_ops, rod, layout, hold);
}
