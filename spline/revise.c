#include "spline/revise.h"
#include "base/memory.h"
#include "spline/local.h"
#include "spline/relax_private.h"
#include "spline/tone.h"
#include <math.h>
#include <stdlib.h>

/* A stroke and what its coming or going changes. */
typedef struct Gain {
    double change;
    int stroke;
} Gain;

static int by_change(const void *a, const void *b)
{
    const Gain *x = a, *y = b;
    if (x->change != y->change) return x->change < y->change ? -1 : 1;
    return (x->stroke > y->stroke) - (x->stroke < y->stroke);
}

/* Those strokes that come, or go. */
typedef struct Choice {
    int first, end, least;
    const double *x; /* dofs of all when they come; NULL: they go */
    bool *absent;    /* [strokes] brought up to date              */
} Choice;

static double try_stroke(Local *local, const SplineModel *model, const Choice *c, int stroke)
{
    return local_change(local, stroke, c->x ? c->x + 4 * model->start[stroke] : NULL);
}

/* Where the energy falls, and at least so many. Returns how many. */
static int choose(Local *local, const SplineModel *model, const Choice *c)
{
    int changed = 0, count = c->end - c->first;
    Gain *gains = mem_alloc((size_t)count, sizeof *gains);
    for (int k = 0; k < count; k++) {
        gains[k] = (Gain){try_stroke(local, model, c, c->first + k), c->first + k};
        local_reject(local);
    }
    qsort(gains, (size_t)count, sizeof *gains, by_change);
    for (int i = 0; i < count && (gains[i].change < 0 || changed < c->least); i++) {
        double change = try_stroke(local, model, c, gains[i].stroke);
        if (change < 0 || changed < c->least) {
            local_accept(local);
            c->absent[gains[i].stroke] = !c->x;
            changed++;
        } else {
            local_reject(local);
        }
    }
    mem_free(gains);
    return changed;
}

static void add_stroke(Strokes *to, const Strokes *from, int stroke)
{
    int first = from->start[stroke];
    strokes_add(to, from->start[stroke + 1] - first, (const double(*)[4])(from->q + 4 * first),
                from->layer[stroke]);
}

/* Of the strokes those that are not absent. */
static Strokes present(const Strokes *strokes, const bool *absent)
{
    Strokes left = {0};
    for (int k = 0; k < strokes->count; k++)
        if (!absent[k]) add_stroke(&left, strokes, k);
    return left;
}

/* Lets strokes from `candidate` on come or, where there are none, all go. Returns how many did. */
static int revise(const SplineTarget *target, const RelaxDef *def, int candidate, int least, Strokes *strokes)
{
    bool coming = candidate < strokes->count, *absent = mem_alloc((size_t)strokes->count, sizeof *absent);
    for (int k = candidate; k < strokes->count; k++) absent[k] = true;
    double *rest = spline_rest_lengths(target, def, strokes);
    SplineModel *model = spline_model_create(target, strokes, rest, &def->model);
    SplineWeights weights = spline_weights_scaled(def->weights, target->page.pen, target->spacing);
    Local *local = local_create(model, &weights, strokes->q, absent);
    Choice choice = {coming ? candidate : 0, strokes->count, least, coming ? strokes->q : NULL, absent};
    int changed = choose(local, model, &choice);
    local_destroy(local);
    spline_model_destroy(model);
    Strokes left = present(strokes, absent);
    strokes_clear(strokes);
    *strokes = left;
    mem_free(rest);
    mem_free(absent);
    return changed;
}

int spline_remove_strokes(const SplineTarget *target, const RelaxDef *def, int least, Strokes *strokes)
{
    return strokes->count ? revise(target, def, strokes->count, least, strokes) : 0;
}

int spline_insert_strokes(const SplineTarget *target, const RelaxDef *def, const Strokes *candidates,
                          int least, Strokes *strokes)
{
    int before = strokes->count;
    for (int k = 0; k < candidates->count; k++) add_stroke(strokes, candidates, k);
    return candidates->count ? revise(target, def, before, least, strokes) : 0;
}

/* Missing ink in square tiles, three of which a stroke is long. */
typedef struct Missing {
    int columns, rows;
    double size;
    double *length; /* [rows][columns] of ink; what is too much counts negative          */
    Vec2 *moment;   /* [rows][columns] of its places where it is missing; with `short` */
    double *weight; /* [rows][columns] of what is missing alone                        */
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

/* The direction that costs least, as near to `last` as its sense allows; to the right where there are none.
 */
static Vec2 direction_at(const SplineTarget *target, Vec2 at, Vec2 last)
{
    Vec2 v = {1, 0};
    if (target->align) {
        GridSample M;
        grid_spline_sample(target->align, pack_set(at.x), pack_set(at.y), 0, &M);
        double angle = atan2(-2 * M.value[1][0], M.value[2][0] - M.value[0][0]) / 2;
        v = (Vec2){cos(angle), sin(angle)};
    }
    return v.x * last.x + v.y * last.y < 0 ? (Vec2){-v.x, -v.y} : v;
}

static bool is_on_page(const SplinePage *page, Vec2 p)
{
    return fmin(p.x, page->width - p.x) > page->pen && fmin(p.y, page->height - p.y) > page->pen;
}

/* From a place on, by the rule of the midpoint; returns how many steps it got. */
static int follow(const SplineTarget *target, Vec2 at, double step, int steps, Vec2 *places)
{
    Vec2 last = {step > 0 ? 1 : -1, 0};
    double way = fabs(step);
    for (int k = 0; k < steps; k++) {
        Vec2 v = k || step > 0 ? direction_at(target, at, last) : direction_at(target, at, (Vec2){1, 0});
        if (k == 0 && step < 0) v = (Vec2){-v.x, -v.y};
        last = direction_at(target, (Vec2){at.x + way / 2 * v.x, at.y + way / 2 * v.y}, v);
        at = (Vec2){at.x + way * last.x, at.y + way * last.y};
        if (!is_on_page(&target->page, at)) return k;
        places[k] = at;
    }
    return steps;
}

/* A stroke whose middle is at the place. */
static void add_candidate(const SplineTarget *target, Vec2 center, double rest, int segments,
                          Strokes *candidates)
{
    Vec2 *places = mem_alloc(2 * (size_t)segments + 1, sizeof *places), *back = places + segments + 1;
    int before = follow(target, center, -rest, segments / 2, back);
    int after = follow(target, center, rest, segments - segments / 2, places), nodes = before + 1 + after;
    double(*q)[4] = mem_alloc((size_t)nodes, sizeof *q);
    for (int k = 0; k < nodes; k++) {
        Vec2 p = k < before ? back[before - 1 - k] : k == before ? center : places[k - before - 1];
        q[k][0] = p.x, q[k][1] = p.y;
    }
    for (int k = 0; k < nodes && nodes > 1; k++) {
        const double *a = q[k > 0 ? k - 1 : 0], *b = q[k + 1 < nodes ? k + 1 : k];
        double length = hypot(b[0] - a[0], b[1] - a[1]);
        q[k][2] = rest / 3 * (b[0] - a[0]) / length, q[k][3] = rest / 3 * (b[1] - a[1]) / length;
    }
    if (nodes > 1) strokes_add(candidates, nodes, (const double(*)[4])q, 0);
    mem_free(q);
    mem_free(places);
}

static Tone tone_of(const SplineTarget *target, const RelaxDef *def, const Strokes *strokes)
{
    double *rest = spline_rest_lengths(target, def, strokes);
    SplineModel *model = spline_model_create(target, strokes, rest, &def->model);
    SplinePoints points = spline_points_create(&model->rule, model->segment_count);
    spline_points_update(&points, model, strokes->q);
    Tone tone = tone_create(target, NULL);
    tone_update(&tone, &points);
    spline_points_clear(&points);
    spline_model_destroy(model);
    mem_free(rest);
    return tone;
}

void spline_propose_strokes(const SplineTarget *target, const RelaxDef *def, const Strokes *strokes,
                            int segments, Strokes *candidates)
{
    double rest = (def->rest > 0 ? def->rest : relax_default().rest) * target->spacing,
           length = segments * rest;
    Missing missing = missing_create(&target->page, length / 3);
    Tone tone = tone_of(target, def, strokes);
    sum_missing(&missing, &tone);
    int tiles = missing.columns * missing.rows;
    Gain *worst = mem_alloc((size_t)tiles, sizeof *worst);
    bool *taken = mem_alloc((size_t)tiles, sizeof *taken);
    Vec2 center;
    for (int k = 0; k < tiles; k++) worst[k] = (Gain){-around(&missing, k, &center), k};
    qsort(worst, (size_t)tiles, sizeof *worst, by_change);
    for (int k = 0; k < tiles && worst[k].change < -length / 2; k++) {
        int tile = worst[k].stroke, column = tile % missing.columns, row = tile / missing.columns;
        bool free = true;
        for (int other = 0; other < tiles; other++)
            if (taken[other] && abs(other % missing.columns - column) < 3 &&
                abs(other / missing.columns - row) < 3)
                free = false;
        if (!free) continue;
        taken[tile] = true;
        around(&missing, tile, &center);
        if (is_on_page(&target->page, center)) add_candidate(target, center, rest, segments, candidates);
    }
    mem_free(worst);
    mem_free(taken);
    tone_clear(&tone);
    missing_clear(&missing);
}

/* How many strokes are too many, at their rest lengths: a crowd has pressed itself together. */
static int surplus(const SplineTarget *target, const RelaxDef *def, const Strokes *strokes)
{
    double *rest = spline_rest_lengths(target, def, strokes), ink = 0;
    for (int k = 0; k < strokes_segment_count(strokes); k++) ink += rest[k];
    mem_free(rest);
    double excess = ink - spline_ink_budget(target);
    return excess > 0 ? (int)lround(excess * strokes->count / ink) : 0;
}

RelaxInfo spline_refine(const SplineTarget *target, const RelaxDef *def, int rounds, int segments,
                        Strokes *strokes, const RelaxObserver *observer)
{
    RelaxInfo best = spline_relax(target, def, strokes, observer);
    for (int round = 0; round < rounds && best.status != RELAX_STOPPED; round++) {
        Strokes trial = strokes_copy(strokes), candidates = {0};
        int changed = spline_remove_strokes(target, def, surplus(target, def, strokes), &trial);
        spline_propose_strokes(target, def, &trial, segments, &candidates);
        changed += spline_insert_strokes(target, def, &candidates, candidates.count, &trial);
        strokes_clear(&candidates);
        RelaxInfo info = best;
        if (changed) info = spline_relax(target, def, &trial, observer);
        if (!changed || info.energy >= best.energy) {
            strokes_clear(&trial);
            break;
        }
        info.iterations += best.iterations;
        best = info;
        strokes_clear(strokes);
        *strokes = trial;
    }
    return best;
}
