/* Hard-magnetic energy E = -V/2 sum over both nodes of M.R^T B: M the remanent magnetisation of an element in
 * the material frame, V its volume, B at the node. Magnetised along the tangent, in a uniform field, it acts
 * like an additional pull M V/h B; where B varies in space it also pulls at the nodes, with V/2 G^T R M,
 * G = dB/dx, so that their positions must be dofs.
 *
 * With u = R^T B and Q = R M a turn of the node feels u x M, its position -G^T Q. */
#include "rod/term.h"
#include "field/flux.h"
#include <assert.h>

enum { TURN = 0, PLACE = 6 }; /* an element's dofs: turns of both nodes; where fields vary, their positions */

/* A node of each element: its rotations, and the flux density there. */
typedef struct Node {
    Quat q[PACK_LANES];
    Flux flux;
    Pack3 u; /* B in the node's frame */
} Node;

static bool varies(const RodTerm *term)
{
    return term->rod->fields.count > 0;
}

static int magnetic_size(const void *self)
{
    return varies(self) ? 12 : 6;
}

static void magnetic_dofs(const void *self, int e, int *dof)
{
    rod_term_turn_dofs(self, e, dof);
    const RodLayout *layout = &((const RodTerm *)self)->layout;
    for (int i = 0; varies(self) && i < 6; i++)
        dof[PLACE + i] = layout->position + 3 * rod_element_node(layout, e) + i;
}

static Pack3 rotated(const Quat *q, bool back, Pack3 v)
{
    Pack3 r;
    for (int l = 0; l < PACK_LANES; l++) {
        Vec3 w = quat_rotate(back ? quat_conj(q[l]) : q[l], vec3(v.x[l], v.y[l], v.z[l]));
        r.x[l] = w.x, r.y[l] = w.y, r.z[l] = w.z;
    }
    return r;
}

static Pack3 to_world(const Node *node, Pack3 v)
{
    return rotated(node->q, false, v);
}

static Pack3 to_body(const Node *node, Pack3 v)
{
    return rotated(node->q, true, v);
}

static FluxSum sum_of(const RodTerm *term, const Point *at)
{
    return (FluxSum){&term->rod->fields, term->rod->flux, at->p, at->time};
}

static void set_field(const RodTerm *term, const Point *at, const Pack *place, Node *node)
{
    node->flux = varies(term) ? flux_at(sum_of(term, at), pack3_load(place))
                              : flux_uniform(at->p + term->rod->flux.uniform);
    node->u = to_body(node, node->flux.B);
}

/* Node k, 0 or 1, of the elements, with their dofs x. */
static Node node_at(const RodTerm *term, int pack, int k, const Point *at, const Pack *x)
{
    Node node;
    Pack3 turn = pack3_load(x + TURN + 3 * k);
    for (int l = 0; l < PACK_LANES; l++) {
        int e = segment_lane(&term->layout, pack, l);
        Quat q = rod_reference(&term->layout, at->x, rod_element_node(&term->layout, e) + k);
        Quat half = {1, {turn.x[l] / 2, turn.y[l] / 2, turn.z[l] / 2}};
        node.q[l] = quat_unit(quat_mul(q, half));
    }
    set_field(term, at, x + PLACE + 3 * k, &node);
    return node;
}

/* V/2, m^3 */
static Pack half_volume(const RodTerm *term, int pack)
{
    return rod_term_section(term, pack, &term->rod->unit->area) * rod_term_length(term, pack) / 2;
}

/* G^T R M */
static Pack3 pull(const Node *node, Pack3 M)
{
    return pack_mat_left(to_world(node, M), node->flux.gradient);
}

static PackMat turn_hessian(const Node *node, Pack3 M)
{
    return pack_mat_add(pack_mat_diagonal(pack3_dot(M, node->u)),
                        pack_mat_scale(pack_set(-0.5), pack_mat_symmetric(M, node->u)));
}

/* Rows of a place, columns of its turn: (R^T dB/dx_l) x M. */
static PackMat mixed_hessian(const Node *node, Pack3 M)
{
    PackMat columns = pack_mat_transpose(node->flux.gradient);
    return (PackMat){pack3_cross(to_body(node, columns.r0), M), pack3_cross(to_body(node, columns.r1), M),
                     pack3_cross(to_body(node, columns.r2), M)};
}

static PackMat place_hessian(const Node *node, Pack3 M)
{
    Pack3 Q = to_world(node, M);
    const PackMat *curvature = node->flux.curvature;
    PackMat sum = pack_mat_add(pack_mat_scale(Q.x, curvature[0]), pack_mat_scale(Q.y, curvature[1]));
    return pack_mat_neg(pack_mat_add(sum, pack_mat_scale(Q.z, curvature[2])));
}

static Pack magnetic_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const RodTerm *term = self;
    int size = magnetic_size(self);
    Pack3 M =
        pack3_scale(half_volume(term, pack), rod_term_vector(term, pack, at->p + term->rod->magnetization));
    const double *B = at->p + term->rod->flux.uniform;
    Pack energy = {0};
    if (g) rod_term_clear(g, size);
    if (H) element_clear(H, size);
    if (!varies(term) && B[0] == 0 && B[1] == 0 && B[2] == 0) return energy;
    for (int k = 0; k < 2; k++) {
        Node node = node_at(term, pack, k, at, x);
        energy -= pack3_dot(M, node.u);
        if (g) pack3_store(g + TURN + 3 * k, segment_turned(pack3_load(x + 3 * k), pack3_cross(node.u, M)));
        if (H) element_add_diagonal(H, TURN / 3 + k, turn_hessian(&node, M));
        if (!varies(term)) continue;
        if (g) pack3_store(g + PLACE + 3 * k, pack3_neg(pull(&node, M)));
        if (!H) continue;
        element_add_block(H, PLACE / 3 + k, TURN / 3 + k, mixed_hessian(&node, M));
        element_add_diagonal(H, PLACE / 3 + k, place_hessian(&node, M));
    }
    return energy;
}

/* The force on a turn is u x M, that on a place -G^T R M. */
static void magnetic_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                           const Pack *w, double *dp)
{
    const RodTerm *term = self;
    const Rod *rod = term->rod;
    Pack3 M = rod_term_vector(term, pack, at->p + rod->magnetization);
    for (int k = 0; k < 2; k++) {
        Node node = node_at(term, pack, k, at, x);
        Pack3 turn = pack3_scale(half_volume(term, pack), pack3_load(w + TURN + 3 * k));
        Pack3 dM = pack3_cross(turn, node.u), dB = to_world(&node, pack3_cross(M, turn));
        FluxWork work = {.weight = pack_set(1), .a = dB};
        if (varies(term)) {
            work.x = pack3_load(x + PLACE + 3 * k), work.Q = pack3_neg(to_world(&node, M));
            work.b = pack3_scale(half_volume(term, pack), pack3_load(w + PLACE + 3 * k));
            dM = pack3_sub(dM, to_body(&node, pack_mat_times(node.flux.gradient, work.b)));
        }
        flux_add_param(sum_of(term, at), &work, lanes, dp);
        for (int l = 0; l < lanes; l++) {
            double *m = dp + rod->magnetization + 3 * (pack * PACK_LANES + l);
            m[0] += dM.x[l], m[1] += dM.y[l], m[2] += dM.z[l];
        }
    }
}

static void magnetic_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                   const double *dp, Pack *r)
{
    const RodTerm *term = self;
    const Rod *rod = term->rod;
    Pack3 M = pack3_scale(half_volume(term, pack), rod_term_vector(term, pack, at->p + rod->magnetization)),
          dM = pack3_scale(half_volume(term, pack), rod_term_vector(term, pack, dp + rod->magnetization));
    for (int k = 0; k < 2; k++) {
        Node node = node_at(term, pack, k, at, x), change = node;
        change.flux = varies(term) ? flux_change(sum_of(term, at), dp, pack3_load(x + PLACE + 3 * k))
                                   : flux_uniform(dp + rod->flux.uniform);
        change.u = to_body(&change, change.flux.B);
        pack3_store(r + TURN + 3 * k, pack3_add(pack3_cross(node.u, dM), pack3_cross(change.u, M)));
        if (varies(term))
            pack3_store(r + PLACE + 3 * k, pack3_neg(pack3_add(pull(&node, dM), pull(&change, M))));
    }
}

static const TermOps magnetic_ops = {
    .name = "magnetic",
    .count = rod_term_count,
    .size = magnetic_size,
    .dofs = magnetic_dofs,
    .eval = magnetic_eval,
    .param = magnetic_param,
    .param_forward = magnetic_param_forward,
    .destroy = mem_free,
};

Term rod_magnetic_term(const Rod *rod, RodLayout layout, double hold)
{
    assert(rod->fields.count == 0 || layout.position >= 0);
    return rod_term_make(&magnetic_ops, rod, layout, hold);
}
