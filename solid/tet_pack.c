#include "solid/tet_pack.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "surface/face.h"

/* Gradients of L_a: across the side opposite to a, over the height. */
static void hats(const Tets *tets, int tet, double hat[4][3])
{
    double(*rest)[3] = tets->surface->rest, edge[3][3];
    const int *v = tets->nodes + (size_t)tet * (size_t)tets->each;
    for (int i = 0; i < 9; i++) edge[i / 3][i % 3] = rest[v[1 + i / 3]][i % 3] - rest[v[0]][i % 3];
    for (int i = 0; i < 3; i++) {
        const double *a = edge[(i + 1) % 3], *b = edge[(i + 2) % 3];
        for (int k = 0; k < 3; k++) {
            int l = (k + 1) % 3, m = (k + 2) % 3;
            hat[1 + i][k] = (a[l] * b[m] - a[m] * b[l]) / (6 * tets->volume[tet]);
        }
    }
    for (int k = 0; k < 3; k++) hat[0][k] = -hat[1][k] - hat[2][k] - hat[3][k];
}

TetPack tet_pack(const Tets *tets, int pack)
{
    TetPack r;
    for (int l = 0; l < PACK_LANES; l++) {
        int tet = pack_element(tets->count, pack, l);
        double hat[4][3];
        hats(tets, tet, hat);
        for (int a = 0; a < 4; a++)
            r.hat[a].x[l] = hat[a][0], r.hat[a].y[l] = hat[a][1], r.hat[a].z[l] = hat[a][2];
        r.volume[l] = tets->volume[tet];
    }
    return r;
}

TetPack *tet_packs(const Tets *tets)
{
    int count = pack_count(tets->count);
    TetPack *packs = mem_alloc((size_t)count, sizeof *packs);
    for (int k = 0; k < count; k++) packs[k] = tet_pack(tets, k);
    return packs;
}

void tet_gather(const Tets *tets, int pack, const double *values, Pack *x)
{
    for (int l = 0; l < PACK_LANES; l++) {
        int dof[3 * TET_MAX_NODES];
        tet_dofs(tets, pack_element(tets->count, pack, l), dof);
        for (int i = 0; i < 3 * tets->each; i++) x[i][l] = values[dof[i]];
    }
}

int tet_point_count(const Tets *tets)
{
    return tets->order == TET_QUADRATIC ? 4 : 1;
}

/* (5 + 3 sqrt 5)/20 and (5 - sqrt 5)/20 [Hammer, Marlowe, Stroud 1956]. */
#define NEAR 0.58541019662496845446
#define FAR  0.13819660112501051518

const double *tet_point(const Tets *tets, int q)
{
    static const double middle[4] = {0.25, 0.25, 0.25, 0.25}, four[4][4] = {
                                                                  {NEAR, FAR, FAR, FAR},
                                                                  {FAR, NEAR, FAR, FAR},
                                                                  {FAR, FAR, NEAR, FAR},
                                                                  {FAR, FAR, FAR, NEAR},
                                                              };
    return tets->order == TET_QUADRATIC ? four[q] : middle;
}

void tet_shape(const Tets *tets, const double L[4], double *N)
{
    bool quadratic = tets->order == TET_QUADRATIC;
    for (int a = 0; a < 4; a++) N[a] = quadratic ? L[a] * (2 * L[a] - 1) : L[a];
    for (int e = 0; quadratic && e < 6; e++) N[4 + e] = 4 * L[tet_edges[e][0]] * L[tet_edges[e][1]];
}

void tet_gradients(const Tets *tets, const TetPack *pack, const double L[4], Pack3 *gradient)
{
    bool quadratic = tets->order == TET_QUADRATIC;
    for (int a = 0; a < 4; a++)
        gradient[a] = pack3_scale(pack_set(quadratic ? 4 * L[a] - 1 : 1), pack->hat[a]);
    for (int e = 0; quadratic && e < 6; e++) {
        int a = tet_edges[e][0], b = tet_edges[e][1];
        gradient[4 + e] =
            pack3_axpy(pack_set(4 * L[a]), pack->hat[b], pack3_scale(pack_set(4 * L[b]), pack->hat[a]));
    }
}
