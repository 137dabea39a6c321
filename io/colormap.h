/* colormap.h - colours, and the two maps that turn a number into one.
 *
 * COLORMAP_VIRIDIS (dark blue to yellow) for quantities of one sign, COLORMAP_DIVERGING (blue, white, red)
 * for those of both. Both are even to the eye: equal steps of the number are equal steps of lightness.
 * Between its anchors a map is interpolated in Oklab [Ottosson 2020]. */
#pragma once
#include "base/error.h"

/* sRGB components and opacity, each 0..1, not premultiplied. */
typedef struct Color {
    double r, g, b, a;
} Color;

/* "#1f77b4", or a name: black, white, grey, red, green, blue, cyan, magenta, yellow, orange, brown, purple. A
 * sentence for anything else. */
bool color_parse(const char *text, Color *color, Error *err);

/* A component of sRGB as light, 0..1 [IEC 61966-2-1]. */
double color_linear(double srgb);

typedef enum Colormap { COLORMAP_VIRIDIS, COLORMAP_DIVERGING } Colormap;

/* The colour at t in 0..1; t outside is clamped, NaN is a neutral grey. */
Color colormap_color(Colormap map, double t);

/* Colours for kinds of things, told apart with every kind of colour blindness: blue, vermilion, green,
 * purple, orange, sky blue, black, and again from the start. [Okabe and Ito 2008] */
Color colormap_series(int index);

/* Which number has which colour. */
typedef struct ColorScale {
    Colormap map;
    double low, high; /* the ends of the map, low < high */
} ColorScale;

/* A scale for count numbers (NaN and infinities are left out): viridis from the least to the greatest;
 * symmetric about 0 and diverging where both signs are present. Where a range of one sign begins below a
 * fifth of its end, it starts at 0. Constant or no numbers still give a range. */
ColorScale color_scale_fit(const double *values, int count);

Color color_scale_color(const ColorScale *scale, double value);
