/* product.h - y = A x of a symmetric matrix of which the lower triangle is stored, by several threads.
 *
 * Columns are taken in blocks that follow from the pattern alone. An entry adds to two places of y, of which one may lie
 * beyond the block: there each block has sums of its own, which are added up one block after the other. So no bit depends
 * on the number of threads. */
#pragma once
#include "solve/direct.h"

typedef struct Product Product;

Product *product_create(const Pattern *pattern);
void product_destroy(Product *product);

/* y = A x, all [n]; x and y are not the same. */
void product_apply(Product *product, const Pattern *pattern, const double *values, const double *x, double *y,
                   Workers *workers);
