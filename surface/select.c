#include "surface/select.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A part of a sentence; what does not fit is cut off. */
typedef struct Text {
    char text[700];
    size_t length;
} Text;

__attribute__((format(printf, 2, 3))) static void append(Text *text, const char *format, ...)
{
    size_t room = sizeof text->text - text->length;
    va_list args;
    va_start(args, format);
    int length = vsnprintf(text->text + text->length, room, format, args);
    va_end(args);
    text->length += (size_t)length < room ? (size_t)length : room - 1;
}

static bool check_conditions(const Selection *s, Error *err)
{
    if (s->vertices.count == 0 && !s->has_box && !s->has_ball && !s->group && !s->boundary)
        return error_set(err, "no vertices are named: give vertices, box, ball, group or boundary: true");
    for (int k = 0; s->has_box && k < 3; k++)
        if (!(s->box[0][k] <= s->box[1][k]))
            return error_set(err, "box: its first corner must not exceed its second, but %c is %g and %g",
                             "xyz"[k], s -> box[0][k], s -> box[1][k]);
    if (s->has_ball && !(s->radius > 0))
        return error_set(err, "ball: its radius must be positive, not %g", s->radius);
    return true;
}

/* ---- conditions: each marks its vertices ---- */

static bool mark_listed(const Mesh *mesh, const Indices *listed, bool *mark, Error *err)
{
    for (int i = 0; i < listed->count; i++) {
        int v;
        if (!mesh_vertex(mesh, listed->items[i], &v, err)) return error_prefix(err, "vertices[%d]", i);
        mark[v] = true;
    }
    return true;
}

static void mark_members(const Mesh *mesh, const MeshGroup *group, bool *mark)
{
    int member_count = group->dim == 1 ? 2 * group->count : group->count;
    for (int i = 0; i < member_count; i++) {
        int member = group->members[i];
        for (int k = 0; k < 3 && group->dim == 2; k++) mark[mesh->faces[member][k]] = true;
        for (int k = 0; k < mesh->cell_nodes && group->dim == 3; k++)
            mark[mesh->cells[member * mesh->cell_nodes + k]] = true;
        if (group->dim < 2) mark[member] = true;
    }
}

/* All that the name stands for: its cells, its faces, its edges and its vertices. */
static bool mark_group(const Mesh *mesh, const char *name, bool *mark, Error *err)
{
    bool found = false;
    for (int dim = 0; dim <= 3; dim++) {
        const MeshGroup *group = mesh_group(mesh, name, dim);
        if (!group) continue;
        mark_members(mesh, group, mark);
        found = true;
    }
    if (found) return true;
    char *names = mesh_group_names(mesh, -1);
    error_set(err, "there is no group '%s'; the mesh has %s", name, names);
    mem_free(names);
    return false;
}

/* Rounding of coordinates takes no vertex off the surface of a box or ball. */
static double tolerance(const Mesh *mesh)
{
    return 1e-9 * mesh_diagonal(mesh);
}

static void mark_box(const Mesh *mesh, const double box[2][3], bool *mark)
{
    double beyond = tolerance(mesh);
    for (int v = 0; v < mesh->vertex_count; v++) {
        const double *x = mesh->rest[v];
        mark[v] = true;
        for (int k = 0; k < 3; k++) mark[v] &= box[0][k] - beyond <= x[k] && x[k] <= box[1][k] + beyond;
    }
}

static void mark_ball(const Mesh *mesh, const double center[3], double radius, bool *mark)
{
    double reach = radius + tolerance(mesh);
    for (int v = 0; v < mesh->vertex_count; v++)
        mark[v] = vec3_length(vec3_sub(vec3_load(mesh->rest[v]), vec3_load(center))) <= reach;
}

static void mark_boundary(const Mesh *mesh, bool *mark)
{
    int count, *vertices = mesh_boundary(mesh, &count);
    for (int i = 0; i < count; i++) mark[vertices[i]] = true;
    mem_free(vertices);
}

/* Keeps only what is marked, and clears the marks for the next condition. */
static void narrow(const Mesh *mesh, bool *keep, bool *mark)
{
    for (int v = 0; v < mesh->vertex_count; v++) {
        keep[v] &= mark[v];
        mark[v] = false;
    }
}

/* Clears keep[v] where vertex v fails a condition; mark is scratch, all false. */
static bool apply_conditions(const Mesh *mesh, const Selection *s, bool *keep, bool *mark, Error *err)
{
    if (s->vertices.count > 0) {
        if (!mark_listed(mesh, &s->vertices, mark, err)) return false;
        narrow(mesh, keep, mark);
    }
    if (s->group) {
        if (!mark_group(mesh, s->group, mark, err)) return false;
        narrow(mesh, keep, mark);
    }
    if (s->has_box) {
        mark_box(mesh, s->box, mark);
        narrow(mesh, keep, mark);
    }
    if (s->has_ball) {
        mark_ball(mesh, s->center, s->radius, mark);
        narrow(mesh, keep, mark);
    }
    if (s->boundary) {
        mark_boundary(mesh, mark);
        narrow(mesh, keep, mark);
    }
    return true;
}

/* ---- selections ---- */

static bool refuse_empty(const Mesh *mesh, const Selection *s, Error *err)
{
    Text in = {0};
    const double *lo = s->box[0], *hi = s->box[1], *c = s->center;
    if (s->vertices.count) append(&in, " and the listed vertices");
    if (s->group) append(&in, " and group '%s'", s->group);
    if (s->has_box)
        append(&in, " and box [[%g, %g, %g], [%g, %g, %g]]", lo[0], lo[1], lo[2], hi[0], hi[1], hi[2]);
    if (s->has_ball)
        append(&in, " and the ball of radius %g around [%g, %g, %g]", s->radius, c[0], c[1], c[2]);
    if (s->boundary) append(&in, " and the boundary");
    double low[3], high[3];
    mesh_bounding_box(mesh, low, high);
    return error_set(err, "no vertex is in %s; the mesh spans x %g..%g, y %g..%g, z %g..%g m",
                     in.text + sizeof " and " - 1, low[0], high[0], low[1], high[1], low[2], high[2]);
}

bool select_vertices(const Mesh *mesh, const Selection *selection, Indices *found, Error *err)
{
    *found = (Indices){0};
    if (!check_conditions(selection, err)) return false;
    int n = mesh->vertex_count;
    bool *keep = mem_alloc((size_t)n, sizeof *keep), *mark = mem_alloc((size_t)n, sizeof *mark);
    for (int v = 0; v < n; v++) keep[v] = true;
    bool good = apply_conditions(mesh, selection, keep, mark, err);
    if (good) {
        found->items = mem_alloc((size_t)n, sizeof *found->items);
        for (int v = 0; v < n; v++)
            if (keep[v]) found->items[found->count++] = v;
        good = found->count > 0 || refuse_empty(mesh, selection, err);
    }
    mem_free(keep);
    mem_free(mark);
    if (!good) {
        mem_free(found->items);
        *found = (Indices){0};
    }
    return good;
}

static Indices edges_among(const Mesh *mesh, const Indices *vertices, bool boundary_only)
{
    bool *in = mem_alloc((size_t)mesh->vertex_count, sizeof *in);
    for (int i = 0; i < vertices->count; i++) in[vertices->items[i]] = true;
    Indices found = {.items = mem_alloc((size_t)mesh->edge_count, sizeof *found.items)};
    for (int e = 0; e < mesh->edge_count; e++)
        if (in[mesh->edges[e][0]] && in[mesh->edges[e][1]] &&
            (!boundary_only || mesh_edge_is_boundary(mesh, e)))
            found.items[found.count++] = e;
    mem_free(in);
    return found;
}

Indices select_edges(const Mesh *mesh, const Indices *vertices)
{
    return edges_among(mesh, vertices, false);
}

Indices select_boundary_edges(const Mesh *mesh, const Indices *vertices)
{
    return edges_among(mesh, vertices, true);
}
