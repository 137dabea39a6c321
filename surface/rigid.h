/* rigid.h - rigid motions that nothing holds: how many there are, and whether a dead force drives one away.
 */
#pragma once
#include "surface/mesh.h"

/* Rigid motions of all connected parts (six each) that held coordinates, fixed[3*vertex_count], and slopes,
 * clamped[edge_count] (NULL: none), leave free. A field may hold some of them; statics then still needs a base shift
 * (system.h) to tell a minimum from a neutral state. */
int rigid_free_count(const Mesh *mesh, const bool *fixed, const bool *clamped);

/* False and a sentence where weight, mass[vertex_count] kg by gravity[3], and load[3*vertex_count] N push a part along an
 * axis on which nothing holds it: such a body has no equilibrium. */
bool rigid_check_force(const Mesh *mesh, const bool *fixed, const double *mass, const double *gravity,
                       const double *load, Error *err);
