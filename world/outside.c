#include "world/outside.h"
#include "base/memory.h"
#include "base/vec3.h"
#include <string.h>

/* Of each vertex, the cells around it. */
typedef struct Around {
    int *first, *cell; /* [vertex + 1]; of all */
} Around;

static Around cells_around(const Samples *cells, int vertex_count)
{
    int corners = cells->count * cells->corners;
    Around around = {mem_alloc((size_t)vertex_count + 2, sizeof(int)),
                     mem_alloc((size_t)corners, sizeof(int))};
    /* Where the next cell of a vertex goes; at last where those of the next vertex begin. */
    int *next = around.first + 1;
    for (int i = 0; i < corners; i++) next[cells->vertices[i] + 1]++;
    for (int v = 0; v < vertex_count; v++) next[v + 1] += next[v];
    for (int i = 0; i < corners; i++) around.cell[next[cells->vertices[i]]++] = i / cells->corners;
    return around;
}

static bool has_corners(const Samples *cells, int cell, const Samples *parts, int part)
{
    const int *own = cells->vertices + (long)cell * cells->corners;
    int found = 0;
    for (int i = 0; i < parts->corners; i++)
        for (int j = 0; j < cells->corners; j++)
            found += own[j] == parts->vertices[(long)part * parts->corners + i];
    return found == parts->corners;
}

/* Length, or twice the area. */
static double size_of(const Samples *cells, int cell, const double (*rest)[3])
{
    const int *v = cells->vertices + (long)cell * cells->corners;
    Vec3 a = vec3_load(rest[v[0]]), way = vec3_sub(vec3_load(rest[v[1]]), a);
    return vec3_length(cells->corners == 2 ? way : vec3_cross(way, vec3_sub(vec3_load(rest[v[2]]), a)));
}

/* Writes the entries of a part; returns where those of the next one begin. */
static int put_part(Outside *o, const Around *around, const Samples *parts, const Samples *cells, int part,
                    const double (*rest)[3])
{
    int corner = parts->vertices[(long)part * parts->corners], end = o->first[part];
    double sum = 0;
    for (int k = around->first[corner]; k < around->first[corner + 1]; k++) {
        int cell = around->cell[k];
        if (!has_corners(cells, cell, parts, part)) continue;
        sum += o->weight[end] = size_of(cells, cell, rest);
        o->cell[end++] = cell;
    }
    for (int k = o->first[part]; k < end; k++) o->weight[k] /= sum;
    return end;
}

Outside *outside_create(const Samples *parts, const Samples *cells, const double (*rest)[3], int vertex_count,
                        const double *outside, int doubled)
{
    Outside *o = mem_alloc(1, sizeof *o);
    Around around = cells_around(cells, vertex_count);
    int room = 0;
    for (int e = 0; e < parts->count; e++) {
        int corner = parts->vertices[(long)e * parts->corners];
        room += around.first[corner + 1] - around.first[corner];
    }
    *o = (Outside){.cells = outside, .doubled = doubled};
    o->first = mem_alloc((size_t)parts->count + 1, sizeof *o->first);
    o->cell = mem_alloc((size_t)room, sizeof *o->cell);
    o->weight = mem_alloc((size_t)room, sizeof *o->weight);
    for (int e = 0; e < parts->count; e++) o->first[e + 1] = put_part(o, &around, parts, cells, e, rest);
    mem_free(around.first);
    mem_free(around.cell);
    return o;
}

void outside_destroy(Outside *o)
{
    if (!o) return;
    mem_free(o->first);
    mem_free(o->cell);
    mem_free(o->weight);
    mem_free(o);
}

double outside_at(const Outside *o, int part, const double *p)
{
    double sum = 0;
    if (p && o->doubled >= 0) return outside_change(o, part, p); /* it is linear */
    for (int k = o->first[part]; k < o->first[part + 1]; k++) sum += o->weight[k] * o->cells[o->cell[k]];
    return sum;
}

double outside_change(const Outside *o, int part, const double *dp)
{
    double sum = 0;
    for (int k = o->first[part]; o->doubled >= 0 && k < o->first[part + 1]; k++)
        sum += o->weight[k] * dp[o->doubled + o->cell[k]] / 2;
    return sum;
}

void outside_back(const Outside *o, int part, double amount, double *dp)
{
    for (int k = o->first[part]; o->doubled >= 0 && k < o->first[part + 1]; k++)
        dp[o->doubled + o->cell[k]] += amount * o->weight[k] / 2;
}
