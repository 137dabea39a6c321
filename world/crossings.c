#include "world/crossings.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "world/neighbours.h"

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

static bool share_vertex(const int edge[2], const int face[3])
{
    bool shared = false;
    for (int i = 0; i < 6; i++) shared |= edge[i % 2] == face[i / 2];
    return shared;
}

static void note(int (*pairs)[2], int max, int *count, int a, int b)
{
    if (*count < max) pairs[*count][0] = a, pairs[*count][1] = b;
    (*count)++;
}

static int rod_crossings(const SelfContactDef *def, const double *x, int (*pairs)[2], int max)
{
    Neighbours *n = neighbours_create(def);
    PairList near = {0};
    int count = 0;
    neighbours_find(n, x, ROD_CROSSES * def->distance, &near);
    for (int k = near.points; k < near.count; k++)
        note(pairs, max, &count, near.pairs[k][0], near.pairs[k][1]);
    pair_list_clear(&near);
    neighbours_destroy(n);
    return count;
}

static Box box_around(const double *x, const int *vertices, int count)
{
    Box box = box_empty();
    for (int i = 0; i < count; i++) box_add(&box, x + 3 * vertices[i]);
    return box;
}

int self_contact_crossings(const SelfContactDef *def, const double *x, int (*pairs)[2], int max)
{
    x += def->first;
    if (def->face_count == 0) return rod_crossings(def, x, pairs, max);
    Box *boxes = mem_alloc((size_t)def->face_count, sizeof *boxes);
    for (int f = 0; f < def->face_count; f++) boxes[f] = box_around(x, def->faces[f], 3);
    NearTree *tree = near_tree_create(def->face_count, boxes);
    NearList found = {0};
    int count = 0;
    for (int e = 0; e < def->edge_count; e++) {
        Box own = box_around(x, def->edges[e], 2);
        near_tree_find(tree, &own, &found);
        for (int k = 0; k < found.count; k++) {
            const int *face = def->faces[found.list[k]];
            if (!share_vertex(def->edges[e], face) && passes_through(x, def->edges[e], face))
                note(pairs, max, &count, e, found.list[k]);
        }
    }
    mem_free(found.list);
    near_tree_destroy(tree);
    mem_free(boxes);
    return count;
}
