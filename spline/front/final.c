#include "spline/front/final.h"
#include "base/cubic.h"
#include "base/memory.h"
#include "spline/film.h"
#include "spline/front/front.h"
#include "spline/front/drawing_pens.h"
#include "spline/front/plot_time.h"
#include "spline/ink_seen.h"
#include "spline/metrics.h"
#include "spline/order.h"
#include "spline/outline.h"
#include "spline/terms.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

enum { STEPS = 4 }; /* chords of a segment as ParaView sees it */

bool draw_put_strokes(Run *run, const Drawing *d, const Strokes *parts, int count, Error *err)
{
    Arrays list = {0};
    Strokes all = {0};
    for (int k = 0; k < count; k++) strokes_append(&all, &parts[k], d->parts[k].pen);
    drawing_add_contours(d, &all);
    drawing_add_strokes(d, &all, &list);
    bool ok = arrays_replace(&list, run->journal, "final", err);
    strokes_clear(&all);
    return ok;
}

/* ---- Metrics ---- */

typedef struct MetricRow {
    const char *name, *unit;
    size_t offset;
    bool length; /* in units of the page */
} MetricRow;

#define METRIC(m) "metrics/" #m, "", offsetof(SplineMetrics, m), false
#define LENGTH(m) "metrics/" #m, "m", offsetof(SplineMetrics, m), true
static const MetricRow rows[] = {{LENGTH(ink_length)}, {LENGTH(ink_budget)},     {METRIC(ink)},
                                 {METRIC(target)},     {METRIC(tone_rmse)},      {METRIC(tone_scaled)},
                                 {METRIC(ssim)},       {METRIC(spacing_mean)},   {METRIC(spacing_cv)},
                                 {METRIC(crowded)},    {METRIC(travel_over_ink)}};

enum { ROWS = sizeof rows / sizeof *rows };

/* A number, or one for each pen. */
static Array per_pen(const char *name, const char *unit, const double *values, int pens)
{
    return array_float(name, unit, values, pens > 1, pens, 0);
}

static SplineMetrics measure(const Drawing *d, const Strokes *strokes, int pen)
{
    SplinePage page = d->page;
    SplineField left = drawing_pen_left(d, pen);
    SplineGrid tone = spline_grid(&left);
    page.pen = d->pens[pen].width;
    Strokes own = strokes_of_layer(strokes, pen);
    SplineJudge *judge = spline_judge_create(&page, &tone);
    spline_field_clear(&left);
    SplineMetrics metrics = spline_judge_measure(judge, &own);
    spline_judge_destroy(judge);
    strokes_clear(&own);
    return metrics;
}

static void add_metrics(const Drawing *d, const Strokes *strokes, Run *run, Arrays *list)
{
    double *values = arrays_numbers(list, (size_t)(ROWS * d->pen_count));
    for (int k = 0; k < d->pen_count; k++) {
        SplineMetrics m = measure(d, strokes, k);
        for (int r = 0; r < ROWS; r++)
            values[r * d->pen_count + k] =
                *(const double *)((const char *)&m + rows[r].offset) * (rows[r].length ? d->page.unit : 1);
        host_say(run->host,
                 "%s: tone error %.4f, similarity %.3f, ink %.3f of the budget, spacing varies by %.2f, "
                 "%.1f %% crowded",
                 d->pens[k].name, m.tone_rmse, m.ssim, m.ink_budget > 0 ? m.ink_length / m.ink_budget : 0,
                 m.spacing_cv, 100 * m.crowded);
    }
    for (int r = 0; r < ROWS; r++)
        arrays_add(list, per_pen(rows[r].name, rows[r].unit, values + r * d->pen_count, d->pen_count));
}

/* Where a picture's colours are matched: how far off they are. */
static void add_colours(const Drawing *d, const Strokes *strokes, Run *run, Arrays *list)
{
    Ink inks[INK_MAX];
    InkSet set = pens_inks(d->paper, d->pens, d->pen_count, inks);
    double widths[INK_MAX], *error = arrays_numbers(list, 1);
    for (int k = 0; k < d->pen_count; k++) widths[k] = d->pens[k].width;
    *error = ink_seen_error(&set, &d->page, widths, strokes, &d->light);
    host_say(run->host, "colours: Delta E %.1f on the mean", *error);
    arrays_add(list, array_float("metrics/color_error", "", error, 0, 0, 0));
}

/* What the plotter does: way of the lifted pen before and after ordering, time. */
static void add_plot(const Drawing *d, const Strokes *strokes, const OrderInfo *order, Run *run, Arrays *list)
{
    double *seconds = arrays_numbers(list, (size_t)d->layer_count), *travel = arrays_numbers(list, 2);
    PlotTime time = drawing_plot_time(d, strokes, seconds);
    travel[0] = order->before * d->page.unit, travel[1] = order->after * d->page.unit;
    host_say(run->host,
             "%d strokes, %.2f m of ink; the lifted pen moves %.2f m, %.2f m before ordering; about %.0f "
             "min to plot",
             strokes->count, 1e-3 * time.ink, travel[1], travel[0], time.seconds / 60);
    arrays_add(list, array_float("metrics/travel_before", "m", &travel[0], 0, 0, 0));
    arrays_add(list, array_float("metrics/travel", "m", &travel[1], 0, 0, 0));
    arrays_add(list, per_pen("metrics/plot_time", "s", seconds, d->layer_count));
    if (d->at_most > 0) arrays_add(list, array_float("metrics/thinned", "", &d->thinned, 0, 0, 0));
}

/* As they are in the end, in the order in which they are plotted. */
static void add_contours(const Drawing *d, const Strokes *strokes, Run *run, Arrays *list)
{
    Strokes contours = strokes_of_layer(strokes, d->pen_count);
    double *length = arrays_numbers(list, 1);
    *length = d->page.unit * strokes_length(&contours);
    if (contours.count)
        host_say(run->host, "contours: %d strokes, %.2f m", contours.count, *length);
    else
        host_say(run->host, "there are no contours: a lower `contrast`, other `levels` or a shorter "
                            "`shortest` finds more");
    arrays_add(list, array_float("metrics/contour_length", "m", length, 0, 0, 0));
    strokes_clear(&contours);
}

/* How far the middle of a line leaves the regions at most; more than half a pen is said. */
static void add_outside(const Drawing *d, const Strokes *strokes, Run *run, Arrays *list)
{
    SplineGrid outline = spline_grid(&d->outline);
    double *outside = arrays_numbers(list, 1);
    *outside = d->page.unit * spline_outline_excess(&outline, &d->page, strokes);
    if (*outside > d->page.unit * d->page.pen / 2)
        host_say(run->host, "strokes leave their regions by up to %.3g mm", 1e3 * *outside);
    arrays_add(list, array_float("metrics/outside", "m", outside, 0, 0, 0));
}

/* Why an empty drawing is one. */
static void explain_blank(const Drawing *d, Run *run)
{
    double most = 0;
    for (int k = 0; k < d->part_count; k++) {
        SplineGrid tone = spline_grid(&d->parts[k].tone);
        most = fmax(most, spline_grid_mean(&tone, 0));
    }
    if (most > 0)
        host_say(run->host,
                 "nothing was drawn: paper stays blank where lines would be farther apart than a third of "
                 "the page, or have no room; a finer pen helps");
}

/* ---- For ParaView: strokes as chords ---- */

/* The points of a stroke, from number `at` on; y upwards, as scenes in space have it. Returns where the next
 * one begins. */
static int put_chords(const SplinePage *page, const Strokes *strokes, int stroke, double (*x)[3], int at)
{
    int end = strokes->start[stroke + 1] - 1;
    for (int node = strokes->start[stroke]; node <= end; node++) {
        bool last = node == end;
        Vec2 c[4];
        strokes_bezier(strokes, node - last, c);
        for (int i = 0; i < (last ? 1 : STEPS); i++, at++) {
            Vec2 p = cubic_at(c, last ? 1 : (double)i / STEPS);
            x[at][0] = page->left + page->unit * p.x;
            x[at][1] = page->paper[1] - page->top - page->unit * p.y;
        }
    }
    return at;
}

static bool put_frame(Run *run, const Drawing *d, const Strokes *strokes, Error *err)
{
    int lines = strokes->count, points = STEPS * strokes_segment_count(strokes) + lines, at = 0;
    if (lines == 0) return true;
    Arrays list = {0}, statics = {0};
    int *range = arrays_keep(&statics, mem_alloc(2 * (size_t)lines, sizeof *range));
    double *x = arrays_numbers(&list, 3 * (size_t)points), time = 0,
           *pen = arrays_numbers(&list, (size_t)lines);
    for (int k = 0; k < lines; k++) {
        int next = put_chords(&d->page, strokes, k, (double(*)[3])x, at);
        range[2 * k] = at, range[2 * k + 1] = next - at;
        pen[k] = strokes->layer[k];
        at = next;
    }
    arrays_add(&statics, array_int("lines", range, 2, lines, 2));
    arrays_add(&list, array_float("x", "m", x, 2, points, 3));
    arrays_add(&list, array_float("time", "s", &time, 0, 0, 0));
    arrays_add(&list, array_float("cell/pen", "", pen, 1, lines, 0));
    bool ok = arrays_put(&statics, run->journal, "static", 0, err) &&
              arrays_put(&list, run->journal, "frame", 0, err);
    arrays_clear(&list);
    return ok;
}

/* ---- The whole ---- */

/* As long as the plotter may take, and no longer; what that costs is said. */
static void keep_time(const Drawing *d, Strokes *strokes, OrderInfo *order, Run *run)
{
    int count = drawing_keep_time(d, strokes);
    char *thinned = drawing_thinned(d);
    if (*thinned) host_say(run->host, "%.*s", (int)strcspn(thinned, "\n"), thinned);
    if (count) {
        order->after = order_travel(strokes, &d->page);
        host_say(run->host, "and %d of the shortest strokes are left out for that", count);
    }
    mem_free(thinned);
}

static OrderDef order_def(const Drawing *d, const SplineGrid *outline)
{
    OrderDef def = order_default();
    if (d->draft) def.work /= 10;
    if (d->region_count) def.outline = outline;
    return def;
}

bool draw_finish(Run *run, const Drawing *d, const Strokes *parts, const RelaxInfo *info, const char *status,
                 Error *err)
{
    Arrays list = {0};
    Strokes all = {0};
    for (int k = 0; k < d->part_count; k++) strokes_append(&all, &parts[k], d->parts[k].pen);
    drawing_add_contours(d, &all);
    SplineGrid outline = spline_grid(&d->outline);
    OrderInfo order = {0};
    if (d->order == ORDER_SHORTEST)
        order = order_strokes(&all, &d->page, order_def(d, &outline));
    else
        order.before = order.after = order_travel(&all, &d->page);
    keep_time(d, &all, &order, run);
    drawing_add_strokes(d, &all, &list);
    for (int t = 0; t < SPLINE_WEIGHT_COUNT; t++) {
        char *name = arrays_keep(&list, mem_format("final/energy/%s", spline_term_rows[t].name));
        if (((const double *)&d->relax.weights)[t] != 0)
            arrays_add(&list, array_float(name, "", &info->energies[t], 0, 0, 0));
    }
    arrays_add(&list, array_text("status", status));
    add_metrics(d, &all, run, &list);
    if (d->light.columns) add_colours(d, &all, run, &list);
    add_plot(d, &all, &order, run, &list);
    if (d->layer_count > d->pen_count) add_contours(d, &all, run, &list);
    if (d->region_count) add_outside(d, &all, run, &list);
    if (all.count == 0) explain_blank(d, run);
    bool ok = film_add(run->journal, &list, err);
    if (!ok) arrays_clear(&list);
    ok = ok && arrays_replace(&list, run->journal, "final", err) && put_frame(run, d, &all, err);
    strokes_clear(&all);
    return ok;
}
