#include "solid/stress.h"
#include "base/memory.h"
#include "solid/law.h"
#include "solid/terms.h"
#include "surface/face.h"
#include <string.h>

/* The largest eigenvalue of C = F^T F in closed form [Smith 1961], of trace 3 m, is m + 2 p cos(acos(r)/3), where the
 * invariants of what C has beside m are p and r. */
static double largest_stretch(double F[3][3])
{
    double C[3][3], m = 0, p2 = 0;
    for (int i = 0; i < 9; i++) {
        const int a = i / 3, b = i % 3;
        C[a][b] = F[0][a] * F[0][b] + F[1][a] * F[1][b] + F[2][a] * F[2][b];
        if (a == b) m += C[a][a] / 3;
    }
    for (int i = 0; i < 3; i++) C[i][i] -= m;
    for (int i = 0; i < 9; i++) p2 += C[i / 3][i % 3] * C[i / 3][i % 3] / 6;
    double p = sqrt(p2), det = C[0][0] * (C[1][1] * C[2][2] - C[1][2] * C[2][1]) -
                               C[0][1] * (C[1][0] * C[2][2] - C[1][2] * C[2][0]) +
                               C[0][2] * (C[1][0] * C[2][1] - C[1][1] * C[2][0]);
    double r = p > 0 ? fmax(-1, fmin(1, det / (2 * p * p2))) : 1;
    return sqrt(m + 2 * p * cos(acos(r) / 3));
}

static void lane_of(const PackMat *M, int l, double m[3][3])
{
    const Pack3 *rows[3] = {&M->r0, &M->r1, &M->r2};
    for (int i = 0; i < 3; i++) m[i][0] = rows[i]->x[l], m[i][1] = rows[i]->y[l], m[i][2] = rows[i]->z[l];
}

/* Adds a part of Y P F^T/J to the stress. */
static void add_point(double P[3][3], double F[3][3], double part, TetStress *to)
{
    static const int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < 3; i++) to->cauchy[k] += part * P[row[k]][i] * F[column[k]][i];
    to->stretch = fmax(to->stretch, largest_stretch(F));
}

static double von_mises(const double s[6])
{
    double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
    return sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

/* What the law of the `elastic` term gives (elastic.c). */
static void add_elastic(const Solid *solid, const Point *at, int pack, TetStress *stress)
{
    const Tets *tets = solid->tets;
    const Law *law = law_of(solid->material);
    Lame lame = lame_of(solid->poisson);
    TetPack tet = tet_pack(tets, pack);
    int points = tet_point_count(tets), lanes = tets->count - pack * PACK_LANES;
    Pack x[3 * TET_MAX_NODES];
    tet_gather(tets, pack, at->x, x);
    lame.lambda *= 1 - solid->averaging;
    for (int q = 0; q < points; q++) {
        LawPoint own;
        PackMat P;
        tet_gradients(tets, &tet, tet_point(tets, q), own.gradient);
        own.F = tet_field_gradient(tets->each, own.gradient, x);
        own.cofactor = tet_cofactor(&own.F);
        own.J = pack3_dot(own.F.r0, own.cofactor.r0);
        law->stress(lame, &own, &P);
        for (int l = 0; l < PACK_LANES && l < lanes; l++) {
            double F[3][3], p[3][3];
            int t = pack * PACK_LANES + l;
            lane_of(&own.F, l, F), lane_of(&P, l, p);
            add_point(p, F, at->p[solid->young + t] / (points * own.J[l]), &stress[t]);
        }
    }
}

/* cof F F^T/J = 1: a mean dilation adds a pressure. */
static void add_pressures(const Solid *solid, const System *sys, const Point *at, TetStress *stress)
{
    double *tension = mem_alloc((size_t)solid->tets->count, sizeof *tension);
    for (int t = 0; t < system_term_count(sys); t++)
        if (!strcmp(system_term(sys, t)->ops->name, "mean_dilation"))
            solid_mean_tensions(system_term(sys, t), at, tension);
    for (int t = 0; t < solid->tets->count; t++)
        for (int i = 0; i < 3; i++) stress[t].cauchy[i] += tension[t];
    mem_free(tension);
}

void solid_stresses(const Solid *solid, const System *sys, const Point *at, TetStress *stress)
{
    int count = solid->tets->count;
    memset(stress, 0, (size_t)count * sizeof *stress);
    for (int k = 0; k < pack_count(count); k++) add_elastic(solid, at, k, stress);
    add_pressures(solid, sys, at, stress);
    for (int t = 0; t < count; t++) stress[t].von_mises = von_mises(stress[t].cauchy);
}
