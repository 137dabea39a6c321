#include "optim/implicit.h"
#include "base/memory.h"
#include "solve/tangent.h"
#include <string.h>

void implicit_tangent(System *sys, const Point *at, const double *dp, double *dx)
{
    system_param_forward(sys, at, dp, dx);
    tangent_solve(sys, at, false, dx, dx);
    for (int i = 0; i < system_dof_count(sys); i++) dx[i] = -dx[i];
}

void implicit_adjoint(System *sys, const Point *at, double *gx, double *dp)
{
    tangent_solve(sys, at, true, gx, gx);
    for (int i = 0; i < system_dof_count(sys); i++) gx[i] = -gx[i];
    system_param(sys, at, gx, dp);
}

void implicit_predict(System *sys, const Point *at, const double *dp, const double *p, State *state)
{
    size_t dofs = (size_t)system_dof_count(sys);
    double *dx = mem_alloc(2 * dofs, sizeof *dx), *x = dx + dofs;
    implicit_tangent(sys, at, dp, dx);
    Point from = *at, to;
    from.p = p;
    to = from, to.x = x;
    for (size_t i = 0; i < dofs; i++) x[i] = at->x[i] + dx[i];
    system_project(sys, at->x, x);
    Evaluation moved = system_energy(sys, &to);
    if (moved.finite && moved.energy < system_energy(sys, &from).energy)
        memcpy(state->x, x, dofs * sizeof *x);
    mem_free(dx);
}
