/* show_drawing.h - a picture of a drawing: the target, and beside it the lines with the true width of their
 * pens; or a page, or all, of its film (show_film.h). */
#pragma once
#include "view/show_data.h"

/* Draws the result (its name is the title of a film), the paper as wide as the definition says. False and a sentence for options that do not fit, or
 * where the picture cannot be written. */
bool show_drawing(ShowData *data, const char *result, const char *picture, Error *err);
