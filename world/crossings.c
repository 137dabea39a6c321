#include "world/crossings.h"
#include "base/vec3.h"
#include <string.h>

static const double ROD_CROSSES = 0.1; /* of D */
static const double IN_PLANE = 1e-14;  /* of a place's size: such a height above a plane may be rounding */

/* Six times the volume of a tetrahedron. */
static double volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d)
{
    return vec3_dot(vec3_sub(d, a), vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
}

/* On which side of the face's plane is it? 0: in it, which in a flat sheet all others are. */
static int side_of(const Vec3 face[3], Vec3 p)
{
    Vec3 a = vec3_sub(face[1], face[0]), b = vec3_sub(face[2], face[0]), d = vec3_sub(p, face[0]);
    double v = volume(face[0], face[1], face[2], p),
           rounding = IN_PLANE * vec3_length(a) * vec3_length(b) * (vec3_length(d) + vec3_length(p));
    return (v > rounding) - (v < -rounding);
}

/* Its ends are on either side of the plane, and all corners are on one side of it as seen along the edge. */
static bool passes_through(const double *x, const int edge[2], const int face[3])
{
    Vec3 p = vec3_load(x + 3 * edge[0]), q = vec3_load(x + 3 * edge[1]), t[3];
    for (int i = 0; i < 3; i++) t[i] = vec3_load(x + 3 * face[i]);
    if (side_of(t, p) * side_of(t, q) >= 0) return false;
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
    int count = 0;
    for (int k = near.points; k < near.count; k++) {
        double reach = ROD_CROSSES * neighbours_range(n, near.pairs[k], true), own[DISTANCE_DOFS];
        int vertices[4];
        neighbours_vertices(n, &near, k, vertices);
        neighbours_gather(vertices, x, own);
        if (distance_edges(own).square >= reach * reach) continue;
        if (count < max) memcpy(pairs[count], near.pairs[k], sizeof *pairs);
        count++;
    }
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
