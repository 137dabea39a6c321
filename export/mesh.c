#include "export/mesh.h"
#include "base/memory.h"
#include "io/result_groups.h"
#include <math.h>

/* Of a solid: faces are those of its skin, groups those of all its boundary; of the others the faces that are shown. */
static bool take_shown(Result *result, MeshFile *file, Error *err)
{
    Array of;
    if (!result_has(result, "slender/surface_of_face")) return true;
    if (!result_read_as(result, "slender/surface_of_face", ARRAY_INT32, 1, 0, &of, err)) return false;
    const int *surface = of.data;
    bool ok = of.dims[0] == file->face_count ||
              error_set(err, "slender/surface_of_face is not as slender writes it");
    for (int g = 0; ok && g < file->group_count; g++) {
        MeshGroup *group = &file->groups[g];
        if (group->dim != 2) continue;
        int most = 0, shown = 0;
        for (int k = 0; k < group->count; k++) most = group->members[k] > most ? group->members[k] : most;
        bool *in = mem_alloc((size_t)most + 1, sizeof *in);
        for (int k = 0; k < group->count; k++) in[group->members[k]] = true;
        mem_free(group->members);
        group->members = mem_alloc((size_t)file->face_count, sizeof *group->members);
        for (int f = 0; f < file->face_count; f++)
            if (surface[f] >= 0 && surface[f] <= most && in[surface[f]]) group->members[shown++] = f;
        group->count = shown;
        mem_free(in);
    }
    array_clear(&of);
    return ok;
}

/* Faces, tetrahedra and groups of a result; points are the caller's. */
static bool read_faces(Result *result, int vertices, MeshFile *file, Error *err)
{
    Array faces, cells = {0}, surface = {0};
    file->vertex_count = vertices;
    if (!result_read_as(result, "slender/faces", ARRAY_INT32, 2, 3, &faces, err)) return false;
    bool ok = true;
    if (result_has(result, "slender/cells"))
        ok = result_read_as(result, "slender/cells", ARRAY_INT32, 2, 0, &cells, err) &&
             result_read_as(result, "slender/surface", ARRAY_INT32, 2, 3, &surface, err);
    file->face_count = faces.dims[0], file->cell_count = cells.dims[0], file->cell_nodes = cells.dims[1];
    file->faces = mem_copy(faces.data, (size_t)file->face_count, sizeof *file->faces);
    if (ok && cells.data)
        file->cells =
            mem_copy(cells.data, (size_t)(file->cell_count * file->cell_nodes), sizeof *file->cells);
    for (int i = 0; ok && i < file->cell_count * file->cell_nodes; i++)
        ok = (file->cells[i] >= 0 && file->cells[i] < vertices) ||
             error_set(err, "slender/cells is not as slender writes it");
    const int count[4] = {vertices, 0, cells.data ? surface.dims[0] : file->face_count, file->cell_count};
    ok = ok && result_groups_read(result, count, file, err) && take_shown(result, file, err);
    for (int f = 0; ok && f < 3 * file->face_count; f++)
        ok = (file->faces[f / 3][f % 3] >= 0 && file->faces[f / 3][f % 3] < vertices) ||
             error_set(err, "slender/faces is not as slender writes it");
    array_clear(&faces);
    array_clear(&cells);
    array_clear(&surface);
    return ok;
}

static bool read_points(Result *result, int frame, Array *points, Error *err)
{
    int count = result_step_count(result);
    if (frame >= count)
        return error_set(err, "there is no frame %d: the result has %d, from 0", frame, count);
    if (!result_has(result, "slender/faces"))
        return error_set(
            err,
            "there is no mesh in it: rods are exported as .glb, numbers as .csv, with --dataset, and .npz");
    if (frame >= 0) return result_read_step(result, "Points", frame, points, err);
    if (frame == MESH_FINAL && !result_check_state(result, err)) return false;
    return result_read_as(result, frame == MESH_REST ? "slender/rest" : "slender/state/x", ARRAY_FLOAT64, 2,
                          3, points, err);
}

bool export_check_points(const double (*x)[3], int count, Error *err)
{
    for (int i = 0; i < 3 * count; i++)
        if (!isfinite(x[i / 3][i % 3])) return error_set(err, "point %d is nowhere: it is no number", i / 3);
    return true;
}

bool export_mesh_read(Result *result, int frame, MeshFile *file, Error *err)
{
    Array points = {0};
    *file = (MeshFile){0};
    if (!read_points(result, frame, &points, err)) return false;
    bool ok = read_faces(result, points.dims[0], file, err) &&
              export_check_points((const double(*)[3])points.data, points.dims[0], err);
    file->vertices = mem_copy(points.data, (size_t)points.dims[0], sizeof *file->vertices);
    array_clear(&points);
    return ok;
}

/* Numbers of all cells, tetrahedra first, in a frame or the last one. */
static bool read_cells(Result *result, int frame, const char *name, int width, const MeshFile *file,
                       Array *rows, Error *err)
{
    int step = frame < 0 ? result_step_count(result) - 1 : frame;
    if (step < 0 && !result_check_state(result, err)) return false;
    if (!result_read_step(result, name, step, rows, err)) return false;
    bool fits = array_is(rows, ARRAY_FLOAT64, width > 1 ? 2 : 1, width > 1 ? width : 0) &&
                rows->dims[0] == file->cell_count + file->face_count;
    if (!fits) array_clear(rows);
    return fits || error_set(err, "%s is not as slender writes it", name);
}

bool export_magnetization_read(Result *result, int frame, const MeshFile *file, Array *M, Error *err)
{
    return read_cells(result, frame, "CellData/magnetization", 3, file, M, err);
}

/* The final one has all its digits; frames have theirs where it differs from face to face, or a design looks for it. */
bool export_thickness_read(Result *result, int frame, const MeshFile *file, Array *thickness, Error *err)
{
    static const char path[] = "slender/design/thickness";
    *thickness = (Array){0};
    bool final = frame < 0 && result_has(result, path);
    if (!final && result_has(result, "VTKHDF/CellData/thickness"))
        return read_cells(result, frame, "CellData/thickness", 1, file, thickness, err);
    if (!result_has(result, path)) return true;
    if (!result_read_as(result, path, ARRAY_FLOAT64, 1, 0, thickness, err)) return false;
    return thickness->dims[0] == file->face_count || error_set(err, "%s is not as slender writes it", path);
}
