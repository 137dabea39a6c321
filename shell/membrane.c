/* In-plane St. Venant-Kirchhoff stretch of constant-strain triangles [Chen 2022, eqs. 18, 22].
 *
 * F = sum_i x_i b_i^T with the hat functions' rest gradients b_i (2-vectors in the face's rest plane),
 * G = (F^T F - I)/2, S = Y/(1-nu^2) ((1-nu) G + nu tr(G) I), E = A h/2 G:S. */
#include "base/memory.h"
#include "shell/face.h"
#include "shell/terms.h"
#include "base/vec3.h"
#include "solve/element.h"

typedef struct MembranePack {
    Pack b[3][2]; /* 1/m */
    Pack volume;  /* A h, m^3 */
} MembranePack;

typedef struct Membrane {
    const Shell *shell;
    MembranePack *packs;
} Membrane;

static int membrane_count(const void *self)
{
    return ((const Membrane *)self)->shell->mesh->face_count;
}

static int membrane_size(const void *self)
{
    (void)self;
    return 9;
}

static void membrane_dofs(const void *self, int face, int *dof)
{
    face_dofs(((const Membrane *)self)->shell, face, dof);
}

typedef struct Strain {
    Pack3 f0, f1;      /* columns of F                                  */
    Pack g00, g01, g11; /* Green strain                                  */
    Pack s00, s01, s11; /* second Piola-Kirchhoff stress over Young's modulus */
} Strain;

static Strain strain(const MembranePack *at, double poisson, const Pack *x)
{
    Strain s = {0};
    for (int i = 0; i < 3; i++) {
        s.f0 = pack3_axpy(at->b[i][0], pack3_load(x + 3 * i), s.f0);
        s.f1 = pack3_axpy(at->b[i][1], pack3_load(x + 3 * i), s.f1);
    }
    s.g00 = 0.5 * (pack3_dot(s.f0, s.f0) - 1);
    s.g01 = 0.5 * pack3_dot(s.f0, s.f1);
    s.g11 = 0.5 * (pack3_dot(s.f1, s.f1) - 1);
    double shear = 1 / (1 + poisson), bulk = poisson / (1 - poisson * poisson);
    Pack trace = bulk * (s.g00 + s.g11);
    s.s00 = shear * s.g00 + trace;
    s.s01 = shear * s.g01;
    s.s11 = shear * s.g11 + trace;
    return s;
}

/* S b_i */
static void stress_times(const Strain *s, const Pack b[2], Pack r[2])
{
    r[0] = s->s00 * b[0] + s->s01 * b[1];
    r[1] = s->s01 * b[0] + s->s11 * b[1];
}

/* dE/dx_i = A h F S b_i, here over Young's modulus times `factor`. */
static void forces(const MembranePack *at, const Strain *s, Pack factor, Pack *g)
{
    for (int i = 0; i < 3; i++) {
        Pack t[2];
        stress_times(s, at->b[i], t);
        pack3_store(g + 3 * i, pack3_add(pack3_scale(factor * t[0], s->f0), pack3_scale(factor * t[1], s->f1)));
    }
}

/* With y_i = F b_i, mu = Y/2(1+nu), lambda = Y nu/(1-nu^2):
 * d2E/dx_i dx_j = A h ((b_i.S b_j) I + lambda y_i y_j^T + mu (y_j y_i^T + (b_i.b_j) F F^T)). */
static void stiffness(const MembranePack *at, const Strain *s, double poisson, Pack factor, Pack *H)
{
    Pack mu = factor * (0.5 / (1 + poisson)), lambda = factor * (poisson / (1 - poisson * poisson));
    PackMat metric = pack_mat_add(pack_mat_outer(s->f0, s->f0), pack_mat_outer(s->f1, s->f1));
    Pack3 y[3];
    for (int i = 0; i < 3; i++)
        y[i] = pack3_add(pack3_scale(at->b[i][0], s->f0), pack3_scale(at->b[i][1], s->f1));
    element_clear(H, 9);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++) {
            Pack t[2];
            stress_times(s, at->b[j], t);
            Pack geometric = factor * (at->b[i][0] * t[0] + at->b[i][1] * t[1]);
            Pack product = mu * (at->b[i][0] * at->b[j][0] + at->b[i][1] * at->b[j][1]);
            PackMat block = pack_mat_add(pack_mat_diagonal(geometric), pack_mat_scale(product, metric));
            block = pack_mat_add(block, pack_mat_outer(pack3_scale(lambda, y[i]), y[j]));
            block = pack_mat_add(block, pack_mat_outer(pack3_scale(mu, y[j]), y[i]));
            if (i == j)
                element_add_diagonal(H, i, block);
            else
                element_add_block(H, i, j, block);
        }
}

static Pack membrane_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const Membrane *membrane = self;
    const Shell *shell = membrane->shell;
    const MembranePack *face = &membrane->packs[pack];
    Strain s = strain(face, shell->poisson, x);
    Pack factor = face->volume * face_param(shell, pack, at->p + shell->young, 1, 0);
    if (g) forces(face, &s, factor, g);
    if (H) stiffness(face, &s, shell->poisson, factor, H);
    return 0.5 * factor * (s.g00 * s.s00 + 2 * s.g01 * s.s01 + s.g11 * s.s11);
}

/* The force is linear in Young's modulus. */
static void membrane_param(const void *self, int pack, int lanes, const Point *at, const Pack *x, const Pack *w,
                           double *dp)
{
    (void)at;
    const Membrane *membrane = self;
    const MembranePack *face = &membrane->packs[pack];
    Strain s = strain(face, membrane->shell->poisson, x);
    Pack g[9], sum = {0};
    forces(face, &s, face->volume, g);
    for (int i = 0; i < 9; i++) sum += w[i] * g[i];
    for (int l = 0; l < lanes; l++) dp[membrane->shell->young + face_of_lane(membrane->shell, pack, l)] += sum[l];
}

static void membrane_param_forward(const void *self, int pack, const Point *at, const Pack *x, const double *dp, Pack *r)
{
    (void)at;
    const Membrane *membrane = self;
    const Shell *shell = membrane->shell;
    const MembranePack *face = &membrane->packs[pack];
    Strain s = strain(face, shell->poisson, x);
    forces(face, &s, face->volume * face_param(shell, pack, dp + shell->young, 1, 0), r);
}

static void membrane_destroy(void *self)
{
    mem_free(((Membrane *)self)->packs);
    mem_free(self);
}

static const TermOps membrane_ops = {
    .name = "membrane", .count = membrane_count, .size = membrane_size, .dofs = membrane_dofs,
    .eval = membrane_eval, .param = membrane_param, .param_forward = membrane_param_forward,
    .destroy = membrane_destroy,
};

Term shell_membrane_term(const Shell *shell)
{
    Membrane *membrane = mem_alloc(1, sizeof *membrane);
    membrane->shell = shell;
    membrane->packs = mem_alloc((size_t)face_pack_count(shell), sizeof *membrane->packs);
    for (int k = 0; k < face_pack_count(shell) * PACK_LANES; k++) {
        int face = face_of_lane(shell, k / PACK_LANES, k % PACK_LANES), l = k % PACK_LANES;
        MembranePack *pack = &membrane->packs[k / PACK_LANES];
        FaceFrame frame = face_frame(shell, face);
        Vec3 along = vec3_unit(vec3_load(frame.hat[0])); /* any direction in the plane */
        Vec3 across = vec3_cross(vec3_load(frame.normal), along);
        for (int i = 0; i < 3; i++) {
            pack->b[i][0][l] = vec3_dot(vec3_load(frame.hat[i]), along);
            pack->b[i][1][l] = vec3_dot(vec3_load(frame.hat[i]), across);
        }
        pack->volume[l] = shell->mesh->rest_area[face] * shell->thickness;
    }
    return (Term){&membrane_ops, membrane};
}
