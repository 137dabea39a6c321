/* Bending from the shape operator [Gingold et al. 2004; Chen 2022, eqs. 19, 23], with one director angle per edge in
 * the mid-edge model [Grinspun et al. 2006].
 *
 * A face's energy is a constant form in its three edge quantities, E = Y h^3/2 q^T C q, with
 *     q_i = fold_i (theta_i - rest theta_i + 2 s_i alpha_i),
 * theta the dihedral angle, alpha the edge's angle dof and s = +1 where the face runs along the edge from v0 to v1.
 * G = sum_i q_i t_i t_i^T/(2 A |a_i|) and E = D A/2 ((1-nu) tr G^2 + nu tr^2 G) give
 *     C_ij = 1/(12 (1-nu^2)) A ((1-nu) (a_i.a_j)^2 + nu |a_i|^2 |a_j|^2)/(4 A^2 |a_i| |a_j|).
 *
 * Local dofs: the face's vertices x0 x1 x2, the flaps y0 y1 y2 opposite to them, and (mid-edge) alpha0..2. A boundary
 * edge has its own face's third vertex for a flap, and its theta counts with weight 0. A clamped edge has the mirror
 * image of that vertex: y = x_i - 2 t (t.(x_i - x_{i+1})), t the edge's conormal at rest; rest theta is then 0. */
#include "base/memory.h"
#include "base/vec3.h"
#include "shell/hinge.h"
#include "shell/terms.h"
#include "shell/turn.h"
#include "solve/element.h"

enum { FLAP = 9, ALPHA = 18 };

typedef struct BendingPack {
    int face[PACK_LANES], edge[3][PACK_LANES];
    Pack form[6];                     /* C as a packed lower triangle, 1; 0 where the face is rigid */
    Pack weight[3], rest[3], sign[3]; /* of theta; its rest value; s */
    Pack3 mirror[3];                  /* t of clamped edges, else 0 */
    bool mirrored;                    /* any lane */
} BendingPack;

typedef struct Bending {
    const Shell *shell;
    BendingPack *packs;
    int (*flap)[3]; /* [face] vertex of each flap */
    Turn *turn;
} Bending;

/* One evaluation of a pack. */
typedef struct Bent {
    Dihedral d[3];
    Pack difference[3]; /* q over fold                               */
    Pack fold[3], young, thickness;
    Pack stiffness; /* Y h^3                                      */
    Pack moment[3]; /* (C q)_i, dE/dq over the stiffness          */
} Bent;

static int bending_count(const void *self)
{
    return ((const Bending *)self)->shell->mesh->face_count;
}

static int bending_size(const void *self)
{
    return ((const Bending *)self)->shell->bending == BENDING_MIDEDGE ? 21 : 18;
}

static void bending_dofs(const void *self, int face, int *dof)
{
    const Bending *bending = self;
    const Mesh *mesh = bending->shell->mesh;
    for (int i = 0; i < 9; i++) {
        dof[i] = 3 * mesh->faces[face][i / 3] + i % 3;
        dof[FLAP + i] = 3 * bending->flap[face][i / 3] + i % 3;
    }
    if (bending->shell->bending == BENDING_MIDEDGE)
        for (int i = 0; i < 3; i++)
            dof[ALPHA + i] = shell_angle_dof(bending->shell, mesh->face_edges[face][i]);
}

static Pack3 flap_position(const BendingPack *face, const Pack *x, int i)
{
    Pack3 y = pack3_load(x + FLAP + 3 * i);
    if (!face->mirrored) return y;
    Pack3 t = face->mirror[i], from = pack3_load(x + 3 * ((i + 1) % 3));
    return pack3_axpy(-2 * pack3_dot(t, pack3_sub(y, from)), t, y);
}

static Dihedral angle_of(const BendingPack *face, const Pack *x, int i)
{
    return dihedral_angle(pack3_load(x + 3 * ((i + 1) % 3)), pack3_load(x + 3 * ((i + 2) % 3)),
                          pack3_load(x + 3 * i), flap_position(face, x, i));
}

/* atan2 jumps by 2 pi at a full fold; the angle wanted is the one nearest to the last accepted. */
static Pack unwrap(Pack angle, Pack accepted)
{
    return angle + 2 * M_PI * pack_rint((accepted - angle) / (2 * M_PI));
}

static Pack form(const BendingPack *face, int i, int j)
{
    return face->form[i > j ? TERM_LOWER(i, j) : TERM_LOWER(j, i)];
}

/* memory[pack][3][lane]: the last accepted angle, which the next one is nearest to. */
static Pack accepted_angle(const double *memory, int pack, int i)
{
    Pack accepted;
    memcpy(&accepted, memory + (pack * 3 + i) * PACK_LANES, sizeof accepted);
    return accepted;
}

static Pack face_values(const BendingPack *face, const double *values)
{
    Pack r;
    for (int l = 0; l < PACK_LANES; l++) r[l] = values[face->face[l]];
    return r;
}

static void bend(const Bending *bending, int pack, const Point *at, const Pack *x, Bent *bent)
{
    const Shell *shell = bending->shell;
    const BendingPack *face = &bending->packs[pack];
    bent->young = face_values(face, at->p + shell->young);
    bent->thickness = face_values(face, at->p + shell->face_thickness);
    bent->stiffness = bent->young * bent->thickness * bent->thickness * bent->thickness;
    for (int i = 0; i < 3; i++) {
        for (int l = 0; l < PACK_LANES; l++) bent->fold[i][l] = at->p[shell->fold + face->edge[i][l]];
        bent->d[i] = angle_of(face, x, i);
        Pack angle = unwrap(bent->d[i].angle, accepted_angle(at->memory, pack, i));
        bent->difference[i] = face->weight[i] * (angle - face->rest[i]);
        if (shell->bending == BENDING_MIDEDGE) bent->difference[i] += 2 * face->sign[i] * x[ALPHA + i];
    }
    for (int i = 0; i < 3; i++) {
        bent->moment[i] = pack_set(0);
        for (int j = 0; j < 3; j++) bent->moment[i] += form(face, i, j) * bent->fold[j] * bent->difference[j];
    }
}

/* row[21] = d(difference_i)/dx. A mirrored flap passes its derivative on to the vertices it is made of. */
static void difference_row(const BendingPack *face, const Dihedral *d, int i, Pack *row)
{
    DihedralGradient g = dihedral_gradient(d);
    if (face->mirrored) {
        Pack3 t = face->mirror[i], through = pack3_scale(2 * pack3_dot(t, g.y), t);
        g.y = pack3_sub(g.y, through);
        g.a = pack3_add(g.a, through);
    }
    memset(row, 0, 21 * sizeof *row);
    pack3_store(row + 3 * ((i + 1) % 3), pack3_scale(face->weight[i], g.a));
    pack3_store(row + 3 * ((i + 2) % 3), pack3_scale(face->weight[i], g.b));
    pack3_store(row + 3 * i, pack3_scale(face->weight[i], g.o));
    pack3_store(row + FLAP + 3 * i, pack3_scale(face->weight[i], g.y));
    row[ALPHA + i] = 2 * face->sign[i];
}

/* H = sum_ij row_i (Y h^3 C_ij fold_i fold_j) row_j^T, skipping the zeros: flap i and alpha i appear in row i only. */
static void material_hessian(const BendingPack *face, const Bent *bent, Pack (*row)[21], int size, Pack *H)
{
    Pack right[3][21];
    for (int i = 0; i < 3; i++) {
        Pack c[3];
        for (int j = 0; j < 3; j++) c[j] = bent->stiffness * bent->fold[i] * bent->fold[j] * form(face, i, j);
        for (int k = 0; k < size; k++) right[i][k] = c[0] * row[0][k] + c[1] * row[1][k] + c[2] * row[2][k];
    }
    for (int k = 0; k < 9; k++)
        for (int m = 0; m <= k; m++)
            H[TERM_LOWER(k, m)] = row[0][k] * right[0][m] + row[1][k] * right[1][m] + row[2][k] * right[2][m];
    for (int k = 9; k < size; k++) {
        int i = k < ALPHA ? (k - FLAP) / 3 : k - ALPHA;
        for (int m = 0; m <= k; m++) H[TERM_LOWER(k, m)] = row[i][k] * right[i][m];
    }
}

/* y = (I - T) o + T a with T = 2 t t^T: the Hessian in y becomes one in o's copy and a. */
static void mirror_hessian(Pack3 t, DihedralHessian *h)
{
    PackMat T = pack_mat_outer(pack3_scale(pack_set(2), t), t);
    PackMat R = pack_mat_add(pack_mat_diagonal(pack_set(1)), pack_mat_neg(T));
    PackMat ya = pack_mat_transpose(h->ay), Tya = pack_mat_product(T, ya);
    PackMat yyT = pack_mat_product(h->yy, T);
    h->aa = pack_mat_add(h->aa, pack_mat_add(Tya, pack_mat_transpose(Tya)));
    h->aa = pack_mat_add(h->aa, pack_mat_product(T, yyT));
    h->ab = pack_mat_add(h->ab, pack_mat_product(T, pack_mat_transpose(h->by)));
    h->ay = pack_mat_product(pack_mat_add(h->ay, pack_mat_transpose(yyT)), R);
    h->by = pack_mat_product(h->by, R);
    h->yy = pack_mat_product(pack_mat_product(R, h->yy), R);
}

static void geometric_hessian(const BendingPack *face, const Bent *bent, int i, Pack *H)
{
    int a = (i + 1) % 3, b = (i + 2) % 3, o = i, y = 3 + i;
    DihedralHessian h = dihedral_hessian(&bent->d[i]);
    if (face->mirrored) mirror_hessian(face->mirror[i], &h);
    Pack tau = bent->stiffness * bent->fold[i] * bent->moment[i] * face->weight[i];
    element_add_diagonal(H, a, pack_mat_scale(tau, h.aa));
    element_add_diagonal(H, b, pack_mat_scale(tau, h.bb));
    element_add_diagonal(H, o, pack_mat_scale(tau, h.oo));
    element_add_diagonal(H, y, pack_mat_scale(tau, h.yy));
    element_add_block(H, a, b, pack_mat_scale(tau, h.ab));
    element_add_block(H, a, o, pack_mat_scale(tau, h.ao));
    element_add_block(H, a, y, pack_mat_scale(tau, h.ay));
    element_add_block(H, b, o, pack_mat_scale(tau, h.bo));
    element_add_block(H, b, y, pack_mat_scale(tau, h.by));
}

static Pack bending_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const Bending *bending = self;
    const BendingPack *face = &bending->packs[pack];
    int size = bending_size(self);
    Bent bent;
    bend(bending, pack, at, x, &bent);
    Pack energy = {0}, row[3][21];
    for (int i = 0; i < 3; i++)
        energy += 0.5 * bent.stiffness * bent.fold[i] * bent.difference[i] * bent.moment[i];
    if (!g) return energy;

    for (int i = 0; i < 3; i++) difference_row(face, &bent.d[i], i, row[i]);
    for (int k = 0; k < size; k++) {
        g[k] = pack_set(0);
        for (int i = 0; i < 3; i++) g[k] += bent.stiffness * bent.fold[i] * bent.moment[i] * row[i][k];
    }
    if (!H) return energy;
    material_hessian(face, &bent, row, size, H);
    for (int i = 0; i < 3; i++) geometric_hessian(face, &bent, i, H);
    return energy;
}

/* beta_i = row_i . w. */
static void row_products(const Bending *bending, int pack, const Bent *bent, const Pack *w, Pack *beta)
{
    for (int i = 0; i < 3; i++) {
        Pack row[21];
        difference_row(&bending->packs[pack], &bent->d[i], i, row);
        beta[i] = pack_set(0);
        for (int k = 0; k < bending_size(bending); k++) beta[i] += row[k] * w[k];
    }
}

/* With D = Y h^3 and dE/dx = sum_i D fold_i (C q)_i row_i:
 *     w.d/dD      = sum_i fold_i (C q)_i beta_i
 *     w.d/dfold_i = D ((C q)_i beta_i + difference_i sum_j C_ij fold_j beta_j). */
static void bending_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                          const Pack *w, double *dp)
{
    const Bending *bending = self;
    const Shell *shell = bending->shell;
    const BendingPack *face = &bending->packs[pack];
    Bent bent;
    Pack beta[3], stiffness = {0}, square;
    bend(bending, pack, at, x, &bent);
    row_products(bending, pack, &bent, w, beta);
    for (int i = 0; i < 3; i++) {
        Pack sum = {0};
        for (int j = 0; j < 3; j++) sum += form(face, i, j) * bent.fold[j] * beta[j];
        Pack fold = bent.stiffness * (bent.moment[i] * beta[i] + bent.difference[i] * sum);
        stiffness += bent.fold[i] * bent.moment[i] * beta[i];
        for (int l = 0; l < lanes; l++) dp[shell->fold + face->edge[i][l]] += fold[l];
    }
    square = bent.thickness * bent.thickness;
    for (int l = 0; l < lanes; l++) {
        dp[shell->young + face->face[l]] += square[l] * bent.thickness[l] * stiffness[l];
        dp[shell->face_thickness + face->face[l]] += 3 * bent.young[l] * square[l] * stiffness[l];
    }
}

static void bending_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                  const double *dp, Pack *r)
{
    const Bending *bending = self;
    const Shell *shell = bending->shell;
    const BendingPack *face = &bending->packs[pack];
    int size = bending_size(self);
    Bent bent;
    bend(bending, pack, at, x, &bent);
    Pack fold[3], square = bent.thickness * bent.thickness;
    Pack stiffness = square * (bent.thickness * face_values(face, dp + shell->young) +
                               3 * bent.young * face_values(face, dp + shell->face_thickness));
    for (int i = 0; i < 3; i++)
        for (int l = 0; l < PACK_LANES; l++) fold[i][l] = dp[shell->fold + face->edge[i][l]];
    memset(r, 0, (size_t)size * sizeof *r);
    for (int i = 0; i < 3; i++) {
        Pack sum = {0}, row[21];
        for (int j = 0; j < 3; j++) sum += form(face, i, j) * bent.difference[j] * fold[j];
        Pack tau = bent.moment[i] * (stiffness * bent.fold[i] + bent.stiffness * fold[i]) +
                   bent.stiffness * bent.fold[i] * sum;
        difference_row(face, &bent.d[i], i, row);
        for (int k = 0; k < size; k++) r[k] += tau * row[k];
    }
}

static void gather(const Bending *bending, int pack, int count, const double *from, Pack *x)
{
    for (int l = 0; l < PACK_LANES; l++) {
        int dof[TERM_MAX_DOF];
        bending_dofs(bending, bending->packs[pack].face[l], dof);
        for (int i = 0; i < count; i++) x[i][l] = from[dof[i]];
    }
}

static void bending_accept(const void *self, double *positions, double *memory)
{
    const Bending *bending = self;
    int packs = pack_count(bending_count(self));
    for (int k = 0; k < packs; k++) {
        Pack x[18];
        gather(bending, k, 18, positions, x);
        for (int i = 0; i < 3; i++) {
            Pack angle = unwrap(angle_of(&bending->packs[k], x, i).angle, accepted_angle(memory, k, i));
            memcpy(memory + (k * 3 + i) * PACK_LANES, &angle, sizeof angle);
        }
    }
}

static int bending_memory(const void *self, double *rest)
{
    const Bending *bending = self;
    int packs = pack_count(bending_count(self));
    for (int k = 0; rest && k < packs; k++)
        for (int i = 0; i < 3; i++)
            memcpy(rest + (k * 3 + i) * PACK_LANES, &bending->packs[k].rest[i], sizeof(Pack));
    return packs * 3 * PACK_LANES;
}

/* What a step turns it must not stretch: that would cost more than all bending gains. */
static void bending_follow(void *self, const double *x, const double *d, double a, double *to)
{
    turn_follow(((Bending *)self)->turn, x, d, a, to);
}

static void bending_destroy(void *self)
{
    Bending *bending = self;
    turn_destroy(bending->turn);
    mem_free(bending->packs);
    mem_free(bending->flap);
    mem_free(bending);
}

static const TermOps bending_ops = {
    .name = "bending",
    .count = bending_count,
    .size = bending_size,
    .dofs = bending_dofs,
    .eval = bending_eval,
    .param = bending_param,
    .param_forward = bending_param_forward,
    .follow = bending_follow,
    .accept = bending_accept,
    .memory = bending_memory,
    .destroy = bending_destroy,
};

static void set_form(const Shell *shell, int f, BendingPack *pack, int lane)
{
    const Mesh *mesh = shell->mesh;
    Vec3 a[3];
    for (int i = 0; i < 3; i++)
        a[i] = vec3_sub(vec3_load(mesh->rest[mesh->faces[f][(i + 2) % 3]]),
                        vec3_load(mesh->rest[mesh->faces[f][(i + 1) % 3]]));
    double nu = shell->poisson;
    double scale = shell_face_is_rigid(shell, f) ? 0 : 1 / (12 * (1 - nu * nu)) / (4 * mesh->rest_area[f]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++) {
            double product = vec3_dot(a[i], a[j]), lengths = vec3_length(a[i]) * vec3_length(a[j]);
            pack->form[TERM_LOWER(i, j)][lane] =
                scale * ((1 - nu) * product * product / lengths + nu * lengths);
        }
}

/* What lies across edge i of face f. */
static void set_edge(Bending *bending, int f, int i, BendingPack *pack, int lane)
{
    const Shell *shell = bending->shell;
    const Mesh *mesh = shell->mesh;
    int edge = mesh->face_edges[f][i], own = mesh->faces[f][i];
    int left = mesh->edge_faces[edge][0], other = left == f ? mesh->edge_faces[edge][1] : left;
    pack->edge[i][lane] = edge;
    pack->sign[i][lane] = mesh->face_edge_sign[f][i];
    bending->flap[f][i] = own;
    if (shell->clamped[edge]) {
        Vec3 a = vec3_load(mesh->rest[mesh->faces[f][(i + 1) % 3]]);
        Vec3 along = vec3_unit(vec3_sub(vec3_load(mesh->rest[mesh->faces[f][(i + 2) % 3]]), a));
        Vec3 inward = vec3_sub(vec3_load(mesh->rest[own]), a);
        Vec3 t = vec3_unit(vec3_axpy(-vec3_dot(inward, along), along, inward));
        pack->mirror[i].x[lane] = t.x, pack->mirror[i].y[lane] = t.y, pack->mirror[i].z[lane] = t.z;
        pack->mirrored = true;
        pack->weight[i][lane] = 1;
    } else if (other >= 0) {
        bending->flap[f][i] = mesh->faces[other][mesh_corner(mesh, other, edge)];
        pack->weight[i][lane] = 1;
        pack->rest[i][lane] = shell->rest_angle[edge];
    }
}

Term shell_bending_term(const Shell *shell)
{
    Bending *bending = mem_alloc(1, sizeof *bending);
    int faces = shell->mesh->face_count, packs = pack_count(faces);
    bending->shell = shell;
    bending->turn = turn_create(shell);
    bending->packs = mem_alloc((size_t)packs, sizeof *bending->packs);
    bending->flap = mem_alloc((size_t)faces, sizeof *bending->flap);
    for (int k = 0; k < packs * PACK_LANES; k++) {
        int f = k < faces ? k : faces - 1, lane = k % PACK_LANES;
        BendingPack *pack = &bending->packs[k / PACK_LANES];
        pack->face[lane] = f;
        set_form(shell, f, pack, lane);
        for (int i = 0; i < 3; i++) set_edge(bending, f, i, pack, lane);
    }
    return (Term){&bending_ops, bending};
}

void shell_bending_turns(const Term *term, const Point *at, double (*turn)[3])
{
    const Bending *bending = term->self;
    for (int k = 0; k < pack_count(bending_count(bending)); k++) {
        Pack x[21];
        Bent bent;
        gather(bending, k, bending_size(bending), at->x, x);
        bend(bending, k, at, x, &bent);
        for (int i = 0; i < 3 * PACK_LANES; i++)
            turn[bending->packs[k].face[i / 3]][i % 3] = bent.difference[i % 3][i / 3];
    }
}
