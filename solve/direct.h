/* direct.h - the direct solvers behind sparse.h: an order of elimination, factors, solutions. Each is a row (direct_row.h):
 * CHOLMOD (direct_cholmod.c), with the numbers of positive definite ones by supernodal.h, and MUMPS (direct_mumps.c), whose
 * factors are spread over processes.
 *
 * A Direct is what follows from a pattern alone. A Factor is its numbers and a share of the Direct that they were made
 * in, so that it outlives the matrix and its pattern; whoever keeps one shares it. */
#pragma once
#include "base/error.h"
#include "base/workers.h"
#include "solve/pattern.h"
#include <stdbool.h>

typedef struct Direct Direct;
typedef struct Factor Factor;

/* The values of the scene's key solver.direct, in this order. */
typedef enum DirectKind { DIRECT_CHOLMOD, DIRECT_MUMPS, DIRECT_KINDS } DirectKind;

/* Can it be used, in this program and this process? False with a sentence. */
bool direct_is_ready(DirectKind kind, Error *err);

/* Does it work in all processes of the run (ranks.h), which are to be started before? */
bool direct_is_spread(DirectKind kind);

/* "CHOLMOD 3.0.14", a static text; NULL: it is not in this program. */
const char *direct_version(DirectKind kind);

/* How often a pattern will be factored: what takes longer to find pays for what is factored often. */
typedef enum DirectUse { DIRECT_OFTEN, DIRECT_SELDOM } DirectUse;

/* rank[i]: where an order of low fill (AMD; METIS for large ones) puts unknown i, for any of them. The caller frees it. */
int *direct_order(const Pattern *pattern, DirectUse use);

/* Of a pattern that is in the order of elimination already; rank[n] (copied) says where unknown i went. Of the pivots
 * exactly `negative` are to be negative: more than 0 needs LDL^T, which CHOLMOD makes without pivoting. */
Direct *direct_analyse(DirectKind kind, const Pattern *pattern, const int *rank, int negative);
Direct *direct_share(Direct *direct);
void direct_release(Direct *direct);
const int *direct_rank(const Direct *direct);

typedef struct DirectCost {
    long nonzeros, bytes; /* of a factor       */
    double flops;         /* to make one       */
    /* Of spread ones: memory that making one has taken, at most, of a process, and of all together. */
    long process_bytes, all_bytes;
} DirectCost;
DirectCost direct_cost(const Direct *direct);

/* Threads share in factors and in solves where workers are given, NULL: none; no bit depends on them.
 *
 * Factors the matrix of the analysed pattern and these values into *factor: in its place where nobody else shares it
 * and it is of this Direct, else into a new one, and the old one is let go. False where the pivots are not as
 * direct_analyse was told, or a value is not finite: the factor is then unusable. */
bool direct_factor(Direct *direct, const Pattern *pattern, double *values, Factor **factor, Workers *workers);

/* One more who has it; each lets go once. NULL is allowed. */
Factor *factor_share(Factor *factor);
void factor_release(Factor *factor);

int factor_size(const Factor *factor);

/* That of the Direct which the factor was made in. */
const int *factor_rank(const Factor *factor);

/* Solves for b[n] in the factor's order; the solution, [n], is borrowed until the next call with a factor of the same
 * Direct. */
const double *factor_solve(const Factor *factor, const double *b, Workers *workers);
