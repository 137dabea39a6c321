#include "world/crossings.h"
#include "base/vec3.h"
#include <string.h>

static const double ROD_CROSSES = 0.1; /* of D */

/* Six times the volume of a tetrahedron. */
static double volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d)
{
    return vec3_dot(vec3_sub(d, a), vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
}

/* Its ends are on either side of the plane, and all corners are on one side of it as seen along the edge. */
static bool passes_through(const double *x, const int edge[2], const int face[3])
{
    Vec3 p = vec3_load(x + 3 * edge[0]), q = vec3_load(x + 3 * edge[1]), t[3];
    for (int i = 0; i < 3; i++) t[i] = vec3_load(x + 3 * face[i]);
    double above = volume(t[0], t[1], t[2], p), below = volume(t[0], t[1], t[2], q);
    if (!(above * below < 0)) return false;
    double a = volume(p, q, t[0], t[1]), b = volume(p, q, t[1], t[2]), c = volume(p, q, t[2], t[0]);
    return (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
}

/* Also two vertices at one place, as on a slit: there they touch, and contact leaves them out (neighbours.c). */
static bool share_vertex(const SelfContactDef *def, const int edge[2], const int face[3])
{
    bool shared = false;
    for (int i = 0; i < 6; i++) {
        int a = edge[i % 2], b = face[i / 2];
        bool one_piece = !def->part || def->part[a] == def->part[b];
        shared |= a == b || (one_piece && !memcmp(def->rest[a], def->rest[b], sizeof def->rest[a]));
    }
    return shared;
}

static int rod_crossings(Neighbours *n, const double *x, int (*pairs)[2], int max)
{
    PairList near = {0};
    neighbours_find(n, x, ROD_CROSSES * n->def.distance, &near);
    int count = near.count - near.points;
    for (int k = 0; k < count && k < max; k++) memcpy(pairs[k], near.pairs[near.points + k], sizeof *pairs);
    pair_list_clear(&near);
    return count;
}

int crossings_find(Neighbours *n, const double *x, int (*pairs)[2], int max)
{
    const SelfContactDef *def = &n->def;
    x += def->first;
    if (def->face_count == 0) return rod_crossings(n, x, pairs, max);
    NearPairs *found = neighbours_edges_and_faces(n, x);
    int count = 0;
    for (int k = 0; k < found->count; k++) {
        const int *pair = found->list[k], *edge = def->edges[pair[0]], *face = def->faces[pair[1]];
        if (!share_vertex(def, edge, face) && passes_through(x, edge, face))
            memcpy(found->list[count++], pair, sizeof *found->list);
    }
    near_pairs_sort(found->list, count);
    for (int k = 0; k < count && k < max; k++) memcpy(pairs[k], found->list[k], sizeof *pairs);
    return count;
}

int self_contact_crossings(const SelfContactDef *def, const double *x, int (*pairs)[2], int max)
{
    Neighbours *n = neighbours_create(def);
    int count = crossings_find(n, x, pairs, max);
    neighbours_destroy(n);
    return count;
}
