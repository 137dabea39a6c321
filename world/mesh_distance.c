#include "world/mesh_distance.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEAF = 4, STACK = 64 };

/* A box around faces; those of an inner one are those of its two children, which stand at `child` and behind it. */
typedef struct Node {
    double low[3], high[3];
    int child, first, count; /* child 0: a leaf */
} Node;

struct MeshDistance {
    const Mesh *mesh;
    Node *nodes;
    int node_count;
    int *order;                 /* [face] as leaves have them                                */
    Vec3 *face, *edge, *vertex; /* normals, of any length                                    */
};

static Vec3 corner(const Mesh *mesh, int face, int k)
{
    return vec3_load(mesh->rest[mesh->faces[face][k]]);
}

/* ---- The tree ---- */

typedef struct Place {
    double at;
    int face;
} Place;

static int by_place(const void *a, const void *b)
{
    const Place *p = a, *q = b;
    return p->at != q->at ? (p->at > q->at) - (p->at < q->at) : p->face - q->face;
}

static void put_box(const MeshDistance *d, Node *node)
{
    for (int i = 0; i < 3; i++) node->low[i] = INFINITY, node->high[i] = -INFINITY;
    for (int k = 0; k < 3 * node->count; k++) {
        const double *x = d->mesh->rest[d->mesh->faces[d->order[node->first + k / 3]][k % 3]];
        for (int i = 0; i < 3; i++) {
            node->low[i] = fmin(node->low[i], x[i]);
            node->high[i] = fmax(node->high[i], x[i]);
        }
    }
}

/* Its faces in the order of their middles along its longest side. */
static void sort_faces(MeshDistance *d, const Node *node, Place *work)
{
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (node->high[i] - node->low[i] > node->high[axis] - node->low[axis]) axis = i;
    for (int k = 0; k < node->count; k++) {
        int face = d->order[node->first + k];
        work[k] = (Place){0, face};
        for (int c = 0; c < 3; c++) work[k].at += d->mesh->rest[d->mesh->faces[face][c]][axis];
    }
    qsort(work, (size_t)node->count, sizeof *work, by_place);
    for (int k = 0; k < node->count; k++) d->order[node->first + k] = work[k].face;
}

static void make_tree(MeshDistance *d)
{
    int faces = d->mesh->face_count;
    Place *work = mem_alloc((size_t)faces, sizeof *work);
    d->order = mem_alloc((size_t)faces, sizeof *d->order);
    for (int f = 0; f < faces; f++) d->order[f] = f;
    d->nodes = mem_alloc(2 * (size_t)faces, sizeof *d->nodes);
    d->nodes[0].count = faces;
    d->node_count = 1;
    for (int k = 0; k < d->node_count; k++) {
        Node *node = &d->nodes[k];
        put_box(d, node);
        if (node->count <= LEAF) continue;
        sort_faces(d, node, work);
        int half = node->count / 2;
        node->child = d->node_count;
        d->nodes[d->node_count++] = (Node){.first = node->first, .count = half};
        d->nodes[d->node_count++] = (Node){.first = node->first + half, .count = node->count - half};
    }
    mem_free(work);
}

/* ---- Normals ---- */

static void add(Vec3 *sum, double weight, Vec3 v)
{
    *sum = vec3_axpy(weight, v, *sum);
}

static double angle_at(const Mesh *mesh, int face, int k)
{
    Vec3 x = corner(mesh, face, k), a = vec3_sub(corner(mesh, face, (k + 1) % 3), x),
         b = vec3_sub(corner(mesh, face, (k + 2) % 3), x);
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b));
}

static void make_normals(MeshDistance *d)
{
    const Mesh *mesh = d->mesh;
    d->face = mem_alloc((size_t)mesh->face_count, sizeof *d->face);
    d->edge = mem_alloc((size_t)mesh->edge_count, sizeof *d->edge);
    d->vertex = mem_alloc((size_t)mesh->vertex_count, sizeof *d->vertex);
    for (int f = 0; f < mesh->face_count; f++) {
        Vec3 x = corner(mesh, f, 0);
        d->face[f] = vec3_unit(vec3_cross(vec3_sub(corner(mesh, f, 1), x), vec3_sub(corner(mesh, f, 2), x)));
        for (int k = 0; k < 3; k++) {
            add(&d->edge[mesh->face_edges[f][k]], 1, d->face[f]);
            add(&d->vertex[mesh->faces[f][k]], angle_at(mesh, f, k), d->face[f]);
        }
    }
}

MeshDistance *mesh_distance_create(const Mesh *mesh)
{
    MeshDistance *d = mem_alloc(1, sizeof *d);
    d->mesh = mesh;
    make_tree(d);
    make_normals(d);
    return d;
}

void mesh_distance_destroy(MeshDistance *d)
{
    mem_free(d->nodes);
    mem_free(d->order);
    mem_free(d->face);
    mem_free(d->edge);
    mem_free(d->vertex);
    mem_free(d);
}

/* ---- The nearest point ---- */

/* A point of a face, on its corner k (k), the edge opposite to it (3 + k), or within (6). */
typedef struct Nearest {
    Vec3 point;
    int part;
} Nearest;

static Nearest on_edge(Vec3 a, Vec3 ab, double t, int part)
{
    return (Nearest){vec3_axpy(t, ab, a), part};
}

/* Of a triangle [Ericson 2005, 5.1.5]. */
static Nearest nearest_of(const Mesh *mesh, int face, Vec3 p)
{
    Vec3 a = corner(mesh, face, 0), b = corner(mesh, face, 1), c = corner(mesh, face, 2);
    Vec3 ab = vec3_sub(b, a), ac = vec3_sub(c, a), ap = vec3_sub(p, a), bp = vec3_sub(p, b),
         cp = vec3_sub(p, c);
    double d1 = vec3_dot(ab, ap), d2 = vec3_dot(ac, ap), d3 = vec3_dot(ab, bp), d4 = vec3_dot(ac, bp),
           d5 = vec3_dot(ab, cp), d6 = vec3_dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return (Nearest){a, 0};
    if (d3 >= 0 && d4 <= d3) return (Nearest){b, 1};
    if (d6 >= 0 && d5 <= d6) return (Nearest){c, 2};
    double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return on_edge(a, ab, d1 / (d1 - d3), 5);
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return on_edge(a, ac, d2 / (d2 - d6), 4);
    if (va <= 0 && d4 >= d3 && d5 >= d6)
        return on_edge(b, vec3_sub(c, b), (d4 - d3) / ((d4 - d3) + (d5 - d6)), 3);
    double all = va + vb + vc;
    return (Nearest){vec3_axpy(vb / all, ab, vec3_axpy(vc / all, ac, a)), 6};
}

static double box_distance2(const Node *node, const double x[3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double out = fmax(0, fmax(node->low[i] - x[i], x[i] - node->high[i]));
        sum += out * out;
    }
    return sum;
}

static double side_of(const MeshDistance *d, int face, Nearest nearest, Vec3 x)
{
    Vec3 normal = d->face[face];
    if (nearest.part < 3)
        normal = d->vertex[d->mesh->faces[face][nearest.part]];
    else if (nearest.part < 6)
        normal = d->edge[d->mesh->face_edges[face][nearest.part - 3]];
    return vec3_dot(vec3_sub(x, nearest.point), normal) < 0 ? -1 : 1;
}

/* The best so far of a search. */
typedef struct Best {
    double distance2;
    int face;
    Nearest nearest;
} Best;

static void try_face(const MeshDistance *d, int face, Vec3 x, Best *best)
{
    Nearest found = nearest_of(d->mesh, face, x);
    Vec3 away = vec3_sub(x, found.point);
    double distance2 = vec3_dot(away, away);
    if (distance2 < best->distance2) *best = (Best){distance2, face, found};
}

double mesh_distance_at(const MeshDistance *d, const double x[3], int *face)
{
    Vec3 at = vec3_load(x);
    Best best = {.distance2 = INFINITY};
    int stack[STACK] = {0}, depth = 1;
    if (*face >= 0) try_face(d, *face, at, &best);
    while (depth) {
        const Node *node = &d->nodes[stack[--depth]];
        if (box_distance2(node, x) >= best.distance2) continue;
        for (int k = 0; !node->child && k < node->count; k++)
            try_face(d, d->order[node->first + k], at, &best);
        if (!node->child) continue;
        const Node *child = d->nodes + node->child;
        bool swap = box_distance2(child, x) < box_distance2(child + 1, x);
        stack[depth++] = node->child + swap; /* the nearer one comes first */
        stack[depth++] = node->child + !swap;
    }
    *face = best.face;
    return sqrt(best.distance2) * side_of(d, best.face, best.nearest, at);
}
