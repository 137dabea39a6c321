/* flux_sources.h - what the flux densities of magnets and coils are, in their own frames: the middle at 0, the axis along z.
 *
 * Blocks [Engel-Herbert & Hesjedal 2005] and rectangular coils are exact, cylinders and round coils exact to rounding: what
 * is left of the integral around the axis is taken by the trapezoidal rule, whose error falls exponentially, with as many
 * nodes as the distance to the nearest edge asks for (docs/theory.md). All are B, within the magnets too. */
#pragma once

/* B at a point x (m) and time (s): flux[3] in T, gradient[k][l] = dB_k/dx_l in T/m, curvature[k][l][m] in T/m^2. */
typedef struct FluxSample {
    double flux[3], gradient[3][3], curvature[3][3][3];
} FluxSample;

/* Of remanence[3] (T); half its size[3] (m). */
void flux_of_block(const double half[3], const double remanence[3], const double x[3], FluxSample *sample);

/* Of a radius and half a length (m), and a remanence[3]. */
void flux_of_cylinder(double radius, double half, const double remanence[3], const double x[3],
                      FluxSample *sample);

/* Of current times turns (A): of a winding without thickness, on a cylinder of half that length or, 0, all at its middle. */
void flux_of_round_coil(double radius, double half, double current, const double x[3], FluxSample *sample);

/* All turns at its middle; half its size along x and y. */
void flux_of_rectangular_coil(const double half[2], double current, const double x[3], FluxSample *sample);

/* Of a moment[3] (A m^2). */
void flux_of_dipole(const double moment[3], const double x[3], FluxSample *sample);
