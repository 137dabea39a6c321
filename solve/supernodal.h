/* supernodal.h - the numbers of a supernodal Cholesky factor L L^T, and solves with it, by several threads.
 *
 * The symbolic structure (columns of like pattern gathered into supernodes) is CHOLMOD's; the numbers are multifrontal
 * [Duff & Reid 1983; Liu, SIAM Review 34, 1992]: each supernode adds up its columns of the matrix and what its children in
 * the elimination tree left over, factors these columns, and leaves the Schur complement to its parent. In place of many
 * small products with descendants (left-looking: Ng & Peyton 1993; CHOLMOD: Chen, Davis, Hager & Rajamanickam 2008) each
 * supernode makes one large one.
 *
 * What is done in which order follows from the structure alone; threads only share it out. Subtrees of the tree, the
 * branches, are tasks, each with work space of its own; of the supernodes above them, the crown, one is done after the
 * other, the rows of each shared out in chunks. So no bit depends on the number of threads. */
#pragma once
#include "base/workers.h"
#include "solve/direct.h"

typedef struct Supernodal Supernodal;

/* Supernode s has the columns first[s] .. first[s + 1] and the rows rows[start[s] .. start[s + 1]), ascending, its own
 * columns foremost; all are copied. */
typedef struct SupernodalDef {
    int count;
    const long *first, *start, *rows;
} SupernodalDef;

Supernodal *supernodal_create(const Pattern *pattern, const SupernodalDef *def);
void supernodal_destroy(Supernodal *plan);

/* Doubles of a factor's numbers. */
long supernodal_size(const Supernodal *plan);

/* numbers[size] of the matrix of that pattern and these values. False where it is not positive definite: they are
 * unusable then. */
bool supernodal_factor(Supernodal *plan, const Pattern *pattern, const double *values, double *numbers,
                       Workers *workers);

/* x = (L L^T)^-1 x. */
void supernodal_solve(Supernodal *plan, const double *numbers, double *x, Workers *workers);
