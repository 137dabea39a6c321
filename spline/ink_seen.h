/* ink_seen.h - how near a drawing comes to the colours that it should have, seen from afar: no assumption of how lines
 * of different pens meet (ink.h), but all of them on a fine raster (coverage.h), pixel by pixel. */
#pragma once
#include "spline/grid.h"
#include "spline/ink.h"
#include "spline/strokes.h"

/* The mean Delta E of both, blurred in linear light by 1.5 mean distances of lines of all pens. strokes of layer k are
 * of set->inks[k], widths[k] wide, in units of the page, whose pen is the finest of them; light[3]: of each pixel what
 * the inks should add to that of the paper (below 0: take from it). */
double ink_seen_error(const InkSet *set, const SplinePage *page, const double *widths, const Strokes *strokes,
                      const SplineField *light);
