/* patches.h - packs of elements in patches, the tasks of an evaluation. Private to the System.
 *
 * A patch is a run of neighbouring packs of every term, with numbers of its own for the dofs and the matrix entries that
 * it touches. One thread at a time sums a patch's elements into the places that these numbers stand for; what patches
 * share is summed afterwards (pull.h). So bits depend on the patches, which follow from the terms alone, and not on
 * threads; and what a patch writes to is small and near, which saves more than the second sum costs.
 *
 * Numbers have 16 bits, for one per entry of each element's matrix is most of what an evaluation reads. Number 0 of
 * every patch is its bin: what belongs nowhere is added there and never read. */
#pragma once
#include "base/workers.h"
#include "solve/pull.h"
#include "solve/sparse.h"
#include "solve/term.h"
#include <stdbool.h>
#include <stdint.h>

typedef uint16_t Number;

/* A term and where its packs come from and go to. Terms whose elements begin with the same dofs in the same packs as
 * another's (a membrane's three vertices and those of the bending, a vertex's inertia and its weight) ride with it: what
 * they give is added in the packs, and stored once. */
typedef struct Entry {
    Term term;
    bool changes;                        /* its elements do                                       */
    int host;                            /* the term it rides with; itself: none; then what follows: */
    int count, size, packs, lower;       /* elements, dofs each, packs, Hessian entries each      */
    int memory;                          /* first of what it remembers                            */
    int (*dofs)[PACK_LANES];             /* [pack*size + i] global dof                            */
    Number (*dof_numbers)[PACK_LANES];   /* [pack*size + i] the dof in the patch                  */
    Number (*entry_numbers)[PACK_LANES]; /* [pack*lower + k] the matrix entry in the patch        */
    int *twice_start;                    /* [packs + 1] in twice                                  */
    Number *
        twice; /* k*PACK_LANES + lane: two dofs of an element that are the same, (i, j) and (j, i) both count */
} Entry;

/* Of terms whose elements last, or of such whose elements change (TermOps.update); the former come first. */
typedef struct Patch {
    int first[SYSTEM_MAX_TERMS], end[SYSTEM_MAX_TERMS]; /* packs of each term        */
    int dofs, entries, dof_count, entry_count;          /* its places, the bin first */
} Patch;

/* Places of all patches, and whose they are. Place 0 is nobody's. */
typedef struct Places {
    int count, room, lasting; /* lasting: the first ones, of patches that last   */
    int *target;              /* [count] -1: nobody's                            */
    Pull pull;                /* of the lasting ones; the others are added one by one */
    int value_room;
    double *values; /* [value_room >= count]                           */
} Places;

typedef struct Patches {
    int count, room, lasting;
    Patch *list;
    Places dofs;      /* targets: all dofs */
    Places entries;   /* targets: those of the matrix as it was made, or, of patches that change, as it is */
    double *forces;   /* [dofs.value_room] sums of absolute element forces       */
    double *energies; /* [count][SYSTEM_MAX_TERMS]                               */
} Patches;

/* Divides the packs of the terms that last: once, with the matrix made of their elements. unknown[dof_count]: of a dof in
 * the matrix, -1: none. */
void patches_create(Patches *patches, Entry *entries, int term_count, const Sparse *matrix, int dof_count,
                    const int *unknown);
void patches_destroy(Patches *patches);

/* Divides the packs of the terms that change, in place of those before. Hessians wait for the places of their entries:
 * patches_place, once the matrix is of these elements too; it is to be called whenever that has changed. */
void patches_change(Patches *patches, Entry *entries, int term_count, int dof_count);
void patches_place(Patches *patches, Entry *entries, int term_count, const Sparse *matrix,
                   const int *unknown);

/* Frees what these have found of a term. */
void entry_clear(Entry *entry);

/* What an evaluation is to give; without a gradient there are no values. */
typedef struct Sums {
    double *energies; /* [terms]                                                            */
    double *gradient; /* [dofs]; NULL: not asked for                                        */
    double *forces;   /* [dofs] sums of absolute element forces, with a gradient            */
    double *values;   /* [nonzeros] of the matrix; NULL: not asked for                      */
    const int *where; /* sparse_where of it                                                 */
    int nonzeros;
} Sums;

/* points[term]: as each term sees it (system_term_point). */
void patches_sum(Patches *patches, const Entry *entries, int term_count, const Point *points,
                 Workers *workers, Sums sums);
