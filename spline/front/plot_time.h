/* plot_time.h - how long a plotter takes for a drawing, foretold from its first strokes and told at its end; and what a
 * drawing gives up where that must be less (`plotter.at_most`). */
#pragma once
#include "spline/front/drawing.h"

typedef struct PlotTime {
    int strokes;
    double ink, travel, seconds; /* mm, mm, s; of all pens */
} PlotTime;

/* Of strokes in their order; seconds[layer_count] of each layer, or NULL. */
PlotTime drawing_plot_time(const Drawing *drawing, const Strokes *strokes, double *seconds);

/* Of the first strokes, as a plotter would draw them: what relaxes has as much ink, and about as many strokes. */
PlotTime drawing_foretell(const Drawing *drawing);

/* s of one thread, to make it (method auto; as measured, docs/line_art.md). */
double drawing_work_time(const Drawing *drawing);

/* Lightens all tones by one factor, `thinned`, until the plot is foretold to take no more than `at_most`. False after a
 * refusal: too little would be left. */
bool drawing_fit_time(Drawing *drawing, YamlFile *file);

/* What at_most has cost, a line; "" where it has cost nothing. The caller's. */
char *drawing_thinned(const Drawing *drawing);

/* Takes the shortest of the ordered strokes out until they take no more than `at_most`: these give least ink for their
 * time. What is left is in order. Returns how many went. */
int drawing_keep_time(const Drawing *drawing, Strokes *strokes);
