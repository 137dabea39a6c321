/* flux_field.h - a magnetic flux density that varies in space: formulas, maps, dipoles, magnets, coils.
 *
 * Fields are evaluated where a piece of the body is now, with first and second derivatives in space, so that the
 * forces (dB/dx) and their Hessian follow from the energy. */
#pragma once
#include "base/vec3.h"
#include "field/cubic_grid.h"
#include "field/flux_sources.h"
#include "field/rigid_move.h"
#include "io/mesh_file.h"

typedef struct FluxField FluxField;

/* T m/A, of free space. */
#define FLUX_MU_0 (4e-7 * 3.14159265358979323846)

/* B from three expressions of x, y, z, r, t. length (m) is the scale on which they vary, for instance the body's
 * diagonal: derivatives are central differences of eighth order with a step of 1/64 of it. Takes the formula. */
FluxField *flux_field_formula(Formula *formula, double length);

/* B between numbers on a grid, C2; not a number beyond it. Takes the three grids, of one shape. */
FluxField *flux_field_map(const CubicGrid component[3]);

/* B of a point dipole: moment in A m^2 at a position in m. A permanent magnet of volume V and remanence B_r far away
 * is one of moment B_r V/mu_0. */
FluxField *flux_field_dipole(const double at[3], const double moment[3]);

/* B of a permanent magnet of a remanence (T) that nothing changes, with its middle at a place: a block of a size along x, y
 * and z, or a cylinder along an axis (any length but 0). */
FluxField *flux_field_block(const double at[3], const double size[3], const double remanence[3]);
FluxField *flux_field_cylinder(const double at[3], const double axis[3], double radius, double length,
                               const double remanence[3]);

/* B of a coil without thickness, around an axis through its middle: current times turns in A, counter-clockwise as the axis
 * points to one. A length of 0: all turns in one plane. Of a rectangular one the first side is across the axis and z, or, if
 * the axis is z, along x. */
FluxField *flux_field_round_coil(const double at[3], const double axis[3], double radius, double length,
                                 double current);
FluxField *flux_field_rectangular_coil(const double at[3], const double axis[3], const double sides[2],
                                       double current);

void flux_field_destroy(FluxField *field);

/* Its name, which is copied; "" until it has one. */
void flux_field_set_name(FluxField *field, const char *name);
const char *flux_field_name(const FluxField *field);

/* Moves and turns it about its middle, or a formula's or map's origin; takes both (rigid_move.h). */
void flux_field_set_move(FluxField *field, Timed move, Timed turn);

/* Where a field is at a time (s), and how far it is moved (m) and turned (a rotation vector about its middle, rad) beyond
 * that: numbers of p; NULL: not. */
typedef struct FluxPlace {
    double time;
    const double *move, *turn;
} FluxPlace;

/* x = turn X + shift, X in its own frame. False and a sentence where that is not known. */
bool flux_field_pose(const FluxField *field, FluxPlace place, RigidPose *pose, Error *err);

/* What it looks like in its own frame: its surface, and for each face, (*pole)[face], in which measure it is a north (1) or
 * south pole (-1); of what has no shape an empty surface. Clear it (mesh_file_clear); *pole is the caller's. Its kind as in a
 * scene. */
const char *flux_field_kind(const FluxField *field);
bool flux_field_has_shape(const FluxField *field);
void flux_field_shape(const FluxField *field, MeshFile *shape, double **pole);

/* Re-entrant. A value that is not finite leaves NaN, which the solver notices. */
void flux_field_eval(const FluxField *field, const double x[3], FluxPlace place, FluxSample *sample);

/* False and a sentence where its value is not finite, or a map has ended. */
bool flux_field_is_known(const FluxField *field, const double x[3], FluxPlace place, Error *err);

/* The value alone, for a fiftieth where it is a formula. */
void flux_field_value(const FluxField *field, const double x[3], FluxPlace place, double flux[3]);

/* The first of so many places, x[count][3], that is within a magnet, or, of what has a winding, nearer to it than a hundredth of
 * its radius, where none is without thickness; -1: none is. */
int flux_field_find_within(const FluxField *field, const double *x, int count, FluxPlace place);
bool flux_field_has_winding(const FluxField *field);

/* The middle about which it turns, m. */
void flux_field_middle(const FluxField *field, FluxPlace place, double middle[3]);

/* The fields around a body, each with a factor in its block field_scale. */
typedef struct FluxFields {
    int count;
    FluxField **items; /* owned */
} FluxFields;

/* Takes a field and returns its number. All are there before the body is, whose block counts them. */
int flux_fields_add(FluxFields *fields, FluxField *field);
void flux_fields_clear(FluxFields *fields);
