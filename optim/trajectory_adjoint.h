/* trajectory_adjoint.h - F(u) of a motion in time, its exact discrete gradient and its Gauss-Newton product.
 *
 * The motion is that of solve/march: step k finds x_k with
 *
 *     r(x_k; x_{k-1}, v_{k-1}, p_k) = 0,   v_k = (x_k - x_{k-1})/dt_k.
 *
 * Its states are stored, sub-steps of steps that were cut included, and A_k = dr/dx_k, positive definite and
 * neither shifted nor projected, is factored once at the end of each. Backwards [design after Chen 2022,
 * eq. 40, with the terms that it leaves out]
 *
 *     x*_k += dF/dx_k + v*_k/dt_k,   A_k w = x*_k,   dF/dp -= (dr/dp)^T w,
 *     x*_{k-1} = -v*_k/dt_k - (dr/dx_{k-1})^T w,     v*_{k-1} = -(dr/dv_{k-1})^T w,
 *
 * and forwards the tangent of the same equations. Factors are kept as far as memory allows and made again
 * otherwise. Each evaluation starts its steps from the best motion, moved along the tangent, where that has
 * less energy. */
#pragma once
#include "optim/control.h"
#include "optim/design.h"
#include "solve/march.h"
#include "solve/objective.h"

/* What moves; all borrowed. */
typedef struct TrajectoryProblem {
    System *sys;
    const Design *design; /* of one case */
    const Params *params;
    const Control *controls;
    const Objective *objectives; /* each counts at its frames */
    int control_count, objective_count;
    const State *start; /* where it begins */
    double step;        /* s */
    int steps;
    double *p; /* [params] where the unknown blocks start; design_apply overwrites them */
} TrajectoryProblem;

typedef struct TrajectoryDef {
    MarchDef march;     /* load and move with their self are used, as in march.h; load before the controls */
    long factor_memory; /* bytes; default 2 GiB, for the best motion and the one at work together */
} TrajectoryDef;

TrajectoryDef trajectory_default(void);

typedef struct Trajectory Trajectory;

Trajectory *trajectory_create(const TrajectoryProblem *problem, const TrajectoryDef *def);
void trajectory_destroy(Trajectory *t);

typedef struct TrajectoryInfo {
    MarchInfo march;          /* summed over the steps; the status is that of the last one    */
    int reached;              /* steps; fewer than all: the motion failed there               */
    double forward, backward; /* s */
} TrajectoryInfo;

/* F at u and, where gradient is not NULL, dF/du[size]. INFINITY with a zero gradient where a step failed, or
 * something went through the body. */
double trajectory_evaluate(Trajectory *t, const double *u, double *gradient, TrajectoryInfo *info);

/* Makes the last evaluation the best motion: the next ones start from it. */
void trajectory_accept(Trajectory *t);

/* out = 2 J^T J v at the best motion. */
void trajectory_product(Trajectory *t, const double *v, double *out);

/* J v at the best motion: dx[steps + 1][dofs] at the frames. */
void trajectory_tangent(Trajectory *t, const double *v, double *dx);

/* dF/dp[params] in the blocks' own units, dF/dx and dF/dv at the start ([dofs], zero where held) of the best
 * motion; any may be NULL. */
void trajectory_gradients(Trajectory *t, double *dp, double *dx, double *dv);

/* The best motion's parameters, with controls as at frame n (0: as at the start); its states, without
 * velocities, borrowed; and these, v[dofs]. */
const double *trajectory_params(Trajectory *t, int frame);
State trajectory_frame(const Trajectory *t, int frame);
void trajectory_velocities(const Trajectory *t, int frame, double *v);

/* The best motion beyond u: with it, trajectory_restore goes on bit by bit as the run that saved it. */
typedef struct TrajectoryState {
    int count;            /* steps, and sub-steps                               */
    const double *x;      /* [count + 1][dofs]                                  */
    const double *memory; /* [count + 1][system_memory_count]                   */
    const double *dt;     /* [count] s                                          */
} TrajectoryState;

TrajectoryState trajectory_state(const Trajectory *t);
void trajectory_restore(Trajectory *t, const double *u, const TrajectoryState *state);
