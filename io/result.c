#include "io/result.h"
#include "base/memory.h"
#include "io/hdf5_file.h"
#include "io/result_vtk.h"
#include "io/safe_file.h"
#include "io/text.h"
#include "io/xdmf.h"
#include <errno.h>
#include <math.h>
#include <string.h>
#include <zlib.h>

/* ---- /slender ---- */

/* Texts that are attributes of the group, not datasets in it. */
static const struct {
    const char *path, *kind, *name, *absent;
} attributes[] = {{"slender/status", "final", "status", "unfinished"},
                  {"slender/kernels", "meta", "kernels", NULL}};

enum { ATTRIBUTES = sizeof attributes / sizeof *attributes };

static bool is_attribute(const char *kind, const char *name)
{
    for (int k = 0; k < ATTRIBUTES; k++)
        if (!strcmp(name, attributes[k].name) && !strcmp(kind, attributes[k].kind)) return true;
    return false;
}

/* What a run goes on from has many zeros (state/velocities, cases/NAME/state/loads/.., ..), a film many numbers that are like
 * each other. */
enum { MANY = 4096 }; /* a chunk takes 2 kB beside its numbers */

static Hdf5Layout layout_of(const Array *array, const char *name)
{
    bool state = array->rank == 1 && array->type == ARRAY_FLOAT64 && strstr(name, "state/"),
         film = strstr(name, "film/") != NULL;
    return (Hdf5Layout){.chunk_rows = (state || film) && array->dims[0] >= MANY ? array->dims[0] : 0};
}

/* Every other array of a kind at its own name. */
static bool put_kind(VtkFrames *w, const char *kind, Error *err)
{
    char **names;
    int count;
    bool ok = journal_names(w->journal, kind, 0, &names, &count, err);
    for (int k = 0; ok && k < count; k++) {
        Array array;
        if (is_attribute(kind, names[k])) continue;
        ok = journal_get(w->journal, kind, 0, names[k], &array, err);
        if (!ok) break;
        char *path = mem_format("slender/%s", names[k]);
        ok = hdf5_write(w->file, path, &array, layout_of(&array, names[k]), err);
        mem_free(path);
        array_clear(&array);
    }
    if (names) mem_free(names);
    return ok;
}

static bool put_attribute(VtkFrames *w, int k, Error *err)
{
    const char *kind = attributes[k].kind, *name = attributes[k].name;
    Array text;
    if (!journal_find(w->journal, kind, 0, name, &text, err)) return false;
    const char *value = text.data ? text.data : attributes[k].absent;
    bool ok = !value || hdf5_attribute_text(w->file, "slender", name, value, err);
    array_clear(&text);
    return ok;
}

static bool put_attributes(VtkFrames *w, Error *err)
{
    bool ok = true;
    for (int k = 0; ok && k < ATTRIBUTES; k++) ok = put_attribute(w, k, err);
    return ok;
}

/* What of an evaluation goes into history/: scalars, and tables of vectors. */
static bool is_history(const Array *array)
{
    return (array->rank == 0 || array->rank == 2) && array->type == ARRAY_FLOAT64;
}

static bool is_probe(const char *name)
{
    return !strncmp(name, "probes/", 7);
}

/* history/<name> from the arrays of that name in all evaluations, which are like the first one; of probes their own. */
static bool put_history(VtkFrames *w, const char *name, const int *indices, int count, const Array *first,
                        Error *err)
{
    size_t each = array_count(first);
    double *values = mem_alloc((size_t)count * each, sizeof *values);
    bool ok = true;
    for (int k = 0; ok && k < count; k++) {
        Array array;
        ok = journal_find(w->journal, "evaluation", indices[k], name, &array, err);
        bool alike = array.data && array.type == ARRAY_FLOAT64 && array_count(&array) == each;
        for (size_t i = 0; i < each; i++)
            values[(size_t)k * each + i] = alike ? ((const double *)array.data)[i] : NAN;
        array_clear(&array);
    }
    char *path = mem_format("slender/%s%s", is_probe(name) ? "" : "history/", name);
    Array history = array_float(path, first->unit, values, 1 + first->rank, count, first->dims[0]);
    history.dims[2] = first->dims[1];
    ok = ok && hdf5_write(w->file, path, &history, (Hdf5Layout){0}, err);
    mem_free(path);
    mem_free(values);
    return ok;
}

static bool put_histories(VtkFrames *w, Error *err)
{
    int *indices, count, name_count = 0;
    char **names = NULL;
    bool ok = journal_indices(w->journal, "evaluation", &indices, &count, err);
    if (ok && count) ok = journal_names(w->journal, "evaluation", indices[0], &names, &name_count, err);
    for (int k = 0; ok && k < name_count; k++) {
        Array array;
        ok = journal_get(w->journal, "evaluation", indices[0], names[k], &array, err);
        if (!ok) break;
        if (is_history(&array) || is_probe(names[k]))
            ok = put_history(w, names[k], indices, count, &array, err);
        array_clear(&array);
    }
    mem_free(names);
    mem_free(indices);
    return ok;
}

/* ---- The whole file ---- */

/* The last frame's x, until there is a final one. */
static bool put_last_x(VtkFrames *w, Error *err)
{
    Array x;
    bool has;
    if (!journal_has(w->journal, "final", 0, "state/x", &has, err)) return false;
    if (has) return true;
    if (!journal_get(w->journal, "frame", w->frames[w->count - 1], "x", &x, err)) return false;
    bool ok = hdf5_write(w->file, "slender/state/x", &x, (Hdf5Layout){0}, err);
    array_clear(&x);
    return ok;
}

/* The texts that frames have, a line each. */
static bool put_lines(VtkFrames *w, const char *field, const char *path, Error *err)
{
    Text lines = {0};
    bool ok = true;
    for (int k = 0; ok && k < w->count; k++) {
        Array text;
        ok = journal_find(w->journal, "frame", w->frames[k], field, &text, err);
        if (ok) text_add(&lines, "%s\n", text.data ? (const char *)text.data : "");
        if (ok) array_clear(&text);
    }
    Array all = array_text(path, lines.text);
    ok = ok && hdf5_write(w->file, path, &all, (Hdf5Layout){0}, err);
    mem_free(lines.text);
    return ok;
}

static bool begins(const char *name, const char *start)
{
    return !strncmp(name, start, strlen(start));
}

/* A row for each of several things. */
static bool is_pose(const char *field)
{
    static const char END[] = "_pose";
    size_t length = strlen(field), end = sizeof END - 1;
    return length > end && !strcmp(field + length - end, END);
}

bool result_is_around(const char *field)
{
    return is_pose(field) || begins(field, "flux_");
}

/* Of a stage: rows for each obstacle or support. */
static bool has_rows(const char *stage)
{
    return strstr(stage, "_force") || strstr(stage, "_couple");
}

/* What else the frames hold: flux densities and poses, frames/NAME of state/NAME, what is kept of whole
 * states; probes/NAME, and stages/NAME of the stages of a sequence. */
static bool put_frames(VtkFrames *w, const char *field, Error *err)
{
    bool stage = begins(field, "stages/"), own = stage || is_probe(field), state = begins(field, "state/"),
         around = result_is_around(field),
         many = is_pose(field) || !strcmp(field, "flux_sources") || (stage && has_rows(field));
    if (!own && !state && !around) return true;
    char *path = mem_format("slender/%s%s", own ? "" : "frames/", state ? field + 6 : field);
    bool ok = !strcmp(field, "stages/status") ? put_lines(w, field, path, err)
                                              : vtk_frames_put(w, field, path, NULL, many, err);
    mem_free(path);
    return ok;
}

static bool fill(VtkFrames *w, Error *err)
{
    if (!put_kind(w, "meta", err) || !put_kind(w, "static", err) || !put_kind(w, "obstacles", err) ||
        !put_kind(w, "final", err) || !put_attributes(w, err) || !put_histories(w, err))
        return false;
    bool shown;
    if (!vtk_frames_exist(w->journal, &shown, err)) return false;
    if (w->count == 0 || !shown) return true;
    if (!vtk_frames_read(w, err) || !put_last_x(w, err) || !vtk_frames_write(w, err)) return false;
    for (int k = 0; k < w->field_count; k++)
        if (!put_frames(w, w->fields[k], err)) return false;
    return w->single || vtk_frames_put(w, "x", "slender/frames/x", NULL, true, err);
}

bool result_has_sidecar(const char *path)
{
    return xdmf_can_name(path);
}

char *result_sidecar(const char *path)
{
    size_t length = strlen(path), cut = length > 7 && !strcmp(path + length - 7, ".vtkhdf") ? 7 : 0;
    return mem_format("%.*s.xdmf", (int)(length - cut), path);
}

static bool write_sidecar(const VtkFrames *w, const char *path, Error *err)
{
    if (w->vertex_count == 0 || !xdmf_can_name(path)) return true;
    char *text = xdmf_text(path, w, err);
    if (!text) return false;
    char *sidecar = result_sidecar(path);
    bool ok = safe_file_write(sidecar, text, strlen(text), false, err);
    mem_free(text);
    mem_free(sidecar);
    return ok;
}

bool result_write(Journal *journal, const char *path, ResultDef def, uint32_t *sum, Error *err)
{
    VtkFrames w = {.journal = journal, .single = !def.double_frames, .file = hdf5_create()};
    void *bytes = NULL;
    size_t size;
    errno = 0;
    bool ok = w.file != NULL || error_set(err, "HDF5 cannot make a file");
    ok = ok && journal_indices(journal, "frame", &w.frames, &w.count, err) && fill(&w, err) &&
         hdf5_image(w.file, &bytes, &size, err);
    hdf5_close(w.file);
    if (!ok && errno == ENOMEM) mem_exhausted("HDF5, which makes the result in memory");
    if (ok && sum) *sum = (uint32_t)crc32_z(0, bytes, size);
    ok = ok && safe_file_write(path, bytes, size, true, err) && write_sidecar(&w, path, err);
    mem_free(bytes);
    mem_free(w.frames);
    vtk_frames_clear(&w);
    return ok;
}

/* ---- Reading ---- */

struct Result {
    Hdf5 *file;
    int step_count;
    uint32_t sum;
};

Result *result_open(const char *path, Error *err)
{
    void *bytes;
    size_t size;
    if (!safe_file_read(path, &bytes, &size, err)) return NULL;
    Error inner;
    Result *result = mem_alloc(1, sizeof *result);
    result->file = hdf5_open(bytes, size, &inner);
    result->sum = (uint32_t)crc32_z(0, bytes, size);
    mem_free(bytes);
    Array times;
    if (result->file && hdf5_read(result->file, "VTKHDF/Steps/Values", 0, -1, &times, NULL)) {
        if (array_is(&times, ARRAY_FLOAT64, 1, 0)) result->step_count = times.dims[0];
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

uint32_t result_sum(const Result *result)
{
    return result->sum;
}

bool result_list(Result *result, char ***paths, int *count, Error *err)
{
    return hdf5_list(result->file, paths, count, err);
}

/* Its number, or -1: the path is that of a dataset. */
static int find_attribute(const char *path)
{
    for (int k = 0; k < ATTRIBUTES; k++)
        if (!strcmp(path, attributes[k].path)) return k;
    return -1;
}

bool result_has(Result *result, const char *path)
{
    return find_attribute(path) >= 0 || hdf5_has(result->file, path);
}

bool result_read(Result *result, const char *path, Array *array, Error *err)
{
    char *text;
    int k = find_attribute(path);
    if (k < 0) return hdf5_read(result->file, path, 0, -1, array, err);
    if (!hdf5_read_attribute_text(result->file, "slender", attributes[k].name, &text, err)) return false;
    *array = (Array){.name = mem_text(attributes[k].name),
                     .unit = mem_text(""),
                     .type = ARRAY_TEXT,
                     .rank = 1,
                     .dims = {(int)strlen(text)},
                     .data = text};
    return true;
}

/* Keeps the array where it is as slender writes it. */
static bool keep(bool fits, const char *path, Array *array, Error *err)
{
    if (fits) return true;
    array_clear(array);
    return error_set(err, "%s is not as slender writes it", path);
}

bool result_read_as(Result *result, const char *path, ArrayType type, int rank, int width, Array *array,
                    Error *err)
{
    return result_read(result, path, array, err) &&
           keep(array_is(array, type, rank, width), path, array, err);
}

bool result_read_rows(Result *result, const char *path, int first, int count, Array *array, Error *err)
{
    return hdf5_read(result->file, path, first, count, array, err);
}

int result_step_count(Result *result)
{
    return result->step_count;
}

bool result_check_state(Result *result, Error *err)
{
    return result->step_count > 0 || result_has(result, "slender/state/x") ||
           result_has(result, "slender/rod/x") || error_set(err, "the result has no state yet");
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

/* Where a step's rows of an array begin: Steps/CellDataOffsets/NAME, Steps/PointDataOffsets/NAME,
 * Steps/PointOffsets. */
static char *offsets_of(const char *name, bool cell)
{
    const char *field = strchr(name, '/');
    if (!strcmp(name, "Points")) return mem_text("VTKHDF/Steps/PointOffsets");
    return mem_format("VTKHDF/Steps/%s%s", cell ? "CellDataOffsets" : "PointDataOffsets", field ? field : "");
}

bool result_read_step(Result *result, const char *name, int step, Array *array, Error *err)
{
    bool cell = !strncmp(name, "CellData/", 9), points = !strcmp(name, "Points");
    int first = 0, count = 0;
    char *path = mem_format("VTKHDF/%s", name), *offsets = offsets_of(name, cell);
    bool ok = hdf5_has(result->file, path) || error_set(err, "the result has no %s", name);
    if (ok && (step < 0 || step >= result->step_count))
        ok = error_set(err, "the result has %d steps, from 0", result->step_count);
    ok = ok && offset_at(result, offsets, step, &first, err) &&
         offset_at(result, cell ? "VTKHDF/NumberOfCells" : "VTKHDF/NumberOfPoints", 0, &count, err) &&
         hdf5_read(result->file, path, first, count, array, err) &&
         keep(array->type == ARRAY_FLOAT64 && array->rank >= 1 &&
                  (!points || array_is(array, ARRAY_FLOAT64, 2, 3)),
              path, array, err);
    mem_free(path);
    mem_free(offsets);
    return ok;
}

const char *result_hdf5_version(void)
{
    return hdf5_version();
}
