/* In-plane stretch of constant-strain triangles, of a material in plane stress.
 *
 * F = sum_i x_i b_i^T with the hat functions' rest gradients b_i (2-vectors in the face's rest plane), C = F^T F,
 * G = (C - I)/2, S = 2 dW/dC, E = A h W.
 * St. Venant-Kirchhoff [Chen 2022, eqs. 18, 22]: S = Y/(1-nu^2) ((1-nu) G + nu tr(G) I), W = G:S/2.
 * Neo-Hookean [Blatz, Ko 1962, with their f = 1], mu = Y/2(1+nu), beta = nu/(1-2nu): mu/2 (I - 3 + (J^-2beta - 1)/beta). Without
 * stress across, the thickness follows from the area in closed form, l^2 = (det C)^-k with k = nu/(1-nu), and so
 *     W = mu/2 (tr C - 2 + ((det C)^-k - 1)/k),     S = mu (I - (det C)^(-k-1) adj C):
 * for nu = 1/2 the incompressible mu/2 (tr C + 1/det C - 3), for nu = 0 the limit mu/2 (tr C - 2 - ln det C). */
#include "surface/membrane.h"
#include "base/memory.h"
#include "solve/element.h"
#include <math.h>

static const double CRUSHED = 0.05;            /* of the area */
static const double LEAST_EXTRAPOLATED = 0.25; /* det C: half of the area */

typedef struct MembranePack {
    Pack b[3][2]; /* 1/m */
    Pack volume;  /* FaceLayer.volume */
} MembranePack;

typedef struct Strain {
    Pack3 f0, f1;       /* columns of F                                                      */
    Pack g00, g01, g11; /* Green strain                                                      */
    Pack s00, s01, s11; /* second Piola-Kirchhoff stress over Young's modulus                */
    Pack twice;         /* 2 W over Young's modulus                                          */
    Pack det, slope;    /* of laws with an area: det C, (det C)^(-k-1)                       */
} Strain;

/* dS = lambda tr(dG) I + 2 mu dG + area (adj C : dG) adj C, over Young's modulus. */
typedef struct Tangent {
    Pack lambda, mu, area;
} Tangent;

/* A material, a row. */
typedef struct Law {
    void (*stress)(double poisson,
                   Strain *s); /* of its Green strain: stress, energy, and what the tangent needs */
    Tangent (*tangent)(double poisson, const Strain *s);
    double (*across)(double poisson, double trace,
                     double det); /* of C - 1, C: squared stretch of the thickness */
    bool has_area;                /* Tangent.area is not 0 */
} Law;

typedef struct Membrane {
    FaceLayer layer;
    MembraneDef def;
    const Law *law;
    MembranePack *packs;
} Membrane;

static int membrane_count(const void *self)
{
    return ((const Membrane *)self)->layer.count;
}

static int membrane_size(const void *self)
{
    (void)self;
    return 9;
}

static void membrane_dofs(const void *self, int face, int *dof)
{
    face_dofs(((const Membrane *)self)->layer.faces[face], dof);
}

/* ---- Materials ---- */

static void green_stress(double poisson, Strain *s)
{
    double shear = 1 / (1 + poisson), bulk = poisson / (1 - poisson * poisson);
    Pack trace = bulk * (s->g00 + s->g11);
    s->s00 = shear * s->g00 + trace;
    s->s01 = shear * s->g01;
    s->s11 = shear * s->g11 + trace;
    s->twice = s->g00 * s->s00 + 2 * s->g01 * s->s01 + s->g11 * s->s11;
}

static Tangent green_tangent(double poisson, const Strain *s)
{
    (void)s;
    return (Tangent){.lambda = pack_set(poisson / (1 - poisson * poisson)),
                     .mu = pack_set(0.5 / (1 + poisson))};
}

/* What leaves no stress across: G33 = -nu/(1-nu) tr G. */
static double green_across(double poisson, double trace, double det)
{
    (void)det;
    return 1 - poisson / (1 - poisson) * trace;
}

/* With u = det C - 1 and e = (det C)^-k - 1: what is linear in G cancels in tr C - 2 - u = -4 det G, so that no digits are
 * lost near rest. Infinite where the area is 0: no step goes there. */
static void neo_stress(double poisson, Strain *s)
{
    double mu = 0.5 / (1 + poisson), k = poisson / (1 - poisson);
    Pack det = s->g00 * s->g11 - s->g01 * s->g01, u = 2 * (s->g00 + s->g11) + 4 * det, e, swell;
    for (int l = 0; l < PACK_LANES; l++) {
        double log = log1p(u[l]);
        e[l] = expm1(-k * log);
        swell[l] = u[l] + (k > 0 ? e[l] / k : -log);
    }
    s->det = 1 + u, s->slope = (1 + e) / s->det;
    Pack even = mu * (u - e) / s->det, turn = 2 * mu * s->slope;
    s->s00 = even - turn * s->g11;
    s->s01 = turn * s->g01;
    s->s11 = even - turn * s->g00;
    s->twice = pack_select(s->det > 0, mu * (swell - 4 * det), pack_set(INFINITY));
}

static Tangent neo_tangent(double poisson, const Strain *s)
{
    double mu = 0.5 / (1 + poisson), k = poisson / (1 - poisson);
    return (Tangent){
        .lambda = -2 * mu * s->slope, .mu = mu * s->slope, .area = 2 * mu * (1 + k) * s->slope / s->det};
}

static double neo_across(double poisson, double trace, double det)
{
    (void)trace;
    return pow(det, -poisson / (1 - poisson));
}

static const Law *law_of(MembraneMaterial material)
{
    static const Law rows[] = {
        [MEMBRANE_ST_VENANT_KIRCHHOFF] = {green_stress, green_tangent, green_across, false},
        [MEMBRANE_NEO_HOOKEAN] = {neo_stress, neo_tangent, neo_across, true}};
    return &rows[material];
}

/* ---- Strain, forces, stiffness ---- */

/* f0, f1 = sum_i v_i b_i^T: the gradient of a field on the face. */
static void gradient(const MembranePack *at, const Pack *v, Pack3 *f0, Pack3 *f1)
{
    *f0 = *f1 = (Pack3){0};
    for (int i = 0; i < 3; i++) {
        *f0 = pack3_axpy(at->b[i][0], pack3_load(v + 3 * i), *f0);
        *f1 = pack3_axpy(at->b[i][1], pack3_load(v + 3 * i), *f1);
    }
}

static Strain strain(const Membrane *membrane, int pack, const Pack *x)
{
    Strain s = {0};
    gradient(&membrane->packs[pack], x, &s.f0, &s.f1);
    s.g00 = 0.5 * (pack3_dot(s.f0, s.f0) - 1);
    s.g01 = 0.5 * pack3_dot(s.f0, s.f1);
    s.g11 = 0.5 * (pack3_dot(s.f1, s.f1) - 1);
    membrane->law->stress(membrane->def.poisson, &s);
    return s;
}

/* Of the vertices of a pack's faces, values laid out as x. */
static void gather(const Membrane *membrane, int pack, const double *values, Pack v[9])
{
    for (int l = 0; l < PACK_LANES; l++) {
        int dof[9];
        membrane_dofs(membrane, pack_element(membrane_count(membrane), pack, l), dof);
        for (int i = 0; i < 9; i++) v[i][l] = values[dof[i]];
    }
}

/* The stress that the last step was to bring, of the strain G(x0) + DG(x0) d: what a step stretches beside that, to second
 * order, the next one takes back, and it must not pass for stiffness [mixed integration points: Magisano, Leonetti,
 * Garcea 2017]. Where that strain would leave less than half of the area, the stress stays its own. */
static void extrapolate(const Membrane *membrane, int pack, const Point *at, Strain *s)
{
    const MembranePack *face = &membrane->packs[pack];
    Pack x[9], d[9];
    gather(membrane, pack, at->x_from, x);
    gather(membrane, pack, at->step, d);
    Strain from = strain(membrane, pack, x);
    Pack3 e0, e1;
    gradient(face, d, &e0, &e1);
    from.g00 += pack3_dot(from.f0, e0);
    from.g11 += pack3_dot(from.f1, e1);
    from.g01 += 0.5 * (pack3_dot(from.f0, e1) + pack3_dot(from.f1, e0));
    membrane->law->stress(membrane->def.poisson, &from);
    PackMask fine = membrane->law->has_area ? (PackMask)(from.det > LEAST_EXTRAPOLATED) : ~(PackMask){0};
    s->s00 = pack_select(fine, from.s00, s->s00);
    s->s01 = pack_select(fine, from.s01, s->s01);
    s->s11 = pack_select(fine, from.s11, s->s11);
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
        pack3_store(g + 3 * i,
                    pack3_add(pack3_scale(factor * t[0], s->f0), pack3_scale(factor * t[1], s->f1)));
    }
}

/* With z_i = F adj(C) b_i: A h area z_i z_j^T. */
static void area_stiffness(const MembranePack *at, const Strain *s, Pack area, Pack *H)
{
    Pack c00 = 1 + 2 * s->g00, c01 = 2 * s->g01, c11 = 1 + 2 * s->g11;
    Pack3 z[3];
    for (int i = 0; i < 3; i++)
        z[i] = pack3_add(pack3_scale(c11 * at->b[i][0] - c01 * at->b[i][1], s->f0),
                         pack3_scale(c00 * at->b[i][1] - c01 * at->b[i][0], s->f1));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++) element_add_block(H, i, j, pack_mat_outer(pack3_scale(area, z[i]), z[j]));
    for (int i = 0; i < 3; i++) element_add_diagonal(H, i, pack_mat_outer(pack3_scale(area, z[i]), z[i]));
}

/* With y_i = F b_i, mu and lambda of the tangent, over Young's modulus:
 * d2E/dx_i dx_j = A h ((b_i.S b_j) I + lambda y_i y_j^T + mu (y_j y_i^T + (b_i.b_j) F F^T)), and what an area adds. */
static void stiffness(const MembranePack *at, const Strain *s, Tangent tangent, Pack factor, Pack *H)
{
    Pack mu = factor * tangent.mu, lambda = factor * tangent.lambda;
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

/* Young's modulus, or its change, of values laid out as p. */
static Pack young(const Membrane *membrane, int pack, const double *values)
{
    return face_layer_param(&membrane->layer, pack, values + membrane->def.young, 1, 0);
}

static Pack volume_of(const Membrane *membrane, int pack, const Point *at)
{
    return face_layer_volume(&membrane->layer, pack, membrane->packs[pack].volume, at->p);
}

static Pack membrane_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    const Membrane *membrane = self;
    const MembranePack *face = &membrane->packs[pack];
    Strain s = strain(membrane, pack, x);
    Pack factor = volume_of(membrane, pack, at) * young(membrane, pack, at->p);
    if (g) forces(face, &s, factor, g);
    if (!H) return 0.5 * factor * s.twice;
    Tangent tangent = membrane->law->tangent(membrane->def.poisson, &s);
    if (at->x_from) extrapolate(membrane, pack, at, &s);
    stiffness(face, &s, tangent, factor, H);
    if (membrane->law->has_area) area_stiffness(face, &s, factor * tangent.area, H);
    return 0.5 * factor * s.twice;
}

/* The force is linear in Young's modulus and in the volume. */
static void membrane_param(const void *self, int pack, int lanes, const Point *at, const Pack *x,
                           const Pack *w, double *dp)
{
    const Membrane *membrane = self;
    const MembranePack *face = &membrane->packs[pack];
    Strain s = strain(membrane, pack, x);
    Pack g[9], sum = {0}, volume = volume_of(membrane, pack, at);
    forces(face, &s, volume, g);
    for (int i = 0; i < 9; i++) sum += w[i] * g[i];
    for (int l = 0; l < lanes; l++)
        dp[membrane->def.young + face_layer_row(&membrane->layer, pack, l)] += sum[l];
    face_layer_add_volume(&membrane->layer, pack, lanes, face->volume,
                          young(membrane, pack, at->p) * sum / volume, dp);
}

static void membrane_param_forward(const void *self, int pack, const Point *at, const Pack *x,
                                   const double *dp, Pack *r)
{
    const Membrane *membrane = self;
    const MembranePack *face = &membrane->packs[pack];
    Strain s = strain(membrane, pack, x);
    Pack swell = face_layer_volume_change(&membrane->layer, pack, face->volume, dp);
    forces(face, &s,
           volume_of(membrane, pack, at) * young(membrane, pack, dp) + swell * young(membrane, pack, at->p),
           r);
}

bool membrane_is_crushed(MembraneMaterial material, double area)
{
    return material == MEMBRANE_ST_VENANT_KIRCHHOFF && area < CRUSHED;
}

/* A crushed face may be at rest, and next to it no energy grows. In a motion its inertia takes it through that. */
static bool membrane_tangles(const void *self, const Point *at)
{
    const Membrane *membrane = self;
    if (at->x_prev) return false;
    for (int pack = 0; pack < pack_count(membrane->layer.count); pack++) {
        Pack x[9];
        Pack3 f0, f1;
        gather(membrane, pack, at->x, x);
        gradient(&membrane->packs[pack], x, &f0, &f1);
        Pack slant = pack3_dot(f0, f1), det = pack3_dot(f0, f0) * pack3_dot(f1, f1) - slant * slant;
        for (int l = 0; l < PACK_LANES; l++)
            if (membrane_is_crushed(membrane->def.material, sqrt(fmax(det[l], 0)))) return true;
    }
    return false;
}

static void membrane_destroy(void *self)
{
    face_layer_clear(&((Membrane *)self)->layer);
    mem_free(((Membrane *)self)->packs);
    mem_free(self);
}

static const TermOps membrane_ops = {
    .name = "membrane",
    .count = membrane_count,
    .size = membrane_size,
    .dofs = membrane_dofs,
    .eval = membrane_eval,
    .tangles = membrane_tangles,
    .param = membrane_param,
    .param_forward = membrane_param_forward,
    .destroy = membrane_destroy,
};

Term membrane_term(FaceLayer layer, const MembraneDef *def)
{
    Membrane *membrane = mem_alloc(1, sizeof *membrane);
    int packs = pack_count(layer.count);
    membrane->layer = layer, membrane->def = *def;
    membrane->law = law_of(def->material);
    membrane->packs = mem_alloc((size_t)packs, sizeof *membrane->packs);
    for (int k = 0; k < packs * PACK_LANES; k++) {
        int l = k % PACK_LANES, face = pack_element(layer.count, k / PACK_LANES, l);
        MembranePack *pack = &membrane->packs[k / PACK_LANES];
        double b[3][2];
        face_gradients(layer.rest, layer.faces[face], b);
        for (int i = 0; i < 6; i++) pack->b[i / 2][i % 2][l] = b[i / 2][i % 2];
        pack->volume[l] = layer.volume[face];
    }
    return (Term){&membrane_ops, membrane};
}

/* ---- What a state bears ---- */

void plane_principal(PlaneTensor t, double value[2])
{
    double mean = 0.5 * (t.xx + t.yy), radius = hypot(0.5 * (t.xx - t.yy), t.xy);
    value[0] = mean + radius, value[1] = mean - radius;
}

PlaneTensor membrane_strain(double (*rest)[3], const double *x, const int *face)
{
    double b[3][2], g00 = -1, g01 = 0, g11 = -1;
    face_gradients(rest, face, b);
    for (int k = 0; k < 3; k++) {
        double f[2] = {0};
        for (int i = 0; i < 6; i++) f[i % 2] += b[i / 2][i % 2] * x[3 * face[i / 2] + k];
        g00 += f[0] * f[0], g01 += f[0] * f[1], g11 += f[1] * f[1];
    }
    return (PlaneTensor){0.5 * g00, 0.5 * g01, 0.5 * g11};
}

/* sigma = F S F^T/J has the trace and determinant of S C/J, and J^2 = det C times the thickness' squared stretch; without
 * stress across, von Mises' is tr^2 - 3 det. */
double membrane_von_mises(MembraneMaterial material, double poisson, PlaneTensor strain)
{
    const Law *law = law_of(material);
    Strain s = {.g00 = pack_set(strain.xx), .g01 = pack_set(strain.xy), .g11 = pack_set(strain.yy)};
    law->stress(poisson, &s);
    double xx = s.s00[0], xy = s.s01[0], yy = s.s11[0];
    double c00 = 1 + 2 * strain.xx, c01 = 2 * strain.xy, c11 = 1 + 2 * strain.yy, det = c00 * c11 - c01 * c01;
    double J2 = det * law->across(poisson, 2 * (strain.xx + strain.yy), det);
    double trace = xx * c00 + 2 * xy * c01 + yy * c11,
           squared = trace * trace - 3 * (xx * yy - xy * xy) * det;
    return c00 > 0 && det > 0 && J2 > 0 ? sqrt(fmax(squared, 0) / J2) : NAN;
}
