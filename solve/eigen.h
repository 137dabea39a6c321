/* eigen.h - the lowest eigenvalues of a System's Hessian with the dofs beyond the positions condensed out.
 *
 * H v = lambda M v with M diagonal on free positions and 0 on all other dofs, which is the eigenproblem of the Schur
 * complement of H on the positions: N/m where M = 1, and with lumped masses the vibrations' omega^2. Shift and invert: H + sigma M with the smallest sigma tried that makes it
 * positive definite, then Lanczos with full reorthogonalisation in M. */
#pragma once
#include "solve/system.h"

/* The count lowest eigenvalues, ascending, of the Hessian at the point; M[position_count] (NULL: 1) is positive; modes (NULL or [count][dof_count]) are their
 * vectors with v'Mv = 1, edge angles included. Assembles and factors: the system's factor afterwards is that of the
 * shifted matrix. False where no shift makes the matrix positive definite (then it is not finite). */
bool eigen_lowest(System *sys, const Point *at, const double *M, int count, double *values, double *modes);
