#include "base/weld.h"
#include "base/memory.h"
#include <limits.h>
#include <stdint.h>
#include <string.h>
#include <math.h>

/* Chains of kept points by the hash of their cell. Chains may mix cells: distances decide. */
typedef struct Grid {
    const double (*points)[3];
    double distance, cell; /* cell edge, m; 0: every coordinate is a cell of its own */
    uint64_t mask;
    int *head, *next; /* [mask + 1], [point]; -1 ends a chain */
} Grid;

static double cell_of(const Grid *grid, double x)
{
    return (grid->cell > 0 ? floor(x / grid->cell) : x) + 0.0; /* -0 and 0 are one cell */
}

static uint64_t bucket(const Grid *grid, double cx, double cy, double cz)
{
    double cell[3] = {cx, cy, cz};
    uint64_t bits[3], hash = 0;
    memcpy(bits, cell, sizeof bits);
    for (int k = 0; k < 3; k++) { /* twice: small whole numbers differ only in their 12 highest bits */
        hash = (hash ^ bits[k]) * 0x9e3779b97f4a7c15u;
        hash = (hash ^ hash >> 32) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return hash & grid->mask;
}

static double distance_between(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

/* The lowest point of that chain within reach of p, or INT_MAX. */
static int lowest_in_chain(const Grid *grid, const double p[3], uint64_t chain)
{
    int lowest = INT_MAX;
    for (int u = grid->head[chain]; u >= 0; u = grid->next[u])
        if (u < lowest && distance_between(grid->points[u], p) <= grid->distance) lowest = u;
    return lowest;
}

/* A reach of a quarter cell touches at most two cells per axis. */
static int lowest_near(const Grid *grid, const double p[3])
{
    double ends[3][2];
    for (int k = 0; k < 3; k++)
        for (int side = 0; side < 2; side++)
            ends[k][side] = cell_of(grid, p[k] + (side ? grid->distance : -grid->distance));
    int lowest = INT_MAX;
    for (int corner = 0; corner < 8; corner++) {
        int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
        if ((i && ends[0][0] == ends[0][1]) || (j && ends[1][0] == ends[1][1]) ||
            (k && ends[2][0] == ends[2][1]))
            continue;
        int found = lowest_in_chain(grid, p, bucket(grid, ends[0][i], ends[1][j], ends[2][k]));
        if (found < lowest) lowest = found;
    }
    return lowest;
}

static void keep(Grid *grid, int v)
{
    const double *p = grid->points[v];
    uint64_t chain = bucket(grid, cell_of(grid, p[0]), cell_of(grid, p[1]), cell_of(grid, p[2]));
    grid->next[v] = grid->head[chain];
    grid->head[chain] = v;
}

void weld_map(const double (*points)[3], int count, double distance, int *first)
{
    Grid grid = {.points = points, .distance = distance, .cell = 4 * distance, .mask = 1};
    while (grid.mask < (uint64_t)count) grid.mask = 2 * grid.mask + 1;
    grid.head = mem_alloc(grid.mask + 1, sizeof(int));
    grid.next = mem_alloc((size_t)count, sizeof(int));
    memset(grid.head, -1, (grid.mask + 1) * sizeof(int));
    for (int v = 0; v < count; v++) {
        int found = lowest_near(&grid, points[v]);
        first[v] = found < v ? found : v;
        if (first[v] == v) keep(&grid, v);
    }
    mem_free(grid.head);
    mem_free(grid.next);
}
