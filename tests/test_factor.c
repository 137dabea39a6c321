/* Factors and solves of positive definite matrices: right, and the same bits by one thread and by several. */
#include "base/memory.h"
#include "base/random.h"
#include "matrix_fixture.h"
#include "shell_fixture.h"
#include "solve/sparse.h"
#include "solve/supernodal.h"
#include "solve/system.h"
#include <math.h>
#include <string.h>

static const int threads[] = {1, 2, 3, 5};
enum { COUNTS = 4 };

/* Factored and solved by each count of threads, and one's factor by another's: all the same bits, and right. */
static void check_matrix(Sparse *a, int n)
{
    double *b = mem_alloc(3 * (size_t)n, sizeof *b), *first = b + n, *x = first + n;
    Random random = random_seed(4);
    for (int i = 0; i < n; i++) b[i] = random_signed(&random);
    for (int k = 0; k < COUNTS * COUNTS; k++) {
        Workers *one = workers_create(threads[k / COUNTS]), *other = workers_create(threads[k % COUNTS]);
        sparse_set_workers(a, k == 0 ? NULL : one);
        assert_true(sparse_factor(a, NULL));
        sparse_set_workers(a, k == 0 ? NULL : other);
        sparse_solve(a, b, x);
        if (k == 0) memcpy(first, x, (size_t)n * sizeof *x);
        assert_memory_equal(x, first, (size_t)n * sizeof *x);
        assert_true(misfit(a, n, x, b) < 1e-11);
        workers_destroy(one);
        workers_destroy(other);
    }
    sparse_set_workers(a, NULL);
    mem_free(b);
}

static void check_elements(Elements e, const int *order)
{
    Sparse *a = matrix_of(&e, (SparseDef){.order = order});
    check_matrix(a, e.n);
    sparse_destroy(a);
}

static void test_random(void **state)
{
    (void)state;
    check_elements(random_elements(500, 400, 3, 9, 1), NULL);
    check_elements(random_elements(3000, 2500, 4, 30, 2), NULL);
    check_elements(random_elements(7000, 9000, 3, 12, 3), NULL); /* by nested dissection */
    check_elements(random_elements(900, 300, 2, 2, 5), NULL);    /* many parts */
}

static void test_grid(void **state)
{
    (void)state;
    check_elements(grid_elements(30, 3), NULL);
    check_elements(grid_elements(45, 4), NULL);
}

/* A tree that is not in postorder: its subtrees do not lie in a row. */
static void test_given_order(void **state)
{
    (void)state;
    enum { N = 1200 };
    static int order[N];
    for (int i = 0; i < N; i++) order[i] = i * 7 % N;
    check_elements(random_elements(N, 1000, 3, 4, 6), order);
}

/* 1 x 1; a diagonal; a dense one; two dense ones that share nothing; an arrow. */
static void test_shapes(void **state)
{
    (void)state;
    Elements single = elements_create(1, 1, 1), diagonal = elements_create(700, 700, 1),
             dense = elements_create(401, 1, 401), two = elements_create(300, 2, 150),
             arrow = elements_create(600, 599, 2);
    for (int i = 0; i < 700; i++) diagonal.dofs[i] = i;
    for (int i = 0; i < 401; i++) dense.dofs[i] = i;
    for (int i = 0; i < 300; i++) two.dofs[i] = i;
    for (int i = 0; i < 599; i++) arrow.dofs[2 * i] = i + 1;
    check_elements(single, NULL);
    check_elements(diagonal, NULL);
    check_elements(dense, NULL);
    check_elements(two, NULL);
    check_elements(arrow, NULL);
}

/* One unknown that makes it indefinite, wherever that comes in the order, is found by each count of threads; the next factor is
 * right again. */
static void test_indefinite(void **state)
{
    (void)state;
    enum { STEP = 97 };
    Elements e = grid_elements(24, 3);
    Sparse *a = matrix_of(&e, (SparseDef){0});
    double *shift = mem_alloc(3 * (size_t)e.n, sizeof *shift), *b = shift + e.n, *x = b + e.n;
    for (int i = 0; i < e.n; i++) b[i] = 1;
    for (int t = 0; t < COUNTS; t++) {
        Workers *workers = workers_create(threads[t]);
        sparse_set_workers(a, workers);
        for (int i = t; i < e.n; i += STEP) {
            shift[i] = -1e3;
            assert_false(sparse_factor(a, shift));
            shift[i] = i % 2 ? NAN : INFINITY;
            assert_false(sparse_factor(a, shift));
            shift[i] = 0;
        }
        assert_true(sparse_factor(a, shift));
        sparse_solve(a, b, x);
        assert_true(misfit(a, e.n, x, b) < 1e-11);
        workers_destroy(workers);
    }
    sparse_destroy(a);
    mem_free(shift);
}

/* The lower triangle of L in a dense square: A's and what elimination fills in. */
static void fill_in(int n, char *lower)
{
    for (int c = 0; c < n; c++) {
        int parent = c + 1;
        while (parent < n && !lower[c * n + parent]) parent++;
        for (int i = parent; i < n && parent < n; i++) lower[parent * n + i] |= lower[c * n + i];
    }
}

/* Every column a supernode: of A = 3 on the diagonal, -1/4 where lower[column][row] is set. */
static void check_columns(int n, char *lower)
{
    long *first = mem_alloc(2 * (size_t)n + 2, sizeof *first), *start = first + n + 1,
         *rows = mem_alloc((size_t)n * (size_t)n, sizeof *rows);
    Pattern a = {n, mem_alloc((size_t)n + 1, sizeof(int)), mem_alloc((size_t)n * (size_t)n, sizeof(int))};
    double values[400], b[20] = {0}, x[20];
    int count = 0;
    for (int c = 0; c < n; c++) {
        for (int i = c; i < n; i++)
            if (i == c || lower[c * n + i]) a.rows[count] = i, values[count++] = i == c ? 3 : -0.25;
        a.start[c + 1] = count, x[c] = 1 + c;
    }
    for (int c = 0; c < n; c++)
        for (int k = a.start[c]; k < a.start[c + 1]; k++) {
            b[a.rows[k]] += values[k] * x[c];
            if (a.rows[k] != c) b[c] += values[k] * x[a.rows[k]];
        }
    for (int c = 0; c < n; c++) lower[c * n + c] = 1;
    fill_in(n, lower);
    for (int c = 0; c < n; c++) {
        first[c + 1] = c + 1, start[c + 1] = start[c];
        for (int i = c; i < n; i++)
            if (lower[c * n + i]) rows[start[c + 1]++] = i;
    }
    Supernodal *plan = supernodal_create(&a, &(SupernodalDef){n, first, start, rows});
    double *numbers = mem_alloc((size_t)supernodal_size(plan), sizeof *numbers);
    assert_true(supernodal_factor(plan, &a, values, numbers, NULL));
    supernodal_solve(plan, numbers, b, NULL);
    for (int c = 0; c < n; c++) assert_true(fabs(b[c] - x[c]) < 1e-13 * n);
    values[a.start[n - 1]] = -1;
    assert_false(supernodal_factor(plan, &a, values, numbers, NULL));
    supernodal_destroy(plan);
    mem_free(numbers);
    mem_free(first);
    mem_free(rows);
    mem_free(a.start);
    mem_free(a.rows);
}

/* Small ones, which CHOLMOD would not call supernodal, at random: trees of all kinds, most of them in no postorder. */
static void test_columns(void **state)
{
    (void)state;
    Random random = random_seed(7);
    for (int k = 0; k < 300; k++) {
        char lower[400] = {0};
        int n = 1 + k % 20;
        for (int c = 0; c < n; c++)
            for (int i = c + 1; i < n; i++) lower[c * n + i] = random_signed(&random) > 0.4 + 0.5 * (k % 3);
        check_columns(n, lower);
    }
}

/* A sheet's Hessian with an angle per edge, through its System. */
static void test_sheet(void **state)
{
    (void)state;
    Shell *shell = shell_of_sheet((double[]){0.1, 0.1}, (int[]){40, 40}, PATTERN_RIGHT);
    shell->bending = BENDING_MIDEDGE;
    shell->thickness = 1e-3;
    hold_root(shell, true);
    Body body = body_create(shell, shell_system(shell), 1e5);
    int n = system_dof_count(body.sys);
    double *gradient = mem_alloc(4 * (size_t)n, sizeof *gradient), *b = gradient + n, *first = b + n,
           *x = first + n;
    system_hessian(body.sys, &(Point){.x = body.state.x, .p = body.p, .memory = body.state.memory}, gradient);
    Random random = random_seed(4);
    for (int i = 0; i < n; i++) b[i] = system_is_fixed(body.sys, i) ? 0 : random_signed(&random);
    for (int t = 0; t < COUNTS; t++) {
        Workers *workers = workers_create(threads[t]);
        system_set_workers(body.sys, workers);
        assert_true(system_factor(body.sys, 1e-6));
        assert_true(system_solve_cg(body.sys, b, 1e-6, 100, x) > 0);
        if (t == 0) memcpy(first, x, (size_t)n * sizeof *x);
        assert_memory_equal(x, first, (size_t)n * sizeof *x);
        system_set_workers(body.sys, NULL);
        workers_destroy(workers);
    }
    mem_free(gradient);
    body_clear(&body);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random),      cmocka_unit_test(test_grid),
                                       cmocka_unit_test(test_given_order), cmocka_unit_test(test_shapes),
                                       cmocka_unit_test(test_indefinite),  cmocka_unit_test(test_columns),
                                       cmocka_unit_test(test_sheet)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
