#include "spline/front/plot_time.h"
#include "base/memory.h"
#include "spline/order.h"
#include <math.h>
#include <stdlib.h>

static const long ORDER_WORK = 100000000; /* of a plot that is only foretold */
static const double AIM = 0.96;           /* of at_most: plots take up to so much more than foretold */
static const double LEAST = 0.1;          /* of the ink */

enum { TRIES = 5 };

PlotTime drawing_plot_time(const Drawing *d, const Strokes *strokes, double *seconds)
{
    Plot plot = spline_plot(strokes, &d->page, d->pens, d->layer_count, d->paper);
    PlotTime time = {.strokes = strokes->count};
    for (int k = 0; k < d->layer_count; k++) {
        PlotEstimate estimate = plot_estimate(&plot.layers[k], &d->timed);
        if (seconds) seconds[k] = estimate.seconds;
        time.ink += estimate.ink;
        time.travel += estimate.travel;
        time.seconds += estimate.seconds;
    }
    spline_plot_clear(&plot);
    return time;
}

PlotTime drawing_foretell(const Drawing *d)
{
    Strokes all = {0};
    OrderDef order = order_default();
    order.work = ORDER_WORK;
    for (int k = 0; k < d->part_count; k++) {
        Strokes strokes = drawing_first_strokes(d, k);
        strokes_append(&all, &strokes, d->parts[k].pen);
        strokes_clear(&strokes);
    }
    drawing_add_contours(d, &all);
    if (d->order == ORDER_SHORTEST) order_strokes(&all, &d->page, order);
    PlotTime time = drawing_plot_time(d, &all, NULL);
    strokes_clear(&all);
    return time;
}

/* Fields and first strokes 60 us a segment; an iteration 3.6 us; about 100 of them settle a round. */
double drawing_work_time(const Drawing *d)
{
    double segments = 0, iterations = fmin(d->relax.max_iterations, 100) * (1 + fmin(d->rounds, 3));
    for (int k = 0; k < d->part_count; k++) segments += drawing_segments(&d->parts[k]);
    return segments * (60e-6 + 3.6e-6 * iterations);
}

static void thin(Drawing *d, double factor)
{
    d->thinned *= factor;
    for (int k = 0; k < d->pen_count; k++) spline_field_scale(&d->tones[k], factor);
    for (int k = 0; k < d->part_count; k++) spline_field_scale(&d->parts[k].tone, factor);
}

/* Time grows a little slower than ink, as there are lifts and ways: each try goes on from the last one. */
bool drawing_fit_time(Drawing *d, YamlFile *file)
{
    PlotTime whole = drawing_foretell(d), now = whole;
    double aim = AIM * d->at_most;
    for (int k = 0; k < TRIES && now.seconds > aim; k++) {
        double factor = aim / now.seconds;
        if (d->thinned * factor < LEAST)
            return yaml_refuse(
                file, "spline.plotter.at_most",
                "the whole picture takes about %.3g min, and less than a tenth of its ink would be left; "
                "a wider pen or a smaller page takes less time",
                whole.seconds / 60);
        thin(d, factor);
        now = drawing_foretell(d);
    }
    return true;
}

char *drawing_thinned(const Drawing *d)
{
    if (d->thinned == 1) return mem_text("");
    return mem_format("to take no more than %.4g min to plot, the picture is drawn with %.3g %% of its ink\n",
                      d->at_most / 60, 100 * d->thinned);
}

typedef struct Length {
    double length;
    int stroke;
} Length;

static int by_length(const void *a, const void *b)
{
    const Length *x = a, *y = b;
    if (x->length != y->length) return x->length < y->length ? -1 : 1;
    return (x->stroke > y->stroke) - (x->stroke < y->stroke);
}

static Length *sorted_lengths(const Strokes *strokes)
{
    Length *lengths = mem_alloc((size_t)strokes->count, sizeof *lengths);
    for (int k = 0; k < strokes->count; k++) {
        Strokes one = {0};
        strokes_add_from(&one, strokes, k);
        lengths[k] = (Length){strokes_length(&one), k};
        strokes_clear(&one);
    }
    qsort(lengths, (size_t)strokes->count, sizeof *lengths, by_length);
    return lengths;
}

/* So many seconds' worth of the shortest strokes; one at least. Returns how many. */
static int drop(const Drawing *d, double excess, Strokes *strokes)
{
    Length *lengths = sorted_lengths(strokes);
    bool *gone = mem_alloc((size_t)strokes->count, sizeof *gone);
    int count = 0;
    for (; excess > 0 && count < strokes->count; count++) {
        gone[lengths[count].stroke] = true;
        excess -= 1e3 * d->page.unit * lengths[count].length / d->timed.down + d->timed.lift;
    }
    Strokes left = {0};
    for (int k = 0; k < strokes->count; k++)
        if (!gone[k]) strokes_add_from(&left, strokes, k);
    strokes_clear(strokes);
    *strokes = left;
    mem_free(gone);
    mem_free(lengths);
    return count;
}

int drawing_keep_time(const Drawing *d, Strokes *strokes)
{
    int count = 0;
    while (d->at_most > 0 && strokes->count) {
        double excess = drawing_plot_time(d, strokes, NULL).seconds - d->at_most;
        if (excess <= 0) break;
        count += drop(d, excess, strokes);
    }
    return count;
}
