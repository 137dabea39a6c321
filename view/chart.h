/* chart.h - line charts with axes, ticks, units and a legend. */
#pragma once
#include "io/canvas.h"

/* One line. Points that are not finite (or, on a logarithmic axis, not positive) interrupt it. */
typedef struct ChartSeries {
    const char *name; /* in the legend, which appears with two series or more */
    int count;
    const double *x; /* [count]; NULL: 0, 1, 2, ... */
    const double *y; /* [count] */
} ChartSeries;

typedef enum ChartAxis {
    CHART_AUTO, /* logarithmic where all numbers are positive and span more than a factor of 100 */
    CHART_LINEAR,
    CHART_LOG
} ChartAxis;

typedef struct Chart {
    const char *title;            /* NULL: none */
    const char *x_label, *x_unit; /* "evaluation", "" */
    double x_low, x_high;         /* both 0: from the first to the last number */
    bool x_counts;                /* x are whole numbers, and so are its ticks */
    bool of_stages;               /* row k of its lines is stage k of a sequence */
    const char *y_label, *y_unit; /* "objective", "m^2"; shown with a fitting SI prefix or power of ten */
    ChartAxis y_axis;
    int series_count;
    const ChartSeries *series;
    int mark_count;
    const double *marks; /* thin lines across, at these x: the moments that a page shows          */
    int first_color; /* of the series, see colormap_series: other ones than those of the page's other parts */
} Chart;

/* Draws into the box, labels included. No point at all gives empty axes. */
void chart_draw(Canvas *canvas, const Chart *chart, Box box);
