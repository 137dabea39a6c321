#include "io/result_vtk.h"
#include "base/memory.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { VTK_POLY_LINE = 4, VTK_TRIANGLE = 5, VTK_TETRA = 10, VTK_QUADRATIC_TETRA = 24 };
enum { XDMF_POLYLINE = 2, XDMF_TRIANGLE = 4, XDMF_TETRAHEDRON = 6, XDMF_TETRAHEDRON_10 = 38 };

/* ---- Cells ---- */

static void read_triangles(VtkCells *cells, const Array *faces)
{
    cells->count = faces->dims[0];
    cells->uniform = 3;
    cells->id_count = 3 * cells->count;
    cells->ids = mem_copy(faces->data, (size_t)cells->id_count, sizeof *cells->ids);
    cells->offsets = mem_alloc((size_t)cells->count + 1, sizeof *cells->offsets);
    for (int f = 0; f <= cells->count; f++) cells->offsets[f] = 3 * f;
    cells->types = mem_alloc((size_t)cells->count, sizeof *cells->types);
    for (int f = 0; f < cells->count; f++) cells->types[f] = VTK_TRIANGLE;
}

/* A cell's nodes: Gmsh's two last middles are the other way round in VTK. */
static void put_nodes(const int *from, int count, int *to)
{
    memcpy(to, from, (size_t)count * sizeof *to);
    if (count == 10) to[8] = from[9], to[9] = from[8];
}

/* Tetrahedra, of 4 or 10 nodes, and the triangles of their skin. */
static void read_tetrahedra(VtkCells *cells, const Array *tets, const Array *faces)
{
    int n = tets->dims[0], each = tets->dims[1], m = faces->dims[0];
    cells->count = n + m;
    cells->id_count = n * each + 3 * m;
    cells->ids = mem_alloc((size_t)cells->id_count, sizeof *cells->ids);
    cells->offsets = mem_alloc((size_t)cells->count + 1, sizeof *cells->offsets);
    cells->types = mem_alloc((size_t)cells->count, sizeof *cells->types);
    for (int k = 0; k < cells->count; k++) {
        bool tet = k < n;
        int *to = cells->ids + cells->offsets[k];
        cells->types[k] = !tet ? VTK_TRIANGLE : each == 10 ? VTK_QUADRATIC_TETRA : VTK_TETRA;
        cells->offsets[k + 1] = cells->offsets[k] + (tet ? each : 3);
        if (tet)
            put_nodes((const int *)tets->data + (size_t)k * (size_t)each, each, to);
        else
            put_nodes((const int *)faces->data + 3 * (size_t)(k - n), 3, to);
    }
}

static bool check_lines(const Array *lines, int vertex_count, Error *err)
{
    bool fits = lines->type == ARRAY_INT32 && lines->rank == 2 && lines->dims[1] == 2;
    const int *line = lines->data;
    for (int k = 0; fits && k < lines->dims[0]; k++, line += 2)
        fits = line[0] >= 0 && line[1] >= 2 && line[0] <= vertex_count - line[1];
    return fits || error_set(err,
                             "static/lines must be rows of a first point and a number of points, 2 or "
                             "more, among the %d of a frame",
                             vertex_count);
}

/* Lines given by their first point and number of points. */
static void read_lines(VtkCells *cells, const int (*lines)[2], int count)
{
    cells->lines = true;
    cells->count = count;
    cells->uniform = count ? lines[0][1] : 2;
    cells->offsets = mem_alloc((size_t)count + 1, sizeof *cells->offsets);
    for (int k = 0; k < count; k++) {
        cells->offsets[k + 1] = cells->offsets[k] + lines[k][1];
        if (lines[k][1] != lines[0][1]) cells->uniform = 0;
    }
    cells->id_count = cells->offsets[count];
    cells->ids = mem_alloc((size_t)cells->id_count, sizeof *cells->ids);
    for (int k = 0; k < count; k++)
        for (int i = 0; i < lines[k][1]; i++) cells->ids[cells->offsets[k] + i] = lines[k][0] + i;
    cells->types = mem_alloc((size_t)count, sizeof *cells->types);
    for (int k = 0; k < count; k++) cells->types[k] = VTK_POLY_LINE;
}

static int xdmf_type(int type)
{
    return type == VTK_POLY_LINE         ? XDMF_POLYLINE
           : type == VTK_TRIANGLE        ? XDMF_TRIANGLE
           : type == VTK_QUADRATIC_TETRA ? XDMF_TETRAHEDRON_10
                                         : XDMF_TETRAHEDRON;
}

/* For each cell its type, of a line its number of points, and these. */
static void list_mixed(VtkCells *cells)
{
    cells->mixed = mem_alloc(2 * (size_t)cells->count + (size_t)cells->id_count, sizeof *cells->mixed);
    int *next = cells->mixed;
    for (int k = 0; k < cells->count; k++) {
        *next++ = xdmf_type(cells->types[k]);
        if (cells->lines) *next++ = cells->offsets[k + 1] - cells->offsets[k];
        for (int i = cells->offsets[k]; i < cells->offsets[k + 1]; i++) *next++ = cells->ids[i];
    }
    cells->mixed_count = (int)(next - cells->mixed);
}

bool vtk_frames_exist(Journal *journal, bool *exist, Error *err)
{
    bool faces, lines;
    if (!journal_has(journal, "static", 0, "faces", &faces, err) ||
        !journal_has(journal, "static", 0, "lines", &lines, err))
        return false;
    *exist = faces || lines;
    return true;
}

static bool read_cells(VtkFrames *frames, Error *err)
{
    Array array;
    if (!journal_find(frames->journal, "static", 0, "faces", &array, err)) return false;
    bool lines = !array.data;
    if (lines && !journal_get(frames->journal, "static", 0, "lines", &array, err)) return false;
    bool ok = !lines || check_lines(&array, frames->vertex_count, err);
    Array tets = {0};
    ok = ok && journal_find(frames->journal, "static", 0, "cells", &tets, err);
    if (ok && lines) read_lines(&frames->cells, (void *)array.data, array.dims[0]);
    if (ok && !lines && !tets.data) read_triangles(&frames->cells, &array);
    if (ok && !lines && tets.data) read_tetrahedra(&frames->cells, &tets, &array);
    if (ok && !frames->cells.uniform) list_mixed(&frames->cells);
    array_clear(&array);
    array_clear(&tets);
    return ok;
}

static bool read_times(VtkFrames *frames, Error *err)
{
    frames->times = mem_alloc((size_t)frames->count, sizeof *frames->times);
    for (int k = 0; k < frames->count; k++) {
        Array time;
        if (!journal_get(frames->journal, "frame", frames->frames[k], "time", &time, err)) return false;
        if (time.type == ARRAY_FLOAT64 && time.rank == 0) frames->times[k] = *(const double *)time.data;
        array_clear(&time);
    }
    return true;
}

static bool read_still(VtkFrames *frames, Error *err)
{
    Array still;
    if (!journal_find(frames->journal, "static", 0, "still", &still, err)) return false;
    if (!still.data) return true;
    bool fits = still.type == ARRAY_FLOAT64 && still.rank == 2 && still.dims[1] == 3;
    if (fits) {
        frames->still_count = still.dims[0];
        frames->still = mem_copy(still.data, (size_t)still.dims[0], sizeof *frames->still);
        frames->vertex_count += still.dims[0];
    }
    array_clear(&still);
    return fits || error_set(err, "static/still must be rows of three numbers");
}

static void include_points(const double (*x)[3], int count, double low[3], double high[3])
{
    for (int k = 0; k < count; k++)
        for (int i = 0; i < 3; i++) {
            low[i] = fmin(low[i], x[k][i]);
            high[i] = fmax(high[i], x[k][i]);
        }
}

/* Double precision where single numbers, at the largest coordinate of any frame, are farther apart than
 * RESOLUTION of the body (the diagonal of its first frame): one far from the origin would be shown in steps.
 */
static bool choose_precision(VtkFrames *frames, Error *err)
{
    const double RESOLUTION = 1e-5;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, size = 0,
           largest = 0;
    for (int k = 0; frames->single && k < frames->count; k++) {
        Array x;
        if (!journal_get(frames->journal, "frame", frames->frames[k], "x", &x, err)) return false;
        include_points((const double(*)[3])x.data, (int)(array_count(&x) / 3), low, high);
        array_clear(&x);
        if (k == 0)
            size = sqrt(pow(high[0] - low[0], 2) + pow(high[1] - low[1], 2) + pow(high[2] - low[2], 2));
        for (int i = 0; i < 3; i++) largest = fmax(largest, fmax(-low[i], high[i]));
        frames->single = largest * FLT_EPSILON <= RESOLUTION * size;
    }
    return true;
}

bool vtk_frames_read(VtkFrames *frames, Error *err)
{
    Array x;
    if (!journal_get(frames->journal, "frame", frames->frames[0], "x", &x, err)) return false;
    frames->vertex_count = x.dims[0];
    array_clear(&x);
    return choose_precision(frames, err) && read_still(frames, err) && read_cells(frames, err) &&
           read_times(frames, err) &&
           journal_names(frames->journal, "frame", frames->frames[0], &frames->fields, &frames->field_count,
                         err);
}

void vtk_frames_clear(VtkFrames *frames)
{
    mem_free(frames->still);
    mem_free(frames->cells.ids);
    mem_free(frames->cells.offsets);
    mem_free(frames->cells.types);
    mem_free(frames->cells.mixed);
    mem_free(frames->times);
    mem_free(frames->fields);
}

/* ---- Writing ---- */

static bool put_ints(VtkFrames *frames, const char *path, const int *values, int rank, int d0, int d1,
                     Hdf5Layout layout, Error *err)
{
    Array array = array_int(path, values, rank, d0, d1);
    return hdf5_write(frames->file, path, &array, layout, err);
}

/* The cells, stored once: connectivity, offsets and types. */
static bool put_cells(VtkFrames *frames, Error *err)
{
    const VtkCells *cells = &frames->cells;
    int n = cells->count;
    Hdf5Layout wide = {.wide = true}, bytes = {.bytes = true};
    bool ok = put_ints(frames, "VTKHDF/Connectivity", cells->ids, 1, cells->id_count, 0, wide, err) &&
              put_ints(frames, "VTKHDF/Offsets", cells->offsets, 1, n + 1, 0, wide, err) &&
              put_ints(frames, "VTKHDF/Types", cells->types, 1, n, 0, bytes, err) &&
              put_ints(frames, "VTKHDF/NumberOfPoints", &frames->vertex_count, 1, 1, 0, wide, err) &&
              put_ints(frames, "VTKHDF/NumberOfCells", &n, 1, 1, 0, wide, err) &&
              put_ints(frames, "VTKHDF/NumberOfConnectivityIds", &cells->id_count, 1, 1, 0, wide, err);
    if (!ok || !cells->mixed) return ok;
    return put_ints(frames, "slender/xdmf_topology", cells->mixed, 1, cells->mixed_count, 0, wide, err);
}

/* Where in the long arrays each step begins. */
static bool put_steps(VtkFrames *frames, Error *err)
{
    int steps = frames->count, *zeros = mem_alloc((size_t)steps, sizeof *zeros),
        *ones = mem_alloc((size_t)steps, sizeof *ones);
    int *points = mem_alloc((size_t)steps, sizeof *points);
    for (int k = 0; k < steps; k++) ones[k] = 1, points[k] = k * frames->vertex_count;
    Hdf5Layout wide = {.wide = true};
    Array times = array_float("VTKHDF/Steps/Values", "s", frames->times, 1, steps, 0);
    bool ok = hdf5_attribute_ints(frames->file, "VTKHDF/Steps", "NSteps", &steps, 1, err) &&
              hdf5_write(frames->file, "VTKHDF/Steps/Values", &times, (Hdf5Layout){0}, err) &&
              put_ints(frames, "VTKHDF/Steps/PartOffsets", zeros, 1, steps, 0, wide, err) &&
              put_ints(frames, "VTKHDF/Steps/NumberOfParts", ones, 1, steps, 0, wide, err) &&
              put_ints(frames, "VTKHDF/Steps/PointOffsets", points, 1, steps, 0, wide, err) &&
              put_ints(frames, "VTKHDF/Steps/CellOffsets", zeros, 2, steps, 1, wide, err) &&
              put_ints(frames, "VTKHDF/Steps/ConnectivityIdOffsets", zeros, 2, steps, 1, wide, err);
    mem_free(zeros);
    mem_free(ones);
    mem_free(points);
    return ok;
}

/* What runs go on from, and what is measured. */
static bool is_exact(const char *name)
{
    static const char *const prefixes[] = {"state/", "probes/", "stages/"};
    bool exact = false;
    for (int k = 0; k < 3; k++) exact |= !strncmp(name, prefixes[k], strlen(prefixes[k]));
    return exact;
}

static int rows_of(const Array *array)
{
    return array->rank > 0 ? array->dims[0] : 1;
}

bool vtk_frames_put(VtkFrames *frames, const char *name, const char *path, const char *offsets_path,
                    bool stacked, Error *err)
{
    Hdf5Rows *rows = NULL;
    int *offsets = mem_alloc((size_t)frames->count, sizeof *offsets), stored = 0, chunk = 0, width = 0;
    bool ok = true, single = frames->single && !stacked && !is_exact(name);
    for (int k = 0; ok && k < frames->count; k++) {
        Array array;
        ok = journal_find(frames->journal, "frame", frames->frames[k], name, &array, err);
        if (array.data) {
            if (!rows) {
                chunk = rows_of(&array), width = array.rank > 1 ? array.dims[1] : 0;
                rows = hdf5_rows_create(frames->file, path, array.unit, chunk, width, stacked, single, err);
            }
            bool fits = array.type == ARRAY_FLOAT64 && rows_of(&array) == chunk &&
                        (array.rank > 1 ? array.dims[1] : 0) == width;
            if (ok && !fits) ok = error_set(err, "the frames' %s change their shape", name);
            ok = ok && rows && hdf5_rows_append(rows, array.data, err);
            stored++;
            array_clear(&array);
        }
        offsets[k] = (stored - 1) * chunk;
    }
    ok = hdf5_rows_close(rows, ok ? err : NULL) && ok;
    if (ok && offsets_path)
        ok = put_ints(frames, offsets_path, offsets, 1, frames->count, 0, (Hdf5Layout){.wide = true}, err);
    mem_free(offsets);
    return ok;
}

/* Three numbers for each point of every frame, followed by those of the points that stand still: `still`, or 0. */
static bool put_with_still(VtkFrames *frames, const char *name, const char *path, const double (*still)[3],
                           Error *err)
{
    int moving = frames->vertex_count - frames->still_count;
    double(*points)[3] = mem_alloc((size_t)frames->vertex_count, sizeof *points);
    if (still) memcpy(points + moving, still, (size_t)frames->still_count * sizeof *points);
    Hdf5Rows *rows = NULL;
    bool ok = true;
    for (int k = 0; ok && k < frames->count; k++) {
        Array x = {0};
        ok = journal_get(frames->journal, "frame", frames->frames[k], name, &x, err);
        if (ok && array_count(&x) != 3 * (size_t)moving)
            ok = error_set(err, "the frames' %s change their shape", name);
        if (ok && !rows)
            rows = hdf5_rows_create(frames->file, path, x.unit, frames->vertex_count, 3, false,
                                    frames->single, err);
        if (ok) memcpy(points, x.data, (size_t)moving * sizeof *points);
        ok = ok && rows && hdf5_rows_append(rows, points[0], err);
        array_clear(&x);
    }
    ok = hdf5_rows_close(rows, ok ? err : NULL) && ok;
    mem_free(points);
    return ok;
}

/* Each frame's points, and those that stand still. */
static bool put_points(VtkFrames *frames, Error *err)
{
    static const char PATH[] = "VTKHDF/Points";
    if (!frames->still) return vtk_frames_put(frames, "x", PATH, NULL, false, err);
    return put_with_still(frames, "x", PATH, (const double(*)[3])frames->still, err);
}

/* Where frames have points that stand still, too: a row for every point, so each step has its own rows. */
static bool put_point_field(VtkFrames *frames, const char *field, const char *path, const char *offsets_path,
                            Error *err)
{
    int *offsets = mem_alloc((size_t)frames->count, sizeof *offsets);
    for (int k = 0; k < frames->count; k++) offsets[k] = k * frames->vertex_count;
    bool ok = put_with_still(frames, field, path, NULL, err) &&
              put_ints(frames, offsets_path, offsets, 1, frames->count, 0, (Hdf5Layout){.wide = true}, err);
    mem_free(offsets);
    return ok;
}

static bool put_fields(VtkFrames *frames, Error *err)
{
    static const struct {
        const char *prefix, *data, *offsets;
    } kinds[] = {{"cell/", "CellData", "CellDataOffsets"}, {"point/", "PointData", "PointDataOffsets"}};
    bool ok = true;
    for (int k = 0; ok && k < frames->field_count; k++)
        for (int d = 0; ok && d < 2; d++) {
            size_t length = strlen(kinds[d].prefix);
            const char *field = frames->fields[k];
            if (strncmp(field, kinds[d].prefix, length)) continue;
            char *path = mem_format("VTKHDF/%s/%s", kinds[d].data, field + length),
                 *offsets = mem_format("VTKHDF/Steps/%s/%s", kinds[d].offsets, field + length);
            ok = d == 1 && frames->still ? put_point_field(frames, field, path, offsets, err)
                                         : vtk_frames_put(frames, field, path, offsets, false, err);
            mem_free(path);
            mem_free(offsets);
        }
    return ok;
}

bool vtk_frames_write(VtkFrames *frames, Error *err)
{
    int version[2] = {2, 0};
    return hdf5_attribute_ints(frames->file, "VTKHDF", "Version", version, 2, err) &&
           hdf5_attribute_text(frames->file, "VTKHDF", "Type", "UnstructuredGrid", err) &&
           put_cells(frames, err) && put_steps(frames, err) && put_points(frames, err) &&
           put_fields(frames, err);
}
