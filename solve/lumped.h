/* lumped.h - terms whose elements are single vertices with three position dofs each (dofs 3v .. 3v+2). */
#pragma once
#include "solve/masses.h"
#include "solve/term.h"

/* Weight: E = -sum_v m_v g.x_v with g = p[gravity .. gravity+2] (m/s^2); takes the masses. */
Term lumped_gravity_term(Masses mass, int gravity);

/* Dead loads: E = -sum_v f_v.x_v with f_v = p[load + 3v ..] (N). */
Term lumped_load_term(int vertex_count, int load);
