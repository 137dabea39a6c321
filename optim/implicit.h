/* implicit.h - how an equilibrium x(p) depends on p, by the implicit function theorem [Chen 2022, eqs. 29-33].
 *
 * The system holds the factor of the Hessian at the equilibrium, or where newton_minimize left it: one negligible step
 * before it. */
#pragma once
#include "solve/system.h"

/* dx[dofs] = -H^-1 (d2E/dx dp) dp. */
void implicit_tangent(System *sys, const Point *at, const double *dp, double *dx);

/* dp[params] -= (d2E/dx dp)^T H^-1 gx; gx[dofs] is overwritten. */
void implicit_adjoint(System *sys, const Point *at, double *gx, double *dp);

/* Moves the state, an equilibrium with the parameters of `at`, along the tangent to the parameters p[params], dp[params]
 * away from them, if that has less energy there than where it is. */
void implicit_predict(System *sys, const Point *at, const double *dp, const double *p, State *state);
