/* dense.h - dense blocks of a sparse factor: columns one after the other, `ld` numbers apart.
 *
 * Small blocks, of which a sparse factor has thousands, are done here, in registers; large ones by OpenBLAS, which
 * packs them first. Which, follows from their sizes alone. */
#pragma once
#include <stdbool.h>

/* Most columns of dense_cholesky and dense_follow. */
enum { DENSE_PANEL = 64 };

/* a[rows][cols] = 0. */
void dense_clear(int rows, int cols, double *a, long ld);

/* L of the lower triangle of a[n][n], in its place; above the diagonal nothing is touched. False where a pivot is not
 * positive, or no number. */
bool dense_cholesky(int n, double *a, long ld);

/* a[rows][n] = a L^-T: rows of the factor below that triangle. */
void dense_follow(int rows, int n, const double *l, double *a, long ld);

/* C[rows][cols] -= A[rows][depth] B[cols][depth]^T. */
void dense_subtract(int rows, int cols, int depth, const double *a, const double *b, long ld, double *c,
                    long ldc);

/* C[n][n] -= A[n][depth] A^T, the lower triangle; above it anything may be left. */
void dense_subtract_square(int n, int depth, const double *a, long ld, double *c, long ldc);

/* x[n] = L^-1 x and L^-T x. */
void dense_forward(int n, const double *l, long ld, double *x);
void dense_backward(int n, const double *l, long ld, double *x);

/* y[rows] -= A[rows][n] x, and x[n] -= A^T y. */
void dense_multiply(int rows, int n, const double *a, long ld, const double *x, double *y);
void dense_multiply_transposed(int rows, int n, const double *a, long ld, const double *y, double *x);

/* Neither NaN nor infinity among them. */
bool dense_is_finite(long count, const double *values);
