/* case.h - a load case: a system of energies with its loads, where it is, and what it should do. */
#pragma once
#include "optim/objectives.h"
#include "solve/system.h"

/* Loads at a moment: one, or the stages of a sequence. */
typedef struct Stage {
    double *p; /* [params] owned */
    double time;
} Stage;

/* Where something of the body should be. */
typedef struct Target {
    double weight;
    double (*place)[3]; /* [point] m, coordinates that do not count NAN; NULL: a cloud; owned */
    PointCloud cloud;   /* of which its lists are owned */
} Target;

typedef struct Case {
    char *name;    /* owned, as all below */
    double weight; /* of its objectives   */
    System *sys;
    State state;    /* where to start; of a design the equilibrium of the best one so far */
    double *loads;  /* [params] the loads that act there; NULL: none do                      */
    double *anchor; /* of a motion that goes on: where its factor stands (system_anchor)     */
    int stage_count;
    Stage *stages; /* [stage_count]; a design has one, whose p gets the unknowns */
    int objective_count;
    Objective *objectives;
    int target_count;
    Target *targets;
} Case;

/* One stage with p[size], a copy, at that time; and a name (a copy). */
Case case_create(const char *name, const double *p, size_t size, double time);
void case_clear(Case *c);

/* Puts it where it starts, once its system is there: x[dofs], at its first stage's time. */
void case_start(Case *c, System *sys, const double *x);

/* Room for one more objective. */
Objective *case_add_objective(Case *c);
