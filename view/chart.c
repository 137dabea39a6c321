#include "view/chart.h"
#include "base/memory.h"
#include "view/page.h"
#include "view/ticks.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const Color grid = {0.9, 0.9, 0.91, 1}, mark = {0.5, 0.5, 0.52, 1};

static const double TICK_ROOM = 40; /* pt of a narrow chart for each tick along x */

/* One axis: numbers low..high, shown times factor, mapped to from..to on the page. */
typedef struct Axis {
    bool log;
    double low, high, from, to, factor;
    Ticks ticks; /* of the shown numbers */
    char label[160];
} Axis;

static double series_x(const ChartSeries *series, int i)
{
    return series->x ? series->x[i] : i;
}

/* Infinities and what is as good as one are left out, and on a logarithmic axis what has no logarithm. */
static bool chart_shows(double number, bool log_axis)
{
    return fabs(number) < 1e300 && (!log_axis || number > 1e-300);
}

static double axis_place(const Axis *axis, double number)
{
    double t = axis->log ? log(number / axis->low) / log(axis->high / axis->low)
                         : (number - axis->low) / (axis->high - axis->low);
    return axis->from + t * (axis->to - axis->from);
}

/* The range of all x or y; 0..1 where there is none. positive: of the positive numbers only. */
static void chart_range(const Chart *chart, bool of_x, bool positive, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (int s = 0; s < chart->series_count; s++)
        for (int i = 0; i < chart->series[s].count; i++) {
            double number = of_x ? series_x(&chart->series[s], i) : chart->series[s].y[i];
            if (!chart_shows(number, positive)) continue;
            *low = fmin(*low, number);
            *high = fmax(*high, number);
        }
    if (*low > *high) {
        *low = positive ? 0.1 : 0;
        *high = 1;
    }
}

static void axis_label(Axis *axis, const char *label, const char *unit)
{
    snprintf(axis->label, sizeof axis->label, unit[0] ? "%s (%s)" : "%s", label ? label : "", unit);
}

/* x: exactly from the first to the last number, with at most so many intervals. */
static void axis_set_x(Axis *axis, const Chart *chart, int wanted)
{
    chart_range(chart, true, false, &axis->low, &axis->high);
    if (chart->x_low < chart->x_high) axis->low = chart->x_low, axis->high = chart->x_high;
    if (axis->low == axis->high) axis->high = axis->low + 1;
    const char *unit = chart->x_unit ? chart->x_unit : "";
    UnitScale scale =
        unit[0] ? unit_scale(unit, fmax(fabs(axis->low), fabs(axis->high))) : (UnitScale){.factor = 1};
    axis->factor = scale.factor;
    double low = axis->low * scale.factor, high = axis->high * scale.factor;
    axis->ticks =
        chart->x_counts && high - low < wanted ? ticks_every(1, low, high) : ticks_linear(low, high, wanted);
    axis_label(axis, chart->x_label, scale.unit);
}

/* A little around the numbers; where no two powers of ten are inside, whole decades. */
static void axis_set_log(Axis *axis)
{
    double margin = 0.05 * log10(axis->high / axis->low);
    double low = log10(axis->low) - margin, high = log10(axis->high) + margin;
    if (floor(high) - ceil(low) < 1) {
        low = floor(low + margin);
        high = fmax(ceil(high - margin), low + 1);
    }
    axis->low = pow(10, low);
    axis->high = pow(10, high);
    axis->factor = 1;
    axis->ticks = ticks_log(axis->low, axis->high, 5);
}

/* Where all numbers are 0 there is no scale to show. */
static void axis_set_zero(Axis *axis, const Chart *chart)
{
    axis->low = -1, axis->high = 1, axis->factor = 1;
    axis->ticks = ticks_linear(0, 0, 1);
    axis_label(axis, chart->y_label, chart->y_unit ? chart->y_unit : "");
}

static void axis_set_y(Axis *axis, const Chart *chart)
{
    chart_range(chart, false, false, &axis->low, &axis->high);
    axis->log = chart->y_axis == CHART_LOG ||
                (chart->y_axis == CHART_AUTO && axis->low > 0 && axis->high > 100 * axis->low);
    const char *unit = chart->y_unit ? chart->y_unit : "";
    if (axis->log) {
        chart_range(chart, false, true, &axis->low, &axis->high);
        axis_set_log(axis);
        axis_label(axis, chart->y_label, unit_scale(unit, 1).unit);
        return;
    }
    if (axis->low == 0 && axis->high == 0) {
        axis_set_zero(axis, chart);
        return;
    }
    if (axis->low > 0 && axis->low < 0.5 * axis->high) axis->low = 0;
    if (axis->low == axis->high) axis->low -= fabs(axis->low) * 0.5;
    if (axis->low != 0) axis->low -= 0.05 * (axis->high - axis->low);
    axis->high += 0.05 * (axis->high - axis->low);
    UnitScale scale = unit_scale(unit, fmax(fabs(axis->low), fabs(axis->high)));
    axis->factor = scale.factor;
    axis->ticks = ticks_linear(axis->low * scale.factor, axis->high * scale.factor, 5);
    axis_label(axis, chart->y_label, scale.unit);
}

static double ticks_width(Canvas *canvas, const Ticks *ticks)
{
    double width = 0;
    for (int i = 0; i < ticks->count; i++)
        width = fmax(width, canvas_text_width(canvas, ticks->text[i], (TextStyle){.size = PAGE_LABEL}));
    return width;
}

static void draw_axes(Canvas *canvas, const Axis *x, const Axis *y)
{
    const Pen line = {grid, 0.6, 0}, axis = {page_soft, 0.7, 0};
    for (int i = 0; i < y->ticks.count; i++) {
        double at = axis_place(y, y->ticks.value[i] / y->factor);
        canvas_line(canvas, (Vec2){x->from, at}, (Vec2){x->to, at}, line);
        canvas_text(canvas, (Vec2){x->from - 5, at + 0.36 * PAGE_LABEL}, y->ticks.text[i],
                    (TextStyle){.color = page_ink, .size = PAGE_LABEL, .align = TEXT_RIGHT});
    }
    for (int i = 0; i < x->ticks.count; i++) {
        double at = axis_place(x, x->ticks.value[i] / x->factor);
        canvas_line(canvas, (Vec2){at, y->from}, (Vec2){at, y->from + 3}, axis);
        canvas_text(canvas, (Vec2){at, y->from + 5 + PAGE_LABEL}, x->ticks.text[i],
                    (TextStyle){.color = page_ink, .size = PAGE_LABEL, .align = TEXT_CENTER});
    }
    canvas_line(canvas, (Vec2){x->from, y->from}, (Vec2){x->to, y->from}, axis);
    canvas_text(canvas, (Vec2){0.5 * (x->from + x->to), y->from + 8 + 2.2 * PAGE_LABEL}, x->label,
                (TextStyle){.color = page_ink, .size = PAGE_LABEL, .align = TEXT_CENTER});
}

static void draw_marks(Canvas *canvas, const Chart *chart, const Axis *x, const Axis *y)
{
    for (int k = 0; k < chart->mark_count; k++) {
        double at = axis_place(x, chart->marks[k]);
        if (at >= x->from - 0.01 && at <= x->to + 0.01)
            canvas_line(canvas, (Vec2){at, y->from}, (Vec2){at, y->to}, (Pen){mark, 0.7, 0});
    }
}

/* Runs of points that can be shown become one line each; or, after all lines, dots where they are few, and for a lone point. */
static void draw_series(Canvas *canvas, const ChartSeries *series, const Axis *x, const Axis *y, Color color,
                        bool dots)
{
    Vec2 *points = mem_alloc((size_t)series->count, sizeof *points);
    int run = 0;
    for (int i = 0; i < series->count; i++) {
        double px = series_x(series, i), py = series->y[i];
        bool shown = chart_shows(px, false) && chart_shows(py, y->log);
        if (shown) points[run++] = (Vec2){axis_place(x, px), axis_place(y, py)};
        if (shown && i + 1 < series->count) continue;
        if (run > 1 && !dots) canvas_polyline(canvas, points, run, (Pen){color, 1.3, 0});
        for (int k = 0; dots && k < run && (series->count <= 40 || run == 1); k++)
            canvas_circle(canvas, points[k], run == 1 ? 2.4 : 1.8, color);
        run = 0;
    }
    mem_free(points);
}

/* ---- The legend: rows above the plot, each from its right end to the left ---- */

/* Points. */
static const double SAMPLE = 12, SAMPLE_GAP = 5, ENTRY_GAP = 14, ROW = 11;

enum { NAME_MAX_BYTES = 120, SERIES_MAX = 64 };

typedef struct Legend {
    char name[SERIES_MAX][NAME_MAX_BYTES]; /* as they are shown */
    double width[SERIES_MAX];              /* of an entry       */
    int row[SERIES_MAX], count, rows;
} Legend;

/* The name, or as much of it as there is room for. */
static double fit_name(Canvas *canvas, const char *whole, double room, char name[NAME_MAX_BYTES])
{
    const TextStyle style = {.size = PAGE_LABEL};
    snprintf(name, NAME_MAX_BYTES, "%s", whole ? whole : "");
    size_t length = strlen(name);
    double width;
    while ((width = canvas_text_width(canvas, name, style)) > room && length > 1) {
        while (length > 1 && ((unsigned char)name[--length] & 0xc0) == 0x80) continue;
        snprintf(name + length, NAME_MAX_BYTES - length, "%s", "..");
    }
    return width;
}

static Legend lay_legend(Canvas *canvas, const Chart *chart, double room)
{
    Legend legend = {.count = chart->series_count < 2 ? 0 : chart->series_count};
    if (legend.count > SERIES_MAX) legend.count = SERIES_MAX;
    double used = 0;
    for (int s = 0; s < legend.count; s++) {
        double sample = SAMPLE + SAMPLE_GAP;
        legend.width[s] = sample + fit_name(canvas, chart->series[s].name, room - sample, legend.name[s]);
        bool next = s > 0 && used + ENTRY_GAP + legend.width[s] > room;
        legend.row[s] = s == 0 ? 0 : legend.row[s - 1] + next;
        used = next || s == 0 ? legend.width[s] : used + ENTRY_GAP + legend.width[s];
        legend.rows = legend.row[s] + 1;
    }
    return legend;
}

static void draw_legend(Canvas *canvas, const Chart *chart, const Legend *legend, double end, double baseline)
{
    const TextStyle style = {.color = page_ink, .size = PAGE_LABEL, .align = TEXT_RIGHT};
    double right = end;
    for (int s = legend->count - 1; s >= 0; s--) {
        if (s + 1 < legend->count && legend->row[s] != legend->row[s + 1]) right = end;
        double line = baseline + legend->row[s] * ROW, y = line - 0.32 * PAGE_LABEL,
               left = right - legend->width[s];
        canvas_text(canvas, (Vec2){right, line}, legend->name[s], style);
        canvas_line(canvas, (Vec2){left, y}, (Vec2){left + SAMPLE, y},
                    (Pen){colormap_series(chart->first_color + s), 1.6, 0});
        right = left - ENTRY_GAP;
    }
}

void chart_draw(Canvas *canvas, const Chart *chart, Box box)
{
    Axis x = {.log = false}, y = {.log = false};
    axis_set_x(&x, chart, (int)fmin(6, fmax(2, box.width / TICK_ROOM)));
    axis_set_y(&y, chart);
    const TextStyle title = {.color = page_ink, .size = PAGE_LABEL + 1, .bold = true};
    double titled = chart->title ? canvas_text_width(canvas, chart->title, title) + ENTRY_GAP : 0;
    Legend legend = lay_legend(canvas, chart, box.width - titled);
    bool head = chart->title || legend.count;
    y.to = box.y + (head ? 2.4 * PAGE_LABEL : 0.5 * PAGE_LABEL) +
           (legend.rows > 1 ? (legend.rows - 1) * ROW : 0);
    y.from = box.y + box.height - 11 - 2.2 * PAGE_LABEL;
    x.from = box.x + ticks_width(canvas, &y.ticks) + 2 * PAGE_LABEL + 5;
    x.to = box.x + box.width;
    draw_axes(canvas, &x, &y);
    canvas_text(canvas, (Vec2){box.x + PAGE_LABEL, 0.5 * (y.from + y.to)}, y.label,
                (TextStyle){.color = page_ink, .size = PAGE_LABEL, .align = TEXT_CENTER, .upwards = true});
    draw_marks(canvas, chart, &x, &y);
    for (int k = 0; k < 2 * chart->series_count; k++) {
        int s = k % chart->series_count;
        draw_series(canvas, &chart->series[s], &x, &y, colormap_series(chart->first_color + s), k > s);
    }
    if (chart->title) canvas_text(canvas, (Vec2){x.from, box.y + PAGE_LABEL}, chart->title, title);
    draw_legend(canvas, chart, &legend, x.to, box.y + PAGE_LABEL);
}
