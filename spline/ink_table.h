/* ink_table.h - the inks of all pixels of a picture, by a table of its colours as printers have them [ICC.1, B2A]:
 * ink_match for 33 x 33 x 33 levels of red, green and blue, where there are such pixels, and linear between. */
#pragma once
#include "io/colormap.h"
#include "spline/grid.h"
#include "spline/ink.h"

typedef enum InkIntent {
    INK_RELATIVE, /* white becomes the nearest colour that the inks make, black too, and what is between them keeps its
                     place in linear light: media-relative, with black point compensation */
    INK_ABSOLUTE /* each colour the nearest one */
} InkIntent;

/* The colour in linear light. */
Vec3 ink_linear(Color color);

/* dark: of each pixel 1 - red, 1 - green and 1 - blue, of sRGB. cover[count]: what each ink shall cover; owned. */
void ink_table_cover(const InkSet *set, InkIntent intent, const SplineField *dark, SplineField *cover);

/* The light that they should add to the paper's, [3] of each pixel; owned. */
SplineField ink_table_light(const InkSet *set, InkIntent intent, const SplineField *dark);
