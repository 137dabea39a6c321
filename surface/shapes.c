#include "surface/shapes.h"
#include "base/memory.h"
#include <math.h>

/* ---- arguments and storage ---- */

static bool check_length(const char *shape, const char *key, double length, Error *err)
{
    if (isfinite(length) && length > 0) return true;
    return error_set(err, "%s: %s must be a positive length, not %g m", shape, key, length);
}

static bool check_count(const char *shape, const char *key, int count, Error *err)
{
    if (count >= 1) return true;
    return error_set(err, "%s: %s must be at least 1, not %d", shape, key, count);
}

static bool check_faces(const char *shape, double face_count, Error *err)
{
    if (face_count <= SHAPE_MAX_FACES) return true;
    return error_set(err, "%s: %.0f faces are too many; a generated mesh has at most %d", shape, face_count,
                     SHAPE_MAX_FACES);
}

/* Room for vertices, faces and groups; faces and groups are counted up as they are added. */
static MeshFile start(const char *shape, int vertex_count, int face_count, int group_count)
{
    MeshFile mesh = {.path = mem_text(shape), .vertex_count = vertex_count};
    mesh.vertices = mem_alloc((size_t)vertex_count, sizeof *mesh.vertices);
    mesh.faces = mem_alloc((size_t)face_count, sizeof *mesh.faces);
    mesh.groups = mem_alloc((size_t)group_count, sizeof *mesh.groups);
    return mesh;
}

static void set_vertex(MeshFile *mesh, int v, double x, double y)
{
    mesh->vertices[v][0] = x;
    mesh->vertices[v][1] = y;
}

static void add_face(MeshFile *mesh, int a, int b, int c)
{
    int *face = mesh->faces[mesh->face_count++];
    face[0] = a, face[1] = b, face[2] = c;
}

/* The group first, first + stride, ... of vertices (dim 0) or faces (dim 2). Takes the name. */
static void add_group(MeshFile *mesh, char *name, int dim, int first, int stride, int count)
{
    MeshGroup *group = &mesh->groups[mesh->group_count++];
    *group = (MeshGroup){name, dim, count, mem_alloc((size_t)count, sizeof(int))};
    for (int i = 0; i < count; i++) group->members[i] = first + i * stride;
}

/* ---- sheets ---- */

static void sheet_vertices(MeshFile *mesh, const double size[2], const int cells[2], bool middles)
{
    int v = 0;
    double dx = size[0] / cells[0], dy = size[1] / cells[1];
    for (int j = 0; j <= cells[1]; j++) /* the last ones exactly on the edge */
        for (int i = 0; i <= cells[0]; i++)
            set_vertex(mesh, v++, i == cells[0] ? size[0] : i * dx, j == cells[1] ? size[1] : j * dy);
    for (int j = 0; middles && j < cells[1]; j++)
        for (int i = 0; i < cells[0]; i++) set_vertex(mesh, v++, (i + 0.5) * dx, (j + 0.5) * dy);
}

/* The triangles of a cell with corners a, b, c, d counter-clockwise from the lower left; middle < 0: two
 * triangles. */
static void split_cell(MeshFile *mesh, const int corners[4], int middle, bool falling)
{
    int a = corners[0], b = corners[1], c = corners[2], d = corners[3];
    if (middle >= 0) {
        for (int k = 0; k < 4; k++) add_face(mesh, corners[k], corners[(k + 1) % 4], middle);
    } else if (falling) {
        add_face(mesh, a, b, d);
        add_face(mesh, b, c, d);
    } else {
        add_face(mesh, a, b, c);
        add_face(mesh, a, c, d);
    }
}

static bool make_sheet(const char *shape, const double size[2], const int cells[2], ShapePattern pattern,
                       MeshFile *mesh, Error *err)
{
    bool crossed = pattern == PATTERN_CROSSED;
    int per_cell = crossed ? 4 : 2;
    if (!check_faces(shape, (double)per_cell * cells[0] * cells[1], err)) return false;
    int row = cells[0] + 1, cell_count = cells[0] * cells[1], corner_count = row * (cells[1] + 1);
    *mesh = start(shape, corner_count + (crossed ? cell_count : 0), per_cell * cell_count, 2);
    sheet_vertices(mesh, size, cells, crossed);
    for (int cell = 0; cell < cell_count; cell++) {
        int i = cell % cells[0], j = cell / cells[0], a = j * row + i;
        bool falling = pattern == PATTERN_ALTERNATE && (i + j) % 2;
        split_cell(mesh, (int[4]){a, a + 1, a + row + 1, a + row}, crossed ? corner_count + cell : -1,
                   falling);
    }
    add_group(mesh, mem_text("root"), 0, 0, row, cells[1] + 1);
    add_group(mesh, mem_text("tip"), 0, cells[1] / 2 * row + cells[0], 0, 1);
    return true;
}

bool shape_sheet(const double size[2], const int cells[2], ShapePattern pattern, MeshFile *mesh, Error *err)
{
    *mesh = (MeshFile){0};
    return check_length("sheet", "size[0]", size[0], err) && check_length("sheet", "size[1]", size[1], err) &&
           check_count("sheet", "cells[0]", cells[0], err) &&
           check_count("sheet", "cells[1]", cells[1], err) &&
           make_sheet("sheet", size, cells, pattern, mesh, err);
}

bool shape_strip(double length, double width, int n, ShapePattern pattern, MeshFile *mesh, Error *err)
{
    *mesh = (MeshFile){0};
    if (!check_length("strip", "length", length, err) || !check_length("strip", "width", width, err) ||
        !check_count("strip", "n", n, err))
        return false;
    double across = fmax(1, rint(n * (width / length))); /* bounded, so that it fits an int and is refused */
    int cells[2] = {n, (int)fmin(across, SHAPE_MAX_FACES)};
    return make_sheet("strip", (double[2]){length, width}, cells, pattern, mesh, err);
}

/* ---- hexagonal rings: a middle vertex, then ring k of 6 k vertices, k on each side of a hexagon ---- */

/* Vertex i of ring k, counted from corner `sector`; i up to and beyond k goes on along the ring. */
static int ring_vertex(int k, int sector, int i)
{
    return k == 0 ? 0 : 1 + 3 * k * (k - 1) + (sector * k + i) % (6 * k);
}

static int ring_vertex_count(int n)
{
    return 1 + 3 * n * (n + 1);
}

/* The 6 n^2 faces, ring by ring. */
static void add_ring_faces(MeshFile *mesh, int n)
{
    for (int k = 1; k <= n; k++)
        for (int sector = 0; sector < 6; sector++)
            for (int i = 0; i < k; i++) {
                int inner = ring_vertex(k - 1, sector, i), outer = ring_vertex(k, sector, i + 1);
                add_face(mesh, inner, ring_vertex(k, sector, i), outer);
                if (i < k - 1) add_face(mesh, inner, outer, ring_vertex(k - 1, sector, i + 1));
            }
}

/* ---- hexagram ---- */

/* Puts a vertex at a*c(sector) + b*c(sector + 1), c the hub's corners at -30, 30, 90, ... degrees. */
static void set_star_vertex(MeshFile *mesh, int v, int sector, double a, double b)
{
    static const double h = 0.86602540378443864676; /* sqrt(3)/2 */
    static const double corners[7][2] = {{h, -0.5},  {h, 0.5}, {0, 1},   {-h, 0.5},
                                         {-h, -0.5}, {0, -1},  {h, -0.5}};
    const double *c = corners[sector], *d = corners[sector + 1];
    set_vertex(mesh, v, a * c[0] + b * d[0], a * c[1] + b * d[1]);
}

/* Vertex i of row r of a flap; row 0 is the hub's side, row n the tip. Rows have n + 1 - r vertices. */
static int flap_vertex(int n, int flap, int r, int i)
{
    if (r == 0) return ring_vertex(n, flap, i);
    return ring_vertex_count(n) + flap * (n * (n + 1) / 2) + (r - 1) * (n + 1) - r * (r - 1) / 2 + i;
}

static void add_flap(MeshFile *mesh, int n, int flap, double edge)
{
    for (int r = 1; r <= n; r++)
        for (int i = 0; i <= n - r; i++)
            set_star_vertex(mesh, flap_vertex(n, flap, r, i), flap, (n - i) * edge, (i + r) * edge);
    for (int r = 0; r < n; r++)
        for (int i = 0; i < n - r; i++) {
            int next = flap_vertex(n, flap, r, i + 1), above = flap_vertex(n, flap, r + 1, i);
            add_face(mesh, flap_vertex(n, flap, r, i), above, next);
            if (i < n - r - 1) add_face(mesh, next, above, flap_vertex(n, flap, r + 1, i + 1));
        }
}

bool shape_hexagram(double size, int n, MeshFile *mesh, Error *err)
{
    *mesh = (MeshFile){0};
    if (!check_length("hexagram", "size", size, err) || !check_count("hexagram", "n", n, err) ||
        !check_faces("hexagram", 12.0 * n * n, err))
        return false;
    double edge = size / (2 * sqrt(3)) / n;
    *mesh = start("hexagram", ring_vertex_count(n) + 3 * n * (n + 1), 12 * n * n, 7);
    for (int k = 1; k <= n; k++)
        for (int sector = 0; sector < 6; sector++)
            for (int i = 0; i < k; i++)
                set_star_vertex(mesh, ring_vertex(k, sector, i), sector, (k - i) * edge, i * edge);
    add_ring_faces(mesh, n);
    add_group(mesh, mem_text("hub"), 2, 0, 1, 6 * n * n);
    for (int flap = 0; flap < 6; flap++) {
        add_group(mesh, mem_format("flap%d", flap + 1), 2, mesh->face_count, 1, n * n);
        add_flap(mesh, n, flap, edge);
    }
    return true;
}

/* ---- disc ---- */

bool shape_disc(double size, int n, MeshFile *mesh, Error *err)
{
    *mesh = (MeshFile){0};
    if (!check_length("disc", "size", size, err) || !check_count("disc", "n", n, err) ||
        !check_faces("disc", 6.0 * n * n, err))
        return false;
    *mesh = start("disc", ring_vertex_count(n), 6 * n * n, 2);
    for (int k = 1; k <= n; k++)
        for (int i = 0; i < 6 * k; i++) {
            double radius = size / 2 * k / n, angle = acos(-1) * i / (3 * k);
            set_vertex(mesh, ring_vertex(k, 0, i), radius * cos(angle), radius * sin(angle));
        }
    add_ring_faces(mesh, n);
    add_group(mesh, mem_text("centre"), 0, 0, 1, 1);
    add_group(mesh, mem_text("rim"), 0, ring_vertex(n, 0, 0), 1, 6 * n);
    return true;
}

/* ---- kirigami ---- */

bool shape_kirigami(double size, int n, MeshFile *mesh, Error *err)
{
    *mesh = (MeshFile){0};
    if (!check_length("kirigami", "size", size, err) || !check_count("kirigami", "n", n, err) ||
        !check_faces("kirigami", 2.0 * n * n + 2, err))
        return false;
    if (n % 2 == 0)
        return error_set(err, "kirigami: n must be odd, so that all corners are squares, not %d", n);
    int row = n + 1, corners = row * row, squares = (n * n + 1) / 2;
    double cell = size / n;
    *mesh = start("kirigami", corners + squares, 4 * squares, 2);
    for (int v = 0; v < corners; v++)
        set_vertex(mesh, v, (v % row - n / 2.0) * cell, (v / row - n / 2.0) * cell);
    for (int k = 0; k < squares; k++) { /* every other cell */
        int i = 2 * k % n, j = 2 * k / n, a = j * row + i;
        set_vertex(mesh, corners + k, (i + 0.5 - n / 2.0) * cell, (j + 0.5 - n / 2.0) * cell);
        split_cell(mesh, (int[4]){a, a + 1, a + row + 1, a + row}, corners + k, false);
    }
    add_group(mesh, mem_text("centre"), 0, corners + squares / 2, 1, 1);
    add_group(mesh, mem_text("rim"), 0, 0, 1, 4 * n);
    int *rim = mesh->groups[1].members;
    for (int v = 0; v < corners; v++)
        if (v % row == 0 || v % row == n || v / row == 0 || v / row == n) *rim++ = v;
    return true;
}
