#include "base/memory.h"
#include "base/vec3.h"
#include "base/weld.h"
#include "surface/mesh_private.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const double area_limit = 1e-12;  /* of the squared diagonal */
static const double height_limit = 1e-6; /* of the longest edge */

/* What the steps of mesh_create share. */
typedef struct Build {
    const MeshFile *file;
    double weld;
    Mesh *mesh;
    MeshReport *report;
    Error *err;
} Build;

static MeshPlace face_place(const Build *build, int face)
{
    return mesh_place(build->file, build->file->face_line, face);
}

void mesh_warn(MeshReport *report, const char *format, ...)
{
    if (!report) return;
    char text[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    int n = report->warning_count++;
    report->warnings = mem_resize(report->warnings, (size_t)n, (size_t)n + 1, sizeof(char *));
    report->warnings[n] = mem_text(text);
}

static bool check_counts(const Build *build)
{
    const MeshFile *file = build->file;
    if (file->vertex_count < 1) return error_set(build->err, "%s: the mesh has no vertices", file->path);
    if (file->face_count < 1) return error_set(build->err, "%s: the mesh has no faces", file->path);
    if (!(build->weld >= 0 && build->weld <= MESH_FARTHEST))
        return error_set(build->err, "%s: weld must be a distance from 0 to %g m, not %g", file->path,
                         MESH_FARTHEST, build->weld);
    return true;
}

/* ---- vertices ---- */

static void warn_removed(const Build *build)
{
    const MeshFile *file = build->file;
    int first = -1, count = 0;
    for (int v = file->vertex_count - 1; v >= 0; v--)
        if (build->mesh->vertex_of_file[v] < 0) first = v, count++;
    if (count)
        mesh_warn(build->report, "%s: %d %s removed, being %s; the first is vertex %d",
                  mesh_place(file, file->vertex_line, first).text, count,
                  count == 1 ? "vertex was" : "vertices were",
                  file->cell_count ? "middles of edges, which linear tetrahedra have none of" : "in no face",
                  first);
}

static void warn_coincident(const Build *build)
{
    const Mesh *mesh = build->mesh;
    int *first = mem_alloc((size_t)mesh->vertex_count, sizeof *first);
    weld_map((const double(*)[3])mesh->rest, mesh->vertex_count, 0, first);
    int example = -1, count = 0;
    for (int v = mesh->vertex_count - 1; v >= 0; v--)
        if (first[v] != v) example = v, count++;
    if (count) {
        int a = mesh->file_vertex[example], b = mesh->file_vertex[first[example]];
        mesh_warn(
            build->report,
            "%s: %d %s on another one and %s apart, as on a slit (vertex %d on vertex %d); weld joins such",
            mesh_place(build->file, build->file->vertex_line, a).text, count,
            count == 1 ? "vertex lies" : "vertices lie", count == 1 ? "stays" : "stay", a, b);
    }
    mem_free(first);
}

/* Numbers the vertices that faces use, those welded to one counting once, in the file's order. */
static void number_vertices(const Build *build)
{
    const MeshFile *file = build->file;
    Mesh *mesh = build->mesh;
    int n = file->vertex_count;
    int *first = mem_alloc((size_t)n, sizeof *first);
    for (int v = 0; v < n; v++) first[v] = v;
    if (build->weld > 0) weld_map((const double(*)[3])file->vertices, n, build->weld, first);

    bool *used = mem_alloc((size_t)n, sizeof *used);
    for (int f = 0; f < file->face_count; f++)
        for (int i = 0; i < 3; i++) used[first[file->faces[f][i]]] = true;
    for (int i = 0; i < file->cell_count * file->cell_nodes; i++) used[first[file->cells[i]]] = true;

    mesh->file_vertex_count = n;
    mesh->vertex_of_file = mem_alloc((size_t)n, sizeof *mesh->vertex_of_file);
    mesh->file_vertex = mem_alloc((size_t)n, sizeof *mesh->file_vertex);
    mesh->rest = mem_alloc((size_t)n, sizeof *mesh->rest);
    for (int v = 0; v < n; v++) {
        if (first[v] < v) {
            mesh->vertex_of_file[v] = mesh->vertex_of_file[first[v]];
        } else if (!used[v]) {
            mesh->vertex_of_file[v] = -1;
        } else {
            memcpy(mesh->rest[mesh->vertex_count], file->vertices[v], sizeof *mesh->rest);
            mesh->file_vertex[mesh->vertex_count] = v;
            mesh->vertex_of_file[v] = mesh->vertex_count++;
        }
    }
    mem_free(first);
    mem_free(used);
    warn_removed(build);
    if (build->weld == 0) warn_coincident(build);
}

/* ---- faces ---- */

static bool check_repeated(const Build *build, int f)
{
    const int *named = build->file->faces[f], *v = build->mesh->faces[f];
    for (int i = 0; i < 3; i++) {
        int a = named[i], b = named[(i + 1) % 3];
        if (a == b)
            return error_set(build->err,
                             "%s: face %d names vertex %d twice; a face has three different vertices",
                             face_place(build, f).text, f, a);
        if (v[i] == v[(i + 1) % 3])
            return error_set(build->err,
                             "%s: weld: %g m joins the vertices %d and %d of face %d; weld by less",
                             face_place(build, f).text, build->weld, a, b, f);
    }
    return true;
}

static bool check_shape(const Build *build, int f, double diagonal)
{
    Mesh *mesh = build->mesh;
    const int *named = build->file->faces[f];
    Vec3 x[3];
    for (int i = 0; i < 3; i++) x[i] = vec3_load(mesh->rest[mesh->faces[f][i]]);
    double longest = 0;
    for (int i = 0; i < 3; i++) longest = fmax(longest, vec3_length(vec3_sub(x[(i + 1) % 3], x[i])));
    double area = 0.5 * vec3_length(vec3_cross(vec3_sub(x[1], x[0]), vec3_sub(x[2], x[0])));
    double height = 2 * area / longest;
    mesh->rest_area[f] = area;
    if (!(area > area_limit * diagonal * diagonal))
        return error_set(
            build->err,
            "%s: face %d (vertices %d, %d, %d) has no area: %.3g m^2, less than %g of the squared diagonal "
            "of the mesh",
            face_place(build, f).text, f, named[0], named[1], named[2], area, area_limit);
    if (!(height >= height_limit * longest))
        return error_set(
            build->err,
            "%s: face %d (vertices %d, %d, %d) is a sliver: its height %.3g m is less than %g of its "
            "longest edge %.3g m",
            face_place(build, f).text, f, named[0], named[1], named[2], height, height_limit, longest);
    return true;
}

static bool build_faces(const Build *build)
{
    const MeshFile *file = build->file;
    Mesh *mesh = build->mesh;
    mesh->face_count = file->face_count;
    mesh->faces = mem_alloc((size_t)mesh->face_count, sizeof *mesh->faces);
    mesh->rest_area = mem_alloc((size_t)mesh->face_count, sizeof *mesh->rest_area);
    double diagonal = mesh_diagonal(mesh);
    for (int f = 0; f < mesh->face_count; f++) {
        for (int i = 0; i < 3; i++) mesh->faces[f][i] = mesh->vertex_of_file[file->faces[f][i]];
        if (!check_repeated(build, f) || !check_shape(build, f, diagonal)) return false;
    }
    return true;
}

/* ---- edges ---- */

/* One side of a face: its ends in ascending order, and the corner opposite. */
typedef struct Side {
    int ends[2], face, corner;
} Side;

/* Stable counting sort by one of the ends. */
static void sort_sides(const Side *from, Side *to, int count, int end, int vertex_count)
{
    int *start = mem_alloc((size_t)vertex_count + 1, sizeof *start);
    for (int s = 0; s < count; s++) start[from[s].ends[end] + 1]++;
    for (int v = 0; v < vertex_count; v++) start[v + 1] += start[v];
    for (int s = 0; s < count; s++) to[start[from[s].ends[end]]++] = from[s];
    mem_free(start);
}

/* All 3 face_count sides by edge, those of an edge by face. */
static Side *sorted_sides(const Mesh *mesh)
{
    int count = 3 * mesh->face_count;
    Side *sides = mem_alloc((size_t)count, sizeof *sides);
    Side *buffer = mem_alloc((size_t)count, sizeof *buffer);
    for (int s = 0; s < count; s++) {
        const int *v = mesh->faces[s / 3];
        int a = v[(s + 1) % 3], b = v[(s + 2) % 3];
        sides[s] = (Side){{a < b ? a : b, a < b ? b : a}, s / 3, s % 3};
    }
    sort_sides(sides, buffer, count, 1, mesh->vertex_count);
    sort_sides(buffer, sides, count, 0, mesh->vertex_count);
    mem_free(buffer);
    return sides;
}

static bool same_edge(const Side *a, const Side *b)
{
    return a->ends[0] == b->ends[0] && a->ends[1] == b->ends[1];
}

static bool refuse_direction(const Build *build, const int edge[2], int f, int g, bool forward)
{
    const int *name = build->mesh->file_vertex;
    return error_set(
        build->err,
        "%s: faces %d and %d both run along their edge from vertex %d to %d; neighbours must run in "
        "opposite directions: flip one (swap two of its vertices); a one-sided surface is no shell",
        face_place(build, g).text, f, g, name[edge[!forward]], name[edge[forward]]);
}

static bool same_face(const Mesh *mesh, const Side *a, const Side *b)
{
    return mesh->faces[a->face][a->corner] == mesh->faces[b->face][b->corner];
}

/* No two of the faces at an edge may be the same one. */
static bool check_doubled(const Build *build, const Side *sides, int count)
{
    for (int s = 1; s < count && s < 3; s++)
        for (int r = 0; r < s; r++)
            if (same_face(build->mesh, &sides[r], &sides[s]))
                return error_set(build->err,
                                 "%s: face %d has the same three vertices as face %d; a face is given once",
                                 face_place(build, sides[s].face).text, sides[s].face, sides[r].face);
    return true;
}

/* Enters the sides of edge e, count of them, into the neighbour tables. */
static bool join_sides(const Build *build, int e, const Side *sides, int count)
{
    Mesh *mesh = build->mesh;
    int *edge = mesh->edges[e], *neighbours = mesh->edge_faces[e];
    edge[0] = sides->ends[0], edge[1] = sides->ends[1];
    neighbours[0] = neighbours[1] = -1;
    if (!check_doubled(build, sides, count)) return false;
    if (count > 2)
        return error_set(build->err,
                         "%s: the faces %d, %d and %d share the edge between vertices %d and %d; an edge has "
                         "one or two faces",
                         face_place(build, sides[2].face).text, sides[0].face, sides[1].face, sides[2].face,
                         mesh->file_vertex[edge[0]], mesh->file_vertex[edge[1]]);
    for (int s = 0; s < count; s++) {
        int f = sides[s].face, i = sides[s].corner;
        bool forward = mesh->faces[f][(i + 1) % 3] == edge[0];
        if (neighbours[!forward] >= 0) return refuse_direction(build, edge, neighbours[!forward], f, forward);
        neighbours[!forward] = f;
        mesh->face_edges[f][i] = e;
        mesh->face_edge_sign[f][i] = forward ? 1 : -1;
    }
    return true;
}

static bool build_edges(const Build *build)
{
    Mesh *mesh = build->mesh;
    int side_count = 3 * mesh->face_count;
    Side *sides = sorted_sides(mesh);
    for (int s = 0; s < side_count; s++) mesh->edge_count += s == 0 || !same_edge(&sides[s - 1], &sides[s]);
    mesh->edges = mem_alloc((size_t)mesh->edge_count, sizeof *mesh->edges);
    mesh->edge_faces = mem_alloc((size_t)mesh->edge_count, sizeof *mesh->edge_faces);
    mesh->face_edges = mem_alloc((size_t)mesh->face_count, sizeof *mesh->face_edges);
    mesh->face_edge_sign = mem_alloc((size_t)mesh->face_count, sizeof *mesh->face_edge_sign);
    bool good = true;
    for (int s = 0, e = 0, end; good && s < side_count; s = end, e++) {
        for (end = s + 1; end < side_count && same_edge(&sides[s], &sides[end]);) end++;
        good = join_sides(build, e, &sides[s], end - s);
    }
    mem_free(sides);
    return good;
}

/* ---- parts ---- */

static int root_of(int *parent, int v)
{
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
}

static void join(int *parent, int a, int b)
{
    a = root_of(parent, a), b = root_of(parent, b);
    parent[a > b ? a : b] = a > b ? b : a;
}

/* Union-find over edges and cells; a part's root is its lowest vertex, so it is numbered before its other vertices. */
static void build_components(Mesh *mesh, const MeshFile *file)
{
    int *parent = mem_alloc((size_t)mesh->vertex_count, sizeof *parent);
    for (int v = 0; v < mesh->vertex_count; v++) parent[v] = v;
    for (int e = 0; e < mesh->edge_count; e++) join(parent, mesh->edges[e][0], mesh->edges[e][1]);
    for (int i = 0; i < file->cell_count * file->cell_nodes; i++)
        join(parent, mesh->vertex_of_file[file->cells[i]],
             mesh->vertex_of_file[file->cells[i - i % file->cell_nodes]]);
    mesh->vertex_component = mem_alloc((size_t)mesh->vertex_count, sizeof *mesh->vertex_component);
    for (int v = 0; v < mesh->vertex_count; v++) {
        int root = root_of(parent, v);
        mesh->vertex_component[v] = root == v ? mesh->component_count++ : mesh->vertex_component[root];
    }
    mem_free(parent);
}

static void take_cells(Mesh *mesh, const MeshFile *file)
{
    int size = file->cell_count * file->cell_nodes;
    mesh->cell_count = file->cell_count, mesh->cell_nodes = file->cell_nodes;
    mesh->cells = mem_alloc((size_t)size, sizeof *mesh->cells);
    for (int i = 0; i < size; i++) mesh->cells[i] = mesh->vertex_of_file[file->cells[i]];
}

/* ---- the public face ---- */

Mesh *mesh_create(const MeshFile *file, double weld, MeshReport *report, Error *err)
{
    if (report) *report = (MeshReport){0};
    Mesh *mesh = mem_alloc(1, sizeof *mesh);
    Build build = {file, weld, mesh, report, err};
    bool good = check_counts(&build) && mesh_check_file(file, err);
    if (good) {
        number_vertices(&build);
        good = build_faces(&build) && build_edges(&build);
    }
    if (!good) {
        mesh_destroy(mesh);
        return NULL;
    }
    build_components(mesh, file);
    take_cells(mesh, file);
    mesh_build_groups(mesh, file, report);
    return mesh;
}

void mesh_destroy(Mesh *mesh)
{
    if (!mesh) return;
    for (int g = 0; g < mesh->group_count; g++) {
        mem_free(mesh->groups[g].name);
        mem_free(mesh->groups[g].members);
    }
    void *owned[] = {mesh->rest,
                     mesh->faces,
                     mesh->cells,
                     mesh->face_middles,
                     mesh->edges,
                     mesh->edge_faces,
                     mesh->face_edges,
                     mesh->rest_area,
                     mesh->face_edge_sign,
                     mesh->vertex_component,
                     mesh->vertex_of_file,
                     mesh->groups,
                     mesh->file_vertex,
                     mesh->group_order,
                     mesh};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) mem_free(owned[i]);
}

void mesh_report_clear(MeshReport *report)
{
    for (int i = 0; i < report->warning_count; i++) mem_free(report->warnings[i]);
    mem_free(report->warnings);
    *report = (MeshReport){0};
}

bool mesh_vertex(const Mesh *mesh, int file_vertex, int *vertex, Error *err)
{
    if (file_vertex < 0 || file_vertex >= mesh->file_vertex_count)
        return error_set(err, "there is no vertex %d; the mesh has vertices 0 to %d", file_vertex,
                         mesh->file_vertex_count - 1);
    *vertex = mesh->vertex_of_file[file_vertex];
    if (*vertex < 0) return error_set(err, "vertex %d is in no face and was removed", file_vertex);
    return true;
}

int mesh_edge(const Mesh *mesh, int a, int b)
{
    int v0 = a < b ? a : b, v1 = a < b ? b : a, low = 0, high = mesh->edge_count;
    while (low < high) {
        int middle = low + (high - low) / 2;
        const int *edge = mesh->edges[middle];
        if (edge[0] < v0 || (edge[0] == v0 && edge[1] < v1))
            low = middle + 1;
        else
            high = middle;
    }
    return low < mesh->edge_count && mesh->edges[low][0] == v0 && mesh->edges[low][1] == v1 ? low : -1;
}

int mesh_corner(const Mesh *mesh, int face, int edge)
{
    const int *edges = mesh->face_edges[face];
    return edges[0] == edge ? 0 : edges[1] == edge ? 1 : 2;
}

int *mesh_boundary(const Mesh *mesh, int *count)
{
    bool *on = mem_alloc((size_t)mesh->vertex_count, sizeof *on);
    for (int e = 0; e < mesh->edge_count; e++)
        if (mesh_edge_is_boundary(mesh, e)) on[mesh->edges[e][0]] = on[mesh->edges[e][1]] = true;
    int *vertices = mem_alloc((size_t)mesh->vertex_count, sizeof *vertices);
    *count = 0;
    for (int v = 0; v < mesh->vertex_count; v++)
        if (on[v]) vertices[(*count)++] = v;
    mem_free(on);
    return vertices;
}

void mesh_bounding_box(const Mesh *mesh, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (int v = 0; v < mesh->vertex_count; v++)
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], mesh->rest[v][k]);
            high[k] = fmax(high[k], mesh->rest[v][k]);
        }
}

double mesh_diagonal(const Mesh *mesh)
{
    double low[3], high[3];
    mesh_bounding_box(mesh, low, high);
    return vec3_length(vec3_sub(vec3_load(high), vec3_load(low)));
}

double mesh_mean_edge(const Mesh *mesh)
{
    double sum = 0;
    for (int e = 0; e < mesh->edge_count; e++)
        sum += vec3_length(
            vec3_sub(vec3_load(mesh->rest[mesh->edges[e][0]]), vec3_load(mesh->rest[mesh->edges[e][1]])));
    return sum / mesh->edge_count;
}
