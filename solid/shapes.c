/* Boxes, hands, hearts, stars. */
#include "solid/shapes.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

/* A sheet that is drawn: vertices, faces and groups are counted up as they come. */
static MeshFile start_sheet(int vertex_count, int face_count, int group_count)
{
    MeshFile sheet = {.path = mem_text("solid")};
    sheet.vertices = mem_alloc((size_t)vertex_count, sizeof *sheet.vertices);
    sheet.faces = mem_alloc((size_t)face_count, sizeof *sheet.faces);
    sheet.groups = mem_alloc((size_t)group_count, sizeof *sheet.groups);
    return sheet;
}

static void add_face(MeshFile *sheet, int a, int b, int c)
{
    memcpy(sheet->faces[sheet->face_count++], (int[3]){a, b, c}, sizeof *sheet->faces);
}

static void add_face_range(MeshFile *sheet, const char *name, int first, int count)
{
    int *members = mem_alloc((size_t)count, sizeof *members);
    for (int i = 0; i < count; i++) members[i] = first + i;
    solid_shape_group(sheet, name, 2, members, count);
}

/* The sheet, which is cleared, made thick. */
static bool extrude(MeshFile *sheet, double thickness, int layers, MeshFile *mesh, Error *err)
{
    Mesh *base = mesh_create(sheet, 0, NULL, err);
    bool ok = base && solid_shape_extrude(base, thickness, layers, mesh, err);
    mesh_destroy(base);
    mesh_file_clear(sheet);
    return ok;
}

/* ---- Defaults ---- */

static bool check_def(SolidShapeDef *def, double thickness, int n, Error *err)
{
    if (isnan(def->thickness)) def->thickness = thickness * def->size;
    if (!def->n) def->n = n;
    if (!(def->size > 0 && isfinite(def->size)))
        return error_set(err, "a solid has a size above 0, not %g m", def->size);
    if (def->n < 1 || def->n > 200) return error_set(err, "a solid has 1 to 200 divisions, not %d", def->n);
    return true;
}

/* ---- Boxes ---- */

/* The edges of a sheet along one of its sides: from a vertex on in steps. */
static void add_side(MeshFile *sheet, const char *name, int first, int step, int count)
{
    int *members = mem_alloc(2 * (size_t)count, sizeof *members);
    for (int i = 0; i < count; i++)
        members[2 * i] = first + i * step, members[2 * i + 1] = first + (i + 1) * step;
    sheet->groups[sheet->group_count++] = (MeshGroup){mem_text(name), 1, count, members};
}

bool solid_shape_plate(const double size[3], const int cells[3], ShapePattern pattern, MeshFile *mesh,
                       Error *err)
{
    MeshFile sheet;
    *mesh = (MeshFile){0};
    double prisms = (pattern == PATTERN_CROSSED ? 4. : 2.) * cells[0] * cells[1];
    if (!solid_shape_check_count(3 * prisms * cells[2], err) ||
        !shape_sheet(size, cells, pattern, &sheet, err))
        return false;
    for (int g = 0; g < sheet.group_count; g++)
        mem_free(sheet.groups[g].name), mem_free(sheet.groups[g].members);
    mem_free(sheet.groups);
    sheet.groups = mem_alloc(4, sizeof *sheet.groups);
    sheet.group_count = 0;
    int row = cells[0] + 1;
    add_side(&sheet, "left", 0, row, cells[1]);
    add_side(&sheet, "right", cells[0], row, cells[1]);
    add_side(&sheet, "front", 0, 1, cells[0]);
    add_side(&sheet, "back", row * cells[1], 1, cells[0]);
    return extrude(&sheet, size[2], cells[2], mesh, err);
}

bool solid_shape_box(const double size[3], const int cells[3], MeshFile *mesh, Error *err)
{
    return solid_shape_plate(size, cells, PATTERN_RIGHT, mesh, err);
}

/* ---- Hand ---- */

/* Its parts, in tenths of its size, fingers two wide and one apart. */
typedef struct Part {
    const char *name;
    int x, y, wide, high;
} Part;

static const Part hand_parts[] = {{"palm", 0, 0, 11, 10},   {"little", 0, 10, 2, 9}, {"ring", 3, 10, 2, 11},
                                  {"middle", 6, 10, 2, 11}, {"index", 9, 10, 2, 10}, {"thumb", 11, 4, 8, 2}};

enum {
    HAND_PARTS = sizeof hand_parts / sizeof *hand_parts,
    HAND_WIDE = 19,
    HAND_HIGH = 21,
    HAND_CELLS = 208
};

/* The grid that the parts lie in: vertices that are used, numbered row by row. */
typedef struct Grid {
    int n, row, *vertex;
} Grid;

static int *at(const Grid *grid, int i, int j)
{
    return &grid->vertex[j * grid->row + i];
}

static Grid hand_grid(int n, double size, MeshFile *sheet)
{
    Grid grid = {.n = n, .row = HAND_WIDE * n + 1};
    int all = grid.row * (HAND_HIGH * n + 1);
    grid.vertex = mem_alloc((size_t)all, sizeof *grid.vertex);
    for (int p = 0; p < HAND_PARTS; p++)
        for (int j = 0; j <= hand_parts[p].high * n; j++)
            for (int i = 0; i <= hand_parts[p].wide * n; i++)
                *at(&grid, hand_parts[p].x * n + i, hand_parts[p].y * n + j) = 1;
    for (int k = 0; k < all; k++) {
        bool used = grid.vertex[k];
        grid.vertex[k] = used ? sheet->vertex_count : -1;
        if (!used) continue;
        double *x = sheet->vertices[sheet->vertex_count++];
        x[0] = size * (k % grid.row) / (10 * n), x[1] = size * (k / grid.row) / (10 * n);
    }
    return grid;
}

static void add_part(const Grid *grid, const Part *part, MeshFile *sheet)
{
    int first = sheet->face_count, n = grid->n;
    for (int j = part->y * n; j < (part->y + part->high) * n; j++)
        for (int i = part->x * n; i < (part->x + part->wide) * n; i++) {
            add_face(sheet, *at(grid, i, j), *at(grid, i + 1, j), *at(grid, i + 1, j + 1));
            add_face(sheet, *at(grid, i, j), *at(grid, i + 1, j + 1), *at(grid, i, j + 1));
        }
    add_face_range(sheet, part->name, first, sheet->face_count - first);
}

/* In the middle of the fingers, a third, two thirds and all but a tenth of the size along them: on no edge of the solid, where
 * the forces of a skin are line loads. */
static int *hand_anchors(const Grid *grid, int *count)
{
    int *anchors = mem_alloc(3 * (HAND_PARTS - 1), sizeof *anchors);
    *count = 0;
    for (int p = 1; p < HAND_PARTS; p++) {
        const Part *part = &hand_parts[p];
        bool sideways = part->wide > part->high;
        int length = sideways ? part->wide : part->high;
        for (int s = 1; s <= 3; s++) {
            int along = s < 3 ? length * s / 3 : length - 1;
            anchors[(*count)++] = *at(grid, (part->x + (sideways ? along : 1)) * grid->n,
                                      (part->y + (sideways ? 1 : along)) * grid->n);
        }
    }
    return anchors;
}

bool solid_shape_hand(SolidShapeDef def, MeshFile *mesh, Error *err)
{
    *mesh = (MeshFile){0};
    if (!check_def(&def, 0.05, 1, err)) return false;
    int n = def.n, count;
    MeshFile sheet =
        start_sheet((HAND_WIDE * n + 1) * (HAND_HIGH * n + 1), 2 * HAND_CELLS * n * n, HAND_PARTS + 1);
    Grid grid = hand_grid(n, def.size, &sheet);
    for (int p = 0; p < HAND_PARTS; p++) add_part(&grid, &hand_parts[p], &sheet);
    add_side(&sheet, "wrist", 0, 1, hand_parts[0].wide * n);
    int *anchors = hand_anchors(&grid, &count), vertices = sheet.vertex_count;
    bool ok = extrude(&sheet, def.thickness, def.layers, mesh, err);
    if (ok) {
        int *members = mem_alloc(2 * (size_t)count, sizeof *members);
        for (int i = 0; i < count; i++)
            members[2 * i] = anchors[i], members[2 * i + 1] = anchors[i] + def.layers * vertices;
        solid_shape_group(mesh, "anchors", 0, members, 2 * count);
    }
    mem_free(anchors);
    mem_free(grid.vertex);
    return ok;
}

/* ---- Heart ---- */

/* The faces whose middles are from low to high. */
static void add_band(MeshFile *mesh, const char *name, double low, double high)
{
    int *members = mem_alloc((size_t)mesh->face_count, sizeof *members), count = 0;
    for (int f = 0; f < mesh->face_count; f++) {
        double z = 0;
        for (int i = 0; i < 3; i++) z += mesh->vertices[mesh->faces[f][i]][2] / 3;
        if (z > low && z < high) members[count++] = f;
    }
    solid_shape_group(mesh, name, 2, members, count);
}

/* The disc of radius 1, its rings at equal angles, on ellipsoids one within the other. */
static void place_heart(const Mesh *disc, const SolidShapeDef *def, double depth, MeshFile *mesh)
{
    for (int k = 0; k < mesh->vertex_count; k++) {
        const double *from = disc->rest[k % disc->vertex_count];
        double inwards = def->thickness * (k / disc->vertex_count) / def->layers, *x = mesh->vertices[k];
        double r = hypot(from[0], from[1]), angle = r * acos(0), out = r > 0 ? sin(angle) / r : 0;
        x[0] = (def->size / 2 - inwards) * out * from[0], x[1] = (def->size / 2 - inwards) * out * from[1];
        x[2] = -(depth - inwards) * cos(angle);
    }
}

bool solid_shape_heart(SolidShapeDef def, MeshFile *mesh, Error *err)
{
    MeshFile sheet;
    *mesh = (MeshFile){0};
    if (!check_def(&def, 0.075, 10, err)) return false;
    if (!(def.thickness > 0 && def.thickness < def.size / 2))
        return error_set(err, "a heart has a wall thinner than its radius %g m, not %g m", def.size / 2,
                         def.thickness);
    if (!shape_disc(2, def.n, &sheet, err)) return false;
    double depth = 0.75 * def.size;
    Mesh *disc = mesh_create(&sheet, 0, NULL, err);
    bool ok = disc && solid_shape_prisms(disc, def.layers, mesh, err);
    if (ok) {
        place_heart(disc, &def, depth, mesh);
        add_band(mesh, "lower", -2 * depth, -0.5 * depth);
        add_band(mesh, "ribbon", -0.6 * depth, -0.4 * depth);
    }
    mesh_destroy(disc);
    mesh_file_clear(&sheet);
    return ok;
}

/* ---- Starfish ---- */

enum { ARMS = 5 };

static const double NOTCH = 0.4,
                    TIP = 0.08; /* radius of the notches, half the width of a tip, in parts of the radius */

/* Vertex i of ring k of the pentagon in the middle, from its corner `arm` on. */
static int ring_vertex(int k, int arm, int i)
{
    return k == 0 ? 0 : 1 + ARMS * k * (k - 1) / 2 + (arm * k + i) % (ARMS * k);
}

/* Vertex i of a row of an arm; row 0 is the side of the pentagon. */
static int arm_vertex(int n, int rows, int arm, int row, int i)
{
    if (row == 0) return ring_vertex(n, arm, i);
    return 1 + ARMS * n * (n + 1) / 2 + (arm * rows + row - 1) * (n + 1) + i;
}

/* In the frame of an arm along x. */
static void put_on_arm(MeshFile *sheet, int vertex, int arm, double x, double y)
{
    double turn = 4 * acos(0) * arm / ARMS, c = cos(turn), s = sin(turn);
    sheet->vertices[vertex][0] = c * x - s * y, sheet->vertices[vertex][1] = s * x + c * y;
    if (vertex >= sheet->vertex_count) sheet->vertex_count = vertex + 1;
}

/* A fifth of the pentagon, as far as the next one begins, and the arm. */
static void place_arm(MeshFile *sheet, int n, int rows, int arm, double radius)
{
    double half = 4 * acos(0) / ARMS / 2, x = NOTCH * radius * cos(half), y = NOTCH * radius * sin(half);
    for (int k = 0; k <= n; k++)
        for (int i = 0; i < (k ? k : 1); i++)
            put_on_arm(sheet, ring_vertex(k, arm, i), arm, x * k / n, y * (2 * i - k) / n);
    for (int r = 1; r <= rows; r++)
        for (int i = 0; i <= n; i++) {
            double out = (double)r / rows, across = (double)(2 * i - n) / n;
            put_on_arm(sheet, arm_vertex(n, rows, arm, r, i), arm, x + (radius - x) * out,
                       across * (y + (TIP * radius - y) * out));
        }
}

static void add_arm(MeshFile *sheet, int n, int rows, int arm)
{
    int first = sheet->face_count;
    for (int k = 1; k <= n; k++)
        for (int i = 0; i < k; i++) {
            int inner = ring_vertex(k - 1, arm, i), outer = ring_vertex(k, arm, i + 1);
            add_face(sheet, inner, ring_vertex(k, arm, i), outer);
            if (i < k - 1) add_face(sheet, inner, outer, ring_vertex(k - 1, arm, i + 1));
        }
    for (int r = 0; r < rows; r++)
        for (int i = 0; i < n; i++) {
            int a = arm_vertex(n, rows, arm, r, i), b = arm_vertex(n, rows, arm, r + 1, i),
                c = arm_vertex(n, rows, arm, r + 1, i + 1), d = arm_vertex(n, rows, arm, r, i + 1);
            bool rising = 2 * i < n; /* towards the axis on both sides of it */
            add_face(sheet, a, b, rising ? c : d);
            add_face(sheet, rising ? a : b, c, d);
        }
    char name[8] = "arm1";
    name[3] = (char)('1' + arm);
    add_face_range(sheet, name, first, sheet->face_count - first);
}

bool solid_shape_starfish(SolidShapeDef def, MeshFile *mesh, Error *err)
{
    *mesh = (MeshFile){0};
    if (!check_def(&def, 0.06, 3, err)) return false;
    int n = def.n, rows = (int)rint(1.8 * n); /* cells 0.8 as long as an arm's are wide where it begins */
    MeshFile sheet =
        start_sheet(1 + ARMS * n * (n + 1) / 2 + ARMS * rows * (n + 1), ARMS * n * (n + 2 * rows), ARMS + 1);
    for (int arm = 0; arm < ARMS; arm++) {
        place_arm(&sheet, n, rows, arm, def.size / 2);
        add_arm(&sheet, n, rows, arm);
    }
    solid_shape_group(&sheet, "centre", 0, mem_alloc(1, sizeof(int)), 1);
    return extrude(&sheet, def.thickness, def.layers, mesh, err);
}
