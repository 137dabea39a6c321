#include "spline/lanes.h"
#include "base/memory.h"
#include <stdlib.h>

enum { LEVELS_MAX = 12 };

static const double least_cell = 1.0 / 4000; /* of a page of area 1: 64 MB */

typedef struct Sample {
    Vec2 at;
    int curve, along;
    int next; /* in its cell; -1: the last */
} Sample;

/* Cells of one size, and the samples in them. */
typedef struct Level {
    double cell;
    int columns, rows, stride; /* of the samples, those with along % stride == 0 */
    int *head;                 /* [rows][columns]; -1: empty */
    Sample *samples;
    int count, room;
} Level;

struct Lanes {
    int levels;
    Level level[LEVELS_MAX];
    int count, room;
    unsigned short *places; /* [count] on how many levels each sample is */
};

Lanes *lanes_create(const SplinePage *page, double step, double reach)
{
    Lanes *lanes = mem_alloc(1, sizeof *lanes);
    double cell = fmax(2 * step, least_cell);
    while (lanes->levels < LEVELS_MAX && (lanes->levels == 0 || cell < 2 * reach)) {
        Level *level = &lanes->level[lanes->levels];
        *level = (Level){.cell = cell, .stride = 1 << (lanes->levels > 0 ? lanes->levels - 1 : 0)};
        level->columns = (int)(page->width / cell) + 1;
        level->rows = (int)(page->height / cell) + 1;
        size_t cells = (size_t)level->columns * (size_t)level->rows;
        level->head = mem_alloc(cells, sizeof *level->head);
        for (size_t i = 0; i < cells; i++) level->head[i] = -1;
        lanes->levels++;
        cell *= 2;
    }
    return lanes;
}

void lanes_destroy(Lanes *lanes)
{
    if (!lanes) return;
    for (int k = 0; k < lanes->levels; k++) {
        mem_free(lanes->level[k].head);
        mem_free(lanes->level[k].samples);
    }
    mem_free(lanes->places);
    mem_free(lanes);
}

static int clamp(int i, int count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

static int *level_cell(const Level *level, Vec2 at)
{
    int j = clamp((int)(at.x / level->cell), level->columns),
        i = clamp((int)(at.y / level->cell), level->rows);
    return level->head + (size_t)i * (size_t)level->columns + j;
}

void lanes_add(Lanes *lanes, Vec2 at, int curve, int along)
{
    if (lanes->count == lanes->room) {
        int room = 2 * lanes->room + 1024;
        lanes->places = mem_resize(lanes->places, (size_t)lanes->room, (size_t)room, sizeof *lanes->places);
        lanes->room = room;
    }
    int k = 0;
    for (; k < lanes->levels && along % lanes->level[k].stride == 0; k++) {
        Level *level = &lanes->level[k];
        if (level->count == level->room) {
            int room = 2 * level->room + 256;
            level->samples =
                mem_resize(level->samples, (size_t)level->room, (size_t)room, sizeof *level->samples);
            level->room = room;
        }
        int *head = level_cell(level, at);
        level->samples[level->count] = (Sample){at, curve, along, *head};
        *head = level->count++;
    }
    lanes->places[lanes->count++] = (unsigned short)k;
}

int lanes_count(const Lanes *lanes)
{
    return lanes->count;
}

void lanes_shrink(Lanes *lanes, int count)
{
    while (lanes->count > count) {
        int places = lanes->places[--lanes->count];
        for (int k = 0; k < places; k++) {
            Level *level = &lanes->level[k];
            const Sample *sample = &level->samples[--level->count];
            *level_cell(level, sample->at) = sample->next;
        }
    }
}

static bool cell_near(const Level *level, const Sample *query, int head, double square, int gap)
{
    for (int s = head; s >= 0; s = level->samples[s].next) {
        const Sample *sample = &level->samples[s];
        double dx = sample->at.x - query->at.x, dy = sample->at.y - query->at.y;
        if (dx * dx + dy * dy >= square) continue;
        if (sample->curve != query->curve || abs(sample->along - query->along) >= gap) return true;
    }
    return false;
}

bool lanes_near(const Lanes *lanes, Vec2 at, double distance, int own, int along, int gap)
{
    int k = 0;
    while (k < lanes->levels - 1 && lanes->level[k].cell < distance) k++;
    const Level *level = &lanes->level[k];
    Sample query = {.at = at, .curve = own, .along = along};
    int reach = (int)ceil(distance / level->cell);
    int j0 = clamp((int)floor(at.x / level->cell), level->columns),
        i0 = clamp((int)floor(at.y / level->cell), level->rows);
    for (int i = i0 - reach; i <= i0 + reach; i++)
        for (int j = j0 - reach; j <= j0 + reach; j++)
            if (i >= 0 && j >= 0 && i < level->rows && j < level->columns &&
                cell_near(level, &query, level->head[(size_t)i * (size_t)level->columns + (size_t)j],
                          distance * distance, gap))
                return true;
    return false;
}
