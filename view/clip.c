#include "view/clip.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <string.h>

bool clip_is_given(const ClipPlane *plane)
{
    return vec3_length(vec3_load(plane->normal)) > 0;
}

/* The work: which vertices are kept, and what has been made of them so far. */
typedef struct Cutter {
    const ClipBody *body;
    double *beyond; /* [vertex] m beyond the plane; below 0: kept     */
    int *point_of;  /* [vertex] 1 + the point that it is; 0: none yet */
    Clip clip;
    size_t point_room, face_room;
} Cutter;

static int add_point(Cutter *cutter, int from, int to, double part)
{
    Clip *clip = &cutter->clip;
    if ((size_t)clip->point_count == cutter->point_room) {
        size_t room = 2 * cutter->point_room + 64;
        clip->points = mem_resize(clip->points, cutter->point_room, room, sizeof *clip->points);
        cutter->point_room = room;
    }
    clip->points[clip->point_count] = (ClipPoint){from, to, part};
    return clip->point_count++;
}

static void add_face(Cutter *cutter, const int points[3], int face, int cell)
{
    Clip *clip = &cutter->clip;
    if ((size_t)clip->face_count == cutter->face_room) {
        size_t old = cutter->face_room, room = 2 * old + 64;
        clip->faces = mem_resize(clip->faces, old, room, sizeof *clip->faces);
        clip->face = mem_resize(clip->face, old, room, sizeof *clip->face);
        clip->cell = mem_resize(clip->cell, old, room, sizeof *clip->cell);
        cutter->face_room = room;
    }
    memcpy(clip->faces[clip->face_count], points, sizeof *clip->faces);
    clip->face[clip->face_count] = face;
    clip->cell[clip->face_count++] = cell;
}

/* Where the edge from a vertex that is kept to one that is not meets the plane. */
static int add_meeting(Cutter *cutter, int kept, int lost)
{
    double from = cutter->beyond[kept], to = cutter->beyond[lost];
    return add_point(cutter, kept, lost, from / (from - to));
}

static int add_vertex(Cutter *cutter, int vertex)
{
    int *point = &cutter->point_of[vertex];
    if (!*point) *point = 1 + add_point(cutter, vertex, vertex, 0);
    return *point - 1;
}

static bool is_kept(const Cutter *cutter, int vertex)
{
    return cutter->beyond[vertex] < 0;
}

/* ---- Triangles ---- */

static void add_quad(Cutter *cutter, const int q[4], int face, int cell)
{
    add_face(cutter, (int[3]){q[0], q[1], q[2]}, face, cell);
    add_face(cutter, (int[3]){q[0], q[2], q[3]}, face, cell);
}

/* Its corners go round in the order of the face's. */
static void cut_face(Cutter *cutter, int face)
{
    const ClipBody *body = cutter->body;
    const int *v = body->faces[face];
    int cell = body->cell_of_face ? body->cell_of_face[face] : -1, polygon[4], count = 0;
    for (int i = 0; i < 3; i++) {
        int a = v[i], b = v[(i + 1) % 3];
        if (is_kept(cutter, a)) polygon[count++] = add_vertex(cutter, a);
        if (is_kept(cutter, a) != is_kept(cutter, b))
            polygon[count++] = is_kept(cutter, a) ? add_meeting(cutter, a, b) : add_meeting(cutter, b, a);
    }
    if (count == 3) add_face(cutter, polygon, face, cell);
    if (count == 4) add_quad(cutter, polygon, face, cell);
}

/* ---- Tetrahedra ---- */

/* A triangle or a quadrilateral, whose corners lie on edges from nodes that are kept to others. */
static void cut_tetrahedron(Cutter *cutter, const int v[4], int cell)
{
    int kept[4], lost[4], kept_count = 0, lost_count = 0;
    for (int i = 0; i < 4; i++)
        if (is_kept(cutter, v[i]))
            kept[kept_count++] = v[i];
        else
            lost[lost_count++] = v[i];
    if (!kept_count || !lost_count) return;
    int q[4], count = 0;
    for (int k = 0; k < kept_count; k++) /* the second row backwards: round the quadrilateral */
        for (int l = 0; l < lost_count; l++)
            q[count++] = add_meeting(cutter, kept[k], lost[k ? lost_count - 1 - l : l]);
    if (count == 3)
        add_face(cutter, q, -1, cell);
    else
        add_quad(cutter, q, -1, cell);
}

/* Linear tetrahedra between the nodes of a quadratic one: four at its corners, and four round the line from the middle of
 * 02 to that of 13, which fill the octahedron between the middles. Middles: 4 5 6 7 8 9 of 01 12 02 03 23 13. */
static const int eighths[8][4] = {{0, 4, 6, 7}, {1, 5, 4, 9}, {2, 6, 5, 8}, {3, 7, 9, 8},
                                  {6, 9, 4, 5}, {6, 9, 5, 8}, {6, 9, 8, 7}, {6, 9, 7, 4}};

static void cut_cell(Cutter *cutter, int cell)
{
    const ClipBody *body = cutter->body;
    const int *nodes = body->cells + (size_t)cell * (size_t)body->cell_nodes;
    if (body->cell_nodes == 4) cut_tetrahedron(cutter, nodes, cell);
    for (int k = 0; body->cell_nodes == 10 && k < 8; k++) {
        int v[4];
        for (int i = 0; i < 4; i++) v[i] = nodes[eighths[k][i]];
        cut_tetrahedron(cutter, v, cell);
    }
}

/* ---- The whole ---- */

/* Every vertex is a point, those within, too. */
static void keep_all(Cutter *cutter)
{
    const ClipBody *body = cutter->body;
    for (int v = 0; v < body->vertex_count; v++) add_point(cutter, v, v, 0);
    for (int f = 0; f < body->face_count; f++)
        add_face(cutter, body->faces[f], f, body->cell_of_face ? body->cell_of_face[f] : -1);
}

Clip clip_create(const ClipBody *body, const ClipPlane *plane)
{
    Cutter cutter = {.body = body};
    Vec3 normal = vec3_load(plane->normal), point = vec3_load(plane->point);
    if (!clip_is_given(plane)) {
        keep_all(&cutter);
        return cutter.clip;
    }
    normal = vec3_unit(normal);
    cutter.beyond = mem_alloc((size_t)body->vertex_count, sizeof *cutter.beyond);
    cutter.point_of = mem_alloc((size_t)body->vertex_count, sizeof *cutter.point_of);
    for (int v = 0; v < body->vertex_count; v++)
        cutter.beyond[v] = vec3_dot(normal, vec3_sub(vec3_load(body->rest[v]), point));
    for (int f = 0; f < body->face_count; f++) cut_face(&cutter, f);
    for (int c = 0; c < body->cell_count; c++) cut_cell(&cutter, c);
    mem_free(cutter.beyond);
    mem_free(cutter.point_of);
    return cutter.clip;
}

void clip_clear(Clip *clip)
{
    mem_free(clip->points);
    mem_free(clip->faces);
    mem_free(clip->face);
    mem_free(clip->cell);
    *clip = (Clip){0};
}

void clip_points(const Clip *clip, const double (*x)[3], double (*points)[3])
{
    for (int i = 0; i < clip->point_count; i++) {
        const ClipPoint *p = &clip->points[i];
        for (int k = 0; k < 3; k++) /* of one vertex as it is, NaN or not */
            points[i][k] =
                p->from == p->to ? x[p->from][k] : (1 - p->part) * x[p->from][k] + p->part * x[p->to][k];
    }
}
