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

/* The lines of a probe: "tip z", of several cases "tip z, case 1". Of a vector those along which it changes. */
static void add_probe(const Probed *probed, Lines *lines, const char *name, const double *values, int each)
{
    const double little = 1e-3;
    int width = each / probed->cases;
    double most = 0;
    for (int i = 0; i < each; i++) most = fmax(most, change_of(probed, values + i, each));
    for (int i = 0; i < each; i++) {
        if (change_of(probed, values + i, each) <= little * most) continue;
        char *component = width > 1 ? show_text(probed->data, " %c", "xyz"[i % width]) : "",
             *of = probed->cases > 1 ? show_text(probed->data, ", case %d", i / width) : "";
        add_line(probed, lines, show_text(probed->data, "%s%s%s", name, component, of), values + i, each);
    }
}

/* Those of a unit, among all datasets of the result. */
static Chart chart_of(const Probed *probed, int unit, char *const *paths, int count)
{
    ShowData *data = probed->data;
    Chart chart = {.x_label = counts[probed->kind].label,
                   .x_unit = counts[probed->kind].unit,
                   .y_label = units[unit].label,
                   .y_unit = units[unit].unit,
                   .y_axis = CHART_LINEAR};
    Lines *lines = show_block(data, 1, sizeof *lines);
    chart.series = lines->series;
    for (int k = 0; k < count; k++) {
        Array array;
        const char *name = paths[k] + strlen(PROBES);
        if (strncmp(paths[k], PROBES, strlen(PROBES)) != 0 || !strcmp(name, counts[probed->kind].name) ||
            !result_read(data->result, paths[k], &array, NULL))
            continue;
        size_t row = (size_t)(probed->rows * probed->cases), each = array_count(&array) / row;
        bool fits = array.type == ARRAY_FLOAT64 && !strcmp(array.unit, units[unit].unit) &&
                    (each == 1 || each == 3) && array_count(&array) == each * row;
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
