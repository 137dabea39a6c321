/* static_design.h - F(u) of a quasi-static design, its gradient by the adjoint and its Gauss-Newton product.
 *
 * Each load case finds its equilibrium x(p) from the best design's (never from a rejected trial's), moved by
 * the tangent where that lowers the energy. With H at the equilibrium factored [Chen 2022, eqs. 29-33],
 *
 *     adjoint   H w = dF/dx,   dF/dp - (d2E/dx dp)^T w
 *     tangent   dx = -H^-1 (d2E/dx dp) dp
 *
 * Cases are independent of each other and may run in parallel threads; their sums are taken in order, so the
 * result does not depend on the number of threads. */
#pragma once
#include "optim/case.h"
#include "optim/design.h"
#include "solve/newton.h"

typedef struct StaticDesign StaticDesign;

typedef struct StaticDesignDef {
    NewtonDef newton;
    NewtonObserver observer; /* may stop a solve, which then is not found; from all threads; may be zero */
    Workers *workers;        /* solve cases side by side (borrowed); default NULL: one after the other    */
} StaticDesignDef;

StaticDesignDef static_design_default(void);

/* Borrows design and cases; their unknowns in stages[0].p are overwritten, state is that of the best design. */
StaticDesign *static_design_create(const Design *design, const Params *params, Case *cases,
                                   const StaticDesignDef *def);
void static_design_destroy(StaticDesign *sd);

typedef struct CaseInfo {
    NewtonInfo newton;
    double objective; /* weighted */
} CaseInfo;

/* F at u and, where gradient is not NULL, dF/du[size]. INFINITY with a zero gradient where an equilibrium was
 * not found; case_info[case_count] says how each went. */
double static_design_evaluate(StaticDesign *sd, const double *u, double *gradient, CaseInfo *case_info);

/* Makes the last evaluation the best design: the next ones start from it. */
void static_design_accept(StaticDesign *sd);

/* A case's state in the last evaluation, borrowed, and its p. */
const State *static_design_trial(const StaticDesign *sd, int load_case, const double **p);

/* What the best design's case is, beyond u: with it, static_design_restore goes on bit by bit as the run that
 * saved it. */
typedef struct CaseState {
    State *state;       /* the equilibrium                                                       */
    double *linearised; /* [dofs] where its factor stands: before Newton's last, negligible step */
} CaseState;

/* Borrowed; to be read, or filled before static_design_restore. */
CaseState static_design_state(StaticDesign *sd, int load_case);

/* Makes u, with the states filled in, the best design. */
void static_design_restore(StaticDesign *sd, const double *u);

/* out = J^T J v at the best design (of the sum of squares), 2 J^T J as the gradient is 2 J^T r; the first
 * call after an evaluation that was not accepted factors again. soft > 0 adds as much of the tangent's
 * dx^T H^-1 dx, which counts soft modes more: at 1 the mode that is about to snap as much as the objectives
 * pull at it. */
void static_design_product(StaticDesign *sd, const double *v, double soft, double *out);

/* dF/dp[params] of one case at the best design, weighted, in the blocks' own units; p of it may be had too. */
void static_design_param_gradient(StaticDesign *sd, int load_case, double *dp);
const double *static_design_params(const StaticDesign *sd, int load_case);
