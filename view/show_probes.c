#include "view/show_probes.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

static const char PROBES[] = "slender/probes/";

enum { LINES = 3, ROWS = 3 }; /* in a chart; kinds of rows */

/* What counts the rows. */
static const struct {
    const char *name, *label, *unit;
} counts[ROWS] = {{"stage", "stage", ""}, {"time", "t", "s"}, {"evaluation", "evaluation", ""}};

static const struct {
    const char *unit, *label;
} units[] = {{"m", "place, distance"}, {"N", "force"}, {"N m", "couple"}, {"rad", "angle"}};

enum { UNITS = sizeof units / sizeof *units };

/* The lines that change most. */
typedef struct Lines {
    int count;
    ChartSeries series[LINES];
    double change[LINES]; /* from the first row, at most */
} Lines;

typedef struct Probed {
    ShowData *data;
    int kind, rows, cases;
    const double *x; /* [rows] */
} Probed;

/* Load cases of an evaluation; all other rows are of one. */
static int cases_of(ShowData *data, int kind)
{
    Array names;
    int count = 0;
    if (strcmp(counts[kind].name, "evaluation") != 0 ||
        !result_read_as(data->result, "slender/case_names", ARRAY_TEXT, 1, 0, &names, NULL))
        return 1;
    for (const char *c = names.data; *c; c++) count += *c == '\n';
    array_clear(&names);
    return count;
}

static bool read_rows(ShowData *data, Probed *probed)
{
    *probed = (Probed){.data = data};
    for (int k = 0; k < ROWS; k++) {
        Array rows;
        char *path = show_text(data, "%s%s", PROBES, counts[k].name);
        if (!result_has(data->result, path) || !result_read(data->result, path, &rows, NULL)) continue;
        bool numbers = rows.type == ARRAY_FLOAT64;
        const double *x = show_keep(data, rows);
        if (numbers) *probed = (Probed){data, k, (int)array_count(&rows), cases_of(data, k), x};
    }
    return probed->rows > 1 && probed->cases > 0;
}

/* How far every `stride`-th number is from the first, at most. */
static double change_of(const Probed *probed, const double *values, int stride)
{
    double most = 0;
    for (int r = 1; r < probed->rows; r++) most = fmax(most, fabs(values[r * stride] - values[0]));
    return most;
}

static void add_line(const Probed *probed, Lines *lines, char *name, const double *values, int stride)
{
    double change = change_of(probed, values, stride);
    int least = 0;
    for (int k = 1; k < lines->count; k++)
        if (lines->change[k] < lines->change[least]) least = k;
    if (lines->count == LINES && change <= lines->change[least]) return;
    int place = lines->count < LINES ? lines->count++ : least;
    double *y = show_block(probed->data, (size_t)probed->rows, sizeof *y);
    for (int r = 0; r < probed->rows; r++) y[r] = values[r * stride];
    lines->series[place] = (ChartSeries){.name = name, .count = probed->rows, .x = probed->x, .y = y};
    lines->change[place] = change;
}

/* The lines of a probe: "tip z", of several cases "tip z, case 1". Of a vector those along which it changes; a number that does
 * not is a line, too. */
static void add_probe(const Probed *probed, Lines *lines, const char *name, const double *values, int each)
{
    const double little = 1e-3;
    int width = each / probed->cases;
    double most = 0;
    for (int i = 0; i < each; i++) most = fmax(most, change_of(probed, values + i, each));
    for (int i = 0; i < each; i++) {
        bool stays = change_of(probed, values + i, each) <= little * most;
        if (stays && (most > 0 || width > 1)) continue;
        char *component = width > 1 ? show_text(probed->data, " %c", "xyz"[i % width]) : "",
             *of = probed->cases > 1 ? show_text(probed->data, ", case %d", i / width) : "";
        add_line(probed, lines, show_text(probed->data, "%s%s%s", name, component, of), values + i, each);
    }
}

/* Of the box around the last state, m. */
static double body_size(const Probed *probed)
{
    Array x;
    double size = 0;
    if (!result_read_as(probed->data->result, "slender/state/x", ARRAY_FLOAT64, 2, 3, &x, NULL)) return 0;
    for (int i = 0; i < 3; i++) {
        double low = INFINITY, high = -INFINITY;
        for (int v = 0; v < x.dims[0]; v++) {
            double at = ((const double *)x.data)[3 * v + i];
            low = fmin(low, at), high = fmax(high, at);
        }
        if (low < high) size = hypot(size, high - low);
    }
    array_clear(&x);
    return size;
}

/* What numbers of a unit are small beside: the body's size, the weight of as much water, or 1. */
static double scale_of(const Probed *probed, const char *unit)
{
    const double water = 1e4; /* N/m^3 */
    double size = body_size(probed);
    return !strcmp(unit, "m") ? size : !strcmp(unit, "N") ? water * pow(size, 3) : 1;
}

/* Numbers that are nothing but rounding beside a size become 0. */
static void clear_rounding(Array *array, double size)
{
    const double rounding = 1e-12;
    double *values = (double *)array->data, most = 0;
    size_t count = array_count(array);
    for (size_t k = 0; k < count; k++) most = fmax(most, fabs(values[k]));
    if (most < rounding * size) memset(values, 0, count * sizeof *values);
}

/* Those of a unit, among all datasets of the result. */
static Chart chart_of(const Probed *probed, int unit, char *const *paths, int count)
{
    ShowData *data = probed->data;
    Chart chart = {.x_label = counts[probed->kind].label,
                   .x_unit = counts[probed->kind].unit,
                   .x_counts = counts[probed->kind].unit[0] == 0,
                   .y_label = units[unit].label,
                   .y_unit = units[unit].unit,
                   .y_axis = CHART_LINEAR};
    Lines *lines = show_block(data, 1, sizeof *lines);
    chart.series = lines->series;
    double size = scale_of(probed, units[unit].unit);
    for (int k = 0; k < count; k++) {
        Array array;
        const char *name = paths[k] + strlen(PROBES);
        if (strncmp(paths[k], PROBES, strlen(PROBES)) != 0 || !strcmp(name, counts[probed->kind].name) ||
            !result_read(data->result, paths[k], &array, NULL))
            continue;
        size_t row = (size_t)(probed->rows * probed->cases), each = array_count(&array) / row;
        bool fits = array.type == ARRAY_FLOAT64 && !strcmp(array.unit, units[unit].unit) &&
                    (each == 1 || each == 3) && array_count(&array) == each * row;
        if (fits) clear_rounding(&array, size);
        if (fits)
            add_probe(probed, lines, name, show_keep(data, array), (int)each * probed->cases);
        else
            array_clear(&array);
    }
    chart.series_count = lines->count;
    return chart;
}

int show_probes_charts(ShowData *data, Chart *charts, int room)
{
    Probed probed;
    char **paths;
    int count, made = 0;
    if (!read_rows(data, &probed) || !result_list(data->result, &paths, &count, NULL)) return 0;
    for (int unit = 0; unit < UNITS && made < room; unit++) {
        charts[made] = chart_of(&probed, unit, paths, count);
        made += charts[made].series_count > 0;
    }
    mem_free(paths);
    return made;
}
