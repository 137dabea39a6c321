/* flux_field.h - a magnetic flux density that varies in space: formulas, point dipoles, permanent magnets.
 *
 * Fields are evaluated where a piece of the body is now, with first and second derivatives in space, so that the
 * forces (dB/dx) and their Hessian follow from the energy. */
#pragma once
#include "io/formula.h"

typedef struct FluxField FluxField;

/* T m/A, of free space. */
#define FLUX_MU_0 (4e-7 * 3.14159265358979323846)

/* B at a point x (m) and time (s): flux[3] in T, gradient[k][l] = dB_k/dx_l in T/m, curvature[k][l][m] in T/m^2. */
typedef struct FluxSample {
    double flux[3], gradient[3][3], curvature[3][3][3];
} FluxSample;

/* B from three expressions of x, y, z, r, t. length (m) is the scale on which they vary, for instance the body's
 * diagonal: derivatives are central differences of eighth order with a step of 1/64 of it. Takes the formula. */
FluxField *flux_field_formula(Formula *formula, double length);

/* B of a point dipole: moment in A m^2 at a position in m. A permanent magnet of volume V and remanence B_r far away
 * is one of moment B_r V/mu_0. */
FluxField *flux_field_dipole(const double at[3], const double moment[3]);

void flux_field_destroy(FluxField *field);

/* Re-entrant. A value that is not finite leaves NaN, which the solver notices. */
void flux_field_eval(const FluxField *field, const double x[3], double time, FluxSample *sample);

/* False and a sentence where a formula's value is not finite. */
bool flux_field_is_known(const FluxField *field, const double x[3], double time, Error *err);

/* The value alone, for a fiftieth where it is a formula. */
void flux_field_value(const FluxField *field, const double x[3], double time, double flux[3]);

/* The fields around a body, each with a factor in its block field_scale. */
typedef struct FluxFields {
    int count;
    FluxField **items; /* owned */
} FluxFields;

/* Takes a field and returns its number. All are there before the body is, whose block counts them. */
int flux_fields_add(FluxFields *fields, FluxField *field);
void flux_fields_clear(FluxFields *fields);
