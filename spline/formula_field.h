/* formula_field.h - a field over the page from expressions.
 *
 * Formulas of drawings know x and y, in metres from the top left corner of the drawable part (y down), and u
 * and v, the same in parts of its width and height. */
#pragma once
#include "base/error.h"
#include "io/formula.h"
#include "spline/grid.h"

extern const char *const spline_formula_variables[]; /* NULL-terminated, for formula_create */

/* The formula's `width` expressions in square pixels of about that size. False and a sentence, and no field,
 * where one is not finite. */
bool spline_field_from_formula(Formula *formula, const SplinePage *page, double pixel, int width,
                               SplineField *field, Error *err);
