/* sparse.h - symmetric sparse matrices that are assembled in place, factored and solved (direct.h).
 *
 * The pattern comes from the elements' dof lists, is ordered once for low fill (AMD; METIS for large ones) and stored
 * in the permuted order, so that factoring needs neither a transpose nor a new analysis. Positive definiteness is
 * news, not an error: sparse_factor returns false. */
#pragma once
#include "solve/direct.h"
#include <stdbool.h>

typedef struct Sparse Sparse;

typedef struct SparseDef {
    /* [n] the unknowns in the order of elimination; NULL: one for low fill is found (direct_order). */
    const int *order;

    /* So many unknowns are Lagrange multipliers: the matrix counts as definite where exactly so many pivots of its LDL^T
     * are negative, that is, where it is definite on what the multipliers allow. Each must come after unknowns that it
     * is coupled with, for there is no pivoting. */
    int negative;
    DirectKind direct;
} SparseDef;

/* The pattern of n unknowns that are coupled in groups (pattern.h). */
Sparse *sparse_create(int n, Groups groups, SparseDef def);
void sparse_destroy(Sparse *matrix);

/* Couples these groups beside those it was made of, in place of such given before; all its values are 0 then. The factor
 * at hand stays good. The next one has the order of those before, unless L would have 1.6 times the nonzeros (and no order
 * was given): it follows from the groups at hand alone, not from earlier ones, and is found when it is needed. */
void sparse_couple(Sparse *matrix, Groups groups);

/* Entries of the matrix as it was made; and where each (sparse_slot before any sparse_couple) is stored now, NULL: at its own
 * place. */
int sparse_made_nonzeros(const Sparse *matrix);
const int *sparse_where(const Sparse *matrix);

/* Factors, solves and products are shared out to these threads, from now on (borrowed; NULL: to none). No bit depends on
 * them. */
void sparse_set_workers(Sparse *matrix, Workers *workers);

/* Where entry (i, j) is stored in sparse_values(); either triangle. The pattern must hold it. */
int sparse_slot(const Sparse *matrix, int i, int j);

/* The same of a whole group of up to 32, its lower triangle by rows; -1 where either is none. Soon, for most come one behind the other. */
void sparse_slots(const Sparse *matrix, int count, const int *unknowns, int *slots);

/* The stored lower triangle of the permuted matrix, [sparse_nonzeros()]. */
double *sparse_values(Sparse *matrix);
int sparse_nonzeros(const Sparse *matrix);

/* diagonal[i] = A(i, i). */
void sparse_diagonal(const Sparse *matrix, double *diagonal);

/* Cholesky factor (with multipliers LDL^T) of A + diag(shift) (shift NULL: of A). False when that is not positive definite
 * (see SparseDef) or not finite: the factor is then unusable. */
bool sparse_factor(Sparse *matrix, const double *shift);

/* x = (A + diag(shift))^-1 b with the last factor; b and x may be the same. */
void sparse_solve(Sparse *matrix, const double *b, double *x);

/* y = A x. */
void sparse_multiply(const Sparse *matrix, const double *x, double *y);

/* Solves A x = b by conjugate gradients with the factor at hand, of a matrix nearby, as preconditioner M, from x = 0
 * until r'M^-1 r fell by tolerance^2. Returns the iterations; less than 0: SPARSE_INDEFINITE when A showed itself not positive
 * definite, -1 when max_iterations were too few. b and x may be the same. */
enum { SPARSE_INDEFINITE = -2 };

int sparse_solve_cg(Sparse *matrix, const double *b, double tolerance, int max_iterations, double *x);

/* The factor at hand, shared: the caller releases it (direct.h), when he likes. And a factor made the one at hand,
 * which takes a share: it may be of another pattern, and of another matrix altogether. False where it is of another
 * size: nothing is changed. */
Factor *sparse_share_factor(Sparse *matrix);
bool sparse_use_factor(Sparse *matrix, Factor *factor);

/* What it cost. */
typedef struct SparseInfo {
    long factor_nonzeros;          /* of L                                              */
    double factor_flops;           /* of one factorisation                              */
    long factor_bytes;             /* of a factor that is kept                          */
    long process_bytes, all_bytes; /* DirectCost's, of the factor that took most */
    long factorizations, solves;   /* so far, failed factorisations included            */
    double factor_seconds, solve_seconds;
} SparseInfo;
SparseInfo sparse_info(const Sparse *matrix);
