/* formula_jet.h - formulas of the place with their first and second derivatives in space.
 *
 * Their variables are x, y, z, r of the place and then numbers that stay (the time, ..). Derivatives are central differences
 * of eighth order: for what varies on a scale L, steps of L/64 leave truncation and round-off both near 1e-12
 * (docs/theory.md). */
#pragma once
#include "base/vec3.h"
#include "io/formula.h"

enum {
    FORMULA_JET_RESULTS = 3, /* at most */
    FORMULA_JET_NUMBERS = 3  /* at most */
};

/* Of each expression k: its value, gradient[k][l] = d/dx_l and curvature[k][l][m]. */
typedef struct FormulaJet {
    double value[FORMULA_JET_RESULTS], gradient[FORMULA_JET_RESULTS][3], curvature[FORMULA_JET_RESULTS][3][3];
} FormulaJet;

/* A formula with so many expressions, and how it is sampled. */
typedef struct FormulaOfPlace {
    Formula *formula; /* borrowed */
    int results, numbers;
    double step; /* m, of differences */
} FormulaOfPlace;

/* At x. Re-entrant. False, and NaN for values, where one of 49 places around x has a result that is not finite. */
bool formula_jet(const FormulaOfPlace *of, Vec3 x, const double *numbers, FormulaJet *jet);

/* The values alone; false and a sentence (err may be NULL) where one is not finite. */
bool formula_jet_value(const FormulaOfPlace *of, Vec3 x, const double *numbers, double *value, Error *err);
