/* drawing_fields.h - the fields of a drawing, from its picture and formulas: part of drawing_create. */
#pragma once
#include "spline/front/drawing.h"

/* Tones of all pens, direction, potential, flow and the picture to be shown, for the page and pens that the
 * drawing has. False after a refusal. */
bool drawing_read_fields(Drawing *drawing, const SplineScene *scene, YamlFile *file);
