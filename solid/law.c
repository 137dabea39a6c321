/* Neo-Hookean psi = mu/2 (F:F - 3) - mu (J - 1) + V(J), with V = (lambda + mu)/2 (J - 1)^2, or, as usually written,
 * mu/2 (F:F - 3) - mu ln J + lambda/2 (ln J)^2 [Bonet, Wood 2008]. With D = F - 1 the parts linear in D cancel, so that
 * no digits are lost near rest:
 *     (F:F - 3)/2 - (J - 1) = D:D/2 - (sum of the principal minors of D) - det D.
 * St. Venant-Kirchhoff: psi = lambda/2 tr(E)^2 + mu E:E, E = (F^T F - 1)/2. */
#include "solid/law.h"
#include "solve/element.h"

Lame lame_of(double poisson)
{
    return (Lame){.mu = 0.5 / (1 + poisson), .lambda = poisson / ((1 + poisson) * (1 - 2 * poisson))};
}

static Pack dot(const PackMat *a, const PackMat *b)
{
    return pack3_dot(a->r0, b->r0) + pack3_dot(a->r1, b->r1) + pack3_dot(a->r2, b->r2);
}

static void add_block(Pack *H, int a, int b, PackMat block)
{
    if (a == b)
        element_add_diagonal(H, a, block);
    else
        element_add_block(H, a, b, block);
}

/* ---- Neo-Hookean ---- */

/* V and its derivatives. */
typedef struct Volumetric {
    Pack value, slope, curve;
} Volumetric;

static Volumetric stable(Lame lame, Pack J)
{
    Pack k = pack_set(lame.lambda + lame.mu), j = J - 1;
    return (Volumetric){0.5 * k * j * j, k * j, k};
}

/* Infinite where J <= 0: no step goes there. */
static Volumetric logarithmic(Lame lame, Pack J)
{
    Pack ln, inverse = 1 / J;
    for (int l = 0; l < PACK_LANES; l++) ln[l] = log1p(J[l] - 1);
    Pack value = lame.mu * (J - 1 - ln) + 0.5 * lame.lambda * ln * ln;
    return (Volumetric){.value = pack_select(J > 0, value, pack_set(INFINITY)),
                        .slope = lame.mu * (1 - inverse) + lame.lambda * ln * inverse,
                        .curve = (lame.mu + lame.lambda * (1 - ln)) * inverse * inverse};
}

/* The same for a number. */
typedef Volumetric VolumetricLaw(Lame lame, Pack J);

/* (F:F - 3)/2 - (J - 1) */
static Pack distortion(const PackMat *F)
{
    PackMat D = *F;
    D.r0.x -= 1, D.r1.y -= 1, D.r2.z -= 1;
    PackMat minors = tet_cofactor(&D);
    return 0.5 * dot(&D, &D) - (minors.r0.x + minors.r1.y + minors.r2.z) - pack3_dot(D.r0, minors.r0);
}

/* P = mu F + (V' - mu) dJ/dF */
static inline Pack neo_stress(VolumetricLaw *law, Lame lame, const LawPoint *at, PackMat *P)
{
    Volumetric V = law(lame, at->J);
    if (P)
        *P = pack_mat_add(pack_mat_scale(pack_set(lame.mu), at->F),
                          pack_mat_scale(V.slope - lame.mu, at->cofactor));
    return lame.mu * distortion(&at->F) + V.value;
}

/* Of the block of nodes a and b: w (mu (grad N_a.grad N_b) 1 + V'' y_a y_b^T - (V' - mu) [F (grad N_a x grad N_b)]x). */
typedef struct NeoPoint {
    Pack even, curve, turn;
    Pack3 y[TET_MAX_NODES];
} NeoPoint;

static inline NeoPoint neo_point(VolumetricLaw *law, Lame lame, const LawPoint *at, int nodes)
{
    Volumetric V = law(lame, at->J);
    NeoPoint r = {.even = at->weight * lame.mu,
                  .curve = at->weight * V.curve,
                  .turn = at->weight * (lame.mu - V.slope)};
    for (int a = 0; a < nodes; a++) r.y[a] = pack_mat_times(at->cofactor, at->gradient[a]);
    return r;
}

static inline PackMat neo_block(const NeoPoint *neo, const LawPoint *at, int a, int b)
{
    Pack3 ga = at->gradient[a], gb = at->gradient[b];
    PackMat block = pack_mat_outer(pack3_scale(neo->curve, neo->y[a]), neo->y[b]);
    Pack even = neo->even * pack3_dot(ga, gb);
    block.r0.x += even, block.r1.y += even, block.r2.z += even;
    if (a == b) return block;
    Pack3 c = pack3_scale(neo->turn, pack_mat_times(at->F, pack3_cross(ga, gb)));
    return pack_mat_add(block, pack_mat_cross(c));
}

static inline void neo_stiffness(VolumetricLaw *law, Lame lame, const LawPoint *points, int point_count,
                                 int nodes, Pack *H)
{
    NeoPoint neo[TET_MAX_POINTS];
    for (int q = 0; q < point_count; q++) neo[q] = neo_point(law, lame, &points[q], nodes);
    for (int a = 0; a < nodes; a++)
        for (int b = 0; b <= a; b++) {
            PackMat block = neo_block(&neo[0], &points[0], a, b);
            for (int q = 1; q < point_count; q++)
                block = pack_mat_add(block, neo_block(&neo[q], &points[q], a, b));
            add_block(H, a, b, block);
        }
}

/* With c = V' - mu: mu + c s_k about the axis k, mu - c s_k in the shear across it. */
static inline LawModes neo_modes(VolumetricLaw *law, Lame lame, const double s[3])
{
    double J = s[0] * s[1] * s[2];
    Volumetric V = law(lame, pack_set(J));
    double c = V.slope[0] - lame.mu, curve = V.curve[0];
    LawModes r;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        r.twist[i] = lame.mu + c * s[i];
        r.flip[i] = lame.mu - c * s[i];
        r.stretch[i][i] = lame.mu + curve * s[j] * s[k] * s[j] * s[k];
        r.stretch[i][j] = r.stretch[j][i] = curve * s[j] * s[k] * s[k] * s[i] + c * s[k];
    }
    return r;
}

#define NEO_HOOKEAN(volumetric)                                                                              \
    static Pack volumetric##_stress(Lame lame, const LawPoint *at, PackMat *P)                               \
    {                                                                                                        \
        return neo_stress(volumetric, lame, at, P);                                                          \
    }                                                                                                        \
    static void volumetric##_stiffness(Lame lame, const LawPoint *points, int point_count, int nodes,        \
                                       Pack *H)                                                              \
    {                                                                                                        \
        neo_stiffness(volumetric, lame, points, point_count, nodes, H);                                      \
    }                                                                                                        \
    static LawModes volumetric##_modes(Lame lame, const double s[3])                                         \
    {                                                                                                        \
        return neo_modes(volumetric, lame, s);                                                               \
    }

NEO_HOOKEAN(stable)
NEO_HOOKEAN(logarithmic)

/* ---- St. Venant-Kirchhoff ---- */

/* S = lambda tr(E) 1 + 2 mu E; its sum of products with E/2 is psi. */
static PackMat green_stress(Lame lame, const PackMat *F, Pack *energy)
{
    PackMat E = pack_mat_product(pack_mat_transpose(*F), *F);
    E.r0.x -= 1, E.r1.y -= 1, E.r2.z -= 1;
    E = pack_mat_scale(pack_set(0.5), E);
    Pack trace = E.r0.x + E.r1.y + E.r2.z;
    *energy = 0.5 * lame.lambda * trace * trace + lame.mu * dot(&E, &E);
    return pack_mat_add(pack_mat_diagonal(lame.lambda * trace), pack_mat_scale(pack_set(2 * lame.mu), E));
}

static Pack green_law_stress(Lame lame, const LawPoint *at, PackMat *P)
{
    Pack energy;
    PackMat S = green_stress(lame, &at->F, &energy);
    if (P) *P = pack_mat_product(at->F, S);
    return energy;
}

/* With z_a = F grad N_a: w ((grad N_a.S grad N_b) 1 + lambda z_a z_b^T + mu (z_b z_a^T + (grad N_a.grad N_b) F F^T)). */
static void green_law_stiffness(Lame lame, const LawPoint *points, int point_count, int nodes, Pack *H)
{
    Pack mu = pack_set(lame.mu), lambda = pack_set(lame.lambda);
    for (int q = 0; q < point_count; q++) {
        const LawPoint *at = &points[q];
        Pack energy;
        PackMat S = green_stress(lame, &at->F, &energy),
                metric = pack_mat_product(at->F, pack_mat_transpose(at->F));
        Pack3 z[TET_MAX_NODES], stress[TET_MAX_NODES];
        for (int a = 0; a < nodes; a++) {
            z[a] = pack_mat_times(at->F, at->gradient[a]);
            stress[a] = pack_mat_times(S, at->gradient[a]);
        }
        for (int a = 0; a < nodes; a++)
            for (int b = 0; b <= a; b++) {
                PackMat block = pack_mat_diagonal(pack3_dot(at->gradient[a], stress[b]));
                block = pack_mat_add(block, pack_mat_outer(pack3_scale(lambda, z[a]), z[b]));
                block = pack_mat_add(block, pack_mat_outer(pack3_scale(mu, z[b]), z[a]));
                Pack even = mu * pack3_dot(at->gradient[a], at->gradient[b]);
                block = pack_mat_add(block, pack_mat_scale(even, metric));
                add_block(H, a, b, pack_mat_scale(at->weight, block));
            }
    }
}

/* psi_i = s_i T + mu s_i^3, T = lambda tr(E) - mu. */
static LawModes green_law_modes(Lame lame, const double s[3])
{
    double trace = 0.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2] - 3), T = lame.lambda * trace - lame.mu;
    LawModes r;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double even = T + lame.mu * (s[j] * s[j] + s[k] * s[k]), odd = lame.mu * s[j] * s[k];
        r.twist[i] = even - odd;
        r.flip[i] = even + odd;
        r.stretch[i][i] = T + (3 * lame.mu + lame.lambda) * s[i] * s[i];
        r.stretch[i][j] = r.stretch[j][i] = lame.lambda * s[i] * s[j];
    }
    return r;
}

/* ---- The table ---- */

const Law *law_of(SolidMaterial material)
{
    static const Law rows[] = {
        [SOLID_NEO_HOOKEAN] = {stable_stress, stable_stiffness, stable_modes},
        [SOLID_NEO_HOOKEAN_LOG] = {logarithmic_stress, logarithmic_stiffness, logarithmic_modes},
        [SOLID_ST_VENANT_KIRCHHOFF] = {green_law_stress, green_law_stiffness, green_law_modes},
    };
    return &rows[material];
}
