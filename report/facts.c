/* Charts, and what a result says in single numbers. */
#include "base/memory.h"
#include "report/report_private.h"
#include "view/show_motion.h"
#include "view/show_probes.h"
#include "view/ticks.h"
#include <string.h>

enum { PROBE_CHARTS = 3 };

/* ---- Charts ---- */

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

bool report_charts(const ReportPart *part, Error *err)
{
    ShowMotion motion;
    Chart charts[PROBE_CHARTS + SHOW_MOTION_CHARTS + 1];
    if (!show_motion_read(&motion, part->data, err)) return false;
    int count = show_probes_charts(part->data, charts, PROBE_CHARTS);
    count += show_motion_charts(&motion, charts + count);
    count += show_history(part->data, &charts[count]);
    document_open(part->document, "charts", '[');
    for (int k = 0; k < count; k++) add_chart(part->document, &charts[k]);
    document_close(part->document);
    return true;
}

/* ---- Facts ---- */

static void add_fact(Document *document, const char *name, const char *value)
{
    document_open(document, NULL, '[');
    document_text(document, NULL, name);
    document_text(document, NULL, value);
    document_close(document);
}

/* A single number, in a fitting unit, or a text of one line. */
static void add_single(Document *document, const char *name, const Array *array)
{
    char text[64];
    if (array->type == ARRAY_TEXT) {
        if (!strchr(array->data, '\n')) add_fact(document, name, array->data);
    } else if (array->rank == 0) {
        double value = array->type == ARRAY_INT32 ? *(const int *)array->data : *(const double *)array->data;
        unit_format(value, array->unit ? array->unit : "", text, sizeof text);
        add_fact(document, name, text);
    }
}

static bool is_told_elsewhere(const char *path)
{
    return !strncmp(path, "state/", 6) || !strcmp(path, "scene") || !strncmp(path, "cases/", 6);
}

bool report_facts(const ReportPart *part, Error *err)
{
    static const char group[] = "slender/";
    Result *result = part->data->result;
    char **paths;
    int count;
    Array array;
    if (!result_list(result, &paths, &count, err)) return false;
    document_open(part->document, "facts", '[');
    for (int k = 0; k < count; k++) {
        const char *name = paths[k] + strlen(group);
        if (strncmp(paths[k], group, strlen(group)) != 0 || is_told_elsewhere(name) ||
            !result_read(result, paths[k], &array, NULL))
            continue;
        add_single(part->document, name, &array);
        array_clear(&array);
    }
    document_close(part->document);
    mem_free(paths);
    if (result_has(result, "slender/scene") && result_read(result, "slender/scene", &array, NULL)) {
        document_text(part->document, "scene", array.data);
        array_clear(&array);
    }
    return true;
}
