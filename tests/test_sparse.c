/* Sparse matrices and their factors, which are values: they outlive patterns, and serve other ones. */
#include "base/memory.h"
#include "base/random.h"
#include "solve/sparse.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

enum { SIDE = 12, N = SIDE * SIDE };

/* A grid of springs to the right and up and, `far`, some more across it: other patterns, other orders. Values are
 * graph Laplacians plus 1. */
static Sparse *make_grid(int far, double stiffness, int n)
{
    int dofs[8 * N], count = 0;
    long start[4 * N + 1] = {0};
    for (int i = 0; i < n; i++) {
        const int ends[] = {i % SIDE < SIDE - 1 ? i + 1 : -1, i + SIDE < n ? i + SIDE : -1,
                            far && i % 7 == 0 ? (i * 5 + far) % n : -1};
        for (int k = 0; k < 3; k++) {
            if (ends[k] < 0 || ends[k] >= n || ends[k] == i) continue;
            dofs[2 * count] = i, dofs[2 * count + 1] = ends[k];
            count++;
            start[count] = 2 * count;
        }
    }
    Sparse *a = sparse_create(n, (Groups){count, start, dofs}, (SparseDef){0});
    double *values = sparse_values(a);
    for (int i = 0; i < n; i++) values[sparse_slot(a, i, i)] += 1;
    for (int e = 0; e < count; e++) {
        int i = dofs[2 * e], j = dofs[2 * e + 1];
        values[sparse_slot(a, i, i)] += stiffness;
        values[sparse_slot(a, j, j)] += stiffness;
        values[sparse_slot(a, i, j)] -= stiffness;
    }
    return a;
}

/* Largest entry of A x - b. */
static double misfit(const Sparse *a, const double *x, const double *b)
{
    double product[N], worst = 0;
    sparse_multiply(a, x, product);
    for (int i = 0; i < N; i++) worst = fmax(worst, fabs(product[i] - b[i]));
    return worst;
}

static void fill(double *b)
{
    Random random = random_seed(4);
    for (int i = 0; i < N; i++) b[i] = random_signed(&random);
}

/* A factor that is shared keeps its numbers when the matrix is factored anew, and is renewed in place when it is not. */
static void test_share(void **state)
{
    (void)state;
    Sparse *a = make_grid(0, 3, N);
    double b[N], first[N], second[N], again[N], shift[N];
    fill(b);
    assert_true(sparse_factor(a, NULL));
    sparse_solve(a, b, first);
    assert_true(misfit(a, first, b) < 1e-13);
    Factor *kept = sparse_share_factor(a);
    for (int i = 0; i < N; i++) shift[i] = 0.5;
    assert_true(sparse_factor(a, shift));
    sparse_solve(a, b, second);
    assert_true(fabs(second[0] - first[0]) > 1e-3);
    assert_true(sparse_use_factor(a, kept));
    sparse_solve(a, b, again);
    assert_memory_equal(first, again, sizeof first);
    factor_release(kept);
    sparse_solve(a, b, again); /* the matrix has its own share */
    assert_memory_equal(first, again, sizeof first);
    sparse_destroy(a);
}

/* A factor outlives its matrix, and used with one of another pattern and order it is what it was: A^-1, in the order in
 * which unknowns are numbered; as a preconditioner it leads to the other matrix's solution. */
static void test_other_pattern(void **state)
{
    (void)state;
    Sparse *a = make_grid(0, 3, N), *other = make_grid(11, 3.2, N);
    double b[N], x[N], y[N], z[N];
    fill(b);
    assert_true(sparse_factor(a, NULL));
    sparse_solve(a, b, x);
    Factor *factor = sparse_share_factor(a);
    sparse_destroy(a);
    assert_true(sparse_factor(other, NULL));
    Factor *its = sparse_share_factor(other);
    assert_int_not_equal(memcmp(factor_rank(factor), factor_rank(its), N * sizeof(int)), 0);
    factor_release(its);
    assert_true(sparse_use_factor(other, factor));
    factor_release(factor);
    sparse_solve(other, b, y);
    assert_memory_equal(x, y, sizeof x);
    int iterations = sparse_solve_cg(other, b, 1e-12, 100, z);
    assert_true(iterations > 1 && iterations < 60);
    assert_true(misfit(other, z, b) < 1e-10);
    assert_true(sparse_factor(other, NULL));
    sparse_solve(other, b, z);
    assert_true(misfit(other, z, b) < 1e-13);
    sparse_destroy(other);
}

/* Of another size it is refused, and what was at hand stays. */
static void test_other_size(void **state)
{
    (void)state;
    Sparse *a = make_grid(0, 3, N), *small = make_grid(0, 3, N / 2);
    double b[N], x[N], y[N];
    fill(b);
    assert_true(sparse_factor(a, NULL) && sparse_factor(small, NULL));
    sparse_solve(a, b, x);
    Factor *factor = sparse_share_factor(small);
    assert_false(sparse_use_factor(a, factor));
    sparse_solve(a, b, y);
    assert_memory_equal(x, y, sizeof x);
    factor_release(factor);
    sparse_destroy(a);
    sparse_destroy(small);
}

/* What is not positive definite, or not finite, is said to be so; the next factor is right again. */
static void test_indefinite(void **state)
{
    (void)state;
    Sparse *a = make_grid(0, 3, N);
    double b[N], x[N], shift[N];
    fill(b);
    for (int i = 0; i < N; i++) shift[i] = -4;
    assert_false(sparse_factor(a, shift));
    for (int i = 0; i < N; i++) shift[i] = i == 5 ? NAN : 0;
    assert_false(sparse_factor(a, shift));
    assert_true(sparse_factor(a, NULL));
    sparse_solve(a, b, x);
    assert_true(misfit(a, x, b) < 1e-13);
    sparse_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_share), cmocka_unit_test(test_other_pattern),
                                       cmocka_unit_test(test_other_size), cmocka_unit_test(test_indefinite)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
