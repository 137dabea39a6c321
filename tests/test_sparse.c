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

/* Springs between two unknowns each. */
typedef struct Springs {
    long start[4 * N + 1];
    int unknowns[8 * N], count;
} Springs;

static void add_spring(Springs *springs, int i, int j, int n)
{
    if (j < 0 || j >= n || j == i) return;
    springs->unknowns[2 * springs->count] = i, springs->unknowns[2 * springs->count + 1] = j;
    springs->count++;
    springs->start[springs->count] = 2L * springs->count;
}

/* From every `every`-th unknown across the grid; `far` says whereto. */
static void add_far_springs(Springs *springs, int far, int every, int n)
{
    for (int i = 0; i < n; i += every) add_spring(springs, i, (i * 5 + far) % n, n);
}

static void add_grid_springs(Springs *springs, int n)
{
    for (int i = 0; i < n; i++) {
        add_spring(springs, i, i % SIDE < SIDE - 1 ? i + 1 : -1, n);
        add_spring(springs, i, i + SIDE, n);
    }
}

static Groups groups_of(const Springs *springs)
{
    return (Groups){springs->count, springs->start, springs->unknowns};
}

static void add_values(Sparse *a, const Springs *springs, double stiffness)
{
    double *values = sparse_values(a);
    for (int e = 0; e < springs->count; e++) {
        int i = springs->unknowns[2 * e], j = springs->unknowns[2 * e + 1];
        values[sparse_slot(a, i, i)] += stiffness;
        values[sparse_slot(a, j, j)] += stiffness;
        values[sparse_slot(a, i, j)] -= stiffness;
    }
}

static void add_diagonal(Sparse *a, int n)
{
    for (int i = 0; i < n; i++) sparse_values(a)[sparse_slot(a, i, i)] += 1;
}

/* A grid of springs to the right and up and, `far`, some more across it: other patterns, other orders. Values are
 * graph Laplacians plus 1. */
static Sparse *make_grid(int far, double stiffness, int n)
{
    Springs springs = {.count = 0};
    add_grid_springs(&springs, n);
    if (far) add_far_springs(&springs, far, 7, n);
    Sparse *a = sparse_create(n, groups_of(&springs), (SparseDef){0});
    add_diagonal(a, n);
    add_values(a, &springs, stiffness);
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
    assert_int_equal(sparse_solve_cg(a, b, 1e-12, 0, x),
                     -1); /* of its own factor, but no iteration is allowed */
    for (int i = 0; i < N; i++) sparse_values(a)[sparse_slot(a, i, i)] -= 100;
    assert_int_equal(sparse_solve_cg(a, b, 1e-12, 100, x), SPARSE_INDEFINITE);
    sparse_destroy(a);
}

/* A factor of the grid with others coupled; its rank is left in rank[N], the solution in x[N]. */
static void solve_coupled(Sparse *a, int far, int every, int *rank, double *x)
{
    Springs grid = {.count = 0}, others = {.count = 0};
    double b[N];
    fill(b);
    add_grid_springs(&grid, N);
    if (every) add_far_springs(&others, far, every, N);
    sparse_couple(a, groups_of(&others));
    add_diagonal(a, N);
    add_values(a, &grid, 3);
    add_values(a, &others, 2);
    assert_true(sparse_factor(a, NULL));
    Factor *factor = sparse_share_factor(a);
    memcpy(rank, factor_rank(factor), N * sizeof *rank);
    factor_release(factor);
    sparse_solve(a, b, x);
    assert_true(misfit(a, x, b) < 1e-13);
}

/* With a few others coupled the order stays; with many there is another. Both follow from what is coupled alone, and not
 * from what was before; entries are found again where sparse_where says; and the factor at hand stays what it was. What is
 * coupled and not factored is not analysed. */
static void test_coupled(void **state)
{
    (void)state;
    Sparse *a = make_grid(0, 3, N), *fresh = make_grid(0, 3, N);
    int plain[N], few[N], many[N], again[N], kept[N];
    int slots[N];
    double x[N], y[N], b[N];
    fill(b);
    for (int i = 0; i < N; i++) slots[i] = sparse_slot(a, i, i);
    assert_true(sparse_factor(a, NULL));
    sparse_solve(a, b, x);
    Factor *factor = sparse_share_factor(a);
    memcpy(plain, factor_rank(factor), sizeof plain);
    factor_release(factor);
    long nonzeros = sparse_info(a).factor_nonzeros;
    sparse_couple(a, (Groups){1, (long[]){0, 2}, (int[]){0, N - 1}});
    for (int i = 0; i < N; i++) assert_int_equal(sparse_where(a)[slots[i]], sparse_slot(a, i, i));
    sparse_solve(a, b, y);
    assert_memory_equal(x, y, sizeof x);
    assert_int_equal(sparse_info(a).factor_nonzeros, nonzeros);

    solve_coupled(a, 11, 70, few, x);
    assert_true(sparse_info(a).factor_nonzeros > nonzeros);
    assert_memory_equal(plain, few, sizeof plain);
    solve_coupled(a, 11, 2, many, x);
    assert_int_not_equal(memcmp(plain, many, sizeof plain), 0);
    for (int i = 0; i < N; i++) assert_int_equal(sparse_where(a)[slots[i]], sparse_slot(a, i, i));
    const int group[5] = {4, 3, -1, 4, 3};
    int found[15];
    sparse_slots(a, 5, group, found);
    for (int i = 0; i < 15; i++) {
        const int row[] = {0, 1, 1, 2, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 4},
                  column[] = {0, 0, 1, 0, 1, 2, 0, 1, 2, 3, 0, 1, 2, 3, 4};
        int p = group[row[i]], q = group[column[i]];
        assert_int_equal(found[i], p < 0 || q < 0 ? -1 : sparse_slot(a, p, q));
    }
    solve_coupled(a, 40, 3, again, x);
    solve_coupled(fresh, 40, 3, kept, y);
    assert_memory_equal(again, kept, sizeof kept);
    assert_memory_equal(x, y, sizeof x);
    solve_coupled(a, 0, 0, again, x);
    assert_memory_equal(plain, again, sizeof plain);
    sparse_destroy(a);
    sparse_destroy(fresh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_share), cmocka_unit_test(test_other_pattern),
                                       cmocka_unit_test(test_other_size), cmocka_unit_test(test_indefinite),
                                       cmocka_unit_test(test_coupled)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
