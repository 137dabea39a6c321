/* diffuse.h - fills the gaps of a vector field from what surrounds them. */
#pragma once
#include "spline/grid.h"

/* u (width 2) = argmin sum over pixels a |u - b/a|^2 + stiffness |grad u|^2 in pixels, source (width 3) =
 * (b1, b2, a), a >= 0 and positive somewhere; nothing flows over the edges. Gauss-Seidel from coarse to fine
 * grids. */
void spline_diffuse(const SplineField *source, double stiffness, SplineField *u);
