#include "view/show_framings.h"
#include <string.h>

static const char FRAMES[] = "slender/rod/frames";

/* One component of all framings; names: a line each. */
static ChartSeries *make_series(ShowData *data, int strand_count, const int *strands, const char *names,
                                const double *s, const double *component)
{
    ChartSeries *series = show_block(data, (size_t)strand_count, sizeof *series);
    for (int k = 0; k < strand_count; k++) {
        int first = strands[k], count = strands[k + 1] - first, length = (int)strcspn(names, "\n");
        double *y = show_block(data, (size_t)count, sizeof *y);
        for (int j = 0; j < count; j++) y[j] = component[3 * (first + j)];
        series[k] = (ChartSeries){show_text(data, "%.*s", length, names), count, s + first, y};
        names += length + (names[length] != 0);
    }
    return series;
}

int show_framings(ShowData *data, int strand_count, const int *strands, const double *s, const double *strain,
                  Chart *charts)
{
    static const char *const labels[FRAMING_CHARTS] = {"natural twist", "natural k1", "natural k2"};
    Array names;
    if (!result_has(data->result, FRAMES) ||
        !result_read_as(data->result, FRAMES, ARRAY_TEXT, 1, 0, &names, NULL))
        return 0;
    for (int i = 0; i < FRAMING_CHARTS; i++)
        charts[i] = (Chart){.x_label = "s",
                            .x_unit = "m",
                            .y_label = labels[i],
                            .y_unit = "1/m",
                            .y_axis = CHART_LINEAR,
                            .series_count = strand_count,
                            .series = make_series(data, strand_count, strands, names.data, s, strain + i),
                            .first_color = 2};
    array_clear(&names);
    return FRAMING_CHARTS;
}
