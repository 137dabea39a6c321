/* potential.h - potentials that a rod lies in: an energy u per metre of it, by a formula of the place x, y, z, r, the time t,
 * the arclength s and the length L of its strand. The force on each metre is -grad u: a spring to a wall, buoyancy in
 * layers, charges. */
#pragma once
#include "field/formula_jet.h"

typedef struct RodPotential RodPotential;

/* Where a piece of the rod is. */
typedef struct RodPlace {
    Vec3 x;      /* m                                  */
    double time; /* s                                  */
    double s, L; /* m, arclength and length            */
} RodPlace;

/* The variables of its formula, in order; ends with NULL. */
extern const char *const rod_place_variables[];

/* One expression in J/m. length (m) is the scale on which it varies, for instance the rod's (formula_jet.h). Takes the
 * formula. */
RodPotential *rod_potential_create(Formula *formula, double length);

/* u with its derivatives in space, in row 0; false and a sentence where it is not finite, there or at one of the places around
 * it that tell the derivatives. Re-entrant. */
bool rod_potential_known(const RodPotential *potential, RodPlace at, FormulaJet *jet, Error *err);

/* Potentials around a rod, each with a factor in its block potential_scale. */
typedef struct RodPotentials {
    int count;
    RodPotential **items; /* owned */
} RodPotentials;

/* Takes a potential. */
void rod_potentials_add(RodPotentials *potentials, RodPotential *potential);
void rod_potentials_clear(RodPotentials *potentials);
