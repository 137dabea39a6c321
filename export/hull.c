#include "export/hull.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double LEAST_COSINE = 0.5; /* of a point's way off the surface */

static void add_face(Part *part, int a, int b, int c)
{
    size_t count = (size_t)part->face_count++;
    if ((count & (count - 1)) == 0)
        part->faces = mem_resize(part->faces, count, 2 * count + 1, sizeof *part->faces);
    memcpy(part->faces[count], (int[]){a, b, c}, sizeof *part->faces);
}

static int add_point(Part *part, Vec3 x)
{
    size_t count = (size_t)part->point_count++;
    if ((count & (count - 1)) == 0)
        part->points = mem_resize(part->points, count, 2 * count + 1, sizeof *part->points);
    vec3_store(part->points[count], x);
    return (int)count;
}

/* By the divergence theorem. */
static double volume_of(const Part *part)
{
    double sum = 0;
    Vec3 origin = part->point_count ? vec3_load(part->points[0]) : vec3(0, 0, 0);
    for (int f = 0; f < part->face_count; f++) {
        Vec3 x[3];
        for (int i = 0; i < 3; i++) x[i] = vec3_sub(vec3_load(part->points[part->faces[f][i]]), origin);
        sum += vec3_dot(x[0], vec3_cross(x[1], x[2])) / 6;
    }
    return sum;
}

/* ---- Sides: edges of faces, faces of tetrahedra ---- */

/* The side of an element that its k-th corner is not on, by its vertices in order. */
typedef struct Side {
    int key[3], element, k;
} Side;

static int compare(const void *a, const void *b)
{
    const Side *p = a, *q = b;
    for (int i = 0; i < 3; i++)
        if (p->key[i] != q->key[i]) return p->key[i] < q->key[i] ? -1 : 1;
    return p->element < q->element ? -1 : p->element > q->element;
}

static void order(int key[3])
{
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < 2; i++)
            if (key[i] > key[i + 1]) {
                int other = key[i];
                key[i] = key[i + 1], key[i + 1] = other;
            }
}

/* [count * corners], those of the same vertices beside each other; elements have `nodes` vertices, the corners first. */
static Side *find_sides(const int *elements, int count, int nodes, int corners)
{
    Side *sides = mem_alloc((size_t)count * (size_t)corners, sizeof *sides), *side = sides;
    for (int e = 0; e < count; e++)
        for (int k = 0; k < corners; k++, side++) {
            *side = (Side){.element = e, .k = k};
            for (int i = 1; i < corners; i++) side->key[3 - i] = elements[e * nodes + (k + i) % corners];
            if (corners == 3) side->key[0] = -1;
            order(side->key);
        }
    qsort(sides, (size_t)count * (size_t)corners, sizeof *sides, compare);
    return sides;
}

static bool same_side(const Side *a, const Side *b)
{
    return !memcmp(a->key, b->key, sizeof a->key);
}

/* Has another element of its part the side, too? They stand beside each other. */
static bool is_shared(const Side *sides, int count, int s, const int *part)
{
    for (int other = s - 1; other <= s + 1; other += 2)
        if (other >= 0 && other < count && same_side(&sides[s], &sides[other]) &&
            part[sides[other].element] == part[sides[s].element])
            return true;
    return false;
}

/* ---- Shells ---- */

/* Corners of faces that are one point: sets of [3 * face + corner]. */
static int root_of(int *parent, int corner)
{
    while (parent[corner] != corner) corner = parent[corner] = parent[parent[corner]];
    return corner;
}

static int corner_at(const MeshFile *mesh, int face, int vertex)
{
    for (int i = 0; i < 3; i++)
        if (mesh->faces[face][i] == vertex) return 3 * face + i;
    return 3 * face;
}

/* Across the edges that two faces share, of one part where `part` is given. */
static int *join_corners(const MeshFile *mesh, const Side *sides, const int *part)
{
    int corners = 3 * mesh->face_count, *parent = mem_alloc((size_t)corners, sizeof *parent);
    for (int c = 0; c < corners; c++) parent[c] = c;
    for (int s = 0; s + 1 < corners; s++) {
        int f = sides[s].element, g = sides[s + 1].element;
        if (!same_side(&sides[s], &sides[s + 1]) || (part && part[f] != part[g])) continue;
        for (int i = 1; i < 3; i++) {
            int a = root_of(parent, corner_at(mesh, f, sides[s].key[i])),
                b = root_of(parent, corner_at(mesh, g, sides[s].key[i]));
            parent[a > b ? a : b] = a > b ? b : a;
        }
    }
    for (int c = 0; c < corners; c++) parent[c] = root_of(parent, c);
    return parent;
}

static Vec3 corner_edge(const MeshFile *mesh, int f, int i, int step)
{
    const int *v = mesh->faces[f];
    return vec3_sub(vec3_load(mesh->vertices[v[(i + step) % 3]]), vec3_load(mesh->vertices[v[i]]));
}

/* What the faces around a point say of it. */
typedef struct Around {
    Vec3 normal; /* times angles, summed */
    double angle, cosine, area, volume;
} Around;

/* From the surface to the upper side, [3 * face + corner] of which the first of a set is filled in. */
static Vec3 *find_ways(const MeshFile *mesh, const double *thickness, const int *parent)
{
    size_t corners = 3 * (size_t)mesh->face_count;
    Around *around = mem_alloc(corners, sizeof *around);
    Vec3 *ways = mem_alloc(corners, sizeof *ways);
    for (int pass = 0; pass < 2; pass++)
        for (size_t c = 0; c < corners; c++) {
            int f = (int)(c / 3), i = (int)(c % 3);
            Around *at = &around[parent[c]];
            Vec3 e1 = corner_edge(mesh, f, i, 1), e2 = corner_edge(mesh, f, i, 2), n = vec3_cross(e1, e2);
            double area = vec3_length(n), angle = atan2(area, vec3_dot(e1, e2));
            if (!(area > 0)) continue;
            if (pass) {
                at->cosine += angle * vec3_dot(vec3_unit(at->normal), vec3_unit(n));
            } else {
                at->normal = vec3_axpy(angle, vec3_unit(n), at->normal);
                at->angle += angle, at->area += area, at->volume += area * thickness[f];
            }
        }
    for (size_t c = 0; c < corners; c++) {
        const Around *at = &around[c];
        if (!(at->area > 0)) continue;
        double cosine = fmax(at->cosine / at->angle, LEAST_COSINE);
        ways[c] = vec3_scale(at->volume / at->area / 2 / cosine, vec3_unit(at->normal));
    }
    mem_free(around);
    return ways;
}

/* A wall from the lower side up, along an edge of the face that runs from corner i to the next one. */
static void add_wall(Part *part, const int *upper, const int *lower, int a, int b)
{
    add_face(part, lower[a], lower[b], upper[b]);
    add_face(part, lower[a], upper[b], upper[a]);
}

static void make_shells(const MeshFile *mesh, const double *thickness, const int *part, Parts *parts)
{
    int corners = 3 * mesh->face_count;
    Side *sides = find_sides(mesh->faces[0], mesh->face_count, 3, 3);
    int *whole = join_corners(mesh, sides, NULL), *own = join_corners(mesh, sides, part);
    Vec3 *ways = find_ways(mesh, thickness, whole);
    int *upper = mem_alloc((size_t)corners, sizeof *upper),
        *lower = mem_alloc((size_t)corners, sizeof *lower);
    for (int c = 0; c < corners; c++) { /* the first of a set comes first */
        Part *in = &parts->list[part[c / 3]];
        Vec3 x = vec3_load(mesh->vertices[mesh->faces[c / 3][c % 3]]), way = ways[whole[c]];
        upper[c] = own[c] == c ? add_point(in, vec3_add(x, way)) : upper[own[c]];
        lower[c] = own[c] == c ? add_point(in, vec3_sub(x, way)) : lower[own[c]];
    }
    for (int c = 0; c < corners; c += 3) {
        add_face(&parts->list[part[c / 3]], upper[c], upper[c + 1], upper[c + 2]);
        add_face(&parts->list[part[c / 3]], lower[c], lower[c + 2], lower[c + 1]);
    }
    for (int s = 0; s < corners; s++) {
        int f = sides[s].element, a = 3 * f + (sides[s].k + 1) % 3, b = 3 * f + (sides[s].k + 2) % 3;
        if (!is_shared(sides, corners, s, part)) add_wall(&parts->list[part[f]], upper, lower, a, b);
    }
    mem_free(sides);
    mem_free(whole);
    mem_free(own);
    mem_free(ways);
    mem_free(upper);
    mem_free(lower);
}

/* ---- Solids ---- */

/* Of the side opposite to each corner, outwards; and where the middles between these three are. */
static const int opposite[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

static int middle_of(int a, int b)
{
    static const int nodes[4][4] = {{-1, 4, 6, 7}, {4, -1, 5, 9}, {6, 5, -1, 8}, {7, 9, 8, -1}};
    return nodes[a][b];
}

/* A point of the part for a vertex; `of` is its table, 0: none yet. */
static int point_of(const MeshFile *mesh, Part *part, int *of, int vertex)
{
    if (!of[vertex]) of[vertex] = 1 + add_point(part, vec3_load(mesh->vertices[vertex]));
    return of[vertex] - 1;
}

static void add_side(const MeshFile *mesh, const Side *side, Part *part, int *of)
{
    const int *nodes = mesh->cells + side->element * mesh->cell_nodes, *k = opposite[side->k];
    int p[3], m[3];
    for (int i = 0; i < 3; i++) p[i] = point_of(mesh, part, of, nodes[k[i]]);
    if (mesh->cell_nodes == 4) {
        add_face(part, p[0], p[1], p[2]);
        return;
    }
    for (int i = 0; i < 3; i++) m[i] = point_of(mesh, part, of, nodes[middle_of(k[i], k[(i + 1) % 3])]);
    for (int i = 0; i < 3; i++) add_face(part, p[i], m[i], m[(i + 2) % 3]);
    add_face(part, m[0], m[1], m[2]);
}

static void make_solids(const MeshFile *mesh, const int *part, Parts *parts)
{
    int count = 4 * mesh->cell_count;
    Side *sides = find_sides(mesh->cells, mesh->cell_count, mesh->cell_nodes, 4);
    int *of = mem_alloc((size_t)mesh->vertex_count, sizeof *of);
    for (int p = 0; p < parts->count; p++) {
        memset(of, 0, (size_t)mesh->vertex_count * sizeof *of);
        for (int s = 0; s < count; s++)
            if (part[sides[s].element] == p && !is_shared(sides, count, s, part))
                add_side(mesh, &sides[s], &parts->list[p], of);
    }
    mem_free(sides);
    mem_free(of);
}

void hull_make(const MeshFile *mesh, const double *thickness, const int *part, Parts *parts)
{
    if (mesh->cell_count)
        make_solids(mesh, part, parts);
    else
        make_shells(mesh, thickness, part, parts);
    for (int p = 0; p < parts->count; p++) parts->list[p].volume = volume_of(&parts->list[p]);
}
