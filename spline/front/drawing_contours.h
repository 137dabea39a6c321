/* drawing_contours.h - the contours of a drawing, from its open tone: part of drawing_create. */
#pragma once
#include "spline/edges.h"
#include "spline/front/drawing.h"

/* False after a refusal: a level is there twice. */
bool drawing_check_levels(const ContoursScene *scene, YamlFile *file);

/* How they are found; detail is what the tone should be looked at with. */
SplineEdgeDef drawing_contours_def(const Drawing *drawing, const ContoursScene *scene);

/* Contours, and what they cover. */
void drawing_find_contours(Drawing *drawing, const ContoursScene *scene, const SplineEdgeDef *def,
                           const SplineField *tone);
