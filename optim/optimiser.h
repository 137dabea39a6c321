/* optimiser.h - minimise F(u) within bounds: NLopt's MMA and L-BFGS, and a matrix-free Gauss-Newton of our
 * own, behind one interface.
 *
 * Evaluations are counted, not iterations: NLopt's inner ones cannot be told apart. Every optimiser keeps the
 * best point so far, tests convergence on the gradient projected on the bounds, and replays recorded
 * evaluations first, so that a resumed run goes the same way bit by bit. */
#pragma once
#include <stdbool.h>

typedef struct Problem {
    int n;
    const double *lower, *upper; /* [n] may be infinite */
    void *self;

    /* F and its gradient[n]; INFINITY and zeros where the simulation failed. */
    double (*evaluate)(void *self, const double *u, double *gradient);

    /* The last evaluation is the best so far: start the next ones from it. */
    void (*accept)(void *self);

    /* out = J^T J v at the best point; for Gauss-Newton. With knows_soft, soft > 0 adds a product that damps
     * the modes in which the state gives way most; at 1 as strongly as F pulls at them. */
    void (*product)(void *self, const double *v, double soft, double *out);
    bool knows_soft;

    /* The next trial of a run that is being replayed: Gauss-Newton then need not find it. False: there is
     * none. */
    bool (*recall)(void *self, double *u);

    /* Asked after each evaluation, before the next: false stops. */
    bool (*go_on)(void *self);
} Problem;

/* Rows of the table in optimiser.c, with the names that scenes know them by (NULL at the end). */
typedef enum OptimiserMethod { OPTIMISER_MMA, OPTIMISER_LBFGS, OPTIMISER_GAUSS_NEWTON } OptimiserMethod;

extern const char *const optimiser_names[];

typedef struct OptimiserDef {
    OptimiserMethod method; /* default mma                                                               */
    int evaluations;        /* at most; default 50                                                       */
    double gradient_tol; /* converged when the projected gradient fell to this part of the first one; 1e-6 */
} OptimiserDef;

OptimiserDef optimiser_default(void);

typedef enum OptimiserStatus {
    OPTIMISER_CONVERGED,      /* the projected gradient is small, or F is 0 at the start       */
    OPTIMISER_MAX_ITERATIONS, /* as many evaluations as were allowed                           */
    OPTIMISER_STALLED,        /* no better point is found                                      */
    OPTIMISER_STATIONARY,     /* the gradient is zero at the start: there is no way to go      */
    OPTIMISER_FAILED,         /* no evaluation succeeded                                       */
    OPTIMISER_STOPPED,        /* go_on said so                                                 */
} OptimiserStatus;

typedef struct OptimiserInfo {
    OptimiserStatus status;
    int evaluations;
    long products;
    double objective, gradient_norm; /* at the best point; the norm is that of the projected gradient */
    double first_norm;               /* of the start, or of the first success                         */
} OptimiserInfo;

/* From u, which ends as the best point. */
OptimiserInfo optimise(const Problem *problem, const OptimiserDef *def, double *u);

/* Zero to the last digits of F: a whole unit of the scaled unknowns would not change them. Where F itself is
 * 0 a gradient of zero is no sign of anything. */
bool optimiser_is_zero(const double *gradient, int n, double objective);

/* One word: "converged", "max_iterations", .. */
const char *optimiser_status_name(OptimiserStatus status);

/* The linked NLopt's version, e.g. "2.7.1"; static text. */
const char *optimiser_nlopt_version(void);
