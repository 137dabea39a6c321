/* term.h - the interface of one energy term.
 *
 * Everything that moves a model is a row of functions over small elements: membrane, bending, magnetic, gravity and
 * loads alike. A term is a potential E(x; p): its value, its first two derivatives in x, and the two products with
 * d2E/dx dp that let an adjoint run without knowing any physics. Add a term by writing one file that ends in one
 * TermOps, and one row in the model's term list (docs/adding_a_term.md).
 *
 * Elements come in packs of PACK_LANES side by side (base/pack.h): lane l of pack k is element k*PACK_LANES + l, and
 * the last pack is filled up by repeating the last element. A term may hold its own constants as packs. */
#pragma once
#include "base/pack.h"
#include "solve/state.h"
#include <stdbool.h>

enum {
    TERM_MAX_DOF = 30,    /* largest element, in degrees of freedom */
    SYSTEM_MAX_TERMS = 24 /* of a System                            */
};

/* Entry (i, j), j <= i, of an element Hessian's packed lower triangle. */
#define TERM_LOWER(i, j) ((i) * ((i) + 1) / 2 + (j))

/* Where a term is evaluated: whole vectors. */
typedef struct Point {
    const double *x;               /* positions and other dofs                     */
    const double *p;               /* all model parameters (params.h)              */
    const double *memory;          /* what terms remember (State.memory); to a term: its own part of it */
    double time;                   /* s; fields may depend on it                   */
    const double *x_prev, *v_prev; /* start of the step of time, whole vectors; NULL in statics */
    double dt;                     /* s; 0 in statics                                           */
    /* Where terms take what they lag, so that a step stays a minimisation (friction: its normal forces and planes);
     * NULL: at x_prev. */
    const double *x_lag;
    /* Where the last Newton step began, and that step: the Hessian then takes the stresses that the step was to bring
     * (TermOps.follow); NULL: its own. */
    const double *x_from, *step;
    bool
        convex; /* the Hessian is to be without what makes it indefinite, where a term knows (TermOps.convexes) */
    bool tangled; /* and so because the body is inside out, where a term knows (TermOps.tangles) */
} Point;

/* Where lagged quantities are taken; NULL in statics. */
static inline const double *point_lag(const Point *at)
{
    return at->x_lag ? at->x_lag : at->x_prev;
}

/* Where a state stands, with p. */
static inline Point state_point(const State *state, const double *p)
{
    return (Point){.x = state->x, .p = p, .memory = state->memory, .time = state->time};
}

typedef struct TermOps {
    const char *name; /* also the name of its energy in the result, e.g. "bending" */
    bool idles;       /* it acts between what is near: no energy < 0, and none means no force */

    /* Does its Hessian, with the elements at hand, heed Point.convex? NULL: no. */
    bool (*convexes)(const void *self);

    /* Is the body turned inside out, or flattened to nothing, somewhere? Its Hessian heeds Point.tangled then, if it can be
     * indefinite, and the first steps are by that. NULL: never. */
    bool (*tangles)(const void *self, const Point *at);

    int (*count)(const void *self); /* elements                                    */
    int (*size)(const void *self);  /* dofs per element, <= TERM_MAX_DOF           */

    /* The global dofs of element e, dof[size]; a dof may appear twice. */
    void (*dofs)(const void *self, int e, int *dof);

    /* Has the elements follow from the point, and from nothing that was before: count and dofs tell the new ones. True
     * when they changed. Called before anything else with that point: so it should soon know an x_prev (or x) that it
     * knows already. Ordered so that equal points give equal lists. NULL: the elements last. */
    bool (*update)(void *self, const Point *at);

    /* Energies of a pack, J; writes dE/dx to g[size] and the lower triangle of d2E/dx2 to H[TERM_LOWER(size, 0)].
     * H NULL: value and gradient; g NULL too: value only. x[size] are the elements' own dofs. Pure and re-entrant. */
    Pack (*eval)(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H);

    /* dp += w^T d2E/dx dp for the first `lanes` elements of the pack, dp laid out as Point.p; w[size].
     * NULL when no parameter enters the forces. */
    void (*param)(const void *self, int pack, int lanes, const Point *at, const Pack *x, const Pack *w,
                  double *dp);

    /* r = d2E/dx dp . dp, r[size]: the tangent of param. */
    void (*param_forward)(const void *self, int pack, const Point *at, const Pack *x, const double *dp,
                          Pack *r);

    /* dx, dv = w^T d2E/dx d(x_prev, v_prev), on the elements' own dofs, [size] each; what is lagged stays. NULL where the
     * energy does not depend on the start of the step. */
    void (*prev)(const void *self, int pack, const Point *at, const Pack *x, const Pack *w, Pack *dx,
                 Pack *dv);

    /* r = d2E/dx d(x_prev, v_prev) . (dx, dv): the tangent of prev. */
    void (*prev_forward)(const void *self, int pack, const Point *at, const Pack *x, const Pack *dx,
                         const Pack *dv, Pack *r);

    /* dx = w^T d2E/dx dx_lag, and its tangent r = d2E/dx dx_lag . dx. NULL where nothing is lagged. */
    void (*lag)(const void *self, int pack, const Point *at, const Pack *x, const Pack *w, Pack *dx);
    void (*lag_forward)(const void *self, int pack, const Point *at, const Pack *x, const Pack *dx, Pack *r);

    /* r = S d, where forces have no potential (a couple that keeps its direction on what turns): eval's Hessian is the
     * symmetric part of their derivative, S the skew one, S^T = -S; eval's energy is one that has these forces where the
     * references of turns stand. NULL: all have one. */
    void (*circulate)(const void *self, int pack, const Point *at, const Pack *x, const Pack *d, Pack *r);

    /* The largest a in (0, 1] such that the straight way from at->x to at->x + a d is admissible (d: whole vector);
     * NULL: 1. */
    double (*reach)(const void *self, const Point *at, const double *d);

    /* Moves `to`, which is x + a d, to where the motion that begins at x with velocity d is better said to be after the time
     * a: the same to first order in a; whole vectors. A Hessian of what stretches heeds Point.x_from then. NULL where the
     * straight way is as good. */
    void (*follow)(void *self, const double *x, const double *d, double a, double *to);

    /* Makes a trial x, to which a step leads from the admissible one at `from`, admissible: what follows from other dofs
     * (the positions of an inextensible rod from its rotations) is put into it, what would go too far stopped (at a
     * wall). Whole vectors; NULL if nothing. */
    void (*project)(const void *self, const double *from, double *x);

    /* Has something gone through the body in a step of time, from at->x_prev to at->x, which is solved? It is cut then, as
     * one that fails (march.h). NULL: never. */
    bool (*passes)(const void *self, const Point *at);

    /* After an accepted step: notes in memory what must be (the turns of a fold angle), and may write the same state
     * otherwise (rotations that are increments from a reference in x become 0, the reference turns). NULL if nothing. */
    void (*accept)(const void *self, double *x, double *memory);

    /* How many numbers the term remembers beside x: they are of the State, not of the term. At rest they are what is
     * written to rest, where that is not NULL. NULL: none. */
    int (*memory)(const void *self, double *rest);

    void (*destroy)(void *self);
} TermOps;

typedef struct Term {
    const TermOps *ops;
    void *self;
} Term;
