/* show_film.h - the film of a drawing that relaxes: a page for each moment, and the drawing as it is at the end as the last one.
 *
 *     title
 *     iteration
 *     [ the paper, with the true width of its pens ]
 *     [ what was to be drawn ]  [ energy over iterations, the moment marked ]
 */
#pragma once
#include "spline/drawn.h"
#include "view/show_data.h"

/* Frame def.frame as a picture, or all of them in def.seconds; the paper is def.width pixels wide. False and a sentence where
 * the result has no film, or the picture cannot be written (data.drawn). */
bool show_film(ShowData *data, const Drawn *drawn, const char *result, const char *picture, Error *err);
