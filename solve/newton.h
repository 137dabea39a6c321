/* newton.h - minimise a System's energy over its free dofs: regularised Newton with line search.
 *
 * The one nonlinear solver of the project; shells and rods differ only in their terms. Each iteration factors
 * H + (base + shift) D, with a shift in parts of each dof class's mean diagonal that is remembered from one iteration
 * to the next; steps are capped, accepted by Armijo's rule with a guard against round-off, and saddles are left along
 * a direction of negative curvature. Forces without a potential (TermOps.circulate) are brought into balance with the whole
 * derivative: by plain Newton steps where these do soon; else by shifted ones, which are downhill for an energy that has these
 * forces at the point; else by plain ones. `converged` then says that there is balance, not that it is stable. The method and its constants were measured on 19 problems (docs/newton.md). */
#pragma once
#include "solve/system.h"

typedef struct NewtonDef {
    int max_iterations; /* default 300 */
    double
        step_tol; /* converged when the Newton step is smaller, in the body's measure, or is rounding; default 1e-8 */
    double force_tol;    /* ... and no force exceeds this part of the element forces; default 1e-6 */
    double energy_tol;   /* ... or when the step will gain less than this part of the energies; 0: not */
    int cg_iterations;   /* at most so many conjugate gradients with the last factor; default 0 */
    double cg_tol;       /* ... until the residual fell to this part; default 1e-3 */
    double step_cap;     /* largest step, body's measure; default 0.25 */
    double shift_first;  /* shift tried first, in parts of D; default 1e-8 */
    double shift_least;  /* smallest one that is remembered; default 1e-10 */
    double shift_growth; /* factor between tries; default 4 */
    double shift_decay;  /* ... and back after a success; default 16 */
    double armijo;       /* sufficient decrease; default 1e-4 */
    int shifted_max;     /* shifted iterations in a row before negative curvature is looked for; default 3 */
} NewtonDef;

NewtonDef newton_default(void);

typedef enum NewtonStatus {
    NEWTON_CONVERGED, /* stationary and the (base-shifted) Hessian positive definite: a stable equilibrium */
    NEWTON_SADDLE,    /* stationary, not positive definite, and no way down was found */
    NEWTON_NEUTRAL,   /* stationary with a zero mode: a buckling point, or a rigid motion */
    NEWTON_STALLED,   /* no step lowers the energy */
    NEWTON_MAX_ITERATIONS, /* still falling */
    NEWTON_NOT_FINITE,     /* energy or forces at the start are not finite */
    NEWTON_STOPPED,        /* the observer asked for it */
    NEWTON_UNBALANCED,     /* of a pose that was only looked at: its forces are not in balance */
    NEWTON_UNSETTLED, /* of a step of time: friction and the forces that it follows do not agree (march.h) */
    NEWTON_BLOCKED,   /* of a step of time: what is held was to go where the body does not let it */
    NEWTON_CRUSHED, /* of a body, by whoever knows it: a piece has lost its size, and energies mean nothing */
    NEWTON_TANGLED, /* stationary, and a piece is inside out, or flat (TermOps.tangles): no equilibrium */
    NEWTON_PIERCED, /* of a motion: something has gone through the body (march.h)                    */
    NEWTON_ASTRAY,  /* all iterations are done, and the later half has come no nearer to balance     */
    NEWTON_UNKNOWN_FIELD, /* by whoever knows it: a field has no value where the body is or was to go */
} NewtonStatus;

typedef struct NewtonInfo {
    NewtonStatus status;
    int iterations, factorizations, cg_iterations, evaluations;
    double energy, gradient_max, force_scale; /* at the final x: J, N, N                            */
    double step;                              /* the last Newton step, body's measure                */
    double curvature;                         /* lowest v'Hv/v'Dv seen at a saddle or neutral point  */
} NewtonInfo;

/* Puts the counts of what was done before to those of info. */
void newton_add_counts(NewtonInfo *info, const NewtonInfo *before);

/* Called after each iteration; returns false to stop. */
typedef struct NewtonObserver {
    bool (*iteration)(void *self, const NewtonInfo *info);
    void *self;
} NewtonObserver;

/* Starts from the state's x and leaves the final iterate there, with what the terms remember of it; observer may be NULL.
 * `at` gives p and time and, in a step of time, x_prev, v_prev and dt; its x and memory are not looked at. Without conjugate gradients the system holds, after NEWTON_CONVERGED, the
 * factor of the (base-shifted) Hessian at the point from which the last, negligible step was taken (system_linearised),
 * ready for an adjoint. With them, the factor is an older one, and that the point is a minimum is known only of the
 * directions that they have seen. */
NewtonInfo newton_minimize(System *sys, const NewtonDef *def, const Point *at, State *state,
                           const NewtonObserver *observer);

/* Are all iterations done: still falling, or astray? */
bool newton_is_used_up(NewtonStatus status);

/* One word: "converged", "saddle", ... and a sentence for the user. */
const char *newton_status_name(NewtonStatus status);
const char *newton_status_text(NewtonStatus status);

/* A largest force below this is rounding of the coordinates times the stiffness of the last Hessian, N. */
double newton_round_off(const System *sys, const double *x);
