/* along.h - strokes along polylines. */
#pragma once
#include "spline/strokes.h"

/* Appends a stroke along points[count], nodes equally far apart, about `segment`; tangents are a third of the chord of
 * half a segment to both sides, around the seam too where the last point is the first one. Nothing of a line without
 * length. */
void strokes_along(const Vec2 *points, int count, double segment, int layer, Strokes *strokes);
