/* length.h - the energy of a stroke's whole length, of one stroke: for local.h. */
#pragma once
#include "spline/points.h"

/* Of a stroke whose points these are. */
double spline_length_energy(const SplineModel *model, double S, int stroke, const SplinePoints *points);
