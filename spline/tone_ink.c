#include "spline/tone.h"
#include "base/memory.h"

enum { BINS = 256, MAX_STRIPS = 64 };

Tone tone_create(const SplineTarget *target, Workers *workers)
{
    const Probes *probes = target->probes;
    Tone tone = {.probes = probes, .pen = target->page.pen, .workers = workers};
    for (int l = 0; l < probes->level_count; l++) tone.row_count += probes->levels[l].rows;
    tone.ink = mem_alloc((size_t)probes->size, sizeof *tone.ink);
    tone.force = mem_alloc((size_t)probes->size, sizeof *tone.force);
    tone.rows = mem_alloc((size_t)tone.row_count, sizeof *tone.rows);
    return tone;
}

void tone_clear(Tone *tone)
{
    mem_free(tone->ink);
    mem_free(tone->force);
    mem_free(tone->rows);
}

/* The page in strips of rows, one for each thread, with about as many points in each. */
typedef struct Strips {
    Tone *tone;
    const SplinePoints *points;
    int count;
    double edge[MAX_STRIPS + 1];
} Strips;

static int bin_of(double y, double height)
{
    double bin = fmin(fmax(y / height * BINS, 0), BINS - 1);
    return (int)bin;
}

static void cut_strips(Strips *s)
{
    const ProbeLevel *level = &s->tone->probes->levels[0];
    double height = level->rows * level->dy;
    int points[BINS] = {0}, strip = 0;
    for (int p = 0; p < s->points->count; p++) points[bin_of(s->points->y[p], height)]++;
    s->edge[0] = -INFINITY;
    long sum = 0;
    for (int b = 0; b < BINS; b++) {
        sum += points[b];
        while (strip < s->count && sum * s->count > (long)(strip + 1) * s->points->count)
            s->edge[++strip] = height * (b + 1) / BINS;
    }
    while (strip < s->count) s->edge[++strip] = INFINITY;
    s->edge[s->count] = INFINITY;
}

/* Each probe sums its points in their order, whatever the strips are. */
static void spread_task(void *self, int strip)
{
    const Strips *s = self;
    const SplinePoints *points = s->points;
    const Probes *probes = s->tone->probes;
    double *ink = s->tone->ink, c = 4 * s->tone->pen / M_PI;
    ProbeRows rows = probe_rows(probes, s->edge[strip], s->edge[strip + 1]);
    for (int l = 0; l < probes->level_count; l++) {
        const ProbeLevel *level = &probes->levels[l];
        if (rows.from[l] < rows.to[l])
            memset(ink + level->first + (long)rows.from[l] * level->stride, 0,
                   (size_t)(rows.to[l] - rows.from[l]) * (size_t)level->stride * sizeof *ink);
    }
    for (int p = 0; p < points->count; p++)
        probes_spread(probes, &rows, points->x[p], points->y[p], c * points->ink[p], ink);
}

/* Energies and forces of the rows of one level, from one on. */
static double take_row(Tone *tone, long first, int columns)
{
    const Probes *probes = tone->probes;
    Pack energy = {0};
    for (long k = first; k < first + columns; k += PACK_LANES) {
        Pack off = pack_load(tone->ink + k) - pack_load(probes->target + k),
             force = pack_load(probes->gain + k) * off;
        energy += force * off;
        pack_store(tone->force + k, force);
    }
    return pack_sum(energy, PACK_LANES) / 2;
}

static void force_task(void *self, int task)
{
    Tone *tone = self;
    int row = task;
    for (int l = 0; l < tone->probes->level_count; l++) {
        const ProbeLevel *level = &tone->probes->levels[l];
        if (row < level->rows) {
            tone->rows[task] = take_row(tone, level->first + (long)row * level->stride, level->columns);
            return;
        }
        row -= level->rows;
    }
}

double tone_update(Tone *tone, const SplinePoints *points)
{
    int threads = workers_count(tone->workers);
    Strips strips = {.tone = tone, .points = points, .count = threads < MAX_STRIPS ? threads : MAX_STRIPS};
    cut_strips(&strips);
    workers_run(tone->workers, strips.count, spread_task, &strips);
    workers_run(tone->workers, tone->row_count, force_task, tone);
    double energy = 0;
    for (int k = 0; k < tone->row_count; k++) energy += tone->rows[k];
    return energy;
}
