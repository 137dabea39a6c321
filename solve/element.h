/* element.h - small helpers for writing element Hessians: 3x3 blocks into the packed lower triangle. */
#pragma once
#include "base/pack_mat.h"
#include "solve/term.h"

static inline void element_add_row(Pack *H, int row, int column, Pack3 a)
{
    H[TERM_LOWER(row, column)] += a.x;
    H[TERM_LOWER(row, column + 1)] += a.y;
    H[TERM_LOWER(row, column + 2)] += a.z;
}

/* Adds A at rows 3i.., columns 3j.. and, by symmetry, A^T at (j, i); i != j. */
static inline void element_add_block(Pack *H, int i, int j, PackMat a)
{
    if (i < j) {
        int swap = i;
        i = j, j = swap;
        a = pack_mat_transpose(a);
    }
    element_add_row(H, 3 * i, 3 * j, a.r0);
    element_add_row(H, 3 * i + 1, 3 * j, a.r1);
    element_add_row(H, 3 * i + 2, 3 * j, a.r2);
}

/* Adds a symmetric A at the diagonal block i. */
static inline void element_add_diagonal(Pack *H, int i, PackMat a)
{
    int k = 3 * i;
    H[TERM_LOWER(k, k)] += a.r0.x;
    H[TERM_LOWER(k + 1, k)] += a.r1.x;
    H[TERM_LOWER(k + 1, k + 1)] += a.r1.y;
    H[TERM_LOWER(k + 2, k)] += a.r2.x;
    H[TERM_LOWER(k + 2, k + 1)] += a.r2.y;
    H[TERM_LOWER(k + 2, k + 2)] += a.r2.z;
}

static inline void element_clear(Pack *H, int size)
{
    memset(H, 0, (size_t)TERM_LOWER(size, 0) * sizeof *H);
}
