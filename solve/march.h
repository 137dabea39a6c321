/* march.h - implicit Euler in time: each step is a call of newton_minimize on the incremental potential
 * (kinetic.h).
 *
 * Each Newton step is solved by conjugate gradients with the factor of an earlier moment, which is made anew when they
 * take too many iterations: small steps need none of their own. A step that fails is cut in halves, down to a thousandth; the sub-steps are real steps of the discrete
 * motion. So is a step in which something goes through the body (TermOps.passes): but not the shortest, in which it may. Dofs beyond the positions (edge angles) have no inertia: they are in equilibrium at the end of
 * every step.
 *
 * What terms lag (Point.x_lag) is taken at the start of the step; or, `implicit`, at its end: the step is then solved again
 * and again with what the solution before gives, until it stays where it is. */
#pragma once
#include "solve/newton.h"

typedef struct MarchDef {
    NewtonDef newton;
    NewtonObserver observer;                          /* may be zero */
    int cuts;                                         /* how often a step may be halved; default 10 */
    bool implicit;                                    /* what is lagged is the step's end's         */
    void (*load)(void *self, double time, double *p); /* what depends on time; may be NULL          */
    bool (*move)(void *self, double time, double *x); /* held coordinates at that time; may be NULL */
    /* Another start of the step that ends at that time, with what is held where it is then; false: none. May be NULL. */
    bool (*guess)(void *self, double time, double dt, double *x);
    void (*stored)(void *self, const State *state, double dt); /* after each (sub-)step; may be NULL */
    void *self;
} MarchDef;

/* Newton's tolerance is relative to the step's energies: 1e-10, which leaves 1e-8 in gradients. */
MarchDef march_default(void);

typedef struct MarchInfo {
    NewtonInfo newton; /* of the last try; iterations and factorisations those of all */
    int steps, refused;
    int passed; /* of the shortest steps, in which something went through the body */
} MarchInfo;

/* From the state to that at time + dt; p[params] holds the parameters, of which load fills in those of each
 * step's end. False where even the smallest step failed: state is then the last one that was reached. */
bool march_step(System *sys, const MarchDef *def, double dt, double *p, State *state, MarchInfo *info);
