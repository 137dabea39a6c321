/* flux_sources.h - what the flux densities of magnets and coils are, in their own frames: the middle at 0, the axis along z.
 *
 * Blocks [Engel-Herbert & Hesjedal 2005] and rectangular coils are exact, cylinders and round coils exact to rounding: what
 * is left of the integral around the axis is taken by the trapezoidal rule in a variable in which the error falls
 * exponentially (ring_nodes.h, docs/theory.md). All are B, within the magnets too; through faces and windings it jumps, towards
 * the edges of magnets it grows with the logarithm of the distance, towards wires and a winding's ends without bounds. On edges
 * and wires it is not finite. */
#pragma once
#include "field/flux_sample.h"

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
