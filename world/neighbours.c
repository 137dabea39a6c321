#include "world/neighbours.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <math.h>
#include <string.h>

static const double REST_NEAR =
    1.6; /* of D: more than a quarter of a circle around it (rod/self_contact.h) */

void pair_list_clear(PairList *list)
{
    mem_free(list->pairs);
    *list = (PairList){0};
}

static void add_pair(PairList *list, int a, int b)
{
    if (list->count == list->room) {
        int room = 2 * list->room + 64;
        list->pairs = mem_resize(list->pairs, (size_t)list->room, (size_t)room, sizeof *list->pairs);
        list->room = room;
    }
    list->pairs[list->count][0] = a, list->pairs[list->count][1] = b;
    list->count++;
}

/* ---- Making ---- */

static void copy_faces(Neighbours *n)
{
    const SelfContactDef *def = &n->def;
    n->face_count = def->face_count ? def->face_count : def->edge_count;
    n->faces = mem_alloc((size_t)n->face_count, sizeof *n->faces);
    for (int f = 0; f < n->face_count; f++)
        for (int i = 0; i < 3; i++)
            n->faces[f][i] = def->face_count ? def->faces[f][i] : def->edges[f][i > 0];
}

static void divide_by_mean(int count, double *values)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += values[i];
    for (int i = 0; i < count; i++) values[i] *= count / sum;
}

/* An edge as its ends do in the mean. */
static void weigh(Neighbours *n)
{
    const SelfContactDef *def = &n->def;
    for (int v = 0; v < def->vertex_count; v++) n->vertex_weight[v] = def->face_count ? 0 : 1;
    for (int f = 0; f < def->face_count; f++) {
        Vec3 a = vec3_load(def->rest[def->faces[f][0]]), b = vec3_load(def->rest[def->faces[f][1]]),
             c = vec3_load(def->rest[def->faces[f][2]]);
        double area = vec3_length(vec3_cross(vec3_sub(b, a), vec3_sub(c, a)));
        for (int i = 0; i < 3; i++) n->vertex_weight[def->faces[f][i]] += area;
    }
    divide_by_mean(def->vertex_count, n->vertex_weight);
    for (int e = 0; e < def->edge_count; e++) {
        const int *ends = def->edges[e];
        Vec3 way = vec3_sub(vec3_load(def->rest[ends[1]]), vec3_load(def->rest[ends[0]]));
        n->edge_square[e] = vec3_dot(way, way);
        n->edge_weight[e] = (n->vertex_weight[ends[0]] + n->vertex_weight[ends[1]]) / 2;
    }
    divide_by_mean(def->edge_count, n->edge_weight);
}

/* Of what its vertices sweep. */
static Box box_of(const int *vertices, int count, const double *from, const double *to)
{
    Box box = box_empty();
    for (int i = 0; i < count; i++) {
        box_add(&box, from + 3 * vertices[i]);
        if (to != from) box_add(&box, to + 3 * vertices[i]);
    }
    return box;
}

static const Box *face_boxes(Neighbours *n, const double *from, const double *to)
{
    for (int f = 0; f < n->face_count; f++) n->boxes[f] = box_of(n->faces[f], 3, from, to);
    return n->boxes;
}

static const Box *edge_boxes(Neighbours *n, const double *from, const double *to)
{
    for (int e = 0; e < n->def.edge_count; e++) n->boxes[e] = box_of(n->def.edges[e], 2, from, to);
    return n->boxes;
}

Neighbours *neighbours_create(const SelfContactDef *def)
{
    Neighbours *n = mem_alloc(1, sizeof *n);
    n->def = *def;
    n->def.margin = def->distance * (def->margin > 0 ? def->margin : 0.5);
    copy_faces(n);
    int most = n->face_count > def->edge_count ? n->face_count : def->edge_count;
    n->vertex_weight = mem_alloc((size_t)def->vertex_count, sizeof(double));
    n->edge_weight = mem_alloc((size_t)def->edge_count, sizeof(double));
    n->edge_square = mem_alloc((size_t)def->edge_count, sizeof(double));
    n->boxes = mem_alloc((size_t)most, sizeof *n->boxes);
    weigh(n);
    const double *rest = def->rest[0];
    n->face_tree = near_tree_create(n->face_count, face_boxes(n, rest, rest));
    n->edge_tree = near_tree_create(def->edge_count, edge_boxes(n, rest, rest));
    return n;
}

void neighbours_destroy(Neighbours *n)
{
    if (!n) return;
    near_tree_destroy(n->face_tree);
    near_tree_destroy(n->edge_tree);
    mem_free(n->faces);
    mem_free(n->vertex_weight);
    mem_free(n->edge_weight);
    mem_free(n->edge_square);
    mem_free(n->boxes);
    mem_free(n->found.list);
    mem_free(n);
}

/* ---- Who may meet ---- */

static bool is_held(const SelfContactDef *def, const int vertices[4])
{
    bool held = def->fixed != NULL;
    for (int i = 0; held && i < 12; i++) held = def->fixed[3 * vertices[i / 3] + i % 3];
    return held;
}

static DistanceOf *distance_between(const SelfContactDef *def, bool edges)
{
    return edges ? distance_edges : def->face_count ? distance_point_triangle : distance_point_edge;
}

/* Nearer at rest than 1.6 D: by two vertices, or else by any two points. */
static bool is_near_at_rest(const SelfContactDef *def, const int vertices[4], bool edges)
{
    double x[DISTANCE_DOFS], least = REST_NEAR * def->distance;
    int second = edges ? 2 : 1;
    neighbours_gather(vertices, def->rest[0], x);
    for (int i = 0; i < second; i++)
        for (int j = second; j < 4; j++) {
            Vec3 d = vec3_sub(vec3_load(x + 3 * i), vec3_load(x + 3 * j));
            if (vec3_dot(d, d) < least * least) return true;
        }
    return distance_between(def, edges)(x).square < least * least;
}

static bool may_meet(const SelfContactDef *def, const int vertices[4], bool edges)
{
    int second = edges ? 2 : 1;
    for (int i = 0; i < second; i++)
        for (int j = second; j < 4; j++)
            if (vertices[i] == vertices[j]) return false;
    if (is_held(def, vertices)) return false;
    bool one = !def->part || def->part[vertices[0]] == def->part[vertices[2]];
    return !one || !is_near_at_rest(def, vertices, edges);
}

/* ---- Who is near ---- */

static Box inflated(Box box, double by)
{
    for (int i = 0; i < 3; i++) box.low[i] -= by, box.high[i] += by;
    return box;
}

static void pair_vertices(const Neighbours *n, const int pair[2], bool edges, int vertices[4])
{
    if (edges) {
        memcpy(vertices, n->def.edges[pair[0]], 2 * sizeof *vertices);
        memcpy(vertices + 2, n->def.edges[pair[1]], 2 * sizeof *vertices);
    } else {
        vertices[0] = pair[0];
        memcpy(vertices + 1, n->faces[pair[1]], 3 * sizeof *vertices);
    }
}

/* Of what was found, those that may meet a's box. */
static void take(Neighbours *n, int a, const Box *own, double radius, bool edges, PairList *list)
{
    for (int i = 0; i < n->found.count; i++) {
        int vertices[4], b = n->found.list[i];
        if ((edges && b <= a) || box_gap_square(own, &n->boxes[b]) > radius * radius) continue;
        pair_vertices(n, (int[]){a, b}, edges, vertices);
        if (may_meet(&n->def, vertices, edges)) add_pair(list, a, b);
    }
}

void neighbours_sweep(Neighbours *n, const double *from, const double *to, double radius, PairList *list)
{
    list->count = list->points = 0;
    near_tree_fit(n->face_tree, face_boxes(n, from, to));
    for (int v = 0; v < n->def.vertex_count; v++) {
        Box own = box_of(&v, 1, from, to), wide = inflated(own, radius);
        near_tree_find(n->face_tree, &wide, &n->found);
        take(n, v, &own, radius, false, list);
    }
    list->points = list->count;
    near_tree_fit(n->edge_tree, edge_boxes(n, from, to));
    for (int e = 0; e < n->def.edge_count; e++) {
        Box wide = inflated(n->boxes[e], radius);
        near_tree_find(n->edge_tree, &wide, &n->found);
        take(n, e, &n->boxes[e], radius, true, list);
    }
}

void neighbours_find(Neighbours *n, const double *x, double radius, PairList *list)
{
    int count = 0, points = 0;
    neighbours_sweep(n, x, x, radius, list);
    for (int k = 0; k < list->count; k++) {
        int vertices[4];
        double own[DISTANCE_DOFS];
        neighbours_vertices(n, list, k, vertices);
        neighbours_gather(vertices, x, own);
        if (!(neighbours_distance(n, list, k)(own).square < radius * radius)) continue;
        points += k < list->points;
        memcpy(list->pairs[count++], list->pairs[k], sizeof *list->pairs);
    }
    list->count = count, list->points = points;
}

void neighbours_vertices(const Neighbours *n, const PairList *list, int k, int vertices[4])
{
    pair_vertices(n, list->pairs[k], k >= list->points, vertices);
}

void neighbours_gather(const int vertices[4], const double *x, double to[DISTANCE_DOFS])
{
    for (int i = 0; i < 4; i++) memcpy(to + 3 * i, x + 3 * (long)vertices[i], 3 * sizeof *to);
}

DistanceOf *neighbours_distance(const Neighbours *n, const PairList *list, int k)
{
    return distance_between(&n->def, k >= list->points);
}

double neighbours_moved(const Neighbours *n, const double *x, const double *y)
{
    double mean[3] = {0}, largest = 0;
    int count = n->def.vertex_count;
    for (int i = 0; i < 3 * count; i++) mean[i % 3] += (x[i] - y[i]) / count;
    for (int v = 0; v < count; v++) {
        double square = 0;
        for (int i = 0; i < 3; i++) {
            double d = x[3 * v + i] - y[3 * v + i] - mean[i];
            square += d * d;
        }
        if (!(square <= largest)) largest = square;
        if (!isfinite(square)) return NAN;
    }
    return sqrt(largest);
}
