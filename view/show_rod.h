/* show_rod.h - a picture of a result of rods: input, natural and simulated curves, natural strains, and in
 * small print what is known of their stability.
 *
 * Reads of /slender/rod: input, natural, x [points,3], strands [S+1] (offsets of the strands' points; without
 * it all are one), natural_strain [points,3] over s [points], gravity [3], stable, lowest_eigenvalue,
 * critical_young and morse_index (a number, or one for each strand), identified/..; and metrics/... Moments
 * of a motion and frames are taken from /VTKHDF, whose first points are the simulated ones. */
#pragma once
#include "view/show_data.h"

/* Is it a result of rods? */
bool show_has_rod(const ShowData *data);

/* Draws the result (its name is the title) as its definition says. False and a sentence for options that do
 * not fit, or where the picture cannot be written. */
bool show_rod(ShowData *data, const char *result, const char *picture, Error *err);
