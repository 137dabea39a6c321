/* show_rod.h - a picture of a result of rods: input, natural and simulated curves, natural strains, and in
 * small print what is known of their stability.
 *
 * What it reads says view/show_curves.h; the direction of gravity is rod/gravity [3]. Moments of a motion and frames are taken
 * from /VTKHDF, whose first points are the simulated ones. */
#pragma once
#include "view/show_data.h"

/* Draws the result (its name is the title) as its definition says. False and a sentence for options that do
 * not fit, or where the picture cannot be written. */
bool show_rod(ShowData *data, const char *result, const char *picture, Error *err);
