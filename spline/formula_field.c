#include "spline/formula_field.h"

const char *const spline_formula_variables[] = {"x", "y", "u", "v", NULL};

bool spline_field_from_formula(Formula *formula, const SplinePage *page, double pixel, int width,
                               SplineField *field, Error *err)
{
    *field = spline_field_create(page, pixel, width);
    for (int i = 0; i < field->rows; i++)
        for (int j = 0; j < field->columns; j++) {
            Vec2 at = spline_field_center(field, page, i, j);
            double place[] = {page->unit * at.x, page->unit * at.y, at.x / page->width, at.y / page->height};
            if (formula_eval(formula, place, spline_field_pixel(field, i, j), err)) continue;
            spline_field_clear(field);
            return false;
        }
    return true;
}
