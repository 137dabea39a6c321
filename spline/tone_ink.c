#include "base/memory.h"
#include "spline/tone.h"

/* Strips are more than threads, so that these end at about the same time; where they are cut shall not cost a look at
 * all points. */
enum { BANDS = 256, MAX_STRIPS = 64, STRIPS_PER_THREAD = 4, TASK_POINTS = 2048, CUT_EVERY = 8 };

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
    mem_free(tone->sights);
}

static double page_height(const Tone *tone)
{
    const ProbeLevel *level = &tone->probes->levels[0];
    return level->rows * level->dy;
}

static int band_of(double y, double height)
{
    return probe_index(y / height * BANDS, 0, BANDS - 1);
}

typedef struct Look {
    Tone *tone;
    const SplinePoints *points;
} Look;

static void look_task(void *self, int task)
{
    const Look *look = self;
    const SplinePoints *points = look->points;
    double height = page_height(look->tone);
    for (int p = task * TASK_POINTS; p < (task + 1) * TASK_POINTS && p < points->count; p++)
        look->tone->sights[p] =
            (ToneSight){(uint16_t)probe_levels(look->tone->probes, points->x[p], points->y[p]),
                        (uint16_t)band_of(points->y[p], height)};
}

static void look_at_points(Tone *tone, const SplinePoints *points)
{
    if (points->count > tone->sight_room) {
        mem_free(tone->sights);
        tone->sights = mem_alloc((size_t)points->count, sizeof *tone->sights);
        tone->sight_room = points->count;
    }
    workers_run(tone->workers, (points->count + TASK_POINTS - 1) / TASK_POINTS, look_task,
                &(Look){tone, points});
}

/* The page in strips of rows, with about as many points in each. */
typedef struct Strips {
    Tone *tone;
    const SplinePoints *points;
    int count;
    double edge[MAX_STRIPS + 1];
} Strips;

static int strip_count(const Tone *tone)
{
    int threads = workers_count(tone->workers), most = threads > 1 ? STRIPS_PER_THREAD * threads : 1;
    return most < MAX_STRIPS ? most : MAX_STRIPS;
}

static void cut_strips(Strips *s)
{
    double height = page_height(s->tone);
    int points[BANDS] = {0}, strip = 0;
    long sum = 0, all = 0;
    for (int p = 0; p < s->points->count; p += CUT_EVERY, all++) points[s->tone->sights[p].band]++;
    s->edge[0] = -INFINITY;
    for (int b = 0; b < BANDS; b++) {
        sum += points[b];
        while (strip < s->count && sum * s->count > (strip + 1) * all)
            s->edge[++strip] = height * (b + 1) / BANDS;
    }
    while (strip < s->count) s->edge[++strip] = INFINITY;
    s->edge[s->count] = INFINITY;
}

/* Bands with points that the probes of some rows may see. */
static SplineRange bands_of(const Tone *tone, const ProbeRows *rows)
{
    SplineRange bands = {BANDS, 0};
    for (int l = 0; l < tone->probes->level_count; l++) {
        if (rows->from[l] >= rows->to[l]) continue;
        int first = band_of(rows->low[l], page_height(tone)),
            end = band_of(rows->high[l], page_height(tone)) + 1;
        if (first < bands.first) bands.first = first;
        if (end > bands.end) bands.end = end;
    }
    return bands;
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
    SplineRange bands = bands_of(s->tone, &rows);
    for (int p = 0; p < points->count; p++) {
        ToneSight sight = s->tone->sights[p];
        if (sight.band >= bands.first && sight.band < bands.end)
            probes_spread(probes, &rows, sight.levels, points->x[p], points->y[p], c * points->ink[p], ink);
    }
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
    Strips strips = {.tone = tone, .points = points, .count = strip_count(tone)};
    look_at_points(tone, points);
    cut_strips(&strips);
    workers_run(tone->workers, strips.count, spread_task, &strips);
    workers_run(tone->workers, tone->row_count, force_task, tone);
    double energy = 0;
    for (int k = 0; k < tone->row_count; k++) energy += tone->rows[k];
    return energy;
}

Tone tone_of_strokes(const SplineTarget *target, const Strokes *strokes, double pen)
{
    SplineModelDef def = spline_model_default();
    double *rest = mem_alloc((size_t)strokes_segment_count(strokes), sizeof *rest); /* no matter for ink */
    SplineModel *model = spline_model_create(target, strokes, rest, &def);
    SplinePoints points = spline_points_create(&model->rule, model->segment_count, M_PI / 8 * pen);
    spline_points_update(&points, model, strokes->q);
    Tone tone = tone_create(target, NULL);
    tone.pen = pen;
    tone_update(&tone, &points);
    spline_points_clear(&points);
    spline_model_destroy(model);
    mem_free(rest);
    return tone;
}
