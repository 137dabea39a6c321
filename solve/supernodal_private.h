/* supernodal_private.h - what supernodal.c (the structure), supernodal_factor.c and supernodal_solve.c share. */
#pragma once
#include "solve/supernodal.h"
#include <stdatomic.h>

/* Its columns of L are numbers[width][height] at numbers_at, the upper triangle of the diagonal block unused; its Schur
 * complement, the update, is [below][below], the lower triangle. Below the diagonal block, zero rows fill up the last
 * Pack, so that kernels meet whole ones. */
typedef struct Supernode {
    int first, width, rows, below, height;
    int parent, child, sibling; /* -1: none; the first child and the next one of the same parent, ascending */
    int branch;                 /* -1: of the crown                                                        */
    bool kept; /* the update lies in the plan's work space; else on the desk of who does the branch */
    long numbers_at, update_at;
    long at; /* of what is kept for each of its rows below */
} Supernode;

/* A subtree: the supernodes first .. last, the columns from `column` on. In solves it has a vector of its own: its columns,
 * the rows below those of `last`, its border, and room for a supernode's rows. */
typedef struct Branch {
    int first, last, column, columns, border;
    double work;
    long vector_at;
} Branch;

/* Work space of one thread at a branch. */
typedef struct Desk {
    atomic_flag taken;
    double *work;
} Desk;

struct Supernodal {
    int n, count, branch_count, desk_count;
    Supernode *nodes;
    Branch *branches; /* those with most work first */
    int *rows;    /* [at + i] row i below                                                                */
    int *places;  /* [at + i] where it comes among the parent's rows                                     */
    int *targets; /* [at + i] and in the vector that solves of its branch work on; of the crown: the row */
    int *slots;   /* [the pattern's nonzeros] where an entry comes among the rows of its column's supernode */
    long numbers, work_size, desk_size, vector_size, crown_at;
    Desk *desks;    /* as many as threads were seen                          */
    double *work;   /* the crown's updates, and those that branches leave; from the first factor on */
    double *vector; /* of the branches, and at crown_at room for a supernode */
};

/* Chunks of `size` that `count` make. */
static inline int chunks_of(int count, int size)
{
    return (count + size - 1) / size;
}
