/* diffuse.h - fills the gaps of a field of unit vectors from what surrounds them. */
#pragma once
#include "spline/grid.h"

/* u (width 2) = argmin sum over pixels a |u - b/a|^2 + stiffness |grad u|^2 with |u| = 1, source (width 3) =
 * (b1, b2, a), gradients in pixels; nothing flows over the edges. Vectors are made best for their neighbours
 * one after the other, from coarse to fine grids [Jakob et al. 2015, Instant field-aligned meshes]: u bends
 * evenly where the sources disagree, and only at points is there a singularity. */
void spline_diffuse(const SplineField *source, double stiffness, SplineField *u);
