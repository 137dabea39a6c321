/* plot_split.h - a plot in parts, one after the other: a file each. */
#pragma once
#include "io/plot_file.h"

typedef struct PlotParts {
    int count, room;
    Plot *
        plots; /* [count] with the paper and all layers of the whole, most of them empty: pens keep their numbers. Names,
                  * starts and points are the whole's */
} PlotParts;

/* A part for each layer that has curves. */
PlotParts plot_split_pens(const Plot *plot);

/* A new part before each curve with which the last one would have more than so much ink, mm; a curve is not broken. */
PlotParts plot_split_ink(const Plot *plot, double most);

void plot_parts_clear(PlotParts *parts);
