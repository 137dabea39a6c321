#include "model/flux_map.h"
#include "base/memory.h"
#include "io/table.h"
#include <math.h>
#include <stdlib.h>

enum { COLUMNS = 6 };

/* The nodes along an axis: from low on, in equal steps. */
typedef struct Axis {
    int nodes;
    double low, step;
} Axis;

static int by_value(const void *a, const void *b)
{
    double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

/* The steps are as long as the first one that is longer than rounding. */
static Axis axis_of(const Table *table, int axis)
{
    const double rounding = 1e-6; /* of the whole length: digits of a file */
    size_t rows = (size_t)table->rows;
    double *place = mem_alloc(rows, sizeof *place);
    for (size_t k = 0; k < rows; k++) place[k] = table->values[COLUMNS * k + (size_t)axis];
    qsort(place, rows, sizeof *place, by_value);
    double length = place[rows - 1] - place[0];
    Axis found = {1, place[0], 1};
    for (size_t k = 1; k < rows; k++)
        if (place[k] - place[k - 1] > rounding * length) found.nodes++;
    if (found.nodes > 1) found.step = length / (found.nodes - 1);
    mem_free(place);
    return found;
}

/* The number of a row's node on the grid; -1: it is on none. */
static long node_of(const Axis axis[3], const double *row)
{
    const double little = 1e-3;
    long node = 0;
    for (int i = 0; i < 3; i++) {
        double steps = (row[i] - axis[i].low) / axis[i].step, whole = rint(steps);
        if (!(fabs(steps - whole) < little)) return -1;
        node = node * axis[i].nodes + (long)whole;
    }
    return node;
}

/* values[3][nodes], and in line[nodes] where each is in the file. */
static bool fill(const char *path, const Table *table, const Axis axis[3], size_t nodes, double *values,
                 int *line, Error *err)
{
    for (int k = 0; k < table->rows; k++) {
        const double *row = table->values + (size_t)k * COLUMNS;
        long node = node_of(axis, row);
        if (node < 0)
            return error_set(err, "%s:%d: (%g, %g, %g) m is not on a grid of equal steps, %d x %d x %d nodes",
                             path, table->line[k], row[0], row[1], row[2], axis[0].nodes, axis[1].nodes,
                             axis[2].nodes);
        if (line[node])
            return error_set(err, "%s:%d: the node at (%g, %g, %g) m is there already, in line %d", path,
                             table->line[k], row[0], row[1], row[2], line[node]);
        line[node] = table->line[k];
        for (size_t i = 0; i < 3; i++) values[i * nodes + (size_t)node] = row[3 + i];
    }
    return true;
}

static FluxField *make(const Axis axis[3], size_t nodes, const double *values)
{
    int count[3];
    double low[3], step[3];
    CubicGrid grid[3];
    for (int i = 0; i < 3; i++) count[i] = axis[i].nodes, low[i] = axis[i].low, step[i] = axis[i].step;
    for (size_t i = 0; i < 3; i++) grid[i] = cubic_grid_create(count, low, step, values + i * nodes, false);
    return flux_field_map(grid);
}

FluxField *flux_map_read(const char *path, double factor, Error *err)
{
    Table table;
    if (!table_read(path, "x [m], y [m], z [m], Bx [T], By [T], Bz [T]", &table, err)) return NULL;
    Axis axis[3];
    double nodes = 1;
    for (int i = 0; i < 3; i++) axis[i] = axis_of(&table, i), nodes *= axis[i].nodes;
    FluxField *field = NULL;
    if (nodes != table.rows) {
        error_set(err, "%s: %d rows are no grid: there are %d places along x, %d along y and %d along z",
                  path, table.rows, axis[0].nodes, axis[1].nodes, axis[2].nodes);
    } else {
        size_t count = (size_t)table.rows;
        double *values = mem_alloc(3 * count, sizeof *values);
        int *line = mem_alloc(count, sizeof *line);
        if (fill(path, &table, axis, count, values, line, err)) {
            for (size_t k = 0; k < 3 * count; k++) values[k] *= factor;
            field = make(axis, count, values);
        }
        mem_free(values);
        mem_free(line);
    }
    table_clear(&table);
    return field;
}
