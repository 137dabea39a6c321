/* Hard-magnetic energy [Chen 2022, eq. 24]: E = -A h (F0 M).B with F0 the deformation gradient of the mid-surface
 * whose third column is the current unit normal.
 *
 * Q = F0 M = sum_i c_i x_i + mu n, with c_i = b_i.M (b_i the hat functions' rest gradients) and mu = N.M (N the rest
 * normal). B is uniform (block flux_density) plus fields taken at the face's current barycentre, so its gradient
 * enters the forces. The derivatives of n (eqs. 62, 63) are the corrected ones of docs/theory.md. */
#include "surface/magnetic.h"
#include "base/memory.h"
#include "solve/element.h"
#include "surface/face.h"

typedef struct MagneticPack {
    Pack3 hat[3], normal; /* at rest; 1/m, 1 */
    Pack volume;          /* FaceLayer.volume */
} MagneticPack;

typedef struct Magnetic {
    FaceLayer layer;
    MagneticSurfaceDef def;
    MagneticPack *packs;
} Magnetic;

/* The current normal and its change with the vertices. */
typedef struct Normal {
    Pack3 n, edge[3]; /* edge[i] opposite to vertex i     */
    Pack inverse;     /* 1/(2 A)                          */
} Normal;

static int magnetic_count(const void *self)
{
    return ((const Magnetic *)self)->layer.count;
}

static int magnetic_size(const void *self)
{
    (void)self;
    return 9;
}

static void magnetic_dofs(const void *self, int face, int *dof)
{
    face_dofs(((const Magnetic *)self)->layer.faces[face], dof);
}

static Pack volume_of(const Magnetic *magnetic, int pack, const double *p)
{
    return face_layer_volume(&magnetic->layer, pack, magnetic->packs[pack].volume, p);
}

static Pack3 barycentre(const Pack *x)
{
    return pack3((x[0] + x[3] + x[6]) / 3, (x[1] + x[4] + x[7]) / 3, (x[2] + x[5] + x[8]) / 3);
}

static FluxSum sum_of(const MagneticSurfaceDef *def, const Point *at)
{
    return (FluxSum){def->fields, def->flux, at->p, at->time};
}

static Normal normal_of(const Pack *x)
{
    Normal r;
    for (int i = 0; i < 3; i++)
        r.edge[i] = pack3_sub(pack3_load(x + 3 * ((i + 2) % 3)), pack3_load(x + 3 * ((i + 1) % 3)));
    Pack3 N = pack3_cross(r.edge[2], pack3_neg(r.edge[1]));
    Pack square = pack3_dot(N, N); /* a face without area has no normal: 0 */
    r.inverse = pack_select(square > 0, 1 / pack_sqrt(square), (Pack){0});
    r.n = pack3_scale(r.inverse, N);
    return r;
}

/* N = 2 A n changes by edge_i x dx_i, so d(n.b)/dx_i = (b' x edge_i)/(2 A), b' the part of b across n. */
static Pack3 normal_gradient(const Normal *r, Pack3 b, int i)
{
    Pack3 across = pack3_axpy(-pack3_dot(r->n, b), r->n, b);
    return pack3_scale(r->inverse, pack3_cross(across, r->edge[i]));
}

/* First entry in p of the magnetisation of the face in that lane. */
static int magnetization_entry(const Magnetic *magnetic, int pack, int lane)
{
    return magnetic->def.magnetization + 3 * face_layer_row(&magnetic->layer, pack, lane);
}

static Pack3 magnetization_of(const Magnetic *magnetic, int pack, const double *values)
{
    Pack3 M;
    for (int l = 0; l < PACK_LANES; l++) {
        const double *m = values + magnetization_entry(magnetic, pack, l);
        M.x[l] = m[0], M.y[l] = m[1], M.z[l] = m[2];
    }
    return M;
}

/* Q = F0 M: the magnetisation carried along by the face. */
static Pack3 carried(const MagneticPack *face, const Normal *normal, Pack3 M, const Pack *x)
{
    Pack3 Q = pack3_scale(pack3_dot(face->normal, M), normal->n);
    for (int i = 0; i < 3; i++) Q = pack3_axpy(pack3_dot(face->hat[i], M), pack3_load(x + 3 * i), Q);
    return Q;
}

/* dE/dx over -A h, for magnetisation M, flux density B with gradient G: c_i B + mu d(n.B)/dx_i + G^T Q/3. */
static void forces(const MagneticPack *face, const Normal *normal, Pack3 M, const Flux *flux, Pack3 Q,
                   Pack *g)
{
    Pack mu = pack3_dot(face->normal, M);
    Pack3 pull = pack3_scale(pack_set(1.0 / 3), pack_mat_left(Q, flux->gradient));
    for (int i = 0; i < 3; i++) {
        Pack3 f = pack3_axpy(pack3_dot(face->hat[i], M), flux->B, pull);
        pack3_store(g + 3 * i, pack3_axpy(mu, normal_gradient(normal, flux->B, i), f));
    }
}

/* d2(n.b)/dx_i dx_j = [e_i]x^T W [e_j]x -/+ [b']x/(2 A) for j = i + 1 / i - 1 (N is bilinear in the corners), with
 * W = -(n b'^T + b' n^T + (n.b) (I - n n^T))/(2 A)^2. */
static PackMat normal_hessian(const Normal *r, Pack3 b, int i, int j)
{
    Pack height = pack3_dot(r->n, b);
    Pack3 across = pack3_axpy(-height, r->n, b);
    PackMat W = pack_mat_add(pack_mat_symmetric(r->n, across), pack_mat_diagonal(height));
    W = pack_mat_add(W, pack_mat_outer(pack3_scale(-height, r->n), r->n));
    W = pack_mat_scale(-r->inverse * r->inverse, W);
    PackMat left = pack_mat_cross(r->edge[i]), right = pack_mat_cross(r->edge[j]);
    PackMat block = pack_mat_neg(pack_mat_product(left, pack_mat_product(W, right)));
    if (i == j) return block;
    Pack turn = (j == (i + 1) % 3 ? -1 : 1) * r->inverse;
    return pack_mat_add(block, pack_mat_scale(turn, pack_mat_cross(across)));
}

/* dQ/dx_i = c_i I + mu dn/dx_i, the latter row by row. */
static PackMat carried_gradient(const Normal *normal, Pack c, Pack mu, int i)
{
    Pack one = pack_set(1), zero = {0};
    PackMat turn = {normal_gradient(normal, pack3(one, zero, zero), i),
                    normal_gradient(normal, pack3(zero, one, zero), i),
                    normal_gradient(normal, pack3(zero, zero, one), i)};
    return pack_mat_add(pack_mat_diagonal(c), pack_mat_scale(mu, turn));
}

/* What a varying field adds: (dQ_i^T G + G^T dQ_j)/3 + Q.curvature/9. */
static PackMat field_hessian(const Flux *flux, Pack3 Q, PackMat dQi, PackMat dQj)
{
    PackMat sum = pack_mat_product(pack_mat_transpose(dQi), flux->gradient);
    sum = pack_mat_add(sum, pack_mat_product(pack_mat_transpose(flux->gradient), dQj));
    sum = pack_mat_scale(pack_set(1.0 / 3), sum);
    Pack ninth = pack_set(1.0 / 9);
    sum = pack_mat_add(sum, pack_mat_scale(ninth * Q.x, flux->curvature[0]));
    sum = pack_mat_add(sum, pack_mat_scale(ninth * Q.y, flux->curvature[1]));
    return pack_mat_add(sum, pack_mat_scale(ninth * Q.z, flux->curvature[2]));
}

static void hessian(const Magnetic *magnetic, int pack, const Normal *normal, Pack3 M, const Flux *flux,
                    Pack3 Q, Pack volume, Pack *H)
{
    const MagneticPack *face = &magnetic->packs[pack];
    Pack mu = pack3_dot(face->normal, M);
    PackMat dQ[3];
    bool varies = magnetic->def.fields->count > 0;
    for (int i = 0; varies && i < 3; i++) dQ[i] = carried_gradient(normal, pack3_dot(face->hat[i], M), mu, i);
    element_clear(H, 9);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++) {
            PackMat block = pack_mat_scale(mu, normal_hessian(normal, flux->B, i, j));
            if (varies) block = pack_mat_add(block, field_hessian(flux, Q, dQ[i], dQ[j]));
            block = pack_mat_scale(-volume, block);
            if (i == j)
                element_add_diagonal(H, i, block);
            else
                element_add_block(H, i, j, block);
        }
}

static Pack magnetic_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const Magnetic *magnetic = self;
    const MagneticPack *face = &magnetic->packs[pack];
    Flux flux = flux_at(sum_of(&magnetic->def, at), barycentre(x));
    Normal normal = normal_of(x);
    Pack volume = volume_of(magnetic, pack, at->p);
    Pack3 M = magnetization_of(magnetic, pack, at->p), Q = carried(face, &normal, M, x);
    if (g) {
        forces(face, &normal, M, &flux, Q, g);
        for (int i = 0; i < 9; i++) g[i] *= -volume;
    }
    if (H) hessian(magnetic, pack, &normal, M, &flux, Q, volume, H);
    return -volume * pack3_dot(Q, flux.B);
}

/* M, B and h enter the force linearly. With W = sum_i dQ/dx_i w_i, w' the mean of w and G = dB/dx:
 *     w.d/dB     = -A h W,    of a field in p: -A h (W.B' + Q.(G' w'))
 *     w.d/dM     = -A h (F0^T (G w') + sum_i (w_i.B) b_i + N sum_i w_i.d(n.B)/dx_i),
 *     w.d/dh     = -A (W.B + Q.(G w')). */
static void magnetic_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                           const Pack *w, double *dp)
{
    const Magnetic *magnetic = self;
    const MagneticPack *face = &magnetic->packs[pack];
    FluxSum sum = sum_of(&magnetic->def, at);
    Flux flux = flux_at(sum, barycentre(x));
    Normal normal = normal_of(x);
    Pack3 M = magnetization_of(magnetic, pack, at->p), W = {0}, dM = {0}, mean = {0};
    Pack mu = pack3_dot(face->normal, M), along = {0};
    for (int i = 0; i < 3; i++) mean = pack3_axpy(pack_set(1.0 / 3), pack3_load(w + 3 * i), mean);
    Pack3 pull = pack_mat_times(flux.gradient, mean);
    for (int i = 0; i < 3; i++) {
        Pack3 wi = pack3_load(w + 3 * i);
        W = pack3_add(W, pack_mat_times(carried_gradient(&normal, pack3_dot(face->hat[i], M), mu, i), wi));
        along += pack3_dot(wi, normal_gradient(&normal, flux.B, i));
        dM = pack3_axpy(pack3_dot(wi, flux.B) + pack3_dot(pack3_load(x + 3 * i), pull), face->hat[i], dM);
    }
    dM = pack3_axpy(along + pack3_dot(normal.n, pull), face->normal, dM);
    Pack3 Q = carried(face, &normal, M, x);
    Pack volume = volume_of(magnetic, pack, at->p);
    for (int l = 0; l < lanes; l++) {
        double *m = dp + magnetization_entry(magnetic, pack, l);
        m[0] -= volume[l] * dM.x[l], m[1] -= volume[l] * dM.y[l], m[2] -= volume[l] * dM.z[l];
    }
    face_layer_add_volume(&magnetic->layer, pack, lanes, face->volume,
                          -(pack3_dot(W, flux.B) + pack3_dot(Q, pull)), dp);
    FluxWork work = {-volume, barycentre(x), W, Q, mean};
    flux_add_param(sum, &work, lanes, dp);
}

static void magnetic_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                   const double *dp, Pack *r)
{
    const Magnetic *magnetic = self;
    const MagneticPack *face = &magnetic->packs[pack];
    FluxSum sum = sum_of(&magnetic->def, at);
    Flux flux = flux_at(sum, barycentre(x)), change = flux_change(sum, dp, barycentre(x));
    Normal normal = normal_of(x);
    Pack3 M = magnetization_of(magnetic, pack, at->p), dM = magnetization_of(magnetic, pack, dp);
    Pack3 Q = carried(face, &normal, M, x);
    Pack with_M[9], with_h[9], volume = volume_of(magnetic, pack, at->p),
                               swell = face_layer_volume_change(&magnetic->layer, pack, face->volume, dp);
    forces(face, &normal, dM, &flux, carried(face, &normal, dM, x), with_M);
    forces(face, &normal, M, &flux, Q, with_h);
    forces(face, &normal, M, &change, Q, r);
    for (int i = 0; i < 9; i++) r[i] = -volume * (r[i] + with_M[i]) - swell * with_h[i];
}

static void magnetic_destroy(void *self)
{
    Magnetic *magnetic = self;
    mem_free(magnetic->packs);
    face_layer_clear(&magnetic->layer);
    mem_free(magnetic);
}

static const TermOps magnetic_ops = {
    .name = "magnetic",
    .count = magnetic_count,
    .size = magnetic_size,
    .dofs = magnetic_dofs,
    .eval = magnetic_eval,
    .param = magnetic_param,
    .param_forward = magnetic_param_forward,
    .destroy = magnetic_destroy,
};

Term magnetic_surface_term(FaceLayer layer, const MagneticSurfaceDef *def)
{
    Magnetic *magnetic = mem_alloc(1, sizeof *magnetic);
    int packs = pack_count(layer.count);
    magnetic->layer = layer, magnetic->def = *def;
    magnetic->packs = mem_alloc((size_t)packs, sizeof *magnetic->packs);
    for (int k = 0; k < packs * PACK_LANES; k++) {
        int l = k % PACK_LANES, face = pack_element(layer.count, k / PACK_LANES, l);
        MagneticPack *pack = &magnetic->packs[k / PACK_LANES];
        FaceFrame frame = face_frame(layer.rest, layer.faces[face]);
        for (int i = 0; i < 3; i++)
            pack->hat[i].x[l] = frame.hat[i][0], pack->hat[i].y[l] = frame.hat[i][1],
            pack->hat[i].z[l] = frame.hat[i][2];
        pack->normal.x[l] = frame.normal[0], pack->normal.y[l] = frame.normal[1],
        pack->normal.z[l] = frame.normal[2];
        pack->volume[l] = layer.volume[face];
    }
    return (Term){&magnetic_ops, magnetic};
}
