#include "io/result.h"
#include "base/memory.h"
#include "io/hdf5_file.h"
#include "io/safe_file.h"
#include "io/xdmf.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { VTK_TRIANGLE = 5 };

/* What is being written. */
typedef struct Writer {
    Journal *journal;
    Hdf5 *file;
    ResultDef def;
    int vertex_count, face_count, frame_count;
    int *frames; /* indices of the journal */
    double *times;
    char **fields; /* names of the first frame: those that the file has */
    int field_count;
} Writer;

/* ---- /slender ---- */

/* Every array of a kind at its own name; final/status is an attribute instead. */
static bool put_kind(Writer *w, const char *kind, Error *err)
{
    char **names, path[512];
    int count;
    bool ok = journal_names(w->journal, kind, 0, &names, &count, err);
    for (int k = 0; ok && k < count; k++) {
        Array array;
        if (!strcmp(names[k], "status") && !strcmp(kind, "final")) continue;
        ok = journal_get(w->journal, kind, 0, names[k], &array, err);
        if (!ok) break;
        snprintf(path, sizeof path, "slender/%.400s", names[k]);
        ok = hdf5_write(w->file, path, &array, (Hdf5Layout){0}, err);
        array_clear(&array);
    }
    if (names) mem_free(names);
    return ok;
}

static bool put_status(Writer *w, Error *err)
{
    Array status = {0};
    if (!journal_has(w->journal, "final", 0, "status"))
        return hdf5_attribute_text(w->file, "slender", "status", "unfinished", err);
    bool ok = journal_get(w->journal, "final", 0, "status", &status, err) &&
              hdf5_attribute_text(w->file, "slender", "status", status.data, err);
    array_clear(&status);
    return ok;
}

/* history/<name> from the scalar of that name in all evaluations. */
static bool put_history(Writer *w, const char *name, const int *indices, int count, const char *unit,
                        Error *err)
{
    char path[512];
    double *values = mem_alloc((size_t)count, sizeof *values);
    bool ok = true;
    for (int k = 0; ok && k < count; k++) {
        Array array = {0};
        values[k] = NAN;
        if (!journal_has(w->journal, "evaluation", indices[k], name)) continue;
        ok = journal_get(w->journal, "evaluation", indices[k], name, &array, err);
        if (ok && array.rank == 0 && array.type == ARRAY_FLOAT64) values[k] = *(const double *)array.data;
        array_clear(&array);
    }
    snprintf(path, sizeof path, "slender/history/%.400s", name);
    Array history = array_float(path, unit, values, 1, count, 0);
    ok = ok && hdf5_write(w->file, path, &history, (Hdf5Layout){0}, err);
    mem_free(values);
    return ok;
}

static bool put_histories(Writer *w, Error *err)
{
    int *indices, count, name_count = 0;
    char **names = NULL;
    bool ok = journal_indices(w->journal, "evaluation", &indices, &count, err);
    if (ok && count) ok = journal_names(w->journal, "evaluation", indices[0], &names, &name_count, err);
    for (int k = 0; ok && k < name_count; k++) {
        Array array;
        ok = journal_get(w->journal, "evaluation", indices[0], names[k], &array, err);
        if (!ok) break;
        if (array.rank == 0 && array.type == ARRAY_FLOAT64)
            ok = put_history(w, names[k], indices, count, array.unit, err);
        array_clear(&array);
    }
    mem_free(names);
    mem_free(indices);
    return ok;
}

/* ---- /VTKHDF ---- */

static bool put_ints(Writer *w, const char *path, const int *values, int rank, int d0, int d1,
                     Hdf5Layout layout, Error *err)
{
    Array array = array_int(path, values, rank, d0, d1);
    return hdf5_write(w->file, path, &array, layout, err);
}

/* The triangles, stored once: connectivity, offsets and types. */
static bool put_cells(Writer *w, const int *faces, Error *err)
{
    int n = w->face_count, cells = 3 * n;
    int *offsets = mem_alloc((size_t)n + 1, sizeof *offsets), *types = mem_alloc((size_t)n, sizeof *types);
    for (int f = 0; f <= n; f++) offsets[f] = 3 * f;
    for (int f = 0; f < n; f++) types[f] = VTK_TRIANGLE;
    Hdf5Layout wide = {.wide = true}, bytes = {.bytes = true};
    bool ok = put_ints(w, "VTKHDF/Connectivity", faces, 1, cells, 0, wide, err) &&
              put_ints(w, "VTKHDF/Offsets", offsets, 1, n + 1, 0, wide, err) &&
              put_ints(w, "VTKHDF/Types", types, 1, n, 0, bytes, err) &&
              put_ints(w, "VTKHDF/NumberOfPoints", &w->vertex_count, 1, 1, 0, wide, err) &&
              put_ints(w, "VTKHDF/NumberOfCells", &n, 1, 1, 0, wide, err) &&
              put_ints(w, "VTKHDF/NumberOfConnectivityIds", &cells, 1, 1, 0, wide, err);
    mem_free(offsets);
    mem_free(types);
    return ok;
}

/* Where in the long arrays each step begins. */
static bool put_steps(Writer *w, Error *err)
{
    int steps = w->frame_count, *zeros = mem_alloc((size_t)steps, sizeof *zeros),
        *ones = mem_alloc((size_t)steps, sizeof *ones);
    int *points = mem_alloc((size_t)steps, sizeof *points);
    for (int k = 0; k < steps; k++) ones[k] = 1, points[k] = k * w->vertex_count;
    Hdf5Layout wide = {.wide = true};
    Array times = array_float("VTKHDF/Steps/Values", "s", w->times, 1, steps, 0);
    bool ok = hdf5_attribute_ints(w->file, "VTKHDF/Steps", "NSteps", &steps, 1, err) &&
              hdf5_write(w->file, "VTKHDF/Steps/Values", &times, (Hdf5Layout){0}, err) &&
              put_ints(w, "VTKHDF/Steps/PartOffsets", zeros, 1, steps, 0, wide, err) &&
              put_ints(w, "VTKHDF/Steps/NumberOfParts", ones, 1, steps, 0, wide, err) &&
              put_ints(w, "VTKHDF/Steps/PointOffsets", points, 1, steps, 0, wide, err) &&
              put_ints(w, "VTKHDF/Steps/CellOffsets", zeros, 2, steps, 1, wide, err) &&
              put_ints(w, "VTKHDF/Steps/ConnectivityIdOffsets", zeros, 2, steps, 1, wide, err);
    mem_free(zeros);
    mem_free(ones);
    mem_free(points);
    return ok;
}

/* One array of the frames: a chunk per frame that has it, and for every step the offset of the chunk that
 * holds. */
static bool put_frames_array(Writer *w, const char *name, const char *path, const char *offsets_path,
                             bool stacked, Error *err)
{
    Hdf5Rows *rows = NULL;
    int *offsets = mem_alloc((size_t)w->frame_count, sizeof *offsets), stored = 0, chunk = 0, width = 0;
    bool ok = true;
    for (int k = 0; ok && k < w->frame_count; k++) {
        Array array = {0};
        if (k == 0 || journal_has(w->journal, "frame", w->frames[k], name)) {
            ok = journal_get(w->journal, "frame", w->frames[k], name, &array, err);
            if (ok && !rows) {
                chunk = array.dims[0], width = array.rank > 1 ? array.dims[1] : 0;
                rows = hdf5_rows_create(w->file, path, array.unit, chunk, width, stacked,
                                        !w->def.double_frames, err);
            }
            bool fits = array.type == ARRAY_FLOAT64 && array.dims[0] == chunk &&
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
        ok = put_ints(w, offsets_path, offsets, 1, w->frame_count, 0, (Hdf5Layout){.wide = true}, err);
    mem_free(offsets);
    return ok;
}

static bool put_fields(Writer *w, Error *err)
{
    static const struct {
        const char *prefix, *data, *offsets;
    } kinds[] = {{"cell/", "CellData", "CellDataOffsets"}, {"point/", "PointData", "PointDataOffsets"}};
    char path[512], offsets[512];
    bool ok = true;
    for (int k = 0; ok && k < w->field_count; k++)
        for (int d = 0; ok && d < 2; d++) {
            size_t length = strlen(kinds[d].prefix);
            if (strncmp(w->fields[k], kinds[d].prefix, length)) continue;
            const char *name = w->fields[k] + length;
            snprintf(path, sizeof path, "VTKHDF/%s/%.400s", kinds[d].data, name);
            snprintf(offsets, sizeof offsets, "VTKHDF/Steps/%s/%.400s", kinds[d].offsets, name);
            ok = put_frames_array(w, w->fields[k], path, offsets, false, err);
        }
    return ok;
}

static bool put_vtk(Writer *w, Error *err)
{
    Array faces;
    int version[2] = {2, 0};
    if (!journal_get(w->journal, "static", 0, "faces", &faces, err)) return false;
    w->face_count = faces.dims[0];
    bool ok = hdf5_attribute_ints(w->file, "VTKHDF", "Version", version, 2, err) &&
              hdf5_attribute_text(w->file, "VTKHDF", "Type", "UnstructuredGrid", err) &&
              put_cells(w, faces.data, err) && put_steps(w, err) &&
              put_frames_array(w, "x", "VTKHDF/Points", NULL, false, err) && put_fields(w, err);
    array_clear(&faces);
    return ok;
}

/* ---- The whole file ---- */

static bool read_times(Writer *w, Error *err)
{
    w->times = mem_alloc((size_t)w->frame_count, sizeof *w->times);
    for (int k = 0; k < w->frame_count; k++) {
        Array time;
        if (!journal_get(w->journal, "frame", w->frames[k], "time", &time, err)) return false;
        if (time.type == ARRAY_FLOAT64 && time.rank == 0) w->times[k] = *(const double *)time.data;
        array_clear(&time);
    }
    return journal_names(w->journal, "frame", w->frames[0], &w->fields, &w->field_count, err);
}

/* The last frame's x, until there is a final one. */
static bool put_last_x(Writer *w, Error *err)
{
    Array x;
    if (journal_has(w->journal, "final", 0, "state/x")) return true;
    if (!journal_get(w->journal, "frame", w->frames[w->frame_count - 1], "x", &x, err)) return false;
    bool ok = hdf5_write(w->file, "slender/state/x", &x, (Hdf5Layout){0}, err);
    array_clear(&x);
    return ok;
}

static bool fill(Writer *w, Error *err)
{
    Array x;
    if (!put_kind(w, "meta", err) || !put_kind(w, "static", err) || !put_kind(w, "final", err) ||
        !put_status(w, err) || !put_histories(w, err))
        return false;
    if (w->frame_count == 0 || !journal_has(w->journal, "static", 0, "faces")) return true;
    if (!journal_get(w->journal, "frame", w->frames[0], "x", &x, err)) return false;
    w->vertex_count = x.dims[0];
    array_clear(&x);
    if (!read_times(w, err) || !put_last_x(w, err) || !put_vtk(w, err)) return false;
    for (int k = 0; k < w->field_count; k++)
        if (!strcmp(w->fields[k], "flux_density") &&
            !put_frames_array(w, "flux_density", "slender/frames/flux_density", NULL, false, err))
            return false;
    return !w->def.double_frames || put_frames_array(w, "x", "slender/frames/x", NULL, true, err);
}

static bool write_sidecar(const Writer *w, const char *path, Error *err)
{
    if (w->vertex_count == 0) return true;
    size_t length = strlen(path), cut = length > 7 && !strcmp(path + length - 7, ".vtkhdf") ? 7 : 0;
    char *sidecar = mem_format("%.*s.xdmf", (int)(length - cut), path);
    XdmfDef def = {.result = path,
                   .vertex_count = w->vertex_count,
                   .face_count = w->face_count,
                   .step_count = w->frame_count,
                   .times = w->times,
                   .double_points = w->def.double_frames};
    char *text = xdmf_text(&def, w->fields, w->field_count, w->journal, w->frames);
    bool ok = safe_file_write(sidecar, text, strlen(text), false, err);
    mem_free(text);
    mem_free(sidecar);
    return ok;
}

bool result_write(Journal *journal, const char *path, ResultDef def, Error *err)
{
    Writer w = {.journal = journal, .def = def, .file = hdf5_create()};
    void *bytes = NULL;
    size_t size;
    bool ok = w.file != NULL || error_set(err, "HDF5 cannot make a file");
    ok = ok && journal_indices(journal, "frame", &w.frames, &w.frame_count, err) && fill(&w, err) &&
         hdf5_image(w.file, &bytes, &size, err);
    hdf5_close(w.file);
    ok = ok && safe_file_write(path, bytes, size, true, err) && write_sidecar(&w, path, err);
    mem_free(bytes);
    mem_free(w.frames);
    mem_free(w.times);
    mem_free(w.fields);
    return ok;
}

/* ---- Reading ---- */

struct Result {
    Hdf5 *file;
    int step_count;
};

Result *result_open(const char *path, Error *err)
{
    void *bytes;
    size_t size;
    if (!safe_file_read(path, &bytes, &size, err)) return NULL;
    Error inner;
    Result *result = mem_alloc(1, sizeof *result);
    result->file = hdf5_open(bytes, size, &inner);
    mem_free(bytes);
    Array times;
    if (result->file && hdf5_read(result->file, "VTKHDF/Steps/Values", 0, -1, &times, NULL)) {
        result->step_count = times.dims[0];
        array_clear(&times);
    }
    if (result->file) return result;
    mem_free(result);
    error_set(err, "%s: %s", path, inner.text);
    return NULL;
}

void result_close(Result *result)
{
    if (!result) return;
    hdf5_close(result->file);
    mem_free(result);
}

bool result_list(Result *result, char ***paths, int *count, Error *err)
{
    return hdf5_list(result->file, paths, count, err);
}

static bool is_status(const char *path)
{
    return !strcmp(path, "slender/status");
}

bool result_has(Result *result, const char *path)
{
    return is_status(path) || hdf5_has(result->file, path);
}

bool result_read(Result *result, const char *path, Array *array, Error *err)
{
    char *text;
    if (!is_status(path)) return hdf5_read(result->file, path, 0, -1, array, err);
    if (!hdf5_read_attribute_text(result->file, "slender", "status", &text, err)) return false;
    *array = (Array){.name = mem_text("status"),
                     .unit = mem_text(""),
                     .type = ARRAY_TEXT,
                     .rank = 1,
                     .dims = {(int)strlen(text)},
                     .data = text};
    return true;
}

bool result_read_rows(Result *result, const char *path, int first, int count, Array *array, Error *err)
{
    return hdf5_read(result->file, path, first, count, array, err);
}

int result_step_count(Result *result)
{
    return result->step_count;
}

/* The number in a dataset of int64 at an index, or its only one. */
static bool offset_at(Result *result, const char *path, int index, int *value, Error *err)
{
    Array array;
    if (!hdf5_read(result->file, path, index, 1, &array, err)) return false;
    bool ok = array.type == ARRAY_INT32 && array_count(&array) == 1;
    if (ok) *value = *(const int *)array.data;
    array_clear(&array);
    return ok || error_set(err, "%s is not as slender writes it", path);
}

bool result_read_step(Result *result, const char *name, int step, Array *array, Error *err)
{
    bool cell = !strncmp(name, "CellData/", 9), points = !strcmp(name, "Points");
    char path[512], offsets[512];
    int first = 0, count = 0;
    snprintf(path, sizeof path, "VTKHDF/%.400s", name);
    const char *field = strchr(name, '/');
    if (points)
        snprintf(offsets, sizeof offsets, "VTKHDF/Steps/PointOffsets");
    else
        snprintf(offsets, sizeof offsets, "VTKHDF/Steps/%s%.400s",
                 cell ? "CellDataOffsets" : "PointDataOffsets", field ? field : "");
    if (!hdf5_has(result->file, path)) return error_set(err, "the result has no %s", name);
    if (step < 0 || step >= result->step_count)
        return error_set(err, "the result has %d steps, from 0", result->step_count);
    return offset_at(result, offsets, step, &first, err) &&
           offset_at(result, cell ? "VTKHDF/NumberOfCells" : "VTKHDF/NumberOfPoints", 0, &count, err) &&
           hdf5_read(result->file, path, first, count, array, err);
}

const char *result_hdf5_version(void)
{
    return hdf5_version();
}
