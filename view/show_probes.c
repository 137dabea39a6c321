#include "view/show_probes.h"
#include "base/memory.h"
#include "base/vec3.h"
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
    const double *x;              /* [rows] */
    const char *x_label, *x_unit; /* of the axis; "": it counts */
} Probed;

/* ---- What a sequence goes through ---- */

/* What stages may differ by. */
static const struct {
    const char *path, *label, *unit;
    int width;
} ranges[] = {{"slender/stages/flux_density", "flux density", "T", 3},
              {"slender/stages/gravity", "gravity", "m/s^2", 3},
              {"slender/stages/time", "t", "s", 1},
              {"slender/stages/load_part", "part of the loads", "", 1}};

static bool varies(const double *values, int rows, int width)
{
    for (int k = width; k < rows * width; k++)
        if (values[k] != values[k % width]) return true;
    return false;
}

static bool rises(const double *values, int rows)
{
    for (int r = 1; r < rows; r++)
        if (!(values[r] > values[r - 1])) return false;
    return true;
}

/* Along the direction of the longest row, whose largest component counts as positive; NULL: not all are along it. */
static const double *along_one(ShowData *data, const double (*rows)[3], int count)
{
    const double little = 1e-9;
    double *along = show_block(data, (size_t)count, sizeof *along);
    Vec3 way = vec3(0, 0, 0);
    for (int r = 0; r < count; r++)
        if (vec3_length(vec3_load(rows[r])) > vec3_length(way)) way = vec3_load(rows[r]);
    double length = vec3_length(way), x[3], most = 0;
    vec3_store(x, way);
    for (int i = 0; i < 3; i++) most = fabs(x[i]) > fabs(most) ? x[i] : most;
    way = vec3_scale((most < 0 ? -1 : 1) / length, way);
    for (int r = 0; r < count; r++) {
        Vec3 row = vec3_load(rows[r]);
        if (vec3_length(vec3_cross(row, way)) > little * length) return NULL;
        along[r] = vec3_dot(row, way);
    }
    return along;
}

/* Where stages differ by one thing that is a number, it counts the rows in their place. */
static void take_range(Probed *probed)
{
    int found = 0;
    Probed other = *probed;
    for (size_t k = 0; k < sizeof ranges / sizeof *ranges; k++) {
        Array array;
        int width = ranges[k].width;
        if (!result_has(probed->data->result, ranges[k].path) ||
            !result_read_as(probed->data->result, ranges[k].path, ARRAY_FLOAT64, width > 1 ? 2 : 1,
                            width > 1 ? 3 : 0, &array, NULL))
            continue;
        bool fits = array.dims[0] == probed->rows;
        const double *values = show_keep(probed->data, array);
        if (!fits || !varies(values, probed->rows, width)) continue;
        found++;
        other.x = width > 1 ? along_one(probed->data, (const double(*)[3])values, probed->rows)
                  : rises(values, probed->rows) ? values
                                                : NULL;
        other.x_label = ranges[k].label, other.x_unit = ranges[k].unit;
    }
    /* Times and parts that begin anew are those of several stages, which differ by what is not stored. */
    if (found == 1 && other.x) *probed = other;
}

/* ---- The rows ---- */

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
        if (numbers)
            *probed = (Probed){
                data, k, (int)array_count(&rows), cases_of(data, k), x, counts[k].label, counts[k].unit};
    }
    if (probed->rows > 1 && !strcmp(counts[probed->kind].name, "stage")) take_range(probed);
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
    Chart chart = {.x_label = probed->x_label,
                   .x_unit = probed->x_unit,
                   .x_counts = probed->x_label == counts[probed->kind].label && probed->x_unit[0] == 0,
                   .of_stages = !strcmp(counts[probed->kind].name, "stage"),
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
