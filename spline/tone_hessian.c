#include "spline/tone_hessian.h"
#include "base/memory.h"
#include <stdlib.h>

/* drho_c/dx of one segment at eight cells in a row, from (level, row j, column i) on, over 4 pen/pi; false
 * where none of them sees it. */
static bool ink_gradient(const Probes *probes, const ProbeLevel *level, int i, int j,
                         const SplinePoints *points, int m, Pack gradient[8])
{
    const SplineRule *rule = points->rule;
    Pack inverse = pack_load(probes->inverse + level->first + (long)j * level->stride + i), near = {0};
    Pack dx[RULE_MAX_GAUSS], z[RULE_MAX_GAUSS];
    for (int q = 0; q < rule->count; q++) {
        int p = m * rule->count + q;
        dx[q] = probe_dx(level, points->x[p], i);
        z[q] = probe_closeness(dx[q], points->y[p] - (j + 0.5) * level->dy, inverse);
        near += z[q];
    }
    if (!(pack_sum(near * inverse, PACK_LANES) > 0)) return false;
    memset(gradient, 0, 8 * sizeof *gradient);
    for (int q = 0; q < rule->count; q++) {
        int p = m * rule->count + q;
        double dy = points->y[p] - (j + 0.5) * level->dy;
        Pack along = rule->weight[q] / points->n[p] * inverse * z[q] * z[q] * z[q],
             slope = -6 * points->ink[p] * inverse * inverse * z[q] * z[q];
        for (int k = 0; k < 4; k++) {
            gradient[2 * k] += rule->value[q][k] * slope * dx[q] + rule->first[q][k] * along * points->tx[p];
            gradient[2 * k + 1] += rule->value[q][k] * slope * dy + rule->first[q][k] * along * points->ty[p];
        }
    }
    return true;
}

/* Cells of a level that may see a segment within a margin. */
static ProbeWindow segment_window(const ProbeLevel *level, const SplinePoints *points, int m, double margin)
{
    ProbeLevel wide = *level;
    wide.reach += margin;
    int Q = points->rule->count;
    ProbeWindow all = probe_window(&wide, points->x[m * Q], points->y[m * Q]);
    for (int p = m * Q + 1; p < (m + 1) * Q; p++) {
        ProbeWindow w = probe_window(&wide, points->x[p], points->y[p]);
        if (w.left < all.left) all.left = w.left;
        if (w.top < all.top) all.top = w.top;
        if (w.right > all.right) all.right = w.right;
        if (w.bottom > all.bottom) all.bottom = w.bottom;
    }
    return all;
}

static unsigned segment_levels(const Probes *probes, const SplinePoints *points, int m)
{
    unsigned seen = 0;
    for (int p = m * points->rule->count; p < (m + 1) * points->rule->count; p++)
        seen |= probe_levels(probes, points->x[p], points->y[p]);
    return seen;
}

/* Lower triangles of all segments' blocks. */
typedef struct Own {
    const Tone *tone;
    const SplinePoints *points;
    double scale;
    double (*blocks)[36]; /* [segments] */
} Own;

static void add_own_level(const Own *own, const ProbeLevel *level, int m, Pack sum[36])
{
    const Probes *probes = own->tone->probes;
    ProbeWindow w = segment_window(level, own->points, m, 0);
    for (int j = w.top; j <= w.bottom; j++)
        for (int i = w.left; i <= w.right; i += PACK_LANES) {
            Pack gradient[8], gain = pack_load(probes->gain + level->first + (long)j * level->stride + i);
            if (!ink_gradient(probes, level, i, j, own->points, m, gradient)) continue;
            for (int a = 0, k = 0; a < 8; a++)
                for (int b = 0; b <= a; b++, k++) sum[k] += gain * gradient[a] * gradient[b];
        }
}

enum { TASK_SEGMENTS = 32 };

static void own_task(void *self, int task)
{
    const Own *own = self;
    int count = own->points->count / own->points->rule->count;
    for (int m = task * TASK_SEGMENTS; m < (task + 1) * TASK_SEGMENTS && m < count; m++) {
        Pack sum[36] = {{0}};
        unsigned seen = segment_levels(own->tone->probes, own->points, m);
        for (int l = 0; seen >> l; l++)
            if (seen >> l & 1) add_own_level(own, &own->tone->probes->levels[l], m, sum);
        for (int k = 0; k < 36; k++) own->blocks[m][k] = own->scale * pack_sum(sum[k], PACK_LANES);
    }
}

static double gauss_newton_scale(const Tone *tone, double K)
{
    double c = 4 * tone->pen / M_PI;
    return K * c * c;
}

void tone_add_own(const Tone *tone, const SplineModel *model, const SplinePoints *points, double K,
                  const BulkMatrix *H)
{
    Own own = {tone, points, gauss_newton_scale(tone, K), NULL};
    own.blocks = mem_alloc((size_t)model->segment_count, sizeof *own.blocks);
    workers_run(tone->workers, (model->segment_count + TASK_SEGMENTS - 1) / TASK_SEGMENTS, own_task, &own);
    for (int m = 0; m < model->segment_count; m++) {
        double block[64];
        for (int a = 0; a < 8; a++)
            for (int b = 0; b < 8; b++)
                block[8 * a + b] = own.blocks[m][a > b ? TERM_LOWER(a, b) : TERM_LOWER(b, a)];
        spline_add_block(H, model, m, m, block);
    }
    mem_free(own.blocks);
}

void tone_add_curvature(const Tone *tone, const SplineModel *model, const SplinePoints *points, double K,
                        const BulkMatrix *H)
{
    const SplineRule *rule = points->rule;
    for (int m = 0; m < model->segment_count; m++) {
        double block[64] = {0};
        for (int q = 0; q < rule->count; q++) {
            int p = m * rule->count + q;
            ProbeSums s = tone_sums(tone, points, p, 2);
            double w = K * rule->weight[q], n = points->n[p], u[2] = {points->tx[p] / n, points->ty[p] / n};
            double ink = K * points->ink[p], slope[2] = {s.x, s.y};
            double rr[2][2] = {{ink * s.xx, ink * s.xy}, {ink * s.xy, ink * s.yy}};
            for (int a = 0; a < 8; a++)
                for (int b = 0; b < 8; b++) {
                    int i = a % 2, j = b % 2;
                    double Na = rule->value[q][a / 2], Ta = rule->first[q][a / 2];
                    double Nb = rule->value[q][b / 2], Tb = rule->first[q][b / 2];
                    double tt = s.value * ((i == j) - u[i] * u[j]) / n;
                    block[8 * a + b] += Na * Nb * rr[i][j] + w * (Na * Tb * slope[i] * u[j] +
                                                                  Ta * Nb * u[i] * slope[j] + Ta * Tb * tt);
                }
        }
        spline_add_block(H, model, m, m, block);
    }
}

/* Does any point of the segment come within R + margin of the cell? */
static bool is_seen(double inverse, double x, double y, const SplinePoints *points, int m, double margin)
{
    double R = 1 / sqrt(inverse) + margin;
    for (int p = m * points->rule->count; p < (m + 1) * points->rule->count; p++) {
        double dx = points->x[p] - x, dy = points->y[p] - y;
        if (dx * dx + dy * dy < R * R) return true;
    }
    return false;
}

/* Sights of a segment; with cell NULL they are only counted. */
static long find_sights(const Probes *probes, const SplinePoints *points, int m, double margin, long *cell)
{
    long count = 0;
    for (int l = 0; l < probes->level_count; l++) {
        const ProbeLevel *level = &probes->levels[l];
        ProbeWindow w = segment_window(level, points, m, margin);
        for (int j = w.top; j <= w.bottom; j++)
            for (int i = w.left; i <= w.right; i++) {
                long k = level->first + (long)j * level->stride + i;
                if (probes->inverse[k] == 0) continue;
                if (!is_seen(probes->inverse[k], (i + 0.5) * level->dx, (j + 0.5) * level->dy, points, m,
                             margin))
                    continue;
                if (cell) cell[count] = k;
                count++;
            }
    }
    return count;
}

static void clear_lists(ToneCoupling *c)
{
    mem_free(c->x);
    mem_free(c->start);
    mem_free(c->cell);
    spline_pairs_clear(&c->pairs);
}

void tone_coupling_clear(ToneCoupling *coupling)
{
    clear_lists(coupling);
}

/* Sights by cell: first and end of each sight's fellows. */
static void transpose(ToneCoupling *c, const Probes *probes, long sights, int segments)
{
    long *at = mem_alloc((size_t)probes->size + 1, sizeof *at);
    for (long s = 0; s < sights; s++) at[c->cell[s] + 1]++;
    for (long k = 0; k < probes->size; k++) at[k + 1] += at[k];
    for (long s = 0; s < sights; s++) c->first[s] = at[c->cell[s]], c->end[s] = at[c->cell[s] + 1];
    for (int m = 0; m < segments; m++)
        for (long s = c->start[m]; s < c->start[m + 1]; s++)
            c->segment[s] = m, c->by_cell[at[c->cell[s]]++] = s;
    mem_free(at);
}

/* Each segment with those before it and itself. */
static void find_pairs(ToneCoupling *c, int segments)
{
    int *mark = mem_alloc((size_t)segments, sizeof *mark);
    for (int m = 0; m < segments; m++)
        for (long s = c->start[m]; s < c->start[m + 1]; s++)
            for (long k = c->first[s]; k < c->end[s]; k++) {
                int other = c->segment[c->by_cell[k]];
                if (other > m) break;
                if (mark[other] == m + 1) continue;
                mark[other] = m + 1;
                spline_pairs_add(&c->pairs, m, other);
            }
    mem_free(mark);
}

static bool has_moved(const ToneCoupling *c, const SplinePoints *points)
{
    for (int p = 0; p < points->count; p++) {
        double dx = points->x[p] - c->x[p], dy = points->y[p] - c->y[p];
        if (!(dx * dx + dy * dy < c->margin * c->margin)) return true;
    }
    return false;
}

bool tone_couple(ToneCoupling *c, const Tone *tone, const SplineModel *model, const SplinePoints *points)
{
    if (c->x && !has_moved(c, points)) return false;
    clear_lists(c);
    size_t count = (size_t)points->count;
    c->x = mem_alloc(2 * count, sizeof *c->x);
    c->y = c->x + count;
    memcpy(c->x, points->x, count * sizeof *c->x);
    memcpy(c->y, points->y, count * sizeof *c->y);
    int segments = model->segment_count;
    c->start = mem_alloc((size_t)segments + 1, sizeof *c->start);
    for (int m = 0; m < segments; m++)
        c->start[m + 1] = c->start[m] + find_sights(tone->probes, points, m, c->margin, NULL);
    long sights = c->start[segments];
    c->cell = mem_alloc(5 * (size_t)sights, sizeof *c->cell);
    c->first = c->cell + sights, c->end = c->first + sights, c->by_cell = c->end + sights;
    c->segment = (int *)(c->by_cell + sights);
    for (int m = 0; m < segments; m++) find_sights(tone->probes, points, m, c->margin, c->cell + c->start[m]);
    transpose(c, tone->probes, sights, segments);
    find_pairs(c, segments);
    return true;
}

/* drho_c/dx of a segment at one cell, over 4 pen/pi. */
static void sight_gradient(const Tone *tone, const SplinePoints *points, int m, long cell, double gradient[8])
{
    const Probes *probes = tone->probes;
    int l = 0;
    while (l + 1 < probes->level_count && cell >= probes->levels[l + 1].first) l++;
    const ProbeLevel *level = &probes->levels[l];
    long place = cell - level->first;
    Pack packs[8] = {{0}};
    ink_gradient(probes, level, (int)(place % level->stride), (int)(place / level->stride), points, m, packs);
    for (int i = 0; i < 8; i++) gradient[i] = packs[i][0];
}

/* Blocks of a segment with those before it, found by `place`. */
static void add_products(const ToneCoupling *c, const Tone *tone, int m, double (*gradients)[8],
                         const int *place, double (*blocks)[64])
{
    for (long s = c->start[m]; s < c->start[m + 1]; s++) {
        double gain = tone->probes->gain[c->cell[s]];
        for (long k = c->first[s]; k < c->end[s]; k++) {
            long other = c->by_cell[k];
            if (c->segment[other] > m) break;
            double *block = blocks[place[c->segment[other]]];
            for (int a = 0; a < 8; a++)
                for (int b = 0; b < 8; b++) block[8 * a + b] += gain * gradients[s][a] * gradients[other][b];
        }
    }
}

void tone_add_coupled(const ToneCoupling *c, const Tone *tone, const SplineModel *model,
                      const SplinePoints *points, double K, const BulkMatrix *H)
{
    int segments = model->segment_count;
    double(*gradients)[8] = mem_alloc((size_t)c->start[segments], sizeof *gradients);
    int *place = mem_alloc((size_t)segments, sizeof *place);
    double(*blocks)[64] = mem_alloc((size_t)segments, sizeof *blocks), scale = gauss_newton_scale(tone, K);
    for (long s = 0; s < c->start[segments]; s++)
        sight_gradient(tone, points, c->segment[s], c->cell[s], gradients[s]);
    for (long p = 0, first = 0; p < c->pairs.count; first = p) {
        int m = c->pairs.pairs[p][0], count = 0;
        for (; p < c->pairs.count && c->pairs.pairs[p][0] == m; p++) place[c->pairs.pairs[p][1]] = count++;
        memset(blocks, 0, (size_t)count * sizeof *blocks);
        add_products(c, tone, m, gradients, place, blocks);
        for (int k = 0; k < count; k++) {
            for (int i = 0; i < 64; i++) blocks[k][i] *= scale;
            spline_add_block(H, model, m, c->pairs.pairs[first + k][1], blocks[k]);
        }
    }
    mem_free(gradients);
    mem_free(place);
    mem_free(blocks);
}
