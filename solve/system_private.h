/* system_private.h - what system.c (evaluation, assembly) and system_linear.c (factor, solve, products) share. */
#pragma once
#include "solve/system.h"

/* A term and where its packs come from and go to. */
typedef struct Entry {
    Term term;
    int count, size, packs, lower; /* elements, dofs each, packs, Hessian entries each                  */
    int memory;                    /* first of what it remembers                                         */
    int (*dofs)[PACK_LANES];       /* [pack*size + i] global dof                                         */
    int (*slots)[PACK_LANES];      /* [pack*lower + k] place in the matrix; the bin for fixed dofs        */
    int *twice;                    /* [3*twice_count] pack, entry, lane: two different dofs of an element */
    int twice_count;               /*   that are the same global dof: (i, j) and (j, i) both count        */
} Entry;

struct System {
    int dof_count, free_count, term_count, bulk_count, class_count, multiplier_count, memory_count;
    int *order; /* [dof_count] NULL: none given */
    Entry entries[SYSTEM_MAX_TERMS];
    Bulk bulks[SYSTEM_MAX_BULKS];
    BulkCoupling couplings[SYSTEM_MAX_BULKS];             /* as given last              */
    double *bulk_gradient;                                /* [dof] of one of them; NULL without Bulks */
    double energies[SYSTEM_MAX_TERMS + SYSTEM_MAX_BULKS]; /* of the last evaluation     */
    Workers *workers;                                     /* borrowed                   */
    DofClass classes[SYSTEM_MAX_CLASSES];
    bool *fixed, factored; /* factored: the last factor may be used */
    bool prepared;
    int *unknown;   /* [dof] number among the free ones, -1 if fixed */
    Sparse *matrix; /* NULL until it is built */
    double base, stiffness_max;
    double *scale;       /* [dof] D                                     */
    double *compliance;  /* [dof] of multipliers, m/N; 0 elsewhere: see system_gap */
    double gap;          /* m                                           */
    double *force_sum;   /* [dof] sum of absolute element forces        */
    double *linearised;  /* [anchor_count] where the last Hessian stands: see system_anchor */
    double *anchor;      /* [anchor_count] where the last factor stands                     */
    double *work, *diag; /* [free]                                      */
};

/* Entries of an anchor before its vectors x, x_prev, v_prev [dof] each and the terms' memory. */
enum { ANCHOR_USABLE, ANCHOR_TIME, ANCHOR_DT, ANCHOR_SHIFT, ANCHOR_X };

/* x of a pack's elements from a whole vector, and the sum of its elements' numbers into one. */
void system_gather(const Entry *entry, int pack, const double *from, Pack *to);
void system_scatter(const Entry *entry, int pack, const Pack *from, double *to);
int system_lanes(const Entry *entry, int pack);

/* Pattern and slots for the terms and for what the Bulks couple. */
void system_build_matrix(System *sys);

/* Asks the Bulks what they couple at x, and makes the matrix, anew where that is more than before. */
void system_couple(System *sys, const double *x);

/* Energies of the Bulks, with gradients and Hessians as in an evaluation of terms. */
void system_evaluate_bulks(System *sys, const Point *at, double *gradient, double *values,
                           Evaluation *result);

/* Notes where the Hessian that was just assembled stands. */
void system_note_point(System *sys, const Point *at);
