/* Where a solid is turned inside out. F is taken at the corners of its tetrahedra, at the middles of their edges and at
 * the points of integration; that of a linear one is the same everywhere. */
#include "solid/tet_pack.h"
#include "solid/solid.h"
#include "surface/face.h"

static const double FLAT = 1e-3; /* det F: bars that are crushed to 40 % still have 1e-2 at their corners */

/* Least det F of each tetrahedron of a pack over the places that count. */
static Pack least_of_pack(const Tets *tets, int pack, const double *x)
{
    TetPack tet = tet_pack(tets, pack);
    Pack own[3 * TET_MAX_NODES], least = pack_set(INFINITY);
    tet_gather(tets, pack, x, own);
    int points = tet_point_count(tets), places = points + (points > 1 ? TET_MAX_NODES : 0);
    for (int k = 0; k < places; k++) {
        double L[4] = {0};
        int node = k - points;
        if (node < 0)
            for (int a = 0; a < 4; a++) L[a] = tet_point(tets, k)[a];
        else if (node < 4)
            L[node] = 1;
        else
            L[tet_edges[node - 4][0]] = L[tet_edges[node - 4][1]] = 0.5;
        Pack3 gradient[TET_MAX_NODES];
        tet_gradients(tets, &tet, L, gradient);
        PackMat F = tet_field_gradient(tets->each, gradient, own);
        Pack J = pack3_dot(F.r0, pack3_cross(F.r1, F.r2));
        least = pack_select(J < least, J, least);
    }
    return least;
}

void solid_jacobians(const Solid *solid, const double *x, double *least)
{
    int count = solid->tets->count;
    for (int k = 0; k < pack_count(count); k++) {
        Pack J = least_of_pack(solid->tets, k, x);
        for (int l = 0; l < PACK_LANES; l++) least[pack_element(count, k, l)] = J[l];
    }
}

bool solid_is_tangled(double least_jacobian)
{
    return least_jacobian <= FLAT;
}

double solid_least_jacobian(const Solid *solid, const double *x, int *tet)
{
    const Tets *tets = solid->tets;
    double least = INFINITY;
    for (int k = 0; k < pack_count(tets->count); k++) {
        Pack J = least_of_pack(tets, k, x);
        for (int l = 0; l < PACK_LANES; l++)
            if (J[l] < least) {
                least = J[l];
                if (tet) *tet = pack_element(tets->count, k, l);
            }
    }
    return least;
}
