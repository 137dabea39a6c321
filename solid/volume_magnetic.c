/* Hard-magnetic energy of a magnetised volume [Zhao 2019]: E = - sum over points of w (F M).B(x, t), with F and the place x
 * at the points of integration and B uniform (block flux_density) plus fields.
 *
 * Q = F M = sum_a c_a x_a, c_a = M.grad N_a; x = sum_a N_a x_a. With G = dB/dx, over -w:
 *     dE/dx_a       = c_a B + N_a G^T Q
 *     d2E/dx_a dx_b = c_a N_b G + N_a c_b G^T + N_a N_b Q.d2B/dx dx. */
#include "base/memory.h"
#include "solid/terms.h"
#include "solid/tet_pack.h"
#include "solve/element.h"
#include "surface/face.h"
#include "field/flux.h"

typedef struct VolumeMagnetic {
    const Solid *solid;
    TetPack *packs;
    double shape[TET_MAX_POINTS][TET_MAX_NODES]; /* N_a at the points */
} VolumeMagnetic;

/* A point of integration of a pack. */
typedef struct Place {
    Pack weight; /* m^3 */
    const double *shape;
    Pack3 gradient[TET_MAX_NODES], x;
    PackMat F;
} Place;

static int magnetic_count(const void *self)
{
    return ((const VolumeMagnetic *)self)->solid->tets->count;
}

static int magnetic_size(const void *self)
{
    return 3 * ((const VolumeMagnetic *)self)->solid->tets->each;
}

static void magnetic_dofs(const void *self, int tet, int *dof)
{
    tet_dofs(((const VolumeMagnetic *)self)->solid->tets, tet, dof);
}

/* A field's value at the point, of its values at the nodes. */
static Pack3 value_at(const Place *place, int nodes, const Pack *v)
{
    Pack3 sum = {{0}, {0}, {0}};
    for (int a = 0; a < nodes; a++) sum = pack3_axpy(pack_set(place->shape[a]), pack3_load(v + 3 * a), sum);
    return sum;
}

static Place place_of(const VolumeMagnetic *magnetic, int pack, int q, const Pack *x)
{
    const Tets *tets = magnetic->solid->tets;
    const TetPack *tet = &magnetic->packs[pack];
    Place place = {.weight = tet->volume / tet_point_count(tets), .shape = magnetic->shape[q]};
    tet_gradients(tets, tet, tet_point(tets, q), place.gradient);
    place.x = value_at(&place, tets->each, x);
    place.F = tet_field_gradient(tets->each, place.gradient, x);
    return place;
}

static FluxSum sum_of(const Solid *solid, const Point *at)
{
    return (FluxSum){&solid->fields, solid->flux, at->p, at->time};
}

static Pack3 magnetization_of(const Solid *solid, int pack, const double *values)
{
    const double *M = values + solid->volume_magnetization;
    int count = solid->tets->count;
    return pack3(pack_param(count, pack, M, 3, 0), pack_param(count, pack, M, 3, 1),
                 pack_param(count, pack, M, 3, 2));
}

/* g -= w (c_a B + N_a G^T Q) */
static void add_forces(const Place *place, int nodes, Pack3 M, const Flux *flux, Pack *g)
{
    Pack3 pull = pack_mat_left(pack_mat_times(place->F, M), flux->gradient);
    for (int a = 0; a < nodes; a++) {
        Pack c = -place->weight * pack3_dot(M, place->gradient[a]);
        Pack3 f = pack3_axpy(-place->weight * place->shape[a], pull, pack3_load(g + 3 * a));
        pack3_store(g + 3 * a, pack3_axpy(c, flux->B, f));
    }
}

static void add_stiffness(const Place *place, int nodes, Pack3 M, const Flux *flux, Pack *H)
{
    Pack3 Q = pack_mat_times(place->F, M);
    PackMat curvature = pack_mat_scale(Q.x, flux->curvature[0]),
            transposed = pack_mat_transpose(flux->gradient);
    curvature = pack_mat_add(curvature, pack_mat_scale(Q.y, flux->curvature[1]));
    curvature = pack_mat_add(curvature, pack_mat_scale(Q.z, flux->curvature[2]));
    Pack c[TET_MAX_NODES];
    for (int a = 0; a < nodes; a++) c[a] = pack3_dot(M, place->gradient[a]);
    for (int a = 0; a < nodes; a++)
        for (int b = 0; b <= a; b++) {
            double Na = place->shape[a], Nb = place->shape[b];
            PackMat block = pack_mat_scale(c[a] * Nb, flux->gradient);
            block = pack_mat_add(block, pack_mat_scale(c[b] * Na, transposed));
            block = pack_mat_add(block, pack_mat_scale(pack_set(Na * Nb), curvature));
            block = pack_mat_scale(-place->weight, block);
            if (a == b)
                element_add_diagonal(H, a, block);
            else
                element_add_block(H, a, b, block);
        }
}

static Pack magnetic_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const VolumeMagnetic *magnetic = self;
    const Solid *solid = magnetic->solid;
    int nodes = solid->tets->each;
    Pack3 M = magnetization_of(solid, pack, at->p);
    Pack energy = {0};
    for (int i = 0; g && i < 3 * nodes; i++) g[i] = (Pack){0};
    if (H) element_clear(H, 3 * nodes);
    for (int q = 0; q < tet_point_count(solid->tets); q++) {
        Place place = place_of(magnetic, pack, q, x);
        Flux flux = flux_at(sum_of(solid, at), place.x);
        energy -= place.weight * pack3_dot(pack_mat_times(place.F, M), flux.B);
        if (g) add_forces(&place, nodes, M, &flux, g);
        if (H && solid->fields.count) add_stiffness(&place, nodes, M, &flux, H);
    }
    return energy;
}

/* M and B enter the force linearly. With W and w' the gradient and the value of w at a point, over -w:
 *     w.d/dB = W M,   of a field in p: (W M).B' + Q.(G' w'),   w.d/dM = W^T B + F^T (G w'). */
static void magnetic_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                           const Pack *w, double *dp)
{
    const VolumeMagnetic *magnetic = self;
    const Solid *solid = magnetic->solid;
    int nodes = solid->tets->each;
    Pack3 M = magnetization_of(solid, pack, at->p);
    FluxSum sum = sum_of(solid, at);
    for (int q = 0; q < tet_point_count(solid->tets); q++) {
        Place place = place_of(magnetic, pack, q, x);
        Flux flux = flux_at(sum, place.x);
        PackMat W = tet_field_gradient(nodes, place.gradient, w);
        Pack3 mean = value_at(&place, nodes, w), Q = pack_mat_times(place.F, M), dQ = pack_mat_times(W, M);
        Pack3 dM =
            pack3_add(pack_mat_left(flux.B, W), pack_mat_left(pack_mat_times(flux.gradient, mean), place.F));
        for (int l = 0; l < lanes; l++) {
            double *m = dp + solid->volume_magnetization + 3 * pack_element(solid->tets->count, pack, l),
                   weight = place.weight[l];
            m[0] -= weight * dM.x[l], m[1] -= weight * dM.y[l], m[2] -= weight * dM.z[l];
        }
        FluxWork work = {-place.weight, place.x, dQ, Q, mean};
        flux_add_param(sum, &work, lanes, dp);
    }
}

static void magnetic_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                   const double *dp, Pack *r)
{
    const VolumeMagnetic *magnetic = self;
    const Solid *solid = magnetic->solid;
    int nodes = solid->tets->each;
    Pack3 M = magnetization_of(solid, pack, at->p), dM = magnetization_of(solid, pack, dp);
    for (int i = 0; i < 3 * nodes; i++) r[i] = (Pack){0};
    for (int q = 0; q < tet_point_count(solid->tets); q++) {
        Place place = place_of(magnetic, pack, q, x);
        Flux flux = flux_at(sum_of(solid, at), place.x), change = flux_change(sum_of(solid, at), dp, place.x);
        add_forces(&place, nodes, M, &change, r);
        add_forces(&place, nodes, dM, &flux, r);
    }
}

static void magnetic_destroy(void *self)
{
    mem_free(((VolumeMagnetic *)self)->packs);
    mem_free(self);
}

static const TermOps volume_magnetic_ops = {
    .name = "volume_magnetic",
    .count = magnetic_count,
    .size = magnetic_size,
    .dofs = magnetic_dofs,
    .eval = magnetic_eval,
    .param = magnetic_param,
    .param_forward = magnetic_param_forward,
    .destroy = magnetic_destroy,
};

Term solid_volume_magnetic_term(const Solid *solid)
{
    const Tets *tets = solid->tets;
    VolumeMagnetic *magnetic = mem_alloc(1, sizeof *magnetic);
    *magnetic = (VolumeMagnetic){.solid = solid, .packs = tet_packs(tets)};
    for (int q = 0; q < tet_point_count(tets); q++) tet_shape(tets, tet_point(tets, q), magnetic->shape[q]);
    return (Term){&volume_magnetic_ops, magnetic};
}
