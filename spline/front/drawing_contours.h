/* drawing_contours.h - the contours of a drawing, from its open tone: part of drawing_create. */
#pragma once
#include "spline/edges.h"
#include "spline/front/drawing.h"

/* False after a refusal: a level is there twice. */
bool drawing_check_levels(const ContoursScene *scene, YamlFile *file);

/* How they are found; detail is what the tone should be looked at with. */
SplineEdgeDef drawing_contours_def(const Drawing *drawing, const ContoursScene *scene);

/* Contours of the tone, or of the regions, and what they cover. */
void drawing_find_contours(Drawing *drawing, const ContoursScene *scene, const SplineEdgeDef *def,
                           const SplineField *tone);
void drawing_find_outlines(Drawing *drawing, const SplineEdgeDef *def);

/* The part of the contours' ink that counts as that of a pen in a region (NULL: the page), in each of so many crossed
 * sets: with cmyk they are black, with tones of the pen that draws there. No columns: all of it. The caller's. */
SplineField drawing_contours_counted(const Drawing *drawing, const SplineScene *scene, int pen,
                                     const DrawingRegion *region, int sets);
