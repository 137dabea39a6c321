#include "spline/local.h"
#include "base/memory.h"
#include "spline/length.h"
#include "spline/local_pair.h"
#include "spline/terms.h"
#include "spline/tone.h"

/* A stroke's ink, there or not. */
typedef struct Ink {
    bool there;
    SplinePoints points; /* room for the longest stroke; count is what is used */
    double energy;       /* of the terms over its segments */
} Ink;

struct Local {
    const SplineModel *model;
    SplineWeights weights;
    int term_count;
    Term terms[SPLINE_WEIGHT_COUNT];
    double *x; /* [4 node_count] */
    bool *absent;
    Tone tone;
    double *delta; /* [probes->size] change of the ink; 0 between changes */
    ProbeWindow box[PROBES_MAX_LEVELS];
    LocalPair pair;
    /* The change at hand. */
    int stroke;
    Ink before, after;
    double *q; /* new dofs of the stroke */
};

static int longest_stroke(const SplineModel *model)
{
    int longest = 0;
    for (int k = 0; k < model->stroke_count; k++) {
        int nodes = model->start[k + 1] - model->start[k];
        if (nodes > longest) longest = nodes;
    }
    return longest;
}

/* The ink of a stroke with these dofs; NULL: none. */
static void set_ink(const Local *local, Ink *ink, int stroke, const double *q)
{
    int segments = local->model->start[stroke + 1] - local->model->start[stroke] - 1;
    ink->there = q != NULL;
    ink->points.count = q ? segments * local->model->rule.count : 0;
    for (int m = 0; q && m < segments; m++)
        spline_points_set(&ink->points, m, m == 0, m == segments - 1, q + 4 * m);
}

/* One term's energy of a stroke: packs that hold some of its segments; other lanes repeat one of them. */
static double term_energy(const Local *local, const Term *term, int stroke, const double *q)
{
    int first = spline_first_segment(local->model, stroke),
        end = spline_first_segment(local->model, stroke + 1);
    Point at = {.p = (const double *)&local->weights};
    double energy = 0;
    for (int pack = first / PACK_LANES; pack * PACK_LANES < end; pack++) {
        Pack x[8];
        for (int l = 0; l < PACK_LANES; l++) {
            int m = pack * PACK_LANES + l, own = m < first ? 0 : m < end ? m - first : end - 1 - first;
            for (int i = 0; i < 8; i++) x[i][l] = q[4 * own + i];
        }
        Pack energies = term->ops->eval(term->self, pack, &at, x, NULL, NULL);
        for (int l = 0; l < PACK_LANES; l++) {
            int m = pack * PACK_LANES + l;
            if (m >= first && m < end) energy += energies[l];
        }
    }
    return energy;
}

static double terms_energy(const Local *local, int stroke, const double *q)
{
    double energy = 0;
    for (int t = 0; q && t < local->term_count; t++)
        energy += term_energy(local, &local->terms[t], stroke, q);
    return energy;
}

static double length_energy(const Local *local, const Ink *ink)
{
    if (!ink->there) return 0;
    return spline_length_energy(local->model, local->weights.length, local->stroke, &ink->points);
}

static void spread_ink(const Local *local, const Ink *ink, double sign)
{
    const SplinePoints *points = &ink->points;
    const Probes *probes = local->tone.probes;
    ProbeRows rows = probe_rows(probes, -INFINITY, INFINITY);
    double c = sign * 4 * local->tone.pen / M_PI;
    for (int p = 0; p < points->count; p++)
        probes_spread(probes, &rows, probe_levels(probes, points->x[p], points->y[p]), points->x[p],
                      points->y[p], c * points->ink[p], local->delta);
}

/* Cells whose ink may change. */
static void find_boxes(Local *local)
{
    const Probes *probes = local->tone.probes;
    for (int l = 0; l < probes->level_count; l++) {
        const ProbeLevel *level = &probes->levels[l];
        ProbeWindow box = {level->columns, -1, level->rows, -1};
        for (int side = 0; side < 2; side++) {
            const SplinePoints *points = side ? &local->after.points : &local->before.points;
            for (int p = 0; p < points->count; p++) {
                if (!(probe_levels(probes, points->x[p], points->y[p]) >> l & 1)) continue;
                ProbeWindow w = probe_window(level, points->x[p], points->y[p]);
                if (w.left < box.left) box.left = w.left;
                if (w.right > box.right) box.right = w.right;
                if (w.top < box.top) box.top = w.top;
                if (w.bottom > box.bottom) box.bottom = w.bottom;
            }
        }
        local->box[l] = box;
    }
}

/* What is done with a row of a box: packs of cells from `first` on. */
typedef void RowAction(Local *local, long first, int columns, double *sum);

static void for_each_row(Local *local, RowAction *action, double *sum)
{
    const Probes *probes = local->tone.probes;
    for (int l = 0; l < probes->level_count; l++) {
        const ProbeWindow *box = &local->box[l];
        for (int j = box->top; j <= box->bottom; j++)
            action(local, probes->levels[l].first + (long)j * probes->levels[l].stride + box->left,
                   box->right - box->left + 1, sum);
    }
}

/* gain ((off + delta)^2 - off^2)/2 */
static void sum_row(Local *local, long first, int columns, double *sum)
{
    const Probes *probes = local->tone.probes;
    Pack energy = {0};
    for (long k = first; k < first + columns; k += PACK_LANES) {
        Pack delta = pack_load(local->delta + k),
             off = pack_load(local->tone.ink + k) - pack_load(probes->target + k);
        energy += pack_load(probes->gain + k) * delta * (off + delta / 2);
    }
    *sum += pack_sum(energy, PACK_LANES);
}

static void take_row(Local *local, long first, int columns, double *sum)
{
    (void)sum;
    for (long k = first; k < first + columns; k++) {
        local->tone.ink[k] += local->delta[k];
        local->delta[k] = 0;
    }
}

static void drop_row(Local *local, long first, int columns, double *sum)
{
    (void)sum;
    memset(local->delta + first, 0, (size_t)columns * sizeof *local->delta);
}

double local_change(Local *local, int stroke, const double *q)
{
    const SplineModel *model = local->model;
    int first = model->start[stroke], nodes = model->start[stroke + 1] - first;
    const double *old = local->absent[stroke] ? NULL : local->x + 4 * first;
    local->stroke = stroke;
    set_ink(local, &local->before, stroke, old);
    set_ink(local, &local->after, stroke, q);
    if (q) memcpy(local->q, q, 4 * (size_t)nodes * sizeof *q);
    double change = terms_energy(local, stroke, q) - terms_energy(local, stroke, old);
    if (local->weights.length != 0)
        change += length_energy(local, &local->after) - length_energy(local, &local->before);
    if (local->weights.tone != 0) {
        double sum = 0;
        find_boxes(local);
        spread_ink(local, &local->before, -1);
        spread_ink(local, &local->after, 1);
        for_each_row(local, sum_row, &sum);
        change += local->weights.tone * sum;
    }
    if (local->weights.pair != 0) {
        local_pair_remove(&local->pair, spline_first_segment(model, stroke) * model->rule.count,
                          local->before.points.count);
        change += local_pair_energy(&local->pair, &local->after.points) -
                  local_pair_energy(&local->pair, &local->before.points);
    }
    return change;
}

static void put_pairs(Local *local, const Ink *ink)
{
    int first = spline_first_segment(local->model, local->stroke) * local->model->rule.count;
    if (local->weights.pair != 0) local_pair_insert(&local->pair, first, &ink->points);
}

void local_accept(Local *local)
{
    int first = local->model->start[local->stroke], nodes = local->model->start[local->stroke + 1] - first;
    local->absent[local->stroke] = !local->after.there;
    if (local->after.there) memcpy(local->x + 4 * first, local->q, 4 * (size_t)nodes * sizeof *local->x);
    if (local->weights.tone != 0) for_each_row(local, take_row, NULL);
    put_pairs(local, &local->after);
}

void local_reject(Local *local)
{
    if (local->weights.tone != 0) for_each_row(local, drop_row, NULL);
    put_pairs(local, &local->before);
}

void local_renew(Local *local)
{
    const Probes *probes = local->tone.probes;
    memset(local->tone.ink, 0, (size_t)probes->size * sizeof *local->tone.ink);
    for (int k = 0; local->weights.tone != 0 && k < local->model->stroke_count; k++) {
        if (local->absent[k]) continue;
        set_ink(local, &local->after, k, local->x + 4 * local->model->start[k]);
        spread_ink(local, &local->after, 1);
    }
    for (long k = 0; k < probes->size; k++) local->tone.ink[k] = local->delta[k], local->delta[k] = 0;
}

static void add_terms(Local *local)
{
    const double *weights = (const double *)&local->weights;
    for (int row = 0; row < SPLINE_WEIGHT_COUNT; row++)
        if (weights[row] != 0 && spline_term_rows[row].term)
            local->terms[local->term_count++] = spline_term_rows[row].term(local->model, SPLINE_OWN);
}

Local *local_create(const SplineModel *model, const SplineWeights *weights, const double *x,
                    const bool *absent)
{
    Local *local = mem_alloc(1, sizeof *local);
    int longest = longest_stroke(model), strokes = model->stroke_count;
    *local = (Local){.model = model, .weights = *weights, .tone = tone_create(model->target, NULL)};
    add_terms(local);
    local->x = mem_copy(x, 4 * (size_t)model->node_count, sizeof *x);
    local->absent = absent ? mem_copy(absent, (size_t)strokes, sizeof *absent)
                           : mem_alloc((size_t)strokes, sizeof *absent);
    local->delta = mem_alloc((size_t)local->tone.probes->size, sizeof *local->delta);
    local->q = mem_alloc(4 * (size_t)longest, sizeof *local->q);
    double cap = spline_pen_cap(&model->target->page);
    local->before.points = spline_points_create(&model->rule, longest, cap);
    local->after.points = spline_points_create(&model->rule, longest, cap);
    local->pair = local_pair_create(model, weights->pair);
    for (local->stroke = 0; local->stroke < strokes; local->stroke++) {
        if (local->absent[local->stroke]) continue;
        set_ink(local, &local->after, local->stroke, x + 4 * model->start[local->stroke]);
        put_pairs(local, &local->after);
    }
    local_renew(local);
    return local;
}

void local_destroy(Local *local)
{
    if (!local) return;
    for (int t = 0; t < local->term_count; t++) local->terms[t].ops->destroy(local->terms[t].self);
    tone_clear(&local->tone);
    local_pair_clear(&local->pair);
    spline_points_clear(&local->before.points);
    spline_points_clear(&local->after.points);
    mem_free(local->x);
    mem_free(local->absent);
    mem_free(local->delta);
    mem_free(local->q);
    mem_free(local);
}
