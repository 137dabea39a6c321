/* drawing_regions.h - the regions of a drawing: part of drawing_create. */
#pragma once
#include "spline/front/drawing.h"
#include "spline/tone_field.h"

/* Regions and the outline of them all, in pixels of that size, as those of the tones; a mask lies as the scene's
 * picture does. Their directions are left out. False after a refusal. */
bool drawing_read_regions(Drawing *drawing, const SplineScene *scene, YamlFile *file,
                          const SplineToneDef *tone, double pixel);

/* What is outside of all regions becomes 0. */
void drawing_mask(const Drawing *drawing, SplineField *field);
