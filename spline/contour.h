/* contour.h - how far every place of the page is from the outline of what is covered. */
#pragma once
#include "spline/grid.h"

/* cover: width 1, how much of each pixel is covered, 0 to 1. The outline is where it is a half, linear between
 * the centres of pixels [Lorensen and Cline 1987, in the plane]: that of a covered area is met to a tenth of
 * a pixel, its corners are cut by a third of one. At each centre, the distance to the nearest piece of it, in
 * units of the page, positive inside: carried from neighbour to neighbour [Danielsson 1980]. What the page's
 * edge cuts off goes on beyond it: the edge is no outline. Where there is none, the distance is 1 or -1. */
SplineField spline_contour_distance(const SplineField *cover, const SplinePage *page);
