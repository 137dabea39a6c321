#include "io/grid_file.h"
#include "base/memory.h"
#include "io/hdf5_file.h"
#include "io/scan.h"
#include "io/yaml_private.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct Grid {
    const char *path;
    Hdf5 *file;
    GridFile *to;
    Error *err;
} Grid;

/* What one of the unit of a dataset is in this one; false and a sentence. */
static bool factor_of(const Grid *g, const char *name, const Array *array, const char *unit, double *factor)
{
    char wrong[200], *one = mem_format("1 %s", array->unit);
    bool ok = true;
    *factor = 1;
    if (array->unit[0]) ok = unit_parse(one, unit, factor, wrong, sizeof wrong);
    mem_free(one);
    return ok || error_set(g->err, "%s: the unit of %s is '%s', which is no unit in %s", g->path, name,
                           array->unit, unit);
}

/* Its numbers in SI, the caller's, and its shape alone; NULL: err says why not. */
static double *numbers(const Grid *g, const char *name, const char *unit, Array *array)
{
    Error inner;
    double factor;
    if (!hdf5_has(g->file, name))
        return error_set(g->err,
                         "%s: there is no dataset %s; a map has x [nx], y [ny], z [nz] in m, and Bx, By, Bz "
                         "[nx,ny,nz] in T",
                         g->path, name),
               NULL;
    if (!hdf5_read(g->file, name, 0, -1, array, &inner))
        return error_set(g->err, "%s: %s", g->path, inner.text), NULL;
    size_t count = array_count(array);
    double *values = mem_alloc(count, sizeof *values);
    bool ok = array->type != ARRAY_TEXT || error_set(g->err, "%s: %s is a text", g->path, name);
    ok = ok && factor_of(g, name, array, unit, &factor);
    for (size_t i = 0; ok && i < count; i++) {
        values[i] = factor * (array->type == ARRAY_INT32 ? ((const int32_t *)array->data)[i]
                                                         : ((const double *)array->data)[i]);
        if (!isfinite(values[i]))
            ok = error_set(g->err, "%s: number %zu of %s is not finite", g->path, i, name);
    }
    Array shape = {.rank = array->rank};
    memcpy(shape.dims, array->dims, sizeof shape.dims);
    array_clear(array);
    *array = shape;
    if (!ok) mem_free(values);
    return ok ? values : NULL;
}

static bool check_steps(const Grid *g, const char *name, const double *place, int count)
{
    const double little = 1e-3;
    double step = count > 1 ? (place[count - 1] - place[0]) / (count - 1) : 1;
    for (int k = 0; k < count; k++)
        if (!(step > 0) || fabs(place[k] - place[0] - k * step) > little * step)
            return error_set(g->err,
                             "%s: %s[%d] is %g m: places ascend in equal steps, here %d from %g to %g m",
                             g->path, name, k, place[k], count, place[0], place[count - 1]);
    return true;
}

static bool read_axis(const Grid *g, int axis)
{
    const char name[] = {"xyz"[axis], 0};
    Array array;
    double *place = numbers(g, name, "m", &array);
    if (!place) return false;
    int count = array.rank == 1 ? array.dims[0] : 0;
    bool ok = array.rank == 1 || error_set(g->err, "%s: %s is no list of places: it has %d dimensions",
                                           g->path, name, array.rank);
    if (ok && count == 0) ok = error_set(g->err, "%s: %s is empty: it has no places", g->path, name);
    ok = ok && check_steps(g, name, place, count);
    if (ok) {
        g->to->nodes[axis] = count;
        g->to->low[axis] = place[0];
        g->to->step[axis] = count > 1 ? (place[count - 1] - place[0]) / (count - 1) : 1;
    }
    mem_free(place);
    return ok;
}

/* "[3,4]" */
static char *shape_text(int rank, const int *dims)
{
    char *text = mem_text("");
    for (int r = 0; r < rank; r++) {
        char *number = mem_format("%d", dims[r]);
        text = mem_join(text, r ? "," : "", number);
        mem_free(number);
    }
    return text;
}

static bool read_field(const Grid *g, const char *name, const char *unit, double *values)
{
    Array array;
    double *field = numbers(g, name, unit, &array);
    if (!field) return false;
    const int *n = g->to->nodes, *d = array.dims;
    bool ok = array.rank == 3 && d[0] == n[0] && d[1] == n[1] && d[2] == n[2];
    char *shape = shape_text(array.rank, d);
    if (ok)
        memcpy(values, field, (size_t)n[0] * (size_t)n[1] * (size_t)n[2] * sizeof *field);
    else
        error_set(g->err, "%s: %s is [%s]; x, y and z ask for [%d,%d,%d]", g->path, name, shape, n[0], n[1],
                  n[2]);
    mem_free(shape);
    mem_free(field);
    return ok;
}

static bool read_all(const Grid *g, const char *const *fields, int count, const char *unit)
{
    for (int axis = 0; axis < 3; axis++)
        if (!read_axis(g, axis)) return false;
    const int *n = g->to->nodes;
    double nodes = (double)n[0] * n[1] * n[2], most = 1e9;
    if (nodes > most) return error_set(g->err, "%s: a grid of %g nodes is too large", g->path, nodes);
    g->to->values = mem_alloc((size_t)count * (size_t)nodes, sizeof *g->to->values);
    for (int k = 0; k < count; k++)
        if (!read_field(g, fields[k], unit, g->to->values + (size_t)k * (size_t)nodes)) return false;
    return true;
}

bool grid_file_read(const char *path, const char *const *fields, int count, const char *unit, GridFile *grid,
                    Error *err)
{
    char *bytes;
    size_t size;
    Error inner;
    *grid = (GridFile){0};
    if (!scan_file(path, &bytes, &size, err)) return false;
    Grid g = {path, hdf5_open(bytes, size, &inner), grid, err};
    mem_free(bytes);
    if (!g.file) return error_set(err, "%s: %s", path, inner.text);
    bool ok = read_all(&g, fields, count, unit);
    hdf5_close(g.file);
    if (!ok) grid_file_clear(grid);
    return ok;
}

void grid_file_clear(GridFile *grid)
{
    mem_free(grid->values);
    *grid = (GridFile){0};
}
