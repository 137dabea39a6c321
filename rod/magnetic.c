/* Hard-magnetic energy E = -V/2 sum over both nodes of M.R^T B: M the remanent magnetisation of an element in
 * the material frame, V its volume, B uniform. Magnetised along the tangent it acts like an additional pull M
 * V/h B. */
#include "rod/term.h"

static Pack3 node_field(const RodTerm *term, int pack, int offset, const double *x, Pack3 turn,
                        const double *B)
{
    Pack3 u;
    for (int l = 0; l < PACK_LANES; l++) {
        Quat q = rod_reference(&term->layout, x, segment_lane(&term->layout, pack, l) + offset);
        Quat half = {1, {turn.x[l] / 2, turn.y[l] / 2, turn.z[l] / 2}};
        Vec3 v = quat_rotate(quat_conj(quat_unit(quat_mul(q, half))), vec3_load(B));
        u.x[l] = v.x, u.y[l] = v.y, u.z[l] = v.z;
    }
    return u;
}

/* V/2, m^3 */
static Pack half_volume(const RodTerm *term)
{
    return pack_set(term->rod->area * rod_element_length(term->rod) / 2);
}

static Pack magnetic_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const RodTerm *term = self;
    Pack3 M = pack3_scale(half_volume(term), rod_term_vector(term, pack, at->p + term->rod->magnetization));
    const double *B = at->p + term->rod->flux_density;
    Pack energy = {0};
    if (g) rod_term_clear(g, 6);
    if (H) element_clear(H, 6);
    if (B[0] == 0 && B[1] == 0 && B[2] == 0) return energy;
    for (int k = 0; k < 2; k++) {
        Pack3 turn = pack3_load(x + 3 * k), u = node_field(term, pack, k, at->x, turn, B);
        energy -= pack3_dot(M, u);
        if (g) pack3_store(g + 3 * k, segment_turned(turn, pack3_cross(u, M)));
        if (H)
            element_add_diagonal(H, k,
                                 pack_mat_add(pack_mat_diagonal(pack3_dot(M, u)),
                                              pack_mat_scale(pack_set(-0.5), pack_mat_symmetric(M, u))));
    }
    return energy;
}

/* The force on a turn is u x M, u = R^T B. */
static void magnetic_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                           const Pack *w, double *dp)
{
    const RodTerm *term = self;
    const Rod *rod = term->rod;
    Pack volume = half_volume(term);
    for (int k = 0; k < 2; k++) {
        Pack3 turn = pack3_load(x + 3 * k), v = pack3_scale(volume, pack3_load(w + 3 * k));
        Pack3 u = node_field(term, pack, k, at->x, turn, at->p + rod->flux_density), M = pack3_cross(v, u),
              b = pack3_cross(rod_term_vector(term, pack, at->p + rod->magnetization), v);
        for (int l = 0; l < lanes; l++) {
            int e = pack * PACK_LANES + l;
            double *to = dp + rod->magnetization + 3 * e;
            to[0] += M.x[l], to[1] += M.y[l], to[2] += M.z[l];
            Quat q = rod_reference(&term->layout, at->x, e + k);
            Vec3 world = quat_rotate(q, vec3(b.x[l], b.y[l], b.z[l]));
            vec3_store(dp + rod->flux_density, vec3_add(world, vec3_load(dp + rod->flux_density)));
        }
    }
}

static void magnetic_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                   const double *dp, Pack *r)
{
    const RodTerm *term = self;
    const Rod *rod = term->rod;
    Pack3 M = rod_term_vector(term, pack, at->p + rod->magnetization),
          dM = rod_term_vector(term, pack, dp + rod->magnetization);
    for (int k = 0; k < 2; k++) {
        Pack3 turn = pack3_load(x + 3 * k),
              u = node_field(term, pack, k, at->x, turn, at->p + rod->flux_density),
              du = node_field(term, pack, k, at->x, turn, dp + rod->flux_density);
        pack3_store(r + 3 * k,
                    pack3_scale(half_volume(term), pack3_add(pack3_cross(u, dM), pack3_cross(du, M))));
    }
}

static const TermOps magnetic_ops = {
    .name = "magnetic",
    .count = rod_term_count,
    .size = rod_term_turns,
    .dofs = rod_term_turn_dofs,
    .eval = magnetic_eval,
    .param = magnetic_param,
    .param_forward = magnetic_param_forward,
    .destroy = mem_free,
};

Term rod_magnetic_term(const Rod *rod, RodLayout layout, double hold)
{
    return rod_term_make(&magnetic_ops, rod, layout, hold);
}
