/* The mesh of a result, for its report. */
#include "base/memory.h"
#include "report/report_private.h"
#include "view/show_mesh.h"
#include <math.h>
#include <string.h>

/* Positive numbers that span more than the one are told by their logarithms; what spans more than the other is 0 somewhere, but for
 * rounding. */
static const double LOG_LEAST = 1e3, LOG_MOST = 1e6;

/* What the page needs of the points: those of faces that are seen, and of the tetrahedra behind them. */
typedef struct Body {
    const ReportPart *part;
    ShowMesh mesh;
    int point_count, *place; /* [vertex] its place in the page; -1: none */
    int (*carriers)
        [4]; /* [face] vertices that its magnetisation goes with; the last one -1: three, and the normal */
} Body;

/* ---- Points ---- */

static void carry_by(Body *body, int face)
{
    const ClipBody *whole = &body->mesh.body;
    const int *corners = whole->faces[face];
    int cell = whole->cell_of_face ? whole->cell_of_face[face] : -1, *carrier = body->carriers[face];
    bool volume = cell >= 0 && !body->mesh.magnetization.faces && body->mesh.magnetization.cells;
    const int *tetrahedron = volume ? whole->cells + (size_t)cell * (size_t)whole->cell_nodes : NULL;
    for (int i = 0; i < 4; i++) carrier[i] = volume ? tetrahedron[i] : i < 3 ? corners[i] : -1;
}

static void number_points(Body *body)
{
    const ClipBody *whole = &body->mesh.body;
    ShowData *data = body->part->data;
    body->place = show_block(data, (size_t)whole->vertex_count, sizeof *body->place);
    body->carriers = show_block(data, (size_t)whole->face_count, sizeof *body->carriers);
    for (int f = 0; f < whole->face_count; f++) {
        carry_by(body, f);
        for (int i = 0; i < 3; i++) body->place[whole->faces[f][i]] = 1;
        for (int i = 0; i < 4; i++)
            if (body->carriers[f][i] >= 0) body->place[body->carriers[f][i]] = 1;
    }
    for (int v = 0; v < whole->vertex_count; v++) body->place[v] = body->place[v] ? body->point_count++ : -1;
}

static void add_faces(const Body *body, const char *key, const int *vertices, int width)
{
    size_t count = (size_t)body->mesh.body.face_count * (size_t)width;
    int *places = mem_alloc(count, sizeof *places);
    for (size_t i = 0; i < count; i++) places[i] = vertices[i] < 0 ? -1 : body->place[vertices[i]];
    document_indices(body->part->document, key, places, count, (size_t)width);
    mem_free(places);
}

/* Of all vertices, those that are shown. */
static void take_points(const Body *body, const double (*x)[3], double *row)
{
    for (int v = 0; v < body->mesh.body.vertex_count; v++)
        for (int i = 0; i < 3 && body->place[v] >= 0; i++) row[3 * body->place[v] + i] = x[v][i];
}

static Packed points_shape(const Body *body, int rows)
{
    return (Packed){(size_t)rows, 3 * (size_t)body->point_count, 3, 16, false};
}

static bool add_points(const Body *body, Error *err)
{
    const ReportPart *part = body->part;
    size_t width = 3 * (size_t)body->point_count;
    double *rows = mem_alloc((size_t)part->frame_count * width, sizeof *rows);
    bool ok = true;
    for (int k = 0; ok && k < part->frame_count; k++) {
        Array array;
        ok = result_read_step(part->data->result, "Points", part->frames[k], &array, err);
        if (!ok) break;
        ok = array.dims[0] == body->mesh.body.vertex_count ||
             error_set(err, "the result's frame %d has other points than its mesh", part->frames[k]);
        if (ok) take_points(body, (const double(*)[3])array.data, rows + (size_t)k * width);
        array_clear(&array);
    }
    if (ok) report_places(part, "points", rows, points_shape(body, part->frame_count));
    mem_free(rows);
    return ok;
}

static void add_rest(const Body *body)
{
    double *row = mem_alloc(3 * (size_t)body->point_count, sizeof *row);
    take_points(body, body->mesh.body.rest, row);
    report_places(body->part, "rest", row, points_shape(body, 1));
    mem_free(row);
}

/* ---- Numbers on the faces ---- */

/* False where the field is not one number per face, or says nothing anywhere: nothing is added. */
static bool read_field(const Body *body, const char *name, double *rows, const char **unit)
{
    const ReportPart *part = body->part;
    int faces = body->mesh.clip.face_count;
    bool any = false;
    part->show->field = name;
    for (int k = 0; k < part->frame_count; k++) {
        const double *values;
        const char *shown;
        if (!show_mesh_field(&body->mesh, part->frames[k], &values, &shown, unit, NULL) || !values)
            return false;
        for (int f = 0; f < faces; f++)
            rows[(size_t)k * (size_t)faces + (size_t)f] = values[f], any |= isfinite(values[f]);
    }
    return any;
}

static void add_field(const Body *body, const char *name)
{
    const ReportPart *part = body->part;
    size_t faces = (size_t)body->mesh.clip.face_count, count = (size_t)part->frame_count;
    const char *unit = "";
    double *rows = mem_alloc(count * faces, sizeof *rows);
    if (read_field(body, name, rows, &unit)) {
        bool still = report_is_static(rows, count, faces);
        double low, high;
        document_range(rows, count * faces, &low, &high);
        document_open(part->document, NULL, '{');
        document_text(part->document, "name", name);
        document_text(part->document, "unit", unit);
        document_packed(part->document, "values", rows,
                        (Packed){still ? 1 : count, faces, 1, still ? 16 : 8,
                                 low > 0 && high > LOG_LEAST * low && high < LOG_MOST * low});
        document_close(part->document);
    }
    mem_free(rows);
}

/* What faces are coloured by: first what the picture shows, with which the page opens, then all that the frames have. */
static bool add_fields(const Body *body, Error *err)
{
    static const char *const kinds[] = {"VTKHDF/CellData/", "VTKHDF/PointData/"};
    ShowData *data = body->part->data;
    char **paths;
    int count;
    const char *first = NULL, *unit;
    const double *values;
    body->part->show->field = NULL;
    if (!show_mesh_field(&body->mesh, -1, &values, &first, &unit, err) ||
        !result_list(data->result, &paths, &count, err))
        return false;
    document_open(body->part->document, "fields", '[');
    if (values) add_field(body, first);
    for (int k = 0; k < count; k++)
        for (int d = 0; d < 2; d++) {
            size_t length = strlen(kinds[d]);
            if (!strncmp(paths[k], kinds[d], length) && strcmp(paths[k] + length, first) != 0)
                add_field(body, show_text(data, "%s", paths[k] + length));
        }
    document_close(body->part->document);
    document_text(body->part->document, "opens", values ? first : "");
    mem_free(paths);
    return true;
}

/* Of each face, in material space; faces of a skin that have no layer carry none. */
static void take_magnetization(const Body *body, int step, double *M)
{
    const ShowMesh *mesh = &body->mesh;
    ShowRows of = show_mesh_magnetization(mesh, step);
    for (size_t f = 0; f < (size_t)mesh->body.face_count; f++) {
        const double *rows = of.faces;
        size_t row = f;
        if (!rows && mesh->body.cell_of_face) rows = of.cells, row = (size_t)mesh->body.cell_of_face[f];
        for (size_t i = 0; i < 3; i++) M[3 * f + i] = rows && !isnan(rows[3 * row]) ? rows[3 * row + i] : 0;
    }
}

/* That of each frame, where it changes; else the final one. */
static void add_magnetization(const Body *body)
{
    const ReportPart *part = body->part;
    Document *document = part->document;
    bool own = show_mesh_has_own(&body->mesh, "magnetization");
    size_t rows = own ? (size_t)part->frame_count : 1, width = 3 * (size_t)body->mesh.body.face_count;
    double *M = mem_alloc(rows * width, sizeof *M);
    for (size_t k = 0; k < rows; k++) take_magnetization(body, own ? part->frames[k] : -1, M + k * width);
    if (report_is_static(M, rows, width)) rows = 1;
    document_open(document, "magnetization", '{');
    document_packed(document, "values", M, (Packed){rows, width, 3, 16, false});
    add_faces(body, "carriers", body->carriers[0], 4);
    add_rest(body);
    document_close(document);
    mem_free(M);
}

/* ---- Targets ---- */

/* The targets of the cases, and which of them each frame has; x[case]: where its points are, NULL where that is not known. */
static void add_targets(const Body *body, const double (*const *x)[3])
{
    const ReportPart *part = body->part;
    int cases = part->cases.count, *row = show_block(part->data, (size_t)cases, sizeof *row), count = 0;
    size_t width = 3 * (size_t)body->point_count;
    double *rows = mem_alloc((size_t)cases * width, sizeof *rows);
    for (int c = 0; c < cases; c++) {
        const double(*target)[3] =
            x[c] ? show_case_target(part->data, part->cases.names[c], x[c], body->mesh.body.vertex_count)
                 : NULL;
        if (target) take_points(body, target, rows + (size_t)count * width);
        row[c] = target ? count++ : -1;
    }
    if (count) {
        document_open(part->document, "target", '{');
        report_places(part, "points", rows, points_shape(body, count));
        report_rows(part, row);
        document_close(part->document);
    }
    mem_free(rows);
}

static void add_clouds(const Body *body, const double (*const *x)[3])
{
    const ReportPart *part = body->part;
    Document *document = part->document;
    int cases = part->cases.count, *row = show_block(part->data, (size_t)cases, sizeof *row), clouds = 0,
        count;
    document_open(document, "clouds", '{');
    document_open(document, "sets", '[');
    for (int c = 0; c < cases; c++) {
        const double(*points)[3] = x[c] ? show_case_cloud_points(part->data, part->cases.names[c], x[c],
                                                                 body->mesh.body.vertex_count, &count)
                                        : NULL;
        if (points) report_places(part, NULL, points[0], (Packed){1, 3 * (size_t)count, 3, 16, false});
        row[c] = points ? clouds++ : -1;
    }
    document_close(document);
    report_rows(part, row);
    document_close(document);
}

static void add_cases(const Body *body)
{
    const ReportPart *part = body->part;
    int cases = part->cases.count;
    const double(**x)[3] = show_block(part->data, (size_t)cases, sizeof *x);
    for (int c = 0; c < cases; c++)
        x[c] = show_case_dataset(part->data, part->cases.names[c], "x",
                                 3 * (size_t)body->mesh.body.vertex_count);
    if (cases) add_targets(body, x), add_clouds(body, x);
}

/* Whole numbers [count] at a path, 0: as many as there are; NULL: they are not there. */
static const int *read_integers(ShowData *data, const char *path, int *count)
{
    Array array;
    if (!result_has(data->result, path) ||
        !result_read_as(data->result, path, ARRAY_INT32, 1, *count, &array, NULL))
        return NULL;
    *count = array.dims[0];
    return show_keep(data, array);
}

static bool grow(const int *offset, int count)
{
    for (int k = 0; k < count; k++)
        if (offset[k] < 0 || offset[k + 1] < offset[k]) return false;
    return true;
}

/* Named groups of faces, of a solid those of rows of its surface: which of these a face is, is told beside them. */
static void add_groups(const Body *body)
{
    ShowData *data = body->part->data;
    Document *document = body->part->document;
    Array names;
    int groups = 0, ends, members;
    const int *dim = read_integers(data, "slender/groups/dim", &groups);
    const int *offset =
        dim ? (ends = groups + 1, read_integers(data, "slender/groups/offsets", &ends)) : NULL;
    if (!offset || !grow(offset, groups)) return;
    members = offset[groups];
    const int *member = members ? read_integers(data, "slender/groups/members", &members) : NULL;
    if (!member || !result_read_as(data->result, "slender/groups/names", ARRAY_TEXT, 1, 0, &names, NULL))
        return;
    char *rest = NULL, *name = strtok_r(show_keep(data, names), "\n", &rest);
    if (body->mesh.part)
        document_indices(document, "part", body->mesh.part, (size_t)body->mesh.body.face_count, 1);
    document_open(document, "groups", '[');
    for (int g = 0; name && g < groups; g++, name = strtok_r(NULL, "\n", &rest)) {
        if (dim[g] != 2) continue;
        document_open(document, NULL, '{');
        document_text(document, "name", name);
        document_indices(document, "members", member + offset[g], (size_t)(offset[g + 1] - offset[g]), 1);
        document_close(document);
    }
    document_close(document);
}

static bool add_body(Body *body, Error *err)
{
    Document *document = body->part->document;
    number_points(body);
    document_open(document, "body", '{');
    add_faces(body, "faces", body->mesh.body.faces[0], 3);
    bool ok = add_points(body, err) && add_fields(body, err);
    if (ok && body->mesh.magnetic) add_magnetization(body);
    if (!ok) return false;
    add_groups(body);
    document_close(document);
    add_cases(body);
    return true;
}

bool report_body(const ReportPart *part, Error *err)
{
    if (!result_has(part->data->result, "slender/faces") || part->frame_count == 0) return true;
    Body body = {.part = part};
    bool ok = show_mesh_read(&body.mesh, part->data, err) && add_body(&body, err);
    show_mesh_clear(&body.mesh);
    return ok;
}
