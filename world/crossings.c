#include "world/crossings.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "world/neighbours.h"
#include <float.h>
#include <string.h>

static const double ROD_CROSSES = 0.1; /* of D */

/* Six times the volume of a tetrahedron. */
static double volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d)
{
    return vec3_dot(vec3_sub(d, a), vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
}

/* What such a volume of these points may come to by the rounding of their coordinates alone: parts in one plane, as those of a
 * flat sheet, do not pass through each other. */
static double rounding(const Vec3 *at, int count)
{
    double largest = 0;
    Box box = box_empty();
    for (int i = 0; i < count; i++) {
        double x[3];
        vec3_store(x, at[i]);
        box_add(&box, x);
        for (int k = 0; k < 3; k++) largest = fmax(largest, fabs(x[k]));
    }
    double size = fmax(fmax(box.high[0] - box.low[0], box.high[1] - box.low[1]), box.high[2] - box.low[2]);
    return 16 * DBL_EPSILON * largest * size * size;
}

/* Its ends are on either side of the plane, and all corners are on one side of it as seen along the edge. */
static bool passes_through(const double *x, const int edge[2], const int face[3])
{
    Vec3 at[5];
    for (int i = 0; i < 5; i++) at[i] = vec3_load(x + 3 * (i < 3 ? face[i] : edge[i - 3]));
    const Vec3 *t = at, p = at[3], q = at[4];
    double above = volume(t[0], t[1], t[2], p), below = volume(t[0], t[1], t[2], q);
    if (!(above * below < 0) || fmin(fabs(above), fabs(below)) <= rounding(at, 5)) return false;
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

static int rod_crossings(const SelfContactDef *def, const double *x, int (*pairs)[2], int max)
{
    Neighbours *n = neighbours_create(def);
    PairList near = {0};
    neighbours_find(n, x, ROD_CROSSES * def->distance, &near);
    int count = near.count - near.points;
    for (int k = 0; k < count && k < max; k++) memcpy(pairs[k], near.pairs[near.points + k], sizeof *pairs);
    pair_list_clear(&near);
    neighbours_destroy(n);
    return count;
}

/* count features of so many vertices each. */
static NearTree *tree_of(const double *x, int count, const int *vertices, int each)
{
    Box *boxes = mem_alloc((size_t)count, sizeof *boxes);
    for (int k = 0; k < count; k++) {
        boxes[k] = box_empty();
        for (int i = 0; i < each; i++) box_add(&boxes[k], x + 3 * (long)vertices[k * each + i]);
    }
    NearTree *tree = near_tree_create(count, boxes);
    mem_free(boxes);
    return tree;
}

int self_contact_crossings(const SelfContactDef *def, const double *x, int (*pairs)[2], int max)
{
    x += def->first;
    if (def->face_count == 0) return rod_crossings(def, x, pairs, max);
    NearTree *edges = tree_of(x, def->edge_count, def->edges[0], 2),
             *faces = tree_of(x, def->face_count, def->faces[0], 3);
    NearPairs found = {0};
    int count = 0;
    near_tree_pairs(edges, faces, 0, &found);
    for (int k = 0; k < found.count; k++) {
        const int *pair = found.list[k], *edge = def->edges[pair[0]], *face = def->faces[pair[1]];
        if (!share_vertex(def, edge, face) && passes_through(x, edge, face))
            memcpy(found.list[count++], pair, sizeof *found.list);
    }
    near_pairs_sort(found.list, count);
    for (int k = 0; k < count && k < max; k++) memcpy(pairs[k], found.list[k], sizeof *pairs);
    mem_free(found.list);
    near_tree_destroy(edges);
    near_tree_destroy(faces);
    return count;
}
