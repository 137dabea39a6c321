#include "world/neighbours.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <math.h>
#include <string.h>

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

/* All but `within` of them have one. */
static void divide_by_mean(int count, int within, double *values)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += values[i];
    for (int i = 0; i < count; i++) values[i] *= (count - within) / sum;
}

/* How many. */
static int find_within(Neighbours *n)
{
    const SelfContactDef *def = &n->def;
    int count = 0;
    for (int v = 0; v < def->vertex_count; v++) n->within[v] = def->face_count > 0;
    for (int i = 0; i < 3 * def->face_count; i++) n->within[def->faces[i / 3][i % 3]] = false;
    for (int v = 0; v < def->vertex_count; v++) count += n->within[v];
    return count;
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
    divide_by_mean(def->vertex_count, find_within(n), n->vertex_weight);
    for (int e = 0; e < def->edge_count; e++) {
        const int *ends = def->edges[e];
        Vec3 way = vec3_sub(vec3_load(def->rest[ends[1]]), vec3_load(def->rest[ends[0]]));
        n->edge_square[e] = vec3_dot(way, way);
        n->edge_weight[e] = (n->vertex_weight[ends[0]] + n->vertex_weight[ends[1]]) / 2;
    }
    divide_by_mean(def->edge_count, 0, n->edge_weight);
}

Box neighbours_box(const int *vertices, int count, const double *from, const double *to, double grow)
{
    Box box = box_empty();
    double longest = 0;
    for (int i = 0; i < count; i++) {
        const double *x = from + 3 * (long)vertices[i], *y = to + 3 * (long)vertices[i];
        box_add(&box, x);
        if (to == from) continue;
        box_add(&box, y);
        Vec3 way = vec3_sub(vec3_load(y), vec3_load(x));
        longest = vec3_dot(way, way) > longest ? vec3_dot(way, way) : longest;
    }
    double by = grow * sqrt(longest);
    for (int i = 0; i < 3; i++) box.low[i] -= by, box.high[i] += by;
    return box;
}

static void fit_boxes(Neighbours *n, const double *from, const double *to, double grow)
{
    for (int v = 0; v < n->def.vertex_count; v++) n->vertex_boxes[v] = neighbours_box(&v, 1, from, to, grow);
    for (int f = 0; f < n->face_count; f++) n->face_boxes[f] = neighbours_box(n->faces[f], 3, from, to, grow);
    for (int e = 0; e < n->def.edge_count; e++)
        n->edge_boxes[e] = neighbours_box(n->def.edges[e], 2, from, to, grow);
}

static void make_trees(Neighbours *n)
{
    const double *rest = n->def.rest[0];
    n->vertex_boxes = mem_alloc((size_t)n->def.vertex_count, sizeof *n->vertex_boxes);
    n->face_boxes = mem_alloc((size_t)n->face_count, sizeof *n->face_boxes);
    n->edge_boxes = mem_alloc((size_t)n->def.edge_count, sizeof *n->edge_boxes);
    fit_boxes(n, rest, rest, 0);
    n->vertex_tree = near_tree_create(n->def.vertex_count, n->vertex_boxes);
    n->face_tree = near_tree_create(n->face_count, n->face_boxes);
    n->edge_tree = near_tree_create(n->def.edge_count, n->edge_boxes);
}

/* Of so many features with so many vertices each. */
static Seat *seats_of(const SelfContactDef *def, int count, const int *vertices, int each)
{
    Seat *seats = mem_alloc((size_t)count, sizeof *seats);
    for (int k = 0; k < count; k++) {
        const int *own = vertices ? vertices + (long)each * k : &k;
        seats[k].part = def->part ? def->part[own[0]] : 0;
        for (int i = 0; i < 3 * each; i++) seats[k].centre[i % 3] += def->rest[own[i / 3]][i % 3] / each;
    }
    return seats;
}

Neighbours *neighbours_create(const SelfContactDef *def)
{
    Neighbours *n = mem_alloc(1, sizeof *n);
    n->def = *def;
    n->def.margin = def->distance * (def->margin > 0 ? def->margin : 0.25);
    copy_faces(n);
    n->vertex_weight = mem_alloc((size_t)def->vertex_count, sizeof(double));
    n->edge_weight = mem_alloc((size_t)def->edge_count, sizeof(double));
    n->edge_square = mem_alloc((size_t)def->edge_count, sizeof(double));
    n->within = mem_alloc((size_t)def->vertex_count, sizeof *n->within);
    weigh(n);
    n->vertex_seat = seats_of(def, def->vertex_count, NULL, 1);
    n->face_seat = seats_of(def, n->face_count, n->face_count ? n->faces[0] : NULL, 3);
    n->edge_seat = seats_of(def, def->edge_count, def->edge_count ? def->edges[0] : NULL, 2);
    make_trees(n);
    return n;
}

void neighbours_destroy(Neighbours *n)
{
    if (!n) return;
    near_tree_destroy(n->vertex_tree);
    near_tree_destroy(n->face_tree);
    near_tree_destroy(n->edge_tree);
    mem_free(n->faces);
    mem_free(n->vertex_weight);
    mem_free(n->within);
    mem_free(n->edge_weight);
    mem_free(n->edge_square);
    mem_free(n->vertex_seat);
    mem_free(n->face_seat);
    mem_free(n->edge_seat);
    mem_free(n->vertex_boxes);
    mem_free(n->face_boxes);
    mem_free(n->edge_boxes);
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

/* Are two of their vertices nearer than that? */
static bool vertices_are_near(const double x[DISTANCE_DOFS], int second, double distance)
{
    bool near = false;
    for (int i = 0; i < second; i++)
        for (int j = second; j < 4; j++) {
            Vec3 d = vec3_sub(vec3_load(x + 3 * i), vec3_load(x + 3 * j));
            near |= vec3_dot(d, d) < distance * distance;
        }
    return near;
}

double neighbours_range(const Neighbours *n, const int pair[2], bool edges)
{
    const SelfContactDef *def = &n->def;
    if (!def->vertex_outside) return def->distance;
    return edges ? def->edge_outside[pair[0]] + def->edge_outside[pair[1]]
                 : def->vertex_outside[pair[0]] + def->face_outside[pair[1]];
}

/* Pairs of one piece nearer at rest than `least`, 1.6 D, are left out. Of most of them the middles are: that is soon found. */
static bool sits_near(double least, const Seat *a, const Seat *b)
{
    Vec3 d = vec3_sub(vec3_load(a->centre), vec3_load(b->centre));
    return a->part == b->part && vec3_dot(d, d) < least * least;
}

static bool is_near_at_rest(const Neighbours *n, const int vertices[4], bool edges, double least)
{
    const SelfContactDef *def = &n->def;
    double x[DISTANCE_DOFS];
    if (def->part && def->part[vertices[0]] != def->part[vertices[2]]) return false;
    neighbours_gather(vertices, def->rest[0], x);
    return vertices_are_near(x, edges ? 2 : 1, least) ||
           distance_between(def, edges)(x).square < least * least;
}

static bool may_meet(const Neighbours *n, const int vertices[4], bool edges, double least)
{
    int second = edges ? 2 : 1;
    for (int i = 0; i < second; i++)
        for (int j = second; j < 4; j++)
            if (vertices[i] == vertices[j]) return false;
    return !is_held(&n->def, vertices) && !is_near_at_rest(n, vertices, edges, least);
}

/* ---- Who is near ---- */

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

/* What may be wanted of a pair beside that it may meet: nearer than the radius at x; NULL: that its boxes are. */
typedef struct Wanted {
    double radius;
    const double *x;
} Wanted;

static bool is_near(const Neighbours *n, const int vertices[4], bool edges, Wanted wanted)
{
    double x[DISTANCE_DOFS];
    if (!wanted.x) return true;
    neighbours_gather(vertices, wanted.x, x);
    return distance_between(&n->def, edges)(x).square < wanted.radius * wanted.radius;
}

/* Of what was found, those that may meet and are near, sorted. */
static void take(const Neighbours *n, bool edges, Wanted wanted, PairList *list)
{
    const Box *a = edges ? n->edge_boxes : n->vertex_boxes, *b = edges ? n->edge_boxes : n->face_boxes;
    const Seat *s = edges ? n->edge_seat : n->vertex_seat, *t = edges ? n->edge_seat : n->face_seat;
    int first = list->count, vertices[4];
    for (int k = 0; k < n->found.count; k++) {
        const int *pair = n->found.list[k];
        if (!edges && n->within[pair[0]]) continue;
        double least = SELF_CONTACT_REST * neighbours_range(n, pair, edges);
        if (sits_near(least, &s[pair[0]], &t[pair[1]])) continue;
        if (box_gap_square(&a[pair[0]], &b[pair[1]]) > wanted.radius * wanted.radius) continue;
        pair_vertices(n, pair, edges, vertices);
        if (may_meet(n, vertices, edges, least) && is_near(n, vertices, edges, wanted))
            add_pair(list, pair[0], pair[1]);
    }
    if (list->count > first) near_pairs_sort(list->pairs + first, list->count - first);
}

static void find(Neighbours *n, Wanted wanted, PairList *list)
{
    near_tree_fit(n->vertex_tree, n->vertex_boxes);
    near_tree_fit(n->face_tree, n->face_boxes);
    near_tree_fit(n->edge_tree, n->edge_boxes);
    list->count = 0;
    near_tree_pairs(n->vertex_tree, n->face_tree, wanted.radius, &n->found);
    take(n, false, wanted, list);
    list->points = list->count;
    near_tree_pairs(n->edge_tree, n->edge_tree, wanted.radius, &n->found);
    take(n, true, wanted, list);
}

void neighbours_sweep(Neighbours *n, const double *from, const double *to, double grow, PairList *list)
{
    fit_boxes(n, from, to, grow);
    find(n, (Wanted){0, NULL}, list);
}

void neighbours_find(Neighbours *n, const double *x, double radius, PairList *list)
{
    fit_boxes(n, x, x, 0);
    find(n, (Wanted){radius, x}, list);
}

NearPairs *neighbours_edges_and_faces(Neighbours *n, const double *x)
{
    fit_boxes(n, x, x, 0);
    near_tree_fit(n->face_tree, n->face_boxes);
    near_tree_fit(n->edge_tree, n->edge_boxes);
    near_tree_pairs(n->edge_tree, n->face_tree, 0, &n->found);
    return &n->found;
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
