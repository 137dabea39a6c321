/* Charts of a result: what was probed, energies and forces of contact, fields, distances, strains, how a design went on. */
#include "base/memory.h"
#include "report/report_private.h"
#include "view/show_curves.h"
#include "view/show_motion.h"
#include "view/show_probes.h"
#include <math.h>
#include <string.h>

enum { PROBE_CHARTS = 3, LINES_MAX = 6 };

static void add_axis(Document *document, const char *key, const char *label, const char *unit)
{
    document_open(document, key, '{');
    document_text(document, "label", label);
    document_text(document, "unit", unit);
    document_close(document);
}

static void add_chart(Document *document, const Chart *chart)
{
    document_open(document, NULL, '{');
    add_axis(document, "x", chart->x_label, chart->x_unit);
    add_axis(document, "y", chart->y_label, chart->y_unit);
    document_flag(document, "of_stages", chart->of_stages);
    document_flag(document, "linear", chart->y_axis == CHART_LINEAR);
    document_open(document, "series", '[');
    for (int k = 0; k < chart->series_count; k++) {
        const ChartSeries *series = &chart->series[k];
        document_open(document, NULL, '{');
        document_text(document, "name", series->name);
        report_color(document, "color", colormap_series(chart->first_color + k));
        if (series->x) document_numbers(document, "x", series->x, (size_t)series->count);
        document_numbers(document, "y", series->y, (size_t)series->count);
        document_close(document);
    }
    document_close(document);
    document_close(document);
}

/* ---- Energies and forces ---- */

/* Numbers [count] at a path; NULL: there are none, or fewer than two. */
static const double *read_numbers(ShowData *data, const char *path, int *count)
{
    Array array;
    if (!result_has(data->result, path) ||
        !result_read_as(data->result, path, ARRAY_FLOAT64, 1, 0, &array, NULL))
        return NULL;
    *count = array.dims[0];
    const double *values = show_keep(data, array);
    return *count > 1 ? values : NULL;
}

/* Of the stages of a sequence: the terms that are not 0 all the time. */
static bool chart_energies(ShowData *data, Chart *chart)
{
    static const char group[] = "slender/stages/energy/";
    char **paths;
    int count, stages;
    ChartSeries *series = show_block(data, LINES_MAX, sizeof *series);
    *chart = (Chart){.x_label = "stage",
                     .x_unit = "",
                     .of_stages = true,
                     .y_label = "energy",
                     .y_unit = "J",
                     .y_axis = CHART_LINEAR,
                     .series = series};
    if (!result_list(data->result, &paths, &count, NULL)) return false;
    for (int k = 0; k < count && chart->series_count < LINES_MAX; k++) {
        if (strncmp(paths[k], group, strlen(group)) != 0) continue;
        const double *values = read_numbers(data, paths[k], &stages);
        double most = 0;
        for (int t = 0; values && t < stages; t++) most = fmax(most, fabs(values[t]));
        if (most > 0)
            series[chart->series_count++] =
                (ChartSeries){show_text(data, "%s", paths[k] + strlen(group)), stages, NULL, values};
    }
    mem_free(paths);
    return chart->series_count > 0;
}

/* Of a frame the sum over the cells: NaN where it has none. */
static double sum_of_cells(const ReportPart *part, const char *path, int frame)
{
    Array array;
    double sum = 0;
    if (!result_read_step(part->data->result, path, frame, &array, NULL)) return NAN;
    for (size_t k = 0; array.type == ARRAY_FLOAT64 && k < array_count(&array); k++) {
        double value = ((double *)array.data)[k];
        if (!isnan(value)) sum += value;
    }
    array_clear(&array);
    return sum;
}

/* That of a term in the frames of a motion, unless it is 0 all the time. */
static void add_energy(const ReportPart *part, const char *path, const char *name, const double *times,
                       Chart *chart, ChartSeries *series)
{
    double most = 0, *sum = show_block(part->data, (size_t)part->frame_count, sizeof *sum);
    for (int k = 0; k < part->frame_count; k++) {
        sum[k] = sum_of_cells(part, path, part->frames[k]);
        most = fmax(most, fabs(sum[k]));
    }
    if (most > 0)
        series[chart->series_count++] =
            (ChartSeries){show_text(part->data, "%s", name), part->frame_count, times, sum};
}

/* Of a motion over time: what the cells have in its frames, all of a term's energy. */
static bool chart_motion(const ReportPart *part, Chart *chart)
{
    static const char cells[] = "VTKHDF/CellData/energy_";
    ShowData *data = part->data;
    char **paths;
    int count;
    ChartSeries *series = show_block(data, LINES_MAX, sizeof *series);
    double *times = show_block(data, (size_t)part->frame_count, sizeof *times);
    *chart = (Chart){.x_label = "t",
                     .x_unit = "s",
                     .y_label = "energy",
                     .y_unit = "J",
                     .y_axis = CHART_LINEAR,
                     .series = series};
    if (!part->timed || part->frame_count < 2 || !result_list(data->result, &paths, &count, NULL))
        return false;
    for (int k = 0; k < part->frame_count; k++) times[k] = show_frame_time(data, part->frames[k]);
    for (int k = 0; k < count && chart->series_count < LINES_MAX; k++)
        if (!strncmp(paths[k], cells, strlen(cells)))
            add_energy(part, paths[k] + strlen("VTKHDF/"), paths[k] + strlen(cells), times, chart, series);
    mem_free(paths);
    return chart->series_count > 0;
}

/* What friction or water has taken from a motion up to then. */
static bool chart_taken(ShowData *data, Chart *chart)
{
    static const char *const names[] = {"friction", "water"};
    int steps, count;
    const double *times = read_numbers(data, "slender/history/time", &steps);
    ChartSeries *series = show_block(data, 2, sizeof *series);
    *chart = (Chart){.x_label = "t",
                     .x_unit = "s",
                     .y_label = "energy taken",
                     .y_unit = "J",
                     .y_axis = CHART_LINEAR,
                     .series = series};
    for (int k = 0; times && k < 2; k++) {
        const double *work = read_numbers(data, show_text(data, "slender/history/%s_work", names[k]), &count);
        if (!work || count != steps) continue;
        double *sum = show_block(data, (size_t)count, sizeof *sum), most = 0;
        for (int t = 0; t < count; t++) {
            sum[t] = (t ? sum[t - 1] : 0) + work[t];
            most = fmax(most, fabs(sum[t]));
        }
        if (most > 0) series[chart->series_count++] = (ChartSeries){names[k], count, times, sum};
    }
    return chart->series_count > 0;
}

/* In the iterations of a drawing. */
static bool chart_relaxation(ShowData *data, Chart *chart)
{
    ChartSeries *series = show_block(data, 1, sizeof *series);
    *series = (ChartSeries){.name = "energy"};
    series->y = read_numbers(data, "slender/history/energy", &series->count);
    *chart = (Chart){.x_label = "iteration",
                     .x_unit = "",
                     .y_label = "energy",
                     .y_unit = "",
                     .series_count = 1,
                     .series = series};
    return series->y;
}

/* The forces of the first obstacles over the steps of a simulation or the stages of a sequence. */
static bool chart_contact(ShowData *data, Chart *chart)
{
    static const char *const paths[] = {"slender/history/contact_force", "slender/stages/contact_force"};
    Array forces, names;
    int steps, timed = result_has(data->result, paths[0]);
    const char *path = paths[timed ? 0 : 1];
    if (!result_has(data->result, path) || !result_has(data->result, "slender/obstacle_names") ||
        !result_read_as(data->result, path, ARRAY_FLOAT64, 3, 0, &forces, NULL))
        return false;
    const double *force = show_keep(data, forces),
                 *x = timed ? read_numbers(data, "slender/history/time", &steps) : NULL;
    int rows = forces.dims[0], count = forces.dims[1];
    if (forces.dims[2] != 3 || rows < 2 || (timed && (!x || steps != rows)) ||
        !result_read_as(data->result, "slender/obstacle_names", ARRAY_TEXT, 1, 0, &names, NULL))
        return false;
    char *rest = NULL, *name = strtok_r(show_keep(data, names), "\n", &rest);
    ChartSeries *series = show_block(data, LINES_MAX, sizeof *series);
    *chart = (Chart){.x_label = timed ? "t" : "stage",
                     .x_unit = timed ? "s" : "",
                     .of_stages = !timed,
                     .y_label = "force of contact",
                     .y_unit = "N",
                     .y_axis = CHART_LINEAR,
                     .series = series};
    double most = 0;
    for (int k = 0; k < count && k < LINES_MAX && name; k++, name = strtok_r(NULL, "\n", &rest)) {
        double *size = show_block(data, (size_t)rows, sizeof *size);
        for (int t = 0; t < rows; t++) {
            const double *F = force + 3 * (t * count + k);
            size[t] = sqrt(F[0] * F[0] + F[1] * F[1] + F[2] * F[2]);
            most = fmax(most, size[t]);
        }
        series[chart->series_count++] = (ChartSeries){name, rows, x, size};
    }
    return most > 0;
}

bool report_charts(const ReportPart *part, Error *err)
{
    ShowMotion motion;
    ShowCurves curves;
    Chart charts[PROBE_CHARTS + SHOW_MOTION_CHARTS + FRAMING_CHARTS + 7];
    bool rods = show_curves_has(part->data);
    if (!show_motion_read(&motion, part->data, err) || (rods && !show_curves_read(&curves, part->data, err)))
        return false;
    int count = show_probes_charts(part->data, charts, PROBE_CHARTS);
    count += show_motion_charts(&motion, charts + count);
    count += chart_energies(part->data, &charts[count]);
    count += chart_motion(part, &charts[count]);
    count += chart_taken(part->data, &charts[count]);
    count += chart_contact(part->data, &charts[count]);
    count += chart_relaxation(part->data, &charts[count]);
    count += show_history(part->data, &charts[count]);
    if (rods) count += show_curves_strains(&curves, charts + count);
    if (rods) count += show_curves_distance(&curves, &charts[count]);
    document_open(part->document, "charts", '[');
    for (int k = 0; k < count; k++) add_chart(part->document, &charts[k]);
    document_close(part->document);
    return true;
}
