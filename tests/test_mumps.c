/* Factors by MUMPS, over the processes that this is started as: right, of the inertia they are asked for, values as CHOLMOD's. */
#include "base/memory.h"
#include "base/workers.h"
#include "leaks.h"
#include "matrix_fixture.h"
#include "solve/ranks.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static const SparseDef spread = {.direct = DIRECT_MUMPS};

static double *random_vector(int n, unsigned seed)
{
    double *b = mem_alloc((size_t)n, sizeof *b);
    Random random = random_seed(seed);
    for (int i = 0; i < n; i++) b[i] = random_signed(&random);
    return b;
}

static Elements copy_of(Elements e)
{
    e.dofs = mem_copy(e.dofs, (size_t)e.count * (size_t)e.size, sizeof *e.dofs);
    return e;
}

/* Of both solvers the same solution. */
static void check_elements(Elements e)
{
    Elements same = copy_of(e);
    Sparse *a = matrix_of(&e, spread), *other = matrix_of(&same, (SparseDef){0});
    double *b = random_vector(e.n, 4), *x = random_vector(e.n, 5), *y = random_vector(e.n, 6), most = 0;
    assert_true(sparse_factor(a, NULL) && sparse_factor(other, NULL));
    sparse_solve(a, b, x);
    sparse_solve(other, b, y);
    for (int i = 0; i < e.n; i++) most = fmax(most, fabs(x[i] - y[i]));
    assert_true(misfit(a, e.n, x, b) < 1e-11);
    assert_true(most < 1e-10);
    SparseInfo info = sparse_info(a);
    assert_true(info.factor_nonzeros >= e.n && info.factor_bytes >= 8 * info.factor_nonzeros);
    assert_true(info.all_bytes >= info.process_bytes && (e.n < 3000 || info.process_bytes > 0)); /* in MB */
    assert_int_equal(sparse_info(other).all_bytes, 0);
    sparse_destroy(a);
    sparse_destroy(other);
    mem_free(b);
    mem_free(x);
    mem_free(y);
}

static void test_elements(void **state)
{
    (void)state;
    Elements single = elements_create(1, 1, 1), diagonal = elements_create(70, 70, 1),
             dense = elements_create(151, 1, 151), arrow = elements_create(600, 599, 2);
    for (int i = 0; i < 70; i++) diagonal.dofs[i] = i;
    for (int i = 0; i < 151; i++) dense.dofs[i] = i;
    for (int i = 0; i < 599; i++) arrow.dofs[2 * i] = i + 1;
    check_elements(single);
    check_elements(diagonal);
    check_elements(dense);
    check_elements(arrow);
    check_elements(random_elements(3000, 2500, 4, 30, 2));
    check_elements(random_elements(900, 300, 2, 2, 5)); /* many parts */
    check_elements(grid_elements(45, 4));
}

/* ---- Inertia ---- */

enum { SIDE = 23, GRID = SIDE * SIDE };

/* The second differences of a square grid, whose eigenvalues are 4 - 2 cos(i h) - 2 cos(j h), h = pi / (SIDE + 1). */
static Sparse *differences(SparseDef def)
{
    long start[3 * GRID];
    int dofs[6 * GRID], count = 0;
    start[0] = 0;
    for (int i = 0; i < GRID; i++)
        for (int way = 0; way < 2; way++) {
            int to = way ? i + SIDE : i + 1;
            if (to >= GRID || (!way && to % SIDE == 0)) continue;
            dofs[2 * count] = i, dofs[2 * count + 1] = to;
            start[count + 1] = 2L * (count + 1), count++;
        }
    Sparse *a = sparse_create(GRID, (Groups){count, start, dofs}, def);
    double *values = sparse_values(a);
    for (int k = 0; k < sparse_nonzeros(a); k++) values[k] = -1;
    for (int i = 0; i < GRID; i++) values[sparse_slot(a, i, i)] = 4;
    return a;
}

static int eigenvalues_below(double shift)
{
    int count = 0;
    double h = acos(-1) / (SIDE + 1);
    for (int i = 1; i <= SIDE; i++)
        for (int j = 1; j <= SIDE; j++) count += 4 - 2 * cos(i * h) - 2 * cos(j * h) < shift;
    return count;
}

static void check_inertia(double below, int told, bool is_so)
{
    SparseDef def = {.direct = DIRECT_MUMPS, .negative = told};
    Sparse *a = differences(def);
    double shift[GRID], *b = random_vector(GRID, 7), *x = random_vector(GRID, 8);
    for (int i = 0; i < GRID; i++) shift[i] = -below;
    assert_int_equal(sparse_factor(a, shift), is_so);
    if (is_so) {
        sparse_solve(a, b, x);
        double *values = sparse_values(a);
        for (int i = 0; i < GRID; i++) values[sparse_slot(a, i, i)] -= below;
        assert_true(misfit(a, GRID, x, b) < 1e-10);
    }
    sparse_destroy(a);
    mem_free(b);
    mem_free(x);
}

static void test_inertia(void **state)
{
    (void)state;
    static const double shifts[] = {0, 0.01, 0.1, 0.5, 1.7, 3.1, 4.03, 7.9, 9};
    for (size_t k = 0; k < sizeof shifts / sizeof *shifts; k++) {
        int count = eigenvalues_below(shifts[k]);
        check_inertia(shifts[k], count, true);
        check_inertia(shifts[k], count + 1, false);
        if (count > 0) check_inertia(shifts[k], count - 1, false);
        if (count > 1) check_inertia(shifts[k], 0, false);
    }
}

/* [0 B; B^T 0], which has as many eigenvalues below 0 as above, and no pivot on its diagonal: all are 2 x 2, or put off, and more
 * room is needed than was foreseen. */
static void test_pivots(void **state)
{
    (void)state;
    enum { HALF = 600, N = 2 * HALF, ROW = 5 };
    long start[ROW * HALF + 1];
    int dofs[2 * ROW * HALF], order[N], count = 0;
    for (int i = 0; i < HALF; i++)
        for (int k = 0; k < ROW; k++, count++)
            start[count] = 2L * count, dofs[2 * count] = i,
            dofs[2 * count + 1] = HALF + (i + k * k * k) % HALF;
    start[count] = 2L * count;
    for (int i = 0; i < N; i++) order[i] = i;
    Sparse *a = sparse_create(N, (Groups){count, start, dofs},
                              (SparseDef){.order = order, .negative = HALF, .direct = DIRECT_MUMPS});
    double *values = sparse_values(a), *b = random_vector(N, 3), *x = random_vector(N, 4);
    for (int e = 0; e < count; e++)
        values[sparse_slot(a, dofs[2 * e], dofs[2 * e + 1])] = e % ROW ? 0.2 * (1 + e % 3) : 3;
    assert_true(sparse_factor(a, NULL));
    sparse_solve(a, b, x);
    assert_true(misfit(a, N, x, b) < 1e-11);
    sparse_destroy(a);
    mem_free(b);
    mem_free(x);
}

/* What is not definite, wherever that comes in the order, singular, or not finite is found; the next factor is right again. */
static void test_indefinite(void **state)
{
    (void)state;
    Elements e = grid_elements(14, 3);
    Sparse *a = matrix_of(&e, spread);
    double *shift = mem_alloc((size_t)e.n, sizeof *shift), *b = random_vector(e.n, 1),
           *x = mem_copy(b, (size_t)e.n, sizeof *b);
    for (int i = 0; i < e.n; i += 97) {
        shift[i] = -1e3;
        assert_false(sparse_factor(a, shift));
        shift[i] = i % 2 ? NAN : INFINITY;
        assert_false(sparse_factor(a, shift));
        shift[i] = 0;
    }
    memset(sparse_values(a), 0, (size_t)sparse_nonzeros(a) * sizeof(double));
    assert_false(sparse_factor(a, NULL));
    for (int i = 0; i < e.n; i++) shift[i] = 2;
    assert_true(sparse_factor(a, shift));
    sparse_solve(a, b, x);
    for (int i = 0; i < e.n; i++) assert_true(fabs(x[i] - b[i] / 2) < 1e-15);
    sparse_destroy(a);
    mem_free(shift);
    mem_free(b);
    mem_free(x);
}

/* ---- Factors are values ---- */

/* Many kept at once, each of a matrix of its own: all are right, in any order, when the matrix has gone on; the last ones when
 * it is gone. */
static void test_kept(void **state)
{
    (void)state;
    enum { COUNT = 20 };
    Sparse *a = differences(spread), *other = differences(spread), *plain = differences((SparseDef){0});
    Factor *kept[COUNT];
    double shift[GRID], x[GRID], *b = random_vector(GRID, 9), y[GRID];
    for (int k = 0; k < COUNT; k++) {
        for (int i = 0; i < GRID; i++) shift[i] = 1 + k;
        assert_true(sparse_factor(a, shift));
        kept[k] = sparse_share_factor(a);
    }
    for (int k = COUNT - 1; k >= 0; k--) {
        if (k == COUNT / 2) sparse_destroy(a);
        for (int i = 0; i < GRID; i++) shift[i] = 1 + k;
        assert_true(sparse_factor(plain, shift) && sparse_use_factor(other, kept[k]));
        factor_release(kept[k]);
        sparse_solve(plain, b, x);
        sparse_solve(other, b, y);
        for (int i = 0; i < GRID; i++) assert_true(fabs(x[i] - y[i]) < 1e-14);
    }
    Factor *last = sparse_share_factor(plain); /* of the other solver */
    assert_true(sparse_use_factor(other, last));
    factor_release(last);
    sparse_solve(other, b, y);
    assert_memory_equal(x, y, sizeof x);
    sparse_destroy(other);
    sparse_destroy(plain);
    mem_free(b);
}

/* Couplings that come and go have patterns of their own, and take the factor's place. */
static void test_coupled(void **state)
{
    (void)state;
    Sparse *a = differences(spread);
    double *b = random_vector(GRID, 9), *x = random_vector(GRID, 2), shift[GRID];
    for (int i = 0; i < GRID; i++) shift[i] = 1;
    for (int far = 3; far < 9; far++) {
        long start[GRID + 1];
        int dofs[2 * GRID], count = 0;
        start[0] = 0;
        for (int i = far; far < 8 && i < GRID; i += far) {
            dofs[2 * count] = i, dofs[2 * count + 1] = i * 7 % GRID;
            start[count + 1] = 2L * (count + 1), count++;
        }
        sparse_couple(a, (Groups){count, start, dofs});
        double *values = sparse_values(a);
        for (int i = 0; i < GRID; i++) values[sparse_slot(a, i, i)] = 4;
        for (int e = 0; e < count; e++) values[sparse_slot(a, dofs[2 * e], dofs[2 * e + 1])] = -0.3;
        for (int i = 0; i < GRID; i++) values[sparse_slot(a, i, i)] = 4 + shift[i];
        assert_true(sparse_factor(a, NULL));
        sparse_solve(a, b, x);
        assert_true(misfit(a, GRID, x, b) < 1e-13);
    }
    sparse_destroy(a);
    mem_free(b);
    mem_free(x);
}

/* ---- Threads ---- */

static void solve_one(void *self, int k)
{
    double *off = self;
    Elements e = random_elements(400 + 50 * k, 300, 3, 9, (unsigned)k);
    Sparse *a = matrix_of(&e, spread);
    double *b = random_vector(e.n, 4), *x = random_vector(e.n, 5);
    off[k] = 0;
    for (int again = 0; again < 5; again++) {
        bool factored = sparse_factor(a, NULL);
        sparse_solve(a, b, x);
        off[k] = fmax(off[k], factored ? misfit(a, e.n, x, b) : INFINITY);
    }
    sparse_destroy(a);
    mem_free(b);
    mem_free(x);
}

/* Load cases are solved side by side. */
static void test_threads(void **state)
{
    (void)state;
    Workers *workers = workers_create(3);
    double off[12];
    workers_run(workers, 12, solve_one, off);
    workers_destroy(workers);
    for (int k = 0; k < 12; k++) assert_true(off[k] < 1e-11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_elements), cmocka_unit_test(test_inertia),
                                       cmocka_unit_test(test_pivots),   cmocka_unit_test(test_indefinite),
                                       cmocka_unit_test(test_kept),     cmocka_unit_test(test_coupled),
                                       cmocka_unit_test(test_threads)};
    ranks_start();
    if (ranks_serve()) return 0;
    int failed = cmocka_run_group_tests(tests, NULL, nothing_leaks);
    ranks_end();
    return failed;
}
