#include "solve/sparse.h"
#include "base/clock.h"
#include "base/memory.h"
#include "solve/product.h"
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

struct Sparse {
    int n;
    Pattern pattern; /* in the order of elimination */
    Direct *direct;
    Product *product;
    Factor *factor;   /* at hand; NULL: none was made */
    const int *rank;  /* [n] where unknown i went; the Direct's */
    Workers *workers; /* borrowed                              */
    double *values;
    double *diagonal; /* [n] kept aside while a shift stands on the diagonal                          */
    double *cg;       /* [6][n] x, residual, direction, product, M^-1 residual of it; a solve's b; permuted */
    SparseInfo info;
};

static int compare_int(const void *a, const void *b)
{
    int i = *(const int *)a, j = *(const int *)b;
    return (i > j) - (i < j);
}

/* For each unknown, the elements that hold it. */
static void list_elements(int n, int element_count, const long *start, const int *dofs, long **first,
                          int **elements)
{
    long *at = mem_alloc((size_t)n + 2, sizeof *at);
    for (long k = 0; k < start[element_count]; k++)
        if (dofs[k] >= 0) at[dofs[k] + 2]++;
    for (int i = 0; i < n; i++) at[i + 2] += at[i + 1];
    int *list = mem_alloc((size_t)at[n + 1], sizeof *list);
    for (int e = 0; e < element_count; e++)
        for (long k = start[e]; k < start[e + 1]; k++)
            if (dofs[k] >= 0) list[at[dofs[k] + 1]++] = e;
    *first = at;
    *elements = list;
}

/* The lower triangle's pattern in the order given by rank (NULL: as numbered). */
static Pattern build_pattern(int n, int element_count, const long *start, const int *dofs, const int *rank)
{
    long *first;
    int *elements;
    list_elements(n, element_count, start, dofs, &first, &elements);
    int *unknown = mem_alloc((size_t)n, sizeof *unknown); /* the unknown of each column */
    for (int i = 0; i < n; i++) unknown[rank ? rank[i] : i] = i;

    int *mark = mem_alloc((size_t)n, sizeof *mark);
    for (int i = 0; i < n; i++) mark[i] = -1;
    Pattern pattern = {n, mem_alloc((size_t)n + 1, sizeof(int)), NULL};
    long room = 16L * n + 16, count = 0;
    pattern.rows = mem_alloc((size_t)room, sizeof(int));
    for (int column = 0; column < n; column++) {
        int i = unknown[column];
        mark[column] = column;
        if (count + n >= room) {
            pattern.rows = mem_resize(pattern.rows, (size_t)count, (size_t)(2 * room + n), sizeof(int));
            room = 2 * room + n;
        }
        pattern.rows[count++] = column;
        for (long k = first[i]; k < first[i + 1]; k++)
            for (long m = start[elements[k]]; m < start[elements[k] + 1]; m++) {
                if (dofs[m] < 0) continue;
                int row = rank ? rank[dofs[m]] : dofs[m];
                if (row > column && mark[row] != column) mark[row] = column, pattern.rows[count++] = row;
            }
        qsort(pattern.rows + pattern.start[column], (size_t)(count - pattern.start[column]), sizeof(int),
              compare_int);
        pattern.start[column + 1] = (int)count;
    }
    mem_free(first);
    mem_free(elements);
    mem_free(unknown);
    mem_free(mark);
    return pattern;
}

static void clear_pattern(Pattern *pattern)
{
    mem_free(pattern->start);
    mem_free(pattern->rows);
}

/* rank[i] = where unknown i comes in an order. */
static int *rank_of(int n, const int *order)
{
    int *rank = mem_alloc((size_t)n, sizeof *rank);
    for (int k = 0; k < n; k++) rank[order[k]] = k;
    return rank;
}

Sparse *sparse_create(int n, int element_count, const long *element_start, const int *element_dofs,
                      SparseDef def)
{
    Sparse *matrix = mem_alloc(1, sizeof *matrix);
    matrix->n = n;
    if (n == 0) return matrix;
    int *rank;
    if (def.order) {
        rank = rank_of(n, def.order);
    } else {
        Pattern plain = build_pattern(n, element_count, element_start, element_dofs, NULL);
        rank = direct_order(&plain);
        clear_pattern(&plain);
    }
    matrix->pattern = build_pattern(n, element_count, element_start, element_dofs, rank);
    matrix->direct = direct_analyse(&matrix->pattern, rank, def.negative);
    matrix->rank = direct_rank(matrix->direct);
    matrix->product = product_create(&matrix->pattern);
    mem_free(rank);
    matrix->values = mem_alloc((size_t)matrix->pattern.start[n] + 1, sizeof(double));
    matrix->diagonal = mem_alloc((size_t)n, sizeof(double));
    matrix->cg = mem_alloc(6 * (size_t)n, sizeof *matrix->cg);
    DirectCost cost = direct_cost(matrix->direct);
    matrix->info = (SparseInfo){
        .factor_nonzeros = cost.nonzeros, .factor_bytes = cost.bytes, .factor_flops = cost.flops};
    return matrix;
}

void sparse_set_workers(Sparse *matrix, Workers *workers)
{
    matrix->workers = workers;
}

void sparse_destroy(Sparse *matrix)
{
    if (!matrix) return;
    factor_release(matrix->factor);
    direct_release(matrix->direct);
    product_destroy(matrix->product);
    clear_pattern(&matrix->pattern);
    mem_free(matrix->values);
    mem_free(matrix->diagonal);
    mem_free(matrix->cg);
    mem_free(matrix);
}

/* Of unknown i. */
static double *diagonal_entry(const Sparse *matrix, int i)
{
    return &matrix->values[matrix->pattern.start[matrix->rank[i]]];
}

int sparse_slot(const Sparse *matrix, int i, int j)
{
    int a = matrix->rank[i], b = matrix->rank[j];
    int column = a < b ? a : b, row = a < b ? b : a;
    const int *start = matrix->pattern.start, *rows = matrix->pattern.rows;
    int low = start[column], high = start[column + 1] - 1;
    while (low < high) {
        int middle = (low + high) / 2;
        if (rows[middle] < row)
            low = middle + 1;
        else
            high = middle;
    }
    assert(rows[low] == row);
    return low;
}

double *sparse_values(Sparse *matrix)
{
    return matrix->values;
}

int sparse_nonzeros(const Sparse *matrix)
{
    return matrix->n ? matrix->pattern.start[matrix->n] : 0;
}

void sparse_diagonal(const Sparse *matrix, double *diagonal)
{
    for (int i = 0; i < matrix->n; i++) diagonal[i] = *diagonal_entry(matrix, i);
}

bool sparse_factor(Sparse *matrix, const double *shift)
{
    if (matrix->n == 0) return true;
    double begin = clock_seconds();
    for (int i = 0; i < matrix->n; i++) {
        double *entry = diagonal_entry(matrix, i);
        matrix->diagonal[i] = *entry;
        if (shift) *entry += shift[i];
    }
    bool definite =
        direct_factor(matrix->direct, &matrix->pattern, matrix->values, &matrix->factor, matrix->workers);
    for (int i = 0; i < matrix->n; i++) *diagonal_entry(matrix, i) = matrix->diagonal[i];
    matrix->info.factorizations++;
    matrix->info.factor_seconds += clock_seconds() - begin;
    return definite;
}

/* x = M^-1 b with the factor at hand, which may have an order of its own; both in the matrix's. */
static void solve_permuted(Sparse *matrix, const double *b, double *x)
{
    const Factor *factor = matrix->factor;
    const int *own = matrix->rank, *other = factor_rank(factor);
    double begin = clock_seconds(), *from = matrix->cg + 5 * (size_t)matrix->n;
    for (int i = 0; own != other && i < matrix->n; i++) from[other[i]] = b[own[i]];
    const double *to = factor_solve(factor, own == other ? b : from, matrix->workers);
    for (int i = 0; i < matrix->n; i++) x[own[i]] = to[other[i]];
    matrix->info.solves++;
    matrix->info.solve_seconds += clock_seconds() - begin;
}

void sparse_solve(Sparse *matrix, const double *b, double *x)
{
    if (matrix->n == 0) return;
    double *work = matrix->cg;
    for (int i = 0; i < matrix->n; i++) work[matrix->rank[i]] = b[i];
    solve_permuted(matrix, work, work);
    for (int i = 0; i < matrix->n; i++) x[i] = work[matrix->rank[i]];
}

static void multiply_permuted(const Sparse *matrix, const double *from, double *to)
{
    product_apply(matrix->product, &matrix->pattern, matrix->values, from, to, matrix->workers);
}

void sparse_multiply(const Sparse *matrix, const double *x, double *y)
{
    int n = matrix->n;
    if (n == 0) return;
    double *from = mem_alloc(2 * (size_t)n, sizeof *from), *to = from + n;
    for (int i = 0; i < n; i++) from[matrix->rank[i]] = x[i];
    multiply_permuted(matrix, from, to);
    for (int i = 0; i < n; i++) y[i] = to[matrix->rank[i]];
    mem_free(from);
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

int sparse_solve_cg(Sparse *matrix, const double *b, double tolerance, int max_iterations, double *x)
{
    int n = matrix->n, k = 0;
    if (n == 0) return 0;
    double *solution = matrix->cg, *residual = solution + n, *direction = residual + n,
           *product = direction + n, *z = product + n;
    memset(solution, 0, (size_t)n * sizeof *solution);
    for (int i = 0; i < n; i++) residual[matrix->rank[i]] = b[i];
    solve_permuted(matrix, residual, z);
    double size = dot(n, residual, z), stop = tolerance * tolerance * size;
    memcpy(direction, z, (size_t)n * sizeof *direction);
    for (; size > stop; k++) {
        multiply_permuted(matrix, direction, product);
        double curvature = dot(n, direction, product), a = size / curvature;
        if (k == max_iterations || !(curvature > 0)) return -1;
        for (int i = 0; i < n; i++) {
            solution[i] += a * direction[i];
            residual[i] -= a * product[i];
        }
        solve_permuted(matrix, residual, z);
        double next = dot(n, residual, z), ratio = next / size;
        for (int i = 0; i < n; i++) direction[i] = z[i] + ratio * direction[i];
        size = next;
    }
    for (int i = 0; i < n; i++) x[i] = solution[matrix->rank[i]];
    return isfinite(size) ? k : -1;
}

Factor *sparse_share_factor(Sparse *matrix)
{
    return factor_share(matrix->factor);
}

bool sparse_use_factor(Sparse *matrix, Factor *factor)
{
    if (matrix->n == 0) return true;
    if (!factor || factor_size(factor) != matrix->n) return false;
    factor_share(factor);
    factor_release(matrix->factor);
    matrix->factor = factor;
    return true;
}

SparseInfo sparse_info(const Sparse *matrix)
{
    return matrix->info;
}
