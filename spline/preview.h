/* preview.h - a picture of a plot as it will look: every pen with its own width and colour on paper of
 * its colour, one ink shining through the other unless it is opaque. */
#pragma once
#include "io/canvas.h"
#include "io/plot_file.h"
#include "spline/grid.h"
#include "spline/page.h"

/* Draws the paper `width` pixels wide to a .png (or .svg, .pdf) file; layers in their order. target (0 white
 * .. 1 black, or three such numbers for what takes away red, green and blue) is shown to the left of it on a
 * paper of its own; NULL: no target. */
bool spline_preview(const char *path, const Plot *plot, const SplinePage *page, const SplineGrid *target,
                    int width, Error *err);

/* What of it a page of other things shows: with the paper's corner at the origin and so many points a millimetre. */
void preview_draw(Canvas *canvas, const Plot *plot, Vec2 origin, double scale);
void preview_draw_target(Canvas *canvas, const SplinePage *page, const SplineGrid *target, Vec2 origin,
                         double scale);
