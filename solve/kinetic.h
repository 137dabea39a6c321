/* kinetic.h - the terms that make a step of time out of an equilibrium: lumped inertia and viscous damping.
 *
 * Implicit Euler from (x_prev, v_prev) over dt is the minimum of the incremental potential [Chen 2022, eq.
 * 28] E(x; p) + sum_v m_v/(2 dt^2) |x_v - x_prev,v - dt v_prev,v|^2 + sum_v gamma/(2 dt) |x_v - x_prev,v|^2.
 * In statics (dt = 0) both are nothing. Elements are single vertices with three position dofs each (3v ..
 * 3v+2). */
#pragma once
#include "solve/masses.h"
#include "solve/term.h"

/* Takes the masses. */
Term kinetic_inertia_term(Masses mass);

/* gamma = share[v] p[damping], N s/m; share[vertex_count], of p's unit what makes that, is copied; NULL: 1 everywhere. */
Term kinetic_damping_term(int vertex_count, const double *share, int damping);
