/* drawing_start.h - a drawing's first strokes from a file: part of drawing_create. */
#pragma once
#include "spline/front/drawing.h"

/* What `start.file` has, for the parts that the drawing has. False after a refusal. */
bool drawing_read_start(Drawing *drawing, const SplineScene *scene, YamlFile *file);
