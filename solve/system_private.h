/* system_private.h - what system.c (evaluation), system_matrix.c (the matrix) and system_linear.c (factor, solve,
 * products) share. */
#pragma once
#include "solve/patches.h"
#include "solve/system.h"

struct System {
    int dof_count, free_count, term_count, bulk_count, class_count, multiplier_count, memory_count;
    int *order; /* [dof_count] NULL: none given */
    Entry entries[SYSTEM_MAX_TERMS];
    Patches patches;
    Bulk bulks[SYSTEM_MAX_BULKS];
    BulkCoupling couplings[SYSTEM_MAX_BULKS];             /* as given last              */
    double *bulk_gradient;                                /* [dof] of one of them; NULL without Bulks */
    double energies[SYSTEM_MAX_TERMS + SYSTEM_MAX_BULKS]; /* of the last evaluation     */
    Workers *workers;                                     /* borrowed                   */
    DirectKind direct;
    DofClass classes[SYSTEM_MAX_CLASSES];
    bool *fixed, factored; /* factored: the last factor may be used */
    bool prepared;
    bool uncoupled; /* elements have changed since the matrix was coupled */
    int *unknown;   /* [dof] number among the free ones, -1 if fixed      */
    Sparse *matrix; /* NULL until it is built, with the patches           */
    double base, stiffness_max;
    double *scale;       /* [dof] D                                     */
    double *compliance;  /* [dof] of multipliers, m/N; 0 elsewhere: see system_gap */
    double gap;          /* m                                           */
    double *force_sum;   /* [dof] sum of absolute element forces        */
    double *linearised;  /* [anchor_count] where the last Hessian stands: see system_anchor */
    double *anchor;      /* [anchor_count] where the last factor stands                     */
    double *work, *diag; /* [free]                                      */
};

/* Entries of an anchor before its vectors x, x_prev, v_prev [dof] each, where something is lagged whether x_lag is given,
 * and x_lag, and the terms' memory. */
enum { ANCHOR_USABLE, ANCHOR_TIME, ANCHOR_DT, ANCHOR_SHIFT, ANCHOR_X };

/* Values of ANCHOR_USABLE: no factor, one of the whole Hessian, one of its convex part (Point.convex), one without
 * negative parts (Point.tangled). */
enum { ANCHOR_NONE, ANCHOR_OF_ALL, ANCHOR_OF_CONVEX, ANCHOR_OF_TANGLED };

/* x of a pack's elements from a whole vector, and the sum of its elements' numbers into one. */
void system_gather(const Entry *entry, int pack, const double *from, Pack *to);
void system_scatter(const Entry *entry, int pack, const Pack *from, double *to);
int system_lanes(const Entry *entry, int pack);

/* Asks a term for its elements. */
void system_list_elements(Entry *entry);

/* Has the terms' elements follow the point (TermOps.update). */
void system_update(System *sys, const Point *at);

/* Has the matrix hold what elements that change, and Bulks at x, couple. */
void system_couple(System *sys, const double *x);

/* Energies of the Bulks, with gradients and Hessians as in an evaluation of terms. */
void system_evaluate_bulks(System *sys, const Point *at, double *gradient, double *values,
                           Evaluation *result);

/* Notes where the Hessian that was just assembled stands. */
void system_note_point(System *sys, const Point *at);
