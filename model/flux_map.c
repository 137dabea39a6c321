#include "model/flux_map.h"
#include "base/memory.h"
#include "io/grid_file.h"
#include "io/table.h"
#include <math.h>
#include <stdlib.h>
#include <strings.h>
#include <string.h>

enum { COLUMNS = 6 };

static int by_value(const void *a, const void *b)
{
    double left = *(const double *)a, right = *(const double *)b;
    return (left > right) - (left < right);
}

/* The steps are as long as the first one that is longer than rounding. */
static void find_axis(const Table *table, int axis, GridFile *grid)
{
    const double rounding = 1e-6; /* of the whole length: digits of a file */
    size_t rows = (size_t)table->rows;
    double *place = mem_alloc(rows, sizeof *place);
    for (size_t k = 0; k < rows; k++) place[k] = table->values[COLUMNS * k + (size_t)axis];
    qsort(place, rows, sizeof *place, by_value);
    double length = place[rows - 1] - place[0];
    int nodes = 1;
    for (size_t k = 1; k < rows; k++)
        if (place[k] - place[k - 1] > rounding * length) nodes++;
    grid->nodes[axis] = nodes;
    grid->low[axis] = place[0];
    grid->step[axis] = nodes > 1 ? length / (nodes - 1) : 1;
    mem_free(place);
}

/* The number of a row's node on the grid; -1: it is on none. */
static long node_of(const GridFile *grid, const double *row)
{
    const double little = 1e-3;
    long node = 0;
    for (int i = 0; i < 3; i++) {
        double steps = (row[i] - grid->low[i]) / grid->step[i], whole = rint(steps);
        if (!(fabs(steps - whole) < little)) return -1;
        node = node * grid->nodes[i] + (long)whole;
    }
    return node;
}

/* The grid's values, [3][nodes], and in line[nodes] where each is in the file. */
static bool fill(const char *path, const Table *table, GridFile *grid, int *line, Error *err)
{
    const int *n = grid->nodes;
    size_t nodes = (size_t)table->rows;
    for (int k = 0; k < table->rows; k++) {
        const double *row = table->values + (size_t)k * COLUMNS;
        long node = node_of(grid, row);
        if (node < 0)
            return error_set(err, "%s:%d: (%g, %g, %g) m is not on a grid of equal steps, %d x %d x %d nodes",
                             path, table->line[k], row[0], row[1], row[2], n[0], n[1], n[2]);
        if (line[node])
            return error_set(err, "%s:%d: the node at (%g, %g, %g) m is there already, in line %d", path,
                             table->line[k], row[0], row[1], row[2], line[node]);
        line[node] = table->line[k];
        for (size_t i = 0; i < 3; i++) grid->values[i * nodes + (size_t)node] = row[3 + i];
    }
    return true;
}

static bool read_table(const char *path, GridFile *grid, Error *err)
{
    Table table;
    if (!table_read(path, "x [m], y [m], z [m], Bx [T], By [T], Bz [T]", &table, err)) return false;
    for (int i = 0; i < 3; i++) find_axis(&table, i, grid);
    const int *n = grid->nodes;
    size_t count = (size_t)table.rows;
    int *line = mem_alloc(count, sizeof *line);
    grid->values = mem_alloc(3 * count, sizeof *grid->values);
    bool ok =
        (double)n[0] * n[1] * n[2] == table.rows
            ? fill(path, &table, grid, line, err)
            : error_set(err,
                        "%s: %d rows are no grid: there are %d places along x, %d along y and %d along z",
                        path, table.rows, n[0], n[1], n[2]);
    mem_free(line);
    table_clear(&table);
    return ok;
}

static FluxField *make(const GridFile *grid, double factor)
{
    const int *n = grid->nodes;
    size_t nodes = (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
    CubicGrid component[3];
    for (size_t k = 0; k < 3 * nodes; k++) grid->values[k] *= factor;
    for (size_t i = 0; i < 3; i++)
        component[i] = cubic_grid_create(n, grid->low, grid->step, grid->values + i * nodes, false);
    return flux_field_map(component);
}

static bool is_hdf5(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (!strcasecmp(dot, ".h5") || !strcasecmp(dot, ".hdf5"));
}

FluxField *flux_map_read(const char *path, double factor, Error *err)
{
    static const char *const components[] = {"Bx", "By", "Bz"};
    GridFile grid = {0};
    bool ok =
        is_hdf5(path) ? grid_file_read(path, components, 3, "T", &grid, err) : read_table(path, &grid, err);
    FluxField *field = ok ? make(&grid, factor) : NULL;
    grid_file_clear(&grid);
    return field;
}
