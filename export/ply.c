/* Source: G. Turk, The PLY Polygon File Format (1994). */
#include "base/memory.h"
#include "export/export.h"
#include "export/mesh.h"
#include "io/mark.h"
#include "io/text.h"
#include <math.h>
#include <string.h>

/* A field of the frame: `width` numbers for each point, or each face. */
typedef struct PlyField {
    const char *name; /* borrowed of the list of paths */
    int width;
    double *rows; /* [point or face][width]; owned */
} PlyField;

typedef struct Ply {
    MeshFile mesh;
    const int *cell_of_face;  /* [face]; NULL: there are none */
    PlyField *points, *faces; /* owned */
    int point_field_count, face_field_count;
} Ply;

/* Of a face its own row, or that of the tetrahedron behind it. */
static const double *row_of(const Ply *ply, const Array *array, int width, int face)
{
    const double *rows = array->data, *own = rows + (size_t)width * (size_t)(ply->mesh.cell_count + face);
    bool other = isnan(*own) && ply->cell_of_face;
    return other ? rows + (size_t)width * (size_t)ply->cell_of_face[face] : own;
}

static bool add_field(Ply *ply, const char *name, const Array *array, bool points, Error *err)
{
    const MeshFile *mesh = &ply->mesh;
    int count = points ? mesh->vertex_count : mesh->face_count, width = array->rank == 2 ? array->dims[1] : 1;
    bool fits = array->type == ARRAY_FLOAT64 && (array->rank == 1 || array->rank == 2) &&
                array->dims[0] == (points ? count : count + mesh->cell_count);
    if (!fits) return error_set(err, "%s is not as slender writes it", name);
    double *rows = mem_alloc((size_t)count * (size_t)width, sizeof *rows);
    for (int i = 0; i < count; i++)
        memcpy(rows + (size_t)width * (size_t)i,
               points ? (const double *)array->data + (size_t)width * (size_t)i
                      : row_of(ply, array, width, i),
               (size_t)width * sizeof *rows);
    PlyField **list = points ? &ply->points : &ply->faces;
    int *fields = points ? &ply->point_field_count : &ply->face_field_count;
    *list = mem_resize(*list, (size_t)*fields, (size_t)*fields + 1, sizeof **list);
    (*list)[(*fields)++] = (PlyField){name, width, rows};
    return true;
}

/* All that the frame says. */
static bool read_fields(Ply *ply, Result *result, int frame, char *const *paths, int count, Error *err)
{
    static const char *const kinds[] = {"CellData/", "PointData/"};
    int steps = result_step_count(result);
    bool ok = true;
    for (int k = 0; ok && steps && k < 2 * count; k++) {
        const char *kind = kinds[k % 2], *path = paths[k / 2] + strlen("VTKHDF/");
        if (strncmp(paths[k / 2], "VTKHDF/", strlen("VTKHDF/")) || strncmp(path, kind, strlen(kind)))
            continue;
        Array array;
        ok = result_read_step(result, path, frame < 0 ? steps - 1 : frame, &array, err);
        if (!ok) break;
        ok = add_field(ply, path + strlen(kind), &array, k % 2, err);
        array_clear(&array);
    }
    return ok;
}

/* "property double magnetization_x" */
static void add_properties(Text *header, const PlyField *fields, int count)
{
    static const char *const three[] = {"_x", "_y", "_z"}, *const six[] = {"_xx", "_yy", "_zz",
                                                                           "_xy", "_yz", "_xz"};
    for (int k = 0; k < count; k++)
        for (int i = 0; i < fields[k].width; i++) {
            int width = fields[k].width;
            text_add(header, "property double %s", fields[k].name);
            if (width == 3 || width == 6)
                text_add(header, "%s\n", width == 3 ? three[i] : six[i]);
            else
                text_add(header, width == 1 ? "\n" : "_%d\n", i);
        }
}

static void add_rows(Bytes *file, const PlyField *fields, int count, int row)
{
    for (int k = 0; k < count; k++) {
        size_t width = (size_t)fields[k].width;
        bytes_add(file, fields[k].rows + width * (size_t)row, width * sizeof(double));
    }
}

static void write_file(const Ply *ply, Bytes *file)
{
    const MeshFile *mesh = &ply->mesh;
    Text header = {0};
    text_add(&header, "ply\nformat binary_little_endian 1.0\n" MARK_PLY(SLENDER_VERSION));
    text_add(&header, "element vertex %d\nproperty double x\nproperty double y\nproperty double z\n",
             mesh->vertex_count);
    add_properties(&header, ply->points, ply->point_field_count);
    text_add(&header, "element face %d\nproperty list uchar int vertex_indices\n", mesh->face_count);
    add_properties(&header, ply->faces, ply->face_field_count);
    text_add(&header, "end_header\n");
    bytes_add_text(file, header.text);
    mem_free(header.text);
    for (int v = 0; v < mesh->vertex_count; v++) {
        bytes_add(file, mesh->vertices[v], sizeof *mesh->vertices);
        add_rows(file, ply->points, ply->point_field_count, v);
    }
    for (int f = 0; f < mesh->face_count; f++) {
        bytes_add_u8(file, 3);
        bytes_add(file, mesh->faces[f], sizeof *mesh->faces);
        add_rows(file, ply->faces, ply->face_field_count, f);
    }
}

static void clear_fields(PlyField *fields, int count)
{
    for (int k = 0; k < count; k++) mem_free(fields[k].rows);
    mem_free(fields);
}

static bool read_sides(Result *result, Ply *ply, Array *cell_of_face, Error *err)
{
    static const char path[] = "slender/cell_of_face";
    if (!result_has(result, path)) return true;
    if (!result_read_as(result, path, ARRAY_INT32, 1, 0, cell_of_face, err)) return false;
    const int *cell = ply->cell_of_face = cell_of_face->data;
    bool ok = cell_of_face->dims[0] == ply->mesh.face_count;
    for (int f = 0; ok && f < ply->mesh.face_count; f++) ok = cell[f] >= 0 && cell[f] < ply->mesh.cell_count;
    return ok || error_set(err, "%s is not as slender writes it", path);
}

bool export_ply(Result *result, int frame, Bytes *file, Error *err)
{
    Ply ply = {0};
    Array cell_of_face = {0};
    char **paths = NULL;
    int count;
    bool ok = export_mesh_read(result, frame, &ply.mesh, err) &&
              read_sides(result, &ply, &cell_of_face, err) && result_list(result, &paths, &count, err) &&
              read_fields(&ply, result, frame, paths, count, err);
    if (ok) write_file(&ply, file);
    clear_fields(ply.points, ply.point_field_count);
    clear_fields(ply.faces, ply.face_field_count);
    mem_free(paths);
    array_clear(&cell_of_face);
    mesh_file_clear(&ply.mesh);
    return ok;
}
