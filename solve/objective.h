/* objective.h - what a design wants to be small: a function of the state x and the parameters p.
 *
 * A plain sum of rows, each with its weight and without hidden normalisation. A row gives its value, gradient and its
 * own Gauss-Newton product (zero for what is no sum of squares), so that optimisers need not know what it measures. */
#pragma once

typedef struct ObjectiveOps {
    const char *name; /* its key in the scene */

    /* Value; adds weight*gradient to dx[dofs] and dp[params]; both may be NULL together. */
    double (*value)(const void *self, double weight, const double *x, const double *p, double *dx,
                    double *dp);

    /* hx, hp += weight 2 J^T J (vx, vp), J the derivative at (x, p) of the residuals whose squares are summed. NULL for
     * what is no sum of squares. */
    void (*product)(const void *self, double weight, const double *x, const double *p, const double *vx,
                    const double *vp, double *hx, double *hp);

    void (*destroy)(void *self);
} ObjectiveOps;

typedef struct Objective {
    const ObjectiveOps *ops;
    void *self;
    double weight;
    int first, last; /* frames of a motion at which it counts; both 0 for what depends on parameters only */
} Objective;

static inline void objective_destroy(Objective objective)
{
    if (objective.ops->destroy) objective.ops->destroy(objective.self);
}
