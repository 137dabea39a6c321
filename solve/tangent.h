/* tangent.h - linear systems with the whole derivative of the forces, which is not symmetric where some are lagged to the
 * solution itself (Point.x_lag is given: L = d2E/dx dx_lag) or have no potential (TermOps.circulate: S, skew):
 *
 *     (A + L + S) y = b
 *
 * by GMRES with the factor of A that is at hand; L and S are of low rank, or small. Where there is an S, A need not be positive
 * definite at an equilibrium, and its factor may have a shift (system_shift): that is taken out again. */
#pragma once
#include "solve/system.h"

/* y may be b. Transposed: with (A + L + S)^T = A + L^T - S. False where the residual is more than 1e-14 of b after a hundred
 * iterations. */
bool tangent_solve(System *sys, const Point *at, bool transposed, const double *b, double *y);

/* The same, not transposed, with the shift: of A + L + S + shift D. */
bool tangent_solve_shifted(System *sys, const Point *at, const double *b, double *y);

/* A factor of the last Hessian for that: of A, where there is an S with the least shift that it takes. False: there is none. */
bool tangent_factor(System *sys);
