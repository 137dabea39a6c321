/* best.h - the bookkeeping that all optimisers share: evaluations counted, the best point kept. Private to
 * optim/. */
#pragma once
#include "optim/optimiser.h"

typedef struct Best {
    const Problem *problem;
    const OptimiserDef *def;
    double *u, *gradient;    /* [n] of the best point                               */
    double objective;        /* INFINITY before the first success                   */
    bool stopped, succeeded; /* was any evaluation a success?                     */
    bool stationary;         /* at the first success                                */
    OptimiserInfo info;
} Best;

/* Evaluates; keeps and accepts the point if it is the best so far. */
double best_evaluate(Best *best, const double *u, double *gradient);

/* No more evaluations: too many, stopped, or converged; sets info.status. */
bool best_is_done(Best *best);

/* Is an unknown at a bound, and drawn (by -gradient) beyond it? */
bool best_is_held(const Problem *problem, int i, double at, double pull);

/* The three methods, from u. */
void mma_run(Best *best, double *u);
void lbfgs_run(Best *best, double *u);
void gauss_newton_run(Best *best, double *u);
