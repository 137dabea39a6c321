#include "spline/streamlines.h"
#include "base/cubic.h"
#include "base/memory.h"
#include "base/random.h"
#include "spline/direction.h"
#include "spline/target.h"
#include "spline/trace.h"

enum { TRIES = 3 }; /* to meet the ink */

/* An evenly spaced drawing under way. */
typedef struct Spread {
    Tracer tracer;
    SplineStartDef def;
    Random random;
    Points seeds, curve;
    int layer;
    Strokes strokes;
} Spread;

SplineStartDef spline_start_default(void)
{
    return (SplineStartDef){.separation = 0.86, .ink = 1, .longest = 4, .segments = 8, .seed = 1};
}

/* What a tone asks for where it is not blank. */
typedef struct Demand {
    double blank;    /* density below which the paper stays so */
    double greatest; /* density                                */
    double length;   /* of all lines that there are not yet    */
} Demand;

static Demand tone_demand(const SplineGrid *tone, const SplinePage *page, const SplineFixed *fixed)
{
    Demand demand = {.blank = spline_blank_density(page)};
    int count = tone->columns * tone->rows;
    double sum = 0;
    for (int i = 0; i < count; i++) {
        double density = tone->values[i];
        if (!(density >= demand.blank)) continue;
        sum += density;
        demand.greatest = fmax(demand.greatest, density);
    }
    demand.length = fmax(sum / count / page->pen - spline_fixed_length(fixed, page), 0);
    return demand;
}

static double segment_length(const SplineStartDef *def, const SplineGrid *tone, const SplinePage *page)
{
    return def->segment > 0 ? def->segment : spline_segment_length(1.2, spline_line_distance(tone, page));
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
    double(*q)[4] = strokes_extend(strokes, segments + 1, layer);
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
}

static double ink_of(const Strokes *strokes, const SplinePage *page)
{
    return strokes_length(strokes) + 2 * strokes->count * spline_pen_cap(page);
}

/* Pieces of whole segments, half to all of the greatest length by chance: cuts side by side would show as a
 * seam. */
static void cut_curve(Spread *spread)
{
    const Tracer *tracer = &spread->tracer;
    double steps = spread->curve.count - 1, gap = tracer->page->pen / tracer->step;
    int segments = (int)fmax(lround(steps * tracer->step / spread->def.segment), 1);
    double each = steps / segments;
    int longest = (int)fmax(spread->def.longest / (each * tracer->step), 1);
    for (int from = 0, to; from < segments; from = to) {
        int left = segments - from, piece = (int)ceil(longest * (1 + random_uniform(&spread->random)) / 2);
        if (left <= longest)
            piece = left;
        else if (left - piece <= longest / 4) /* no rest that is a mere dash */
            piece = (left + 1) / 2;
        to = from + piece;
        add_stroke(tracer, &spread->curve, from * each + (from > 0 ? gap / 2 : 0),
                   to * each - (to < segments ? gap / 2 : 0), piece, spread->layer, &spread->strokes);
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

/* From the last point of a curve to the first: how far along the mean of both directions, and how far across
 * it; far, where they differ by more than 48 degrees. */
static Vec2 missing(const Points *curve)
{
    const Vec2 *a = curve->at, *b = a + curve->count - 1;
    Vec2 first = {a[1].x - a->x, a[1].y - a->y}, last = {b->x - b[-1].x, b->y - b[-1].y};
    Vec2 v = {first.x + last.x, first.y + last.y}, d = {a->x - b->x, a->y - b->y};
    double speed = hypot(v.x, v.y);
    if (!(first.x * last.x + first.y * last.y > 0.2 * speed * speed)) return (Vec2){INFINITY, 0};
    return (Vec2){(d.x * v.x + d.y * v.y) / speed, (d.y * v.x - d.x * v.y) / speed};
}

/* Moves the end of a curve across, and every other point by its share. */
static void shift_across(Points *curve, double across)
{
    Vec2 before = curve->at[0];
    for (int k = 1; k < curve->count; k++) {
        Vec2 here = curve->at[k], chord = {here.x - before.x, here.y - before.y};
        double shift = across * k / ((curve->count - 1) * hypot(chord.x, chord.y));
        curve->at[k] = (Vec2){here.x - shift * chord.y, here.y + shift * chord.x};
        before = here;
    }
}

/* A curve that has come back to its beginning becomes a ring, with a pen's width between its ends. */
static void close_ring(Points *curve, double step, double pen, double near)
{
    int least = (int)(M_PI * near / step) + 2, whole = curve->count;
    if (whole <= least) return;
    Vec2 gap = missing(curve);
    while (gap.x < pen && hypot(gap.x, gap.y) < near && curve->count > least) {
        curve->count--;
        gap = missing(curve);
    }
    if (!(gap.x >= pen && hypot(gap.x, gap.y) < near)) {
        curve->count = whole;
        return;
    }
    shift_across(curve, gap.y);
    Vec2 from = curve->at[curve->count - 1], begin = curve->at[0];
    for (double s = step; s < gap.x - pen; s += step)
        points_add(curve,
                   (Vec2){from.x + s / gap.x * (begin.x - from.x), from.y + s / gap.x * (begin.y - from.y)});
}

/* The curve through a seed, kept if it has room and becomes long enough: not a mere dash beside its
 * neighbours. */
static void try_seed(Spread *spread, Vec2 seed)
{
    Tracer *tracer = &spread->tracer;
    double spacing = trace_spacing(tracer, seed);
    if (!(spacing > 0) || lanes_near(tracer->lanes, seed, 0.9 * spacing, -1, 0, 0)) return;
    int before = lanes_count(tracer->lanes), most = (int)(4 / tracer->step);
    trace_curve(tracer, seed, most, 2 * most, &spread->curve);
    double least = 1.5 * fmax(spread->def.segment, spacing);
    if ((spread->curve.count - 1) * tracer->step < least) {
        lanes_shrink(tracer->lanes, before);
        return;
    }
    close_ring(&spread->curve, tracer->step, tracer->page->pen, 1.5 * spacing);
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

/* Samples of the strokes that are there, as the first curves. */
static void add_fixed(Spread *spread)
{
    Tracer *tracer = &spread->tracer;
    const Strokes *fixed = spread->def.fixed.strokes;
    for (int k = 0; fixed && k < fixed->count; k++, tracer->curve++)
        for (int node = fixed->start[k], along = 0; node < fixed->start[k + 1] - 1; node++) {
            Vec2 c[4];
            strokes_bezier(fixed, node, c);
            int steps = (int)ceil(strokes_segment_length(fixed, node) / tracer->step);
            for (int i = 0; i <= steps; i++)
                lanes_add(tracer->lanes, cubic_at(c, (double)i / steps), tracer->curve, along++);
        }
}

static Strokes even_strokes(const Tracer *base, const SplineStartDef *def, int layer, double separation)
{
    Spread spread = {.tracer = *base, .def = *def, .random = random_seed(def->seed), .layer = layer};
    spread.tracer.separation = separation;
    spread.tracer.lanes = lanes_create(base->page, base->step, separation * base->page->pen / base->blank);
    add_fixed(&spread);
    spread_curves(&spread);
    lanes_destroy(spread.tracer.lanes);
    mem_free(spread.seeds.at);
    mem_free(spread.curve.at);
    return spread.strokes;
}

void spline_streamlines(const SplineGrid *tone, const SplineGrid *direction, const SplinePage *page,
                        const SplineStartDef *def, int layer, Strokes *strokes)
{
    Demand demand = tone_demand(tone, page, &def->fixed);
    if (!(demand.length > 0)) return;
    SplineStartDef whole = *def;
    whole.segment = segment_length(def, tone, page);
    Tracer tracer = {
        .tone = tone, .direction = direction, .page = page, .outline = def->outline, .blank = demand.blank};
    tracer.step = def->separation * page->pen / demand.greatest / 4;
    double separation = def->separation;
    Strokes even = even_strokes(&tracer, &whole, layer, separation);
    for (int tries = 1; def->ink > 0 && tries < TRIES; tries++) {
        double ink = ink_of(&even, page) / (def->ink * demand.length);
        if (fabs(ink - 1) < 0.03) break;
        separation = fmin(fmax(separation * ink, def->separation / 1.3), 1.3 * def->separation);
        strokes_clear(&even);
        even = even_strokes(&tracer, &whole, layer, separation);
    }
    strokes_append(strokes, &even, layer);
    strokes_clear(&even);
}

/* Sums of the density over all pixels up to each, so that a share of the last one finds a pixel. */
static double *density_sums(const SplineGrid *tone, double blank)
{
    int count = tone->columns * tone->rows;
    double *sums = mem_alloc((size_t)count, sizeof *sums), sum = 0;
    for (int i = 0; i < count; i++) sums[i] = sum += tone->values[i] >= blank ? tone->values[i] : 0;
    return sums;
}

static Vec2 random_place(const SplineGrid *tone, const double *sums, const SplinePage *page, Random *random)
{
    int low = 0, high = tone->columns * tone->rows - 1;
    double share = random_uniform(random) * sums[high];
    while (low < high) {
        int middle = low + (high - low) / 2;
        if (sums[middle] > share)
            high = middle;
        else
            low = middle + 1;
    }
    double x = low % tone->columns + random_uniform(random), y = low / tone->columns + random_uniform(random);
    return (Vec2){x / tone->columns * page->width, y / tone->rows * page->height};
}

void spline_random_strokes(const SplineGrid *tone, const SplineGrid *direction, const SplinePage *page,
                           const SplineStartDef *def, int layer, Strokes *strokes)
{
    Demand demand = tone_demand(tone, page, &def->fixed);
    if (!(demand.length > 0)) return;
    double segment = segment_length(def, tone, page);
    double left = (def->ink > 0 ? def->ink : 1) * demand.length;
    double each = fmax(fmin(def->segments, floor(demand.length / segment)), 1) * segment;
    Tracer tracer = {.tone = tone,
                     .direction = direction,
                     .page = page,
                     .outline = def->outline,
                     .blank = demand.blank,
                     .separation = 1};
    tracer.step = fmin(segment / 8, 0.003);
    int steps = (int)lround(each / tracer.step), tries = 100 + (int)(10 * left / each);
    double *sums = density_sums(tone, demand.blank);
    Random random = random_seed(def->seed);
    Points curve = {0};
    for (; left > each / 2 && tries > 0; tries--) {
        Vec2 seed = random_place(tone, sums, page, &random);
        int behind = (int)(random_uniform(&random) * steps);
        if (!(trace_spacing(&tracer, seed) > 0)) continue;
        trace_curve(&tracer, seed, behind, steps, &curve);
        double length = (curve.count - 1) * tracer.step;
        if (length < segment / 2) continue;
        add_stroke(&tracer, &curve, 0, curve.count - 1, (int)fmax(lround(length / segment), 1), layer,
                   strokes);
        left -= length + 2 * spline_pen_cap(page);
    }
    mem_free(sums);
    mem_free(curve.at);
}
