/* plot.h - from strokes to what a plotter draws: millimetres on the paper, by pen, nothing off the page. */
#pragma once
#include "io/plot_file.h"
#include "spline/page.h"
#include "spline/strokes.h"

typedef struct SplinePen {
    const char *name; /* "black" */
    Color color;
    double width; /* of its line, in units of the page */
    bool opaque;
} SplinePen;

/* The strokes of layer k are drawn by pens[k], in their order; those of layers beyond the last pen are left
 * out. What is outside the drawable part of the page is cut off exactly there, which may make two curves of
 * one or leave none. Names are copied; the caller frees the plot (spline_plot_clear). */
Plot spline_plot(const Strokes *strokes, const SplinePage *page, const SplinePen *pens, int pen_count,
                 Color paper);

void spline_plot_clear(Plot *plot);

/* Is it a line of text that may name a pen? */
bool spline_pen_is_name(const char *name);
