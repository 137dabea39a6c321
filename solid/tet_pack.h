/* tet_pack.h - what terms over tetrahedra share: tetrahedra in packs, their shape functions and points of integration.
 *
 * A place in a tetrahedron is four barycentric coordinates L_a. Of quadratic ones the shape functions are L_a (2 L_a - 1) at
 * the corners and 4 L_a L_b at the middles; they are straight, so that all gradients are sums of those of the L_a. */
#pragma once
#include "base/pack_mat.h"
#include "solid/tets.h"

enum { TET_MAX_NODES = 10, TET_MAX_POINTS = 4 };

typedef struct TetPack {
    Pack3 hat[4]; /* gradients of L_a at rest, 1/m */
    Pack volume;  /* m^3                           */
} TetPack;

/* Caller: mem_free. */
TetPack *tet_packs(const Tets *tets);

TetPack tet_pack(const Tets *tets, int pack);

/* The points of integration, of equal weights 1/count: exact for polynomials of degree 1 and 2. */
int tet_point_count(const Tets *tets);
const double *tet_point(const Tets *tets, int q);

/* Shape functions N[each] at a place, and their gradients at rest, gradient[each]. */
void tet_shape(const Tets *tets, const double L[4], double *N);
void tet_gradients(const Tets *tets, const TetPack *pack, const double L[4], Pack3 *gradient);

/* F = sum_a x_a grad N_a^T: of positions the deformation gradient, of any field its gradient. */
static inline PackMat tet_field_gradient(int nodes, const Pack3 *gradient, const Pack *x)
{
    PackMat F = {{{0}, {0}, {0}}, {{0}, {0}, {0}}, {{0}, {0}, {0}}};
    for (int a = 0; a < nodes; a++) {
        F.r0 = pack3_axpy(x[3 * a], gradient[a], F.r0);
        F.r1 = pack3_axpy(x[3 * a + 1], gradient[a], F.r1);
        F.r2 = pack3_axpy(x[3 * a + 2], gradient[a], F.r2);
    }
    return F;
}

/* dJ/dF, J = det F. */
static inline PackMat tet_cofactor(const PackMat *F)
{
    return (PackMat){pack3_cross(F->r1, F->r2), pack3_cross(F->r2, F->r0), pack3_cross(F->r0, F->r1)};
}

/* The numbers of a pack's nodes, of values that are laid out as positions. */
void tet_gather(const Tets *tets, int pack, const double *values, Pack *x);

/* The dofs of a tetrahedron: its nodes' positions. */
static inline void tet_dofs(const Tets *tets, int tet, int *dof)
{
    const int *nodes = tets->nodes + (size_t)tet * (size_t)tets->each;
    for (int i = 0; i < 3 * tets->each; i++) dof[i] = 3 * nodes[i / 3] + i % 3;
}
