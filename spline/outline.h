/* outline.h - strokes and the outline of the region that they are to stay in (SplineTarget.outline). */
#pragma once
#include "spline/strokes.h"
#include "spline/target.h"

/* Takes the segments out of strokes that are not all inside by so much, a part of a pen is enough: what is left
 * of a stroke on either side is a stroke. Nothing where the target has no outline. */
void spline_outline_cut(const SplineTarget *target, double margin, Strokes *strokes);

/* How far a segment's points are inside of an outline, in units of the page: the least of so many along it. */
double spline_outline_depth(const SplineGrid *distance, const SplinePage *page, const Vec2 bezier[4]);

/* How far strokes leave it at most, in units of the page; 0 where they do not. */
double spline_outline_excess(const SplineGrid *distance, const SplinePage *page, const Strokes *strokes);
