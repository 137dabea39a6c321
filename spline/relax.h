/* relax.h - moves the strokes of a drawing until their energy is least, or as small as is worth while.
 *
 * All methods work on the same energy, of the weights in the def. `auto` is L-BFGS, preconditioned by a
 * Cholesky factor of what couples along strokes only; `newton` couples all strokes that see each other, for
 * small drawings and tight convergence; `gradient`, `monte_carlo` (the moves of Linewise) and `dynamics` are
 * there to compare with. Layers of a drawing with targets of their own do not act on each other: relax each
 * for itself.
 *
 * The same strokes, def and seed give the same result, with any number of threads. */
#pragma once
#include "spline/model.h"
#include <stdint.h>

typedef enum RelaxMethod {
    RELAX_AUTO,
    RELAX_NEWTON,
    RELAX_GRADIENT,
    RELAX_MONTE_CARLO,
    RELAX_DYNAMICS,
    RELAX_METHOD_COUNT
} RelaxMethod;

/* "auto", "newton", ... */
const char *relax_method_name(RelaxMethod method);

/* Lengths are in mean line distances (SplineTarget.spacing). */
typedef struct RelaxDef {
    RelaxMethod method;    /* default RELAX_AUTO                                                          */
    SplineWeights weights; /* pure numbers (weights.h); default spline_weights_default()                  */
    SplineModelDef model;  /* quadrature and kernels; its workers are not looked at                       */
    double rest;           /* L0 (spline_segment_length); default 1.2; 0: as at the start                 */
    int threads;           /* default 1                                                                   */
    int max_iterations;    /* of auto, newton and gradient; default 500                                   */
    double energy_tol;     /* settled when the energy fell by less than this part in 20 iterations; 3e-3  */
    double gradient_tol;   /* converged when no |dE/dx| (a pure number) exceeds this; default 1e-6        */
    double step_cap;       /* no stroke goes further in one step (not monte_carlo's moves); default 1     */

    /* auto, dynamics */
    int memory;  /* steps that L-BFGS remembers; default 20                            */
    int refresh; /* a new factor after so many steps; default 20; 0: no preconditioner */

    /* monte_carlo: temperatures fall geometrically, in energies per length of ink times line distance */
    double temperature_first; /* default 0.03                                               */
    double temperature_last;  /* default 3e-4                                               */
    int temperatures, sweeps; /* how many, and at each so many tries per stroke; default 20, 50 */
    uint64_t seed;            /* default 1                                                  */

    /* dynamics: implicit Euler with mass 1 per rest length; times are of the same unit as lengths */
    double time_step; /* default 1                                              */
    int time_steps;   /* default 100                                            */
    double damping;   /* part of the velocity lost in a time of 1; default 0.1  */
} RelaxDef;

RelaxDef relax_default(void);

typedef enum RelaxStatus {
    RELAX_CONVERGED,      /* the gradient is below its tolerance, or (newton) at a stable equilibrium */
    RELAX_SETTLED,        /* the energy hardly falls any more                                         */
    RELAX_STALLED,        /* no step lowers the energy                                                */
    RELAX_MAX_ITERATIONS, /* all iterations done (the usual end of monte_carlo and dynamics)          */
    RELAX_NOT_FINITE,     /* the energy at the start is not: a stroke has no length                   */
    RELAX_STOPPED,        /* the observer asked for it                                                */
} RelaxStatus;

/* One word: "converged", ... and a sentence for the user. */
const char *relax_status_name(RelaxStatus status);
const char *relax_status_text(RelaxStatus status);

typedef struct RelaxInfo {
    RelaxStatus status;
    int iterations, evaluations, factorizations;
    double seconds;                       /* since the start                                          */
    double energy;                        /* of all                                                   */
    double energies[SPLINE_WEIGHT_COUNT]; /* of each, by the names of spline_term_rows (terms.h)      */
    double gradient_max;                  /* largest |dE/dx|; Monte Carlo: only at the end            */
    double kinetic;                       /* dynamics: energy of motion                               */
    double temperature, acceptance;       /* monte_carlo: and the part of the tries that were taken   */
} RelaxInfo;

/* Called after each iteration (sweep, step of time) with the strokes as they are; returns false to stop. */
typedef struct RelaxObserver {
    bool (*iteration)(void *self, const RelaxInfo *info, const Strokes *strokes);
    void *self;
} RelaxObserver;

/* Moves the strokes; those that cross the page's edge are first brought inside where there is a wall.
 * observer may be NULL. A weight other than 0 needs its field in the target. */
RelaxInfo spline_relax(const SplineTarget *target, const RelaxDef *def, Strokes *strokes,
                       const RelaxObserver *observer);
