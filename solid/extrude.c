/* Sheets of triangles that become solids. */
#include "base/memory.h"
#include "base/vec3.h"
#include "solid/shapes.h"
#include <string.h>

/* What is made of a sheet. */
typedef struct Prisms {
    const Mesh *sheet;
    int layers;
    int *wall; /* [edge] its number among those on the boundary; -1: within */
    int wall_count;
    MeshFile *mesh;
} Prisms;

static int node(const Prisms *p, int layer, int vertex)
{
    return layer * p->sheet->vertex_count + vertex;
}

static void find_walls(Prisms *p)
{
    p->wall = mem_alloc((size_t)p->sheet->edge_count, sizeof *p->wall);
    for (int e = 0; e < p->sheet->edge_count; e++)
        p->wall[e] = mesh_edge_is_boundary(p->sheet, e) ? p->wall_count++ : -1;
}

/* ---- Elements ---- */

/* Three tetrahedra between a triangle and its copy above: each has a step up at one of the corners, in ascending order. */
static void add_prism(const Prisms *p, const int *face, int layer, int *cells)
{
    int v[3] = {face[0], face[1], face[2]};
    bool odd = false;
    for (int k = 0; k < 3; k++) {
        int *a = &v[k == 1], *b = a + 1, old = *a; /* 01 12 01 */
        if (*a <= *b) continue;
        *a = *b, *b = old;
        odd = !odd;
    }
    for (int step = 0; step < 3; step++) {
        int *to = cells + 4 * (2 - step), count = 0;
        for (int i = 0; i <= step; i++) to[count++] = node(p, layer, v[i]);
        for (int i = step; i < 3; i++) to[count++] = node(p, layer + 1, v[i]);
        if (odd == (step != 1)) { /* the one in the middle is the odd one of an even triangle */
            int old = to[2];
            to[2] = to[3], to[3] = old;
        }
    }
}

/* Layer by layer: the two prisms of a cell of the sheet stand side by side, and are patches of one (tet_patches.h). */
static void add_cells(const Prisms *p)
{
    MeshFile *mesh = p->mesh;
    mesh->cell_nodes = 4;
    mesh->cell_count = 3 * p->layers * p->sheet->face_count;
    mesh->cells = mem_alloc(4 * (size_t)mesh->cell_count, sizeof *mesh->cells);
    for (int l = 0; l < p->layers; l++)
        for (int f = 0; f < p->sheet->face_count; f++)
            add_prism(p, p->sheet->faces[f], l, mesh->cells + 12 * (size_t)(l * p->sheet->face_count + f));
}

static void add_face(MeshFile *mesh, int a, int b, int c)
{
    memcpy(mesh->faces[mesh->face_count++], (int[3]){a, b, c}, sizeof *mesh->faces);
}

/* The walls below an edge that its face runs along from a to b. */
static void add_walls(const Prisms *p, int a, int b)
{
    for (int l = 0; l < p->layers; l++) {
        int low[2] = {node(p, l, a), node(p, l, b)}, high[2] = {node(p, l + 1, a), node(p, l + 1, b)};
        add_face(p->mesh, low[0], low[1], high[a < b]);
        add_face(p->mesh, low[a > b], high[1], high[0]);
    }
}

static void add_faces(const Prisms *p)
{
    const Mesh *sheet = p->sheet;
    int count = 2 * sheet->face_count + 2 * p->layers * p->wall_count;
    p->mesh->faces = mem_alloc((size_t)count, sizeof *p->mesh->faces);
    for (int side = 0; side < 2; side++)
        for (int f = 0; f < sheet->face_count; f++) {
            const int *v = sheet->faces[f];
            int at = side ? p->layers : 0;
            add_face(p->mesh, node(p, at, v[0]), node(p, at, v[side ? 1 : 2]), node(p, at, v[side ? 2 : 1]));
        }
    for (int e = 0; e < sheet->edge_count; e++) {
        bool along = sheet->edge_faces[e][0] >= 0;
        if (p->wall[e] >= 0) add_walls(p, sheet->edges[e][!along], sheet->edges[e][along]);
    }
}

/* ---- Groups ---- */

void solid_shape_group(MeshFile *mesh, const char *name, int dim, int *members, int count)
{
    if (count)
        mesh->groups[mesh->group_count++] = (MeshGroup){mem_text(name), dim, count, members};
    else
        mem_free(members);
}

/* The faces of the walls at an edge. */
static int walls_at(const Prisms *p, int edge, int *faces)
{
    if (edge < 0 || p->wall[edge] < 0) return 0;
    int each = 2 * p->layers, first = 2 * p->sheet->face_count + p->wall[edge] * each;
    for (int i = 0; i < each; i++) faces[i] = first + i;
    return each;
}

static void group_nodes(const Prisms *p, const MeshGroup *of)
{
    int vertices = of->dim == 1 ? 2 * of->count : of->count, count = 0;
    int *members = mem_alloc((size_t)vertices * (size_t)(p->layers + 1), sizeof *members);
    for (int l = 0; l <= p->layers; l++)
        for (int i = 0; i < vertices; i++) members[count++] = node(p, l, of->members[i]);
    solid_shape_group(p->mesh, of->name, 0, members, count);
}

static void group_walls(const Prisms *p, const MeshGroup *of)
{
    int *members = mem_alloc((size_t)of->count * 2 * (size_t)p->layers, sizeof *members), count = 0;
    for (int i = 0; i < of->count; i++)
        count +=
            walls_at(p, mesh_edge(p->sheet, of->members[2 * i], of->members[2 * i + 1]), members + count);
    solid_shape_group(p->mesh, of->name, 2, members, count);
}

static void group_faces(const Prisms *p, const MeshGroup *of)
{
    int each = 3 * p->layers, count = 0, cell_count = 0;
    int *faces = mem_alloc((size_t)of->count * (size_t)(2 + 2 * each), sizeof *faces);
    int *cells = mem_alloc((size_t)of->count * (size_t)each, sizeof *cells);
    for (int i = 0; i < of->count; i++) {
        int f = of->members[i];
        faces[count++] = f, faces[count++] = p->sheet->face_count + f;
        for (int k = 0; k < 3; k++) count += walls_at(p, p->sheet->face_edges[f][k], faces + count);
        for (int k = 0; k < each; k++) cells[cell_count++] = 3 * (k / 3 * p->sheet->face_count + f) + k % 3;
    }
    solid_shape_group(p->mesh, of->name, 2, faces, count);
    solid_shape_group(p->mesh, of->name, 3, cells, cell_count);
}

static void add_groups(const Prisms *p)
{
    const Mesh *sheet = p->sheet;
    p->mesh->groups = mem_alloc(2 * (size_t)sheet->group_count + 6, sizeof *p->mesh->groups);
    for (int g = 0; g < sheet->group_count; g++) {
        const MeshGroup *group = &sheet->groups[g];
        if (group->dim == 1) group_walls(p, group);
        if (group->dim < 2) group_nodes(p, group);
        if (group->dim == 2) group_faces(p, group);
    }
    for (int side = 0; side < 2; side++) {
        int count = sheet->face_count, *members = mem_alloc((size_t)count, sizeof *members);
        for (int f = 0; f < count; f++) members[f] = side * count + f;
        solid_shape_group(p->mesh, side ? "top" : "bottom", 2, members, count);
    }
}

/* ---- All ---- */

bool solid_shape_check_count(double count, Error *err)
{
    if (count <= SHAPE_MAX_FACES) return true;
    return error_set(err, "%.0f tetrahedra are too many; a generated solid has at most %d", count,
                     SHAPE_MAX_FACES);
}

bool solid_shape_prisms(const Mesh *sheet, int layers, MeshFile *mesh, Error *err)
{
    *mesh = (MeshFile){0};
    if (layers < 1) return error_set(err, "a solid has at least one layer, not %d", layers);
    if (!solid_shape_check_count(3.0 * layers * sheet->face_count, err)) return false;
    for (int g = 0; g < sheet->group_count; g++)
        if (!strcmp(sheet->groups[g].name, "bottom") || !strcmp(sheet->groups[g].name, "top"))
            return error_set(err,
                             "the sheet has a group '%s', which is the name of a side of what is made of it: "
                             "rename it",
                             sheet->groups[g].name);
    Prisms p = {.sheet = sheet, .layers = layers, .mesh = mesh};
    mesh->vertex_count = (layers + 1) * sheet->vertex_count;
    mesh->vertices = mem_alloc((size_t)mesh->vertex_count, sizeof *mesh->vertices);
    mesh->path = mem_text("solid");
    find_walls(&p);
    add_cells(&p);
    add_faces(&p);
    add_groups(&p);
    mem_free(p.wall);
    return true;
}

/* Unit normals of the vertices; a vertex that has none is refused. */
static bool find_normals(const Mesh *sheet, Vec3 *normal, Error *err)
{
    for (int f = 0; f < sheet->face_count; f++) {
        const int *v = sheet->faces[f];
        Vec3 a = vec3_load(sheet->rest[v[0]]);
        Vec3 area =
            vec3_cross(vec3_sub(vec3_load(sheet->rest[v[1]]), a), vec3_sub(vec3_load(sheet->rest[v[2]]), a));
        for (int i = 0; i < 3; i++) normal[v[i]] = vec3_add(normal[v[i]], area);
    }
    for (int v = 0; v < sheet->vertex_count; v++) {
        if (vec3_length(normal[v]) == 0)
            return error_set(
                err,
                "the faces at vertex %d of the sheet face all ways: there is no normal to make it thick "
                "along",
                sheet->file_vertex[v]);
        normal[v] = vec3_unit(normal[v]);
    }
    return true;
}

/* Where it is curved inwards more narrowly than it is thick, prisms turn inside out. */
static bool check_prisms(const Mesh *sheet, double thickness, const MeshFile *mesh, Error *err)
{
    for (int t = 0; t < mesh->cell_count; t++) {
        const int *v = mesh->cells + 4 * (size_t)t, *corners = sheet->faces[t / 3 % sheet->face_count];
        Vec3 e[3], x0 = vec3_load(mesh->vertices[v[0]]);
        for (int i = 0; i < 3; i++) e[i] = vec3_sub(vec3_load(mesh->vertices[v[i + 1]]), x0);
        if (vec3_dot(e[0], vec3_cross(e[1], e[2])) > 0) continue;
        return error_set(err,
                         "over face %d of the sheet (vertices %d, %d, %d) a thickness of %g m folds over: it "
                         "is curved more narrowly than that along its normals; take less, or turn its faces "
                         "round",
                         t / 3 % sheet->face_count, sheet->file_vertex[corners[0]],
                         sheet->file_vertex[corners[1]], sheet->file_vertex[corners[2]], thickness);
    }
    return true;
}

bool solid_shape_extrude(const Mesh *sheet, double thickness, int layers, MeshFile *mesh, Error *err)
{
    *mesh = (MeshFile){0};
    if (!(thickness > 0 && isfinite(thickness)))
        return error_set(err, "a solid has a thickness above 0, not %g m", thickness);
    Vec3 *normal = mem_alloc((size_t)sheet->vertex_count, sizeof *normal);
    bool ok = find_normals(sheet, normal, err) && solid_shape_prisms(sheet, layers, mesh, err);
    for (int i = 0; ok && i < mesh->vertex_count; i++) {
        int layer = i / sheet->vertex_count, v = i % sheet->vertex_count;
        vec3_store(mesh->vertices[i],
                   vec3_axpy(thickness * layer / layers, normal[v], vec3_load(sheet->rest[v])));
    }
    mem_free(normal);
    ok = ok && check_prisms(sheet, thickness, mesh, err);
    if (!ok) mesh_file_clear(mesh);
    return ok;
}
