/* matrix_fixture.h - matrices of elements, for tests of factors. */
#pragma once
#include "base/memory.h"
#include "base/random.h"
#include "solve/sparse.h"
#include <math.h>

/* Elements of `size` unknowns each, whose matrices are c (1 1^T + I): positive definite where every unknown has one. */
typedef struct Elements {
    int n, count, size;
    int *dofs;
} Elements;

static inline Elements elements_create(int n, int count, int size)
{
    return (Elements){n, count, size, mem_alloc((size_t)count * (size_t)size, sizeof(int))};
}

static inline Sparse *matrix_of(Elements *e, SparseDef def)
{
    long *start = mem_alloc((size_t)e->count + 1, sizeof *start);
    for (int k = 0; k <= e->count; k++) start[k] = (long)k * e->size;
    Sparse *a = sparse_create(e->n, (Groups){e->count, start, e->dofs}, def);
    double *values = sparse_values(a);
    for (int i = 0; i < e->n; i++) values[sparse_slot(a, i, i)] += 0.01;
    for (int k = 0; k < e->count; k++)
        for (int i = 0; i < e->size; i++)
            for (int j = 0; j <= i; j++) {
                int p = e->dofs[k * e->size + i], q = e->dofs[k * e->size + j];
                double c = 1 + 0.1 * (k % 7);
                values[sparse_slot(a, p, q)] += i == j || p == q ? 2 * c : c;
            }
    mem_free(start);
    mem_free(e->dofs);
    return a;
}

/* Unknowns near each other, and a few far: what a mesh with some welds couples. */
static inline Elements random_elements(int n, int count, int size, int reach, unsigned seed)
{
    Elements e = elements_create(n, count, size);
    Random random = random_seed(seed);
    for (int k = 0; k < count; k++) {
        int at = (int)((long)k * n / count);
        for (int i = 0; i < size; i++) {
            double far = k % 50 == 0 ? n : reach;
            int to = at + (int)(far * random_signed(&random));
            e.dofs[k * size + i] = to < 0 ? 0 : to >= n ? n - 1 : to;
        }
    }
    return e;
}

/* A side x side grid of squares, with `dofs` unknowns at each corner. */
static inline Elements grid_elements(int side, int dofs)
{
    Elements e = elements_create((side + 1) * (side + 1) * dofs, side * side, 4 * dofs);
    for (int k = 0; k < e.count; k++)
        for (int i = 0; i < e.size; i++) {
            int corner = i / dofs, x = k % side + corner % 2, y = k / side + corner / 2;
            e.dofs[k * e.size + i] = (y * (side + 1) + x) * dofs + i % dofs;
        }
    return e;
}

static inline double misfit(const Sparse *a, int n, const double *x, const double *b)
{
    double *product = mem_alloc((size_t)n, sizeof *product), worst = 0;
    sparse_multiply(a, x, product);
    for (int i = 0; i < n; i++) worst = fmax(worst, fabs(product[i] - b[i]));
    mem_free(product);
    return worst;
}
