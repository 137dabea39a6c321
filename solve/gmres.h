/* gmres.h - linear systems near the identity: (I + K) x = b, K small or of low rank. */
#pragma once
#include <stdbool.h>

/* y = K x of vectors [n]; x and y are not the same. */
typedef void GmresProduct(void *self, const double *x, double *y);

/* Solves (I + K) x = b by GMRES without restarts [Saad & Schultz 1986] until the residual is tolerance |b|; x may be b. False
 * where it is not in max_iterations: x is then the best there is. */
bool gmres_solve(int n, GmresProduct *product, void *self, const double *b, double tolerance,
                 int max_iterations, double *x);
