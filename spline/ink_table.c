#include "spline/ink_table.h"
#include "base/memory.h"
#include <math.h>

enum { SIDE = 33, NODES = SIDE * SIDE * SIDE };

typedef struct InkTable {
    const InkSet *set;
    Vec3 black, white; /* what black and white shall become */
    double *cover;     /* [NODES][count]; NaN: not yet asked for */
} InkTable;

Vec3 ink_linear(Color color)
{
    return vec3(color_linear(color.r), color_linear(color.g), color_linear(color.b));
}

/* The nearest that the inks make. */
static Vec3 nearest(const InkSet *set, Vec3 color)
{
    double cover[INK_MAX];
    ink_match(set, color, cover);
    return ink_mix(set, cover);
}

/* From black to white, each of red, green and blue for itself. */
static Vec3 between(const InkTable *table, Vec3 color)
{
    Vec3 black = table->black, white = table->white;
    return vec3(black.x + color.x * (white.x - black.x), black.y + color.y * (white.y - black.y),
                black.z + color.z * (white.z - black.z));
}

static const double *node_cover(InkTable *table, int r, int g, int b)
{
    double *cover = table->cover + (size_t)((r * SIDE + g) * SIDE + b) * (size_t)table->set->count;
    const double last = SIDE - 1;
    if (isnan(*cover))
        ink_match(table->set, between(table, ink_linear((Color){r / last, g / last, b / last, 1})), cover);
    return cover;
}

/* Into which cell of the table a level falls, and how far into it. */
static int cell_of(double level, double *into)
{
    double place = (SIDE - 1) * fmin(fmax(level, 0), 1);
    int cell = place < SIDE - 1 ? (int)place : SIDE - 2;
    *into = place - cell;
    return cell;
}

static void look_up(InkTable *table, const double *dark, double *cover)
{
    double into[3];
    int cell[3];
    for (int c = 0; c < 3; c++) cell[c] = cell_of(1 - dark[c], &into[c]);
    for (int k = 0; k < table->set->count; k++) cover[k] = 0;
    for (int corner = 0; corner < 8; corner++) {
        int up[] = {corner & 1, corner >> 1 & 1, corner >> 2};
        double weight = 1;
        for (int c = 0; c < 3; c++) weight *= up[c] ? into[c] : 1 - into[c];
        if (weight == 0) continue;
        const double *node = node_cover(table, cell[0] + up[0], cell[1] + up[1], cell[2] + up[2]);
        for (int k = 0; k < table->set->count; k++) cover[k] += weight * node[k];
    }
}

/* Without its nodes. */
static InkTable table_of(const InkSet *set, InkIntent intent)
{
    InkTable table = {set, vec3(0, 0, 0), vec3(1, 1, 1), NULL};
    if (intent == INK_RELATIVE) {
        table.black = nearest(set, table.black);
        table.white = nearest(set, table.white);
    }
    return table;
}

SplineField ink_table_light(const InkSet *set, InkIntent intent, const SplineField *dark)
{
    InkTable table = table_of(set, intent);
    SplineField light = spline_field_like(dark, 3);
    for (size_t i = 0; i < (size_t)dark->columns * (size_t)dark->rows; i++) {
        const double *d = dark->values + 3 * i;
        Vec3 color = between(&table, ink_linear((Color){1 - d[0], 1 - d[1], 1 - d[2], 1}));
        vec3_store(light.values + 3 * i, vec3_sub(color, set->paper));
    }
    return light;
}

void ink_table_cover(const InkSet *set, InkIntent intent, const SplineField *dark, SplineField *cover)
{
    size_t entries = NODES * (size_t)set->count;
    InkTable table = table_of(set, intent);
    table.cover = mem_alloc(entries, sizeof *table.cover);
    for (size_t i = 0; i < entries; i++) table.cover[i] = NAN;
    for (int k = 0; k < set->count; k++) cover[k] = spline_field_like(dark, 1);
    for (size_t i = 0; i < (size_t)dark->columns * (size_t)dark->rows; i++) {
        double inks[INK_MAX];
        look_up(&table, dark->values + 3 * i, inks);
        for (int k = 0; k < set->count; k++) cover[k].values[i] = inks[k];
    }
    mem_free(table.cover);
}
