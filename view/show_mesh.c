#include "view/show_mesh.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <math.h>
#include <string.h>

/* ---- Reading ---- */

/* Numbers from 0 to before `end`, or -1 where that is allowed. */
static bool are_below(const int *numbers, size_t count, int least, int end)
{
    for (size_t i = 0; i < count; i++)
        if (numbers[i] < least || numbers[i] >= end) return false;
    return true;
}

static bool read_cells(ShowMesh *mesh, Error *err)
{
    ClipBody *body = &mesh->body;
    ShowData *data = mesh->data;
    Array cells;
    if (!result_has(data->result, "slender/cells")) return true;
    if (!result_read_as(data->result, "slender/cells", ARRAY_INT32, 2, 0, &cells, err)) return false;
    size_t faces = (size_t)body->face_count;
    body->cells = show_keep(data, cells);
    body->cell_count = cells.dims[0], body->cell_nodes = cells.dims[1];
    body->cell_of_face = show_dataset(data, "slender/cell_of_face", ARRAY_INT32, faces);
    mesh->part = show_dataset(data, "slender/surface_of_face", ARRAY_INT32, faces);
    for (int f = 0; mesh->part && f < body->face_count; f++)
        mesh->part_count = mesh->part[f] >= mesh->part_count ? mesh->part[f] + 1 : mesh->part_count;
    bool fit = (body->cell_nodes == 4 || body->cell_nodes == 10) &&
               are_below(body->cells, array_count(&cells), 0, body->vertex_count) &&
               (!body->cell_of_face || are_below(body->cell_of_face, faces, 0, body->cell_count)) &&
               (!mesh->part || are_below(mesh->part, faces, 0, body->face_count));
    return fit || error_set(err, "the result's tetrahedra are not as slender writes them");
}

static bool read_body(ShowMesh *mesh, Error *err)
{
    Array faces, rest;
    ClipBody *body = &mesh->body;
    Result *result = mesh->data->result;
    if (!result_read_as(result, "slender/faces", ARRAY_INT32, 2, 3, &faces, err)) return false;
    body->faces = show_keep(mesh->data, faces);
    if (!result_read_as(result, "slender/rest", ARRAY_FLOAT64, 2, 3, &rest, err)) return false;
    body->rest = show_keep(mesh->data, rest);
    body->face_count = mesh->part_count = faces.dims[0], body->vertex_count = rest.dims[0];
    if (body->face_count == 0) return error_set(err, "the result's mesh has no faces");
    if (!are_below(body->faces[0], array_count(&faces), 0, body->vertex_count))
        return error_set(err, "the result's faces name vertices that it does not have");
    if (result_has(result, "slender/cells")) mesh->part_count = 0;
    return read_cells(mesh, err);
}

/* ---- Rows of numbers ---- */

/* A block of the design, `width` numbers a row. Of a solid all are rows of tetrahedra, but for the magnetisation of a skin:
 * that of the volume has another name then. */
static ShowRows design_rows(const ShowMesh *mesh, const char *name, int width)
{
    const ClipBody *body = &mesh->body;
    ShowData *data = mesh->data;
    bool skin =
        !strcmp(name, "magnetization") && result_has(data->result, "slender/design/volume_magnetization");
    const char *path = show_text(data, "slender/design/%s", name);
    size_t each = (size_t)width;
    if (body->cell_count && !skin)
        return (ShowRows){NULL, show_dataset(data, path, ARRAY_FLOAT64, each * (size_t)body->cell_count)};
    const double *own = show_dataset(data, path, ARRAY_FLOAT64, each * (size_t)mesh->part_count);
    if (!own || !mesh->part) return (ShowRows){own, NULL};
    double *values = show_block(data, each * (size_t)body->face_count, sizeof *values);
    for (int f = 0; f < body->face_count; f++)
        memcpy(values + each * (size_t)f, own + each * (size_t)mesh->part[f], each * sizeof *values);
    return (ShowRows){values, NULL};
}

static const double *lengths(ShowData *data, const double *vectors, int count)
{
    double *length = vectors ? show_block(data, (size_t)count, sizeof *length) : NULL;
    for (int i = 0; length && i < count; i++) length[i] = vec3_length(vec3_load(vectors + 3 * i));
    return length;
}

static ShowRows sizes(const ShowMesh *mesh, ShowRows vectors)
{
    return (ShowRows){lengths(mesh->data, vectors.faces, mesh->body.face_count),
                      lengths(mesh->data, vectors.cells, mesh->body.cell_count)};
}

bool show_mesh_has_own(const ShowMesh *mesh, const char *name)
{
    Array first;
    ShowData *data = mesh->data;
    const char *path = show_text(data, "VTKHDF/Steps/CellDataOffsets/%s", name);
    if (!result_has(data->result, path) ||
        !result_read_as(data->result, path, ARRAY_INT32, 1, 0, &first, NULL))
        return false;
    const int *row = show_keep(data, first);
    for (int k = 1; k < first.dims[0]; k++)
        if (row[k] != row[0]) return true;
    return false;
}

/* Rows of the final design as they are in a frame, -1: the final ones. */
static ShowRows rows_at(const ShowMesh *mesh, int step, const char *name, int width, ShowRows final)
{
    Array array;
    ShowData *data = mesh->data;
    size_t cells = (size_t)mesh->body.cell_count, each = (size_t)width;
    if (step < 0 || !show_mesh_has_own(mesh, name) ||
        !result_read_step(data->result, show_text(data, "CellData/%s", name), step, &array, NULL))
        return final;
    const double *rows = show_keep(data, array);
    if (array_count(&array) != each * (cells + (size_t)mesh->body.face_count)) return final;
    return (ShowRows){final.faces ? rows + each * cells : NULL, final.cells ? rows : NULL};
}

ShowRows show_mesh_magnetization(const ShowMesh *mesh, int step)
{
    return rows_at(mesh, step, "magnetization", 3, mesh->magnetization);
}

static bool has_own_row(const ShowMesh *mesh, ShowRows rows, int width, int shown)
{
    int face = mesh->clip.face[shown];
    return rows.faces && face >= 0 && !isnan(rows.faces[width * face]);
}

/* The row of a face that is shown: its own, or its tetrahedron's; NULL: it has none. */
static const double *row_of(const ShowMesh *mesh, ShowRows rows, int width, int shown)
{
    int cell = mesh->clip.cell[shown];
    if (has_own_row(mesh, rows, width, shown)) return rows.faces + width * mesh->clip.face[shown];
    return rows.cells && cell >= 0 ? rows.cells + width * cell : NULL;
}

static const double *shown_numbers(const ShowMesh *mesh, ShowRows rows)
{
    double *values = show_block(mesh->data, (size_t)mesh->clip.face_count, sizeof *values);
    for (int f = 0; f < mesh->clip.face_count; f++) {
        const double *row = row_of(mesh, rows, 1, f);
        values[f] = row ? *row : NAN;
    }
    return values;
}

/* ---- The mesh ---- */

/* Of a body with a magnetised skin the volume is told, too. */
static void read_magnetization(ShowMesh *mesh)
{
    ShowRows *M = &mesh->magnetization;
    *M = design_rows(mesh, "magnetization", 3);
    if (M->faces && mesh->body.cell_count) M->cells = design_rows(mesh, "volume_magnetization", 3).cells;
    for (int i = 0; M->faces && i < 3 * mesh->body.face_count; i++) mesh->magnetic |= M->faces[i] != 0;
    for (int i = 0; M->cells && i < 3 * mesh->body.cell_count; i++) mesh->magnetic |= M->cells[i] != 0;
}

/* What is on the eye's side is left out. */
static ClipPlane plane_of(const ShowDef *def)
{
    ClipPlane plane = def->clip;
    Vec3 eye = vec3_load(def->view);
    if (!(vec3_length(eye) > 0)) eye = CAMERA_THREE_QUARTER;
    if (vec3_dot(eye, vec3_load(plane.normal)) < 0)
        for (int i = 0; i < 3; i++) plane.normal[i] = -plane.normal[i];
    return plane;
}

/* False and a sentence where all of the body is on one side. */
static bool check_plane(const ClipBody *body, const ClipPlane *plane, Error *err)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    Vec3 normal = vec3_load(plane->normal), point = vec3_load(plane->point);
    bool before = false, beyond = false;
    for (int v = 0; v < body->vertex_count; v++) {
        double side = vec3_dot(normal, vec3_sub(vec3_load(body->rest[v]), point));
        before |= side<0, beyond |= side> 0;
        for (int i = 0; i < 3; i++) {
            low[i] = fmin(low[i], body->rest[v][i]);
            high[i] = fmax(high[i], body->rest[v][i]);
        }
    }
    return (before && beyond) || !clip_is_given(plane) ||
           error_set(err,
                     "the plane does not cut the body, which at rest reaches from (%.4g, %.4g, %.4g) to "
                     "(%.4g, %.4g, %.4g) m",
                     low[0], low[1], low[2], high[0], high[1], high[2]);
}

bool show_mesh_read(ShowMesh *mesh, ShowData *data, Error *err)
{
    *mesh = (ShowMesh){.data = data};
    ClipPlane plane = plane_of(data->def);
    if (!read_body(mesh, err) || !check_plane(&mesh->body, &plane, err)) return false;
    mesh->clip = clip_create(&mesh->body, &plane);
    read_magnetization(mesh);
    return true;
}

void show_mesh_clear(ShowMesh *mesh)
{
    clip_clear(&mesh->clip);
}

const double (*show_mesh_points(const ShowMesh *mesh, const double (*x)[3]))[3]
{
    if (!x) return NULL;
    double(*points)[3] = show_block(mesh->data, (size_t)mesh->clip.point_count, sizeof *points);
    clip_points(&mesh->clip, x, points);
    return (const double(*)[3])points;
}

/* ---- What is drawn on the faces ---- */

/* Three edges that M is a sum of: of a face two and its unit normal, of a tetrahedron those from its first corner. */
typedef struct Edges {
    Vec3 e[3];
} Edges;

static Edges edges_of(const double (*x)[3], const int *v, bool solid)
{
    Vec3 x0 = vec3_load(x[v[0]]);
    Edges edges = {{vec3_sub(vec3_load(x[v[1]]), x0), vec3_sub(vec3_load(x[v[2]]), x0)}};
    edges.e[2] = solid ? vec3_sub(vec3_load(x[v[3]]), x0) : vec3_unit(vec3_cross(edges.e[0], edges.e[1]));
    return edges;
}

/* M = a e1 + b e2 + c e3 at rest is a e1' + b e2' + c e3' now. */
static Vec3 carry(Edges rest, Edges now, Vec3 M)
{
    Vec3 carried = {0, 0, 0};
    double det = vec3_dot(rest.e[0], vec3_cross(rest.e[1], rest.e[2]));
    for (int i = 0; i < 3; i++) {
        double part = vec3_dot(M, vec3_cross(rest.e[(i + 1) % 3], rest.e[(i + 2) % 3])) / det;
        carried = vec3_axpy(part, now.e[i], carried);
    }
    return carried;
}

const double (*show_mesh_carried(const ShowMesh *mesh, int step, const double (*x)[3]))[3]
{
    ShowRows rows = show_mesh_magnetization(mesh, step);
    const ClipBody *body = &mesh->body;
    double(*vectors)[3] = show_block(mesh->data, (size_t)mesh->clip.face_count, sizeof *vectors);
    for (int f = 0; f < mesh->clip.face_count; f++) {
        const double *M = row_of(mesh, rows, 3, f);
        if (!M) continue;
        bool solid = !has_own_row(mesh, rows, 3, f);
        const int *v = solid ? body->cells + (size_t)mesh->clip.cell[f] * (size_t)body->cell_nodes
                             : body->faces[mesh->clip.face[f]];
        vec3_store(vectors[f], carry(edges_of(body->rest, v, solid), edges_of(x, v, solid), vec3_load(M)));
    }
    return (const double(*)[3])vectors;
}

static bool varies(const double *values, int count)
{
    for (int f = 1; values && f < count; f++)
        if (fabs(values[f] - values[0]) > 1e-9 * fabs(values[0])) return true;
    return false;
}

/* The sizes of vectors at the points, as the mean of a face's corners. */
static const double *means_of_corners(const ShowMesh *mesh, const double (*vectors)[3])
{
    const Clip *clip = &mesh->clip;
    const double(*at)[3] = show_mesh_points(mesh, vectors);
    double *mean = show_block(mesh->data, (size_t)clip->face_count, sizeof *mean);
    for (int f = 0; f < clip->face_count; f++)
        for (int i = 0; i < 3; i++) mean[f] += vec3_length(vec3_load(at[clip->faces[f][i]])) / 3;
    return mean;
}

/* What there is instead. */
static bool refuse_field(ShowData *data, const char *name, Error *err)
{
    static const char *const kinds[] = {"VTKHDF/CellData/", "VTKHDF/PointData/"};
    char **paths, *names = mem_text("");
    int count;
    if (!result_list(data->result, &paths, &count, err)) return mem_free(names), false;
    for (int k = 0; k < count; k++)
        for (int d = 0; d < 2; d++)
            if (!strncmp(paths[k], kinds[d], strlen(kinds[d])))
                names = mem_join(mem_join(names, *names ? ", " : "", ""), paths[k] + strlen(kinds[d]), "");
    error_set(err, "the frames of the result have no '%s', only %s%s", name, names,
              strstr(names, "von_mises") ? ""
                                         : "; those of motions have stresses with `output: {stress: true}`");
    mem_free(paths);
    mem_free(names);
    return false;
}

/* Of a frame, -1: the last: one number per cell of CellData (a solid's tetrahedra are before the faces of its skin), or
 * vectors of PointData. */
static bool frame_field(const ShowMesh *mesh, int step, const char *name, const double **values,
                        const char **unit, Error *err)
{
    Array array;
    ShowData *data = mesh->data;
    const ClipBody *body = &mesh->body;
    bool points = result_has(data->result, show_text(data, "VTKHDF/PointData/%s", name));
    if (!points && !result_has(data->result, show_text(data, "VTKHDF/CellData/%s", name)))
        return refuse_field(data, name, err);
    if (step < 0) step = result_step_count(data->result) - 1;
    const char *path = show_text(data, "%s/%s", points ? "PointData" : "CellData", name);
    if (!result_read_step(data->result, path, step, &array, err)) return false;
    const double *numbers = show_keep(data, array);
    *unit = array.unit && array.unit[0] ? array.unit : "";
    if (points && array_is(&array, ARRAY_FLOAT64, 2, 3) && array.dims[0] == body->vertex_count)
        return *values = means_of_corners(mesh, (const double(*)[3])numbers), true;
    bool fits = !points && array.type == ARRAY_FLOAT64 &&
                array_count(&array) == (size_t)(body->cell_count + body->face_count);
    if (!fits) return error_set(err, "'%s' is neither one number per face nor a vector per point", name);
    return *values = shown_numbers(mesh, (ShowRows){numbers + body->cell_count, numbers}), true;
}

/* Parameters of the design, in a frame or the final ones: of each face a number, or a vector's length. A solid's young is
 * two blocks, its own and its film's: the frames have them as one. */
static bool design_field(const ShowMesh *mesh, int step, const char *name, const double **values,
                         const char **unit)
{
    static const char *const numbers[][2] = {{"young", "Pa"}, {"thickness", "m"}, {"density", "kg/m^3"}};
    ShowRows rows = {NULL, NULL};
    *unit = "A/m";
    for (int k = 0; k < 3 && !mesh->body.cell_count; k++)
        if (!strcmp(name, numbers[k][0]))
            rows = rows_at(mesh, step, name, 1, design_rows(mesh, name, 1)), *unit = numbers[k][1];
    if (!strcmp(name, "magnetization")) rows = sizes(mesh, show_mesh_magnetization(mesh, step));
    if (!strcmp(name, "volume_magnetization"))
        rows = sizes(mesh, rows_at(mesh, step, "magnetization", 3, design_rows(mesh, name, 3)));
    return (rows.faces || rows.cells) && (*values = shown_numbers(mesh, rows), true);
}

/* What differs from place to place. */
static const char *telling_field(const ShowMesh *mesh)
{
    static const char *const names[] = {"young", "thickness"};
    for (int k = 0; k < 2; k++) {
        ShowRows rows = design_rows(mesh, names[k], 1);
        if (varies(rows.faces, mesh->body.face_count) || varies(rows.cells, mesh->body.cell_count))
            return names[k];
    }
    return mesh->magnetic ? "magnetization" : "none";
}

bool show_mesh_field(const ShowMesh *mesh, int step, const double **values, const char **name,
                     const char **unit, Error *err)
{
    *name = mesh->data->def->field, *unit = "", *values = NULL;
    if (!*name) *name = telling_field(mesh);
    if (!strcmp(*name, "none") || design_field(mesh, step, *name, values, unit)) return true;
    *unit = "";
    return frame_field(mesh, step, *name, values, unit, err);
}
