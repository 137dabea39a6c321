/* flux_formula.h - a flux density by formula, with derivatives by differences. */
#pragma once
#include "base/vec3.h"
#include "field/flux_sources.h"
#include "io/formula.h"

/* At a point, of three expressions of x, y, z, r, t; NaN where one of the values that it needs is not finite. step (m): of the
 * differences. */
void flux_of_formula(Formula *formula, double step, const double x[3], double time, FluxSample *sample);

/* The value alone. */
bool flux_formula_value(Formula *formula, const double x[3], double time, double flux[3], Error *err);
