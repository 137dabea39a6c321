/* path.h - a stored motion: its states, the factor of each step where memory allows, and the two linear
 * sweeps along it. */
#pragma once
#include "optim/trajectory_adjoint.h"

typedef struct Path {
    const TrajectoryProblem *problem;
    const MarchDef *march;
    int dofs, memory_count;
    int count, room;                  /* steps, sub-steps of cut ones included                     */
    int *end;                         /* [problem->steps + 1] the state at the end of each frame    */
    int *frame;                       /* [room] the frame that step 1.. belongs to, from 1          */
    double *dt, *time;                /* [room] s: of a step, and at the end of each state          */
    double *x, *memory;               /* [room][dofs], [room][memory_count] states                  */
    Factor **factor;                  /* [room] of the step that ends at a state; NULL: not kept    */
    long factor_bytes, factor_memory; /* that the kept ones take; that they may take       */
    double *p;                        /* [params] controls as of the last use                        */
    double *v, *gradient;             /* [dofs] */
    bool unsolved; /* a sweep since this was cleared has not solved its equations (march.implicit) */
} Path;

Path path_create(const TrajectoryProblem *problem, const MarchDef *march, long factor_memory);
void path_destroy(Path *path);

/* No steps: only the problem's start. */
void path_clear(Path *path);

/* Adds a state that a step of dt has reached, and factors there; false where that fails. */
bool path_add(Path *path, int frame, const State *state, double dt);

/* Of state k: x and what the terms remember. */
double *path_x(const Path *path, int k);
double *path_memory(const Path *path, int k);

/* v[dofs] at state k: of the step that ends there; of the start, its own. */
void path_velocities(const Path *path, int k, double *v);

/* Another start of a step than where the motion is: x of the frame's end; false: none. */
typedef bool (*PathGuess)(void *self, int frame, double dt, double *x);

/* All steps from the problem's start on, with the parameters in path->p and controls, and path->march. False where one
 * fails: *reached are there; the march's `stored` is told of each. guess may be NULL. The info's counts are sums, its status that of the last step. */
bool path_march(Path *path, PathGuess guess, void *self, MarchInfo *info, int *reached);

/* The parameters of a step, in path->p. */
void path_load(Path *path, int frame, double time);

/* dx[count + 1][dofs] of the states, from those of the start, (dx_0 in its first row, dv_0), and dp[params],
 * of which the current values of controls are overwritten. */
void path_tangent(Path *path, double *dp, const double *dv, double *dx);

/* seed[count + 1][dofs] holds dF/dx of each state and is overwritten; dp += dF/dp. The first row becomes
 * dF/dx_0, and dv[dofs] dF/dv_0. */
void path_adjoint(Path *path, double *seed, double *dp, double *dv);
