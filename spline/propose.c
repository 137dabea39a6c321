/* Where ink is missing, and strokes for there (revise.h). */
#include "base/memory.h"
#include "spline/outline.h"
#include "spline/relax_private.h"
#include "spline/revise.h"
#include "spline/tone.h"
#include <math.h>
#include <stdlib.h>

/* Missing ink in square tiles, three of which a stroke is long. */
typedef struct Missing {
    int columns, rows;
    double size;
    double *length; /* [rows][columns] of ink; what is too much counts negative */
    double *weight; /* [rows][columns] of what is missing, and it alone          */
    Vec2 *moment;   /* [rows][columns] of its places, times that                 */
} Missing;

static Missing missing_create(const SplinePage *page, double size)
{
    Missing missing = {
        .columns = (int)ceil(page->width / size), .rows = (int)ceil(page->height / size), .size = size};
    size_t count = (size_t)missing.columns * (size_t)missing.rows;
    missing.length = mem_alloc(count, sizeof *missing.length);
    missing.weight = mem_alloc(count, sizeof *missing.weight);
    missing.moment = mem_alloc(count, sizeof *missing.moment);
    return missing;
}

static void missing_clear(Missing *missing)
{
    mem_free(missing->length);
    mem_free(missing->weight);
    mem_free(missing->moment);
}

static void sum_missing(Missing *missing, const Tone *tone)
{
    const Probes *probes = tone->probes;
    for (int l = 0; l < probes->level_count; l++) {
        const ProbeLevel *level = &probes->levels[l];
        for (int j = 0; j < level->rows; j++)
            for (int i = 0; i < level->columns; i++) {
                long k = level->first + (long)j * level->stride + i;
                if (probes->inverse[k] == 0) continue;
                double x = (i + 0.5) * level->dx, y = (j + 0.5) * level->dy;
                double length = level->dx * level->dy * (probes->target[k] - tone->ink[k]) / tone->pen;
                int tile = (int)(y / missing->size) * missing->columns + (int)(x / missing->size);
                missing->length[tile] += length;
                if (length <= 0) continue;
                missing->weight[tile] += length;
                missing->moment[tile].x += length * x;
                missing->moment[tile].y += length * y;
            }
    }
}

/* Of a tile and those around it: the missing length, and the centre of what is missing. */
static double around(const Missing *missing, int tile, Vec2 *center)
{
    double length = 0, weight = 0;
    int column = tile % missing->columns, row = tile / missing->columns;
    *center = (Vec2){0, 0};
    for (int k = 0; k < 9; k++) {
        int i = column + k % 3 - 1, j = row + k / 3 - 1, at = j * missing->columns + i;
        if (i < 0 || j < 0 || i >= missing->columns || j >= missing->rows) continue;
        length += missing->length[at];
        weight += missing->weight[at];
        center->x += missing->moment[at].x, center->y += missing->moment[at].y;
    }
    center->x /= weight, center->y /= weight;
    return length;
}

/* The direction that costs least, in the sense of `like`; to the right where there are none. */
static Vec2 direction_at(const SplineTarget *target, Vec2 at, Vec2 like)
{
    Vec2 v = {1, 0};
    if (target->align) {
        GridSample M;
        grid_spline_sample(target->align, (Pack2){pack_set(at.x), pack_set(at.y)}, 0, &M);
        double angle = atan2(-2 * M.value[1][0], M.value[2][0] - M.value[0][0]) / 2;
        v = (Vec2){cos(angle), sin(angle)};
    }
    return v.x * like.x + v.y * like.y < 0 ? (Vec2){-v.x, -v.y} : v;
}

static bool is_on_page(const SplinePage *page, Vec2 p)
{
    return fmin(p.x, page->width - p.x) > page->pen && fmin(p.y, page->height - p.y) > page->pen;
}

/* From a place along v, by the rule of the midpoint, until the edge; returns how many steps it got. */
static int follow(const SplineTarget *target, Vec2 at, Vec2 v, double step, int steps, Vec2 *places)
{
    for (int k = 0; k < steps; k++) {
        v = direction_at(target, at, v);
        v = direction_at(target, (Vec2){at.x + step / 2 * v.x, at.y + step / 2 * v.y}, v);
        at = (Vec2){at.x + step * v.x, at.y + step * v.y};
        if (!is_on_page(&target->page, at)) return k;
        places[k] = at;
    }
    return steps;
}

/* Tangents of a third of the rest length, along the chords between neighbours. */
static void set_tangents(double (*q)[4], int nodes, double rest)
{
    for (int k = 0; k < nodes; k++) {
        const double *a = q[k > 0 ? k - 1 : 0], *b = q[k + 1 < nodes ? k + 1 : k];
        double length = hypot(b[0] - a[0], b[1] - a[1]);
        q[k][2] = rest / 3 * (b[0] - a[0]) / length;
        q[k][3] = rest / 3 * (b[1] - a[1]) / length;
    }
}

/* A stroke whose middle is at the place. */
static void add_candidate(const SplineTarget *target, Vec2 center, double rest, int segments,
                          Strokes *candidates)
{
    Vec2 *back = mem_alloc((size_t)segments, sizeof *back), *on = back + segments / 2, v = {1, 0};
    v = direction_at(target, center, v);
    int before = follow(target, center, (Vec2){-v.x, -v.y}, rest, segments / 2, back);
    int after = follow(target, center, v, rest, segments - segments / 2, on), nodes = before + 1 + after;
    double(*q)[4] = mem_alloc((size_t)nodes, sizeof *q);
    for (int k = 0; k < nodes; k++) {
        Vec2 p = k < before ? back[before - 1 - k] : k == before ? center : on[k - before - 1];
        q[k][0] = p.x, q[k][1] = p.y;
    }
    if (nodes > 1) {
        set_tangents(q, nodes, rest);
        strokes_add(candidates, nodes, (const double(*)[4])q, 0);
    }
    mem_free(q);
    mem_free(back);
}

/* A tile and what is missing around it. */
typedef struct Tile {
    double length;
    int number;
} Tile;

static int by_length(const void *a, const void *b)
{
    const Tile *x = a, *y = b;
    if (x->length != y->length) return x->length > y->length ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

/* All tiles, those that miss most first. */
static Tile *sorted_tiles(const Missing *missing)
{
    int count = missing->columns * missing->rows;
    Tile *tiles = mem_alloc((size_t)count, sizeof *tiles);
    Vec2 center;
    for (int k = 0; k < count; k++) tiles[k] = (Tile){around(missing, k, &center), k};
    qsort(tiles, (size_t)count, sizeof *tiles, by_length);
    return tiles;
}

/* Marks the tiles whose squares would meet that of this one; false where it is marked. */
static bool take_tile(const Missing *missing, bool *taken, int tile)
{
    if (taken[tile]) return false;
    int column = tile % missing->columns, row = tile / missing->columns;
    for (int j = row - 2; j <= row + 2; j++)
        for (int i = column - 2; i <= column + 2; i++)
            if (i >= 0 && j >= 0 && i < missing->columns && j < missing->rows)
                taken[j * missing->columns + i] = true;
    return true;
}

void spline_propose_strokes(const SplineTarget *target, const RelaxDef *def, const Strokes *strokes,
                            int segments, Strokes *candidates)
{
    double rest = spline_segment_length(def->rest > 0 ? def->rest : relax_default().rest, target->spacing);
    segments = (int)fmax(fmin(segments, spline_ink_budget(target) / rest), 1);
    double length = segments * rest;
    Missing missing = missing_create(&target->page, fmax(length / 3, target->spacing / 2));
    Tone tone = tone_of_strokes(target, strokes, target->page.pen);
    sum_missing(&missing, &tone);
    Tile *tiles = sorted_tiles(&missing);
    int count = missing.columns * missing.rows;
    bool *taken = mem_alloc((size_t)count, sizeof *taken);
    for (int k = 0; k < count && tiles[k].length > length / 2; k++) {
        Vec2 center;
        if (!take_tile(&missing, taken, tiles[k].number)) continue;
        around(&missing, tiles[k].number, &center);
        if (is_on_page(&target->page, center)) add_candidate(target, center, rest, segments, candidates);
    }
    spline_outline_cut(target, target->page.pen / 2, candidates);
    mem_free(taken);
    mem_free(tiles);
    tone_clear(&tone);
    missing_clear(&missing);
}
