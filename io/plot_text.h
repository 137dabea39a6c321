/* plot_text.h - what the writers of plots share. Private to io/plot_*.c. */
#pragma once
#include "io/plot_file.h"
#include "io/text.h"

/* A number with at most so many decimals, without needless digits and never "-0". */
void plot_add_number(Text *text, double number, int decimals);

/* Refuses a plot with points that are no finite numbers, or off the paper by more than its size. */
bool plot_check(const char *path, const Plot *plot, Error *err);

/* Adds how long a curve is, up to its last point, mm. */
void plot_add_length(const Vec2 *curve, const Vec2 *end, double *length);
