#include "spline/streamlines.h"
#include "base/memory.h"
#include "base/random.h"
#include "spline/direction.h"
#include "spline/trace.h"
#include <math.h>

static const double SHORTEST = 0.7;  /* of a stroke, in nodes' distances; and no shorter than its spacing */
static const double FARTHEST = 0.15; /* of neighbours, in units of the page                               */
static const double SEED_ROOM = 0.9; /* around a new curve's seed, in spacings                            */

/* An evenly spaced drawing under way. */
typedef struct Spread {
    Tracer tracer;
    SplineStartDef def;
    Random random;
    int layer;
    Points seeds, curve;
    Strokes *strokes;
} Spread;

SplineStartDef spline_start_default(void)
{
    return (SplineStartDef){.separation = 0.8, .ink = 1, .longest = 0.3, .segments = 8, .seed = 1};
}

static double blank_density(const SplinePage *page)
{
    return page->pen / 0.3;
}

double spline_rest_length(const SplineGrid *tone, const SplinePage *page)
{
    double sum = 0, blank = blank_density(page);
    int count = tone->columns * tone->rows, drawn = 0;
    for (int i = 0; i < count; i++)
        if (tone->values[i] >= blank) sum += tone->values[i], drawn++;
    return drawn ? fmin(1.2 * page->pen * drawn / sum, 0.05) : 0;
}

/* The point so many steps along a curve. */
static Vec2 curve_point(const Points *curve, double at)
{
    int k = (int)fmin(fmax(at, 0), curve->count - 2);
    double s = fmin(fmax(at, 0), curve->count - 1) - k;
    Vec2 a = curve->at[k], b = curve->at[k + 1];
    return (Vec2){a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)};
}

/* The part from..to of a curve, in steps, as a stroke. */
static void add_stroke(const Tracer *tracer, const Points *curve, double from, double to, int segments,
                       int layer, Strokes *strokes)
{
    double each = (to - from) / segments, third = each * tracer->step / 3;
    double(*q)[4] = mem_alloc((size_t)segments + 1, sizeof *q);
    for (int k = 0; k <= segments; k++) {
        double at = from + k * each;
        Vec2 p = curve_point(curve, at), a = curve_point(curve, at - 0.5), b = curve_point(curve, at + 0.5);
        Vec2 v = spline_direction_at(tracer->direction, tracer->page, p, NULL);
        double length = v.x * (b.x - a.x) + v.y * (b.y - a.y) < 0 ? -third : third;
        q[k][0] = p.x;
        q[k][1] = p.y;
        q[k][2] = length * v.x;
        q[k][3] = length * v.y;
    }
    strokes_add(strokes, segments + 1, (const double(*)[4])q, layer);
    mem_free(q);
}

/* Pieces of whole segments. They aim at three quarters of the greatest length, so that chance can shift their
 * ends: cuts side by side would show as a seam. */
static void cut_curve(Spread *spread)
{
    const Tracer *tracer = &spread->tracer;
    double steps = spread->curve.count - 1, gap = tracer->page->pen / tracer->step;
    int segments = (int)fmax(lround(steps * tracer->step / spread->def.segment), 1);
    double each = steps / segments, longest = spread->def.longest / (each * tracer->step);
    int pieces = segments <= longest ? 1 : (int)ceil(segments / fmax(0.75 * longest, 1)), from = 0;
    for (int k = 1; k <= pieces; k++) {
        double shift = random_signed(&spread->random) / 6;
        int to = k == pieces ? segments : (int)lround((k + shift) * segments / pieces);
        if (to <= from) continue;
        add_stroke(tracer, &spread->curve, from * each + (from > 0 ? gap / 2 : 0),
                   to * each - (to < segments ? gap / 2 : 0), to - from, spread->layer, spread->strokes);
        from = to;
    }
}

/* Places to both sides, where a neighbour could start. */
static void add_seeds(Spread *spread)
{
    const Tracer *tracer = &spread->tracer;
    double since = INFINITY;
    for (int k = 0; k < spread->curve.count; k++, since += tracer->step) {
        Vec2 p = spread->curve.at[k];
        double spacing = trace_spacing(tracer, p);
        if (since < 0.5 * spacing && k < spread->curve.count - 1) continue;
        since = 0;
        Vec2 v = spline_direction_at(tracer->direction, tracer->page, p, NULL);
        for (int side = -1; side <= 1; side += 2) {
            Vec2 far = {p.x - side * spacing * v.y, p.y + side * spacing * v.x};
            double there = trace_spacing(tracer, far), d = fmin(1, (1 + there / spacing) / 2);
            if (there > 0)
                points_add(&spread->seeds, (Vec2){p.x + d * (far.x - p.x), p.y + d * (far.y - p.y)});
        }
    }
}

/* The curve through a seed, kept if it has room and becomes long enough: not a mere dash beside its
 * neighbours. */
static void try_seed(Spread *spread, Vec2 seed)
{
    Tracer *tracer = &spread->tracer;
    double spacing = trace_spacing(tracer, seed);
    if (!(spacing > 0) || lanes_near(tracer->lanes, seed, SEED_ROOM * spacing, -1, 0, 0)) return;
    int before = lanes_count(tracer->lanes), most = (int)(4 / tracer->step);
    trace_curve(tracer, seed, most, 2 * most, &spread->curve);
    double least = fmax(SHORTEST * spread->def.segment, spacing);
    if ((spread->curve.count - 1) * tracer->step < least) {
        lanes_shrink(tracer->lanes, before);
        return;
    }
    cut_curve(spread);
    add_seeds(spread);
    tracer->curve++;
}

/* Around the seeds of curves that exist, then through the holes that are left, each of which may seed more.
 */
static void spread_curves(Spread *spread)
{
    const SplinePage *page = spread->tracer.page;
    double pitch = 8 * spread->tracer.step;
    int columns = (int)(page->width / pitch) + 1, rows = (int)(page->height / pitch) + 1, next = 0;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) {
            try_seed(spread, (Vec2){(j + random_uniform(&spread->random)) * pitch,
                                    (i + random_uniform(&spread->random)) * pitch});
            for (; next < spread->seeds.count; next++) try_seed(spread, spread->seeds.at[next]);
        }
}

static double greatest_density(const SplineGrid *tone)
{
    double most = 0;
    for (int i = 0; i < tone->columns * tone->rows; i++) most = fmax(most, tone->values[i]);
    return most;
}

static Strokes even_strokes(const Tracer *base, const SplineStartDef *def, double separation, int layer)
{
    Strokes strokes = {0};
    Spread spread = {
        .tracer = *base, .def = *def, .random = random_seed(def->seed), .layer = layer, .strokes = &strokes};
    Tracer *tracer = &spread.tracer;
    tracer->separation = separation;
    tracer->lanes = lanes_create(tracer->page, tracer->step, tracer->farthest);
    spread_curves(&spread);
    lanes_destroy(tracer->lanes);
    mem_free(spread.seeds.at);
    mem_free(spread.curve.at);
    return strokes;
}

static void append(Strokes *strokes, const Strokes *more)
{
    for (int k = 0; k < more->count; k++)
        strokes_add(strokes, more->start[k + 1] - more->start[k],
                    (const double(*)[4])more->q + more->start[k], more->layer[k]);
}

void spline_streamlines(const SplineGrid *tone, const SplineGrid *direction, const SplinePage *page,
                        const SplineStartDef *def, int layer, Strokes *strokes)
{
    double most = greatest_density(tone), budget = spline_grid_mean(tone, 0) / page->pen;
    if (most < blank_density(page)) return;
    SplineStartDef whole = *def;
    if (!(whole.segment > 0)) whole.segment = spline_rest_length(tone, page);
    Tracer tracer = {.tone = tone,
                     .direction = direction,
                     .page = page,
                     .blank = blank_density(page),
                     .farthest = FARTHEST,
                     .step = fmax(whole.separation * page->pen / most / 4, 2e-5)};
    double separation = whole.separation;
    for (int tries = 1;; tries++) {
        Strokes even = even_strokes(&tracer, &whole, separation, layer);
        double ink = strokes_length(&even) / (budget * (whole.ink > 0 ? whole.ink : 1));
        if (!(whole.ink > 0) || tries == 3 || fabs(ink - 1) < 0.03) {
            append(strokes, &even);
            strokes_clear(&even);
            return;
        }
        strokes_clear(&even);
        separation *= ink;
    }
}

/* A curve through a random place that is as dark as chance wants it; false: there was none this time. */
static bool random_curve(Tracer *tracer, double most, int steps, Random *random, Points *curve)
{
    Vec2 at = {tracer->page->width * random_uniform(random), tracer->page->height * random_uniform(random)};
    double density;
    spline_grid_sample(tracer->tone, tracer->page, at, &density);
    bool wanted = random_uniform(random) * most <= density;
    curve->count = 0;
    if (!wanted || !(trace_spacing(tracer, at) > 0)) return false;
    trace_curve(tracer, at, (int)(random_uniform(random) * steps), steps, curve);
    return curve->count > 1;
}

void spline_random_strokes(const SplineGrid *tone, const SplineGrid *direction, const SplinePage *page,
                           const SplineStartDef *def, int layer, Strokes *strokes)
{
    enum { STEPS = 4, TRIES = 1000 }; /* steps of a segment; failures in a row that end the search */
    double most = greatest_density(tone),
           left = spline_grid_mean(tone, 0) / page->pen * (def->ink > 0 ? def->ink : 1);
    if (most < blank_density(page)) return;
    double segment = def->segment > 0 ? def->segment : spline_rest_length(tone, page);
    Tracer tracer = {.tone = tone,
                     .direction = direction,
                     .page = page,
                     .blank = blank_density(page),
                     .separation = def->separation,
                     .farthest = FARTHEST,
                     .step = segment / STEPS};
    Random random = random_seed(def->seed);
    Points curve = {0};
    for (int failed = 0; left > 0 && failed < TRIES;) {
        bool made = random_curve(&tracer, most, def->segments * STEPS, &random, &curve);
        double segments = made ? rint((curve.count - 1.0) / STEPS) : 0;
        if (segments < 1) {
            failed++;
            continue;
        }
        add_stroke(&tracer, &curve, 0, curve.count - 1, (int)segments, layer, strokes);
        left -= strokes_stroke_length(strokes, strokes->count - 1);
        failed = 0;
    }
    mem_free(curve.at);
}
