#include "solve/sparse.h"
#include "base/clock.h"
#include "base/memory.h"
#include "solve/kernels.h"
#include <assert.h>
#include <cholmod.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* From this many unknowns on, nested dissection saves a quarter of the factor's work (docs/speed: about 32k
 * triangles with one angle per edge); its own analysis takes a few times longer, once. */
enum { METIS_FROM = 90000 };

struct Sparse {
    int n, negative; /* SparseDef */
    cholmod_common common;
    cholmod_sparse *a; /* lower triangle, permuted; every diagonal entry is the first of its column */
    cholmod_factor *factor;
    const cholmod_factor *at_hand; /* factor, or one that was kept */
    cholmod_dense *b, *x, *work_y, *work_e;
    int *rank; /* [n] where unknown i went */
    double *values;
    double *diagonal; /* [n] kept aside while a shift stands on the diagonal */
    double *cg;       /* [4][n] x, residual, direction, product of it; permuted  */
    SparseInfo info;
};

/* libgomp, which CHOLMOD loads: its supernodal kernel has four threads compiled in and ignores
 * OMP_NUM_THREADS, which doubles the time on two cores. Declared here because clang ships no omp.h. */
void omp_set_max_active_levels(int levels);

typedef struct Pattern {
    int *start, *rows; /* compressed columns of the lower triangle, rows ascending */
} Pattern;

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
    Pattern pattern = {mem_alloc((size_t)n + 1, sizeof(int)), NULL};
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

/* A CHOLMOD view of a pattern; values may be NULL. */
static cholmod_sparse view(int n, const Pattern *pattern, double *values)
{
    return (cholmod_sparse){
        .nrow = (size_t)n,
        .ncol = (size_t)n,
        .nzmax = (size_t)pattern->start[n],
        .p = pattern->start,
        .i = pattern->rows,
        .x = values,
        .stype = -1,
        .itype = CHOLMOD_INT,
        .xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN,
        .dtype = CHOLMOD_DOUBLE,
        .sorted = 1,
        .packed = 1,
    };
}

static void check_memory(const cholmod_common *common)
{
    if (common->status != CHOLMOD_OUT_OF_MEMORY && common->status != CHOLMOD_TOO_LARGE) return;
    mem_exhausted("the sparse factorisation");
}

/* rank[i] = where unknown i comes in an order. */
static int *rank_of(int n, const int *order)
{
    int *rank = mem_alloc((size_t)n, sizeof *rank);
    for (int k = 0; k < n; k++) rank[order[k]] = k;
    return rank;
}

/* rank[i] = where a fill-reducing ordering puts unknown i. */
static int *find_rank(int n, const Pattern *pattern, cholmod_common *common)
{
    cholmod_sparse a = view(n, pattern, NULL);
    common->method[0].ordering = n >= METIS_FROM ? CHOLMOD_METIS : CHOLMOD_AMD;
    cholmod_factor *factor = cholmod_analyze(&a, common);
    check_memory(common);
    int *rank = rank_of(n, factor->Perm);
    cholmod_free_factor(&factor, common);
    return rank;
}

static void start_cholmod(cholmod_common *common, bool definite)
{
    kernels_one_thread();
    omp_set_max_active_levels(0);
    cholmod_start(common);
    common->print = 0;
    common->final_ll = definite; /* simplicial LDL' would accept an indefinite matrix */
    if (!definite) common->supernodal = CHOLMOD_SIMPLICIAL;
    common->quick_return_if_not_posdef = 1;
    common->nmethods = 1;
}

static long factor_bytes(const cholmod_factor *factor)
{
    long numbers = (long)(factor->is_super ? factor->xsize : factor->nzmax);
    return numbers * (long)sizeof(double) + (factor->is_super ? 0 : numbers * (long)sizeof(int));
}

Sparse *sparse_create(int n, int element_count, const long *element_start, const int *element_dofs,
                      SparseDef def)
{
    Sparse *matrix = mem_alloc(1, sizeof *matrix);
    matrix->n = n;
    matrix->negative = def.negative;
    start_cholmod(&matrix->common, def.negative == 0);
    if (n == 0) return matrix;

    if (def.order) {
        matrix->rank = rank_of(n, def.order);
    } else {
        Pattern plain = build_pattern(n, element_count, element_start, element_dofs, NULL);
        matrix->rank = find_rank(n, &plain, &matrix->common);
        mem_free(plain.start);
        mem_free(plain.rows);
    }

    Pattern pattern = build_pattern(n, element_count, element_start, element_dofs, matrix->rank);
    matrix->values = mem_alloc((size_t)pattern.start[n] + 1, sizeof(double));
    matrix->diagonal = mem_alloc((size_t)n, sizeof(double));
    cholmod_sparse a = view(n, &pattern, matrix->values);
    matrix->a = mem_copy(&a, 1, sizeof a);
    matrix->common.method[0].ordering = CHOLMOD_NATURAL;
    matrix->common.postorder = 0; /* the ordering above is already postordered */
    matrix->factor = cholmod_analyze(matrix->a, &matrix->common);
    check_memory(&matrix->common);
    matrix->at_hand = matrix->factor;
    matrix->info.factor_nonzeros = (long)matrix->common.lnz;
    matrix->info.factor_bytes = factor_bytes(matrix->factor);
    matrix->info.factor_flops = matrix->common.fl;
    matrix->b = cholmod_zeros((size_t)n, 1, CHOLMOD_REAL, &matrix->common);
    return matrix;
}

void sparse_destroy(Sparse *matrix)
{
    if (!matrix) return;
    cholmod_common *common = &matrix->common;
    if (matrix->a) {
        mem_free(matrix->a->p);
        mem_free(matrix->a->i);
    }
    mem_free(matrix->a);
    cholmod_free_factor(&matrix->factor, common);
    cholmod_free_dense(&matrix->b, common);
    cholmod_free_dense(&matrix->x, common);
    cholmod_free_dense(&matrix->work_y, common);
    cholmod_free_dense(&matrix->work_e, common);
    cholmod_finish(common);
    mem_free(matrix->rank);
    mem_free(matrix->values);
    mem_free(matrix->diagonal);
    mem_free(matrix->cg);
    mem_free(matrix);
}

int sparse_slot(const Sparse *matrix, int i, int j)
{
    int a = matrix->rank[i], b = matrix->rank[j];
    int column = a < b ? a : b, row = a < b ? b : a;
    const int *start = matrix->a->p, *rows = matrix->a->i;
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
    return matrix->n ? ((const int *)matrix->a->p)[matrix->n] : 0;
}

void sparse_diagonal(const Sparse *matrix, double *diagonal)
{
    const int *start = matrix->n ? matrix->a->p : NULL;
    for (int i = 0; i < matrix->n; i++) diagonal[i] = matrix->values[start[matrix->rank[i]]];
}

/* CHOLMOD says "ok" to NaN and to infinity. */
static bool all_finite(const double *values, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) sum += values[i] * 0;
    return sum == 0;
}

/* Negative pivots of a simplicial LDL^T; they head the columns of L. */
static int count_negative(const cholmod_factor *factor)
{
    const int *start = factor->p;
    const double *values = factor->x;
    int count = 0;
    for (size_t k = 0; k < factor->n; k++) count += values[start[k]] < 0;
    return count;
}

bool sparse_factor(Sparse *matrix, const double *shift)
{
    if (matrix->n == 0) return true;
    double begin = clock_seconds();
    omp_set_max_active_levels(0); /* a setting of the calling thread */
    const int *start = matrix->a->p;
    for (int i = 0; i < matrix->n; i++) {
        double *entry = &matrix->values[start[matrix->rank[i]]];
        matrix->diagonal[i] = *entry;
        if (shift) *entry += shift[i];
    }
    bool finite = all_finite(matrix->values, sparse_nonzeros(matrix));
    matrix->at_hand = matrix->factor;
    if (finite) cholmod_factorize(matrix->a, matrix->factor, &matrix->common);
    check_memory(&matrix->common);
    for (int i = 0; i < matrix->n; i++) matrix->values[start[matrix->rank[i]]] = matrix->diagonal[i];
    matrix->info.factorizations++;
    matrix->info.factor_seconds += clock_seconds() - begin;
    /* cholmod_factorize returns true for an indefinite matrix, too. */
    bool complete =
        finite && matrix->common.status == CHOLMOD_OK && matrix->factor->minor == (size_t)matrix->n;
    return complete && (matrix->negative == 0 || count_negative(matrix->factor) == matrix->negative);
}

/* Permuted, from matrix->b to matrix->x. */
static void solve_permuted(Sparse *matrix)
{
    double begin = clock_seconds();
    /* cholmod_solve2 does not change the factor, although it does not say so. */
    cholmod_solve2(CHOLMOD_A, (cholmod_factor *)matrix->at_hand, matrix->b, NULL, &matrix->x, NULL,
                   &matrix->work_y, &matrix->work_e, &matrix->common);
    check_memory(&matrix->common);
    matrix->info.solves++;
    matrix->info.solve_seconds += clock_seconds() - begin;
}

void sparse_solve(Sparse *matrix, const double *b, double *x)
{
    if (matrix->n == 0) return;
    double *from = matrix->b->x;
    for (int i = 0; i < matrix->n; i++) from[matrix->rank[i]] = b[i];
    solve_permuted(matrix);
    const double *to = matrix->x->x;
    for (int i = 0; i < matrix->n; i++) x[i] = to[matrix->rank[i]];
}

static void multiply_permuted(const Sparse *matrix, const double *from, double *to)
{
    const int *start = matrix->a->p, *rows = matrix->a->i;
    memset(to, 0, (size_t)matrix->n * sizeof *to);
    for (int column = 0; column < matrix->n; column++) {
        double x = from[column], sum = matrix->values[start[column]] * x;
        for (int k = start[column] + 1; k < start[column + 1]; k++) {
            to[rows[k]] += matrix->values[k] * x;
            sum += matrix->values[k] * from[rows[k]];
        }
        to[column] += sum;
    }
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

/* matrix->x = M^-1 residual; returns the residual's size in that measure. */
static double precondition(Sparse *matrix, const double *residual)
{
    memcpy(matrix->b->x, residual, (size_t)matrix->n * sizeof *residual);
    solve_permuted(matrix);
    return dot(matrix->n, residual, matrix->x->x);
}

int sparse_solve_cg(Sparse *matrix, const double *b, double tolerance, int max_iterations, double *x)
{
    int n = matrix->n, k = 0;
    if (n == 0) return 0;
    if (!matrix->cg) matrix->cg = mem_alloc(4 * (size_t)n, sizeof *matrix->cg);
    double *solution = matrix->cg, *residual = solution + n, *direction = residual + n,
           *product = direction + n;
    memset(solution, 0, (size_t)n * sizeof *solution);
    for (int i = 0; i < n; i++) residual[matrix->rank[i]] = b[i];
    double size = precondition(matrix, residual), stop = tolerance * tolerance * size;
    memcpy(direction, matrix->x->x, (size_t)n * sizeof *direction);
    for (; size > stop; k++) {
        multiply_permuted(matrix, direction, product);
        double curvature = dot(n, direction, product), a = size / curvature;
        if (k == max_iterations || !(curvature > 0)) return -1;
        for (int i = 0; i < n; i++) {
            solution[i] += a * direction[i];
            residual[i] -= a * product[i];
        }
        double next = precondition(matrix, residual), ratio = next / size;
        const double *z = matrix->x->x;
        for (int i = 0; i < n; i++) direction[i] = z[i] + ratio * direction[i];
        size = next;
    }
    for (int i = 0; i < n; i++) x[i] = solution[matrix->rank[i]];
    return isfinite(size) ? k : -1;
}

SparseFactor *sparse_keep(Sparse *matrix)
{
    if (matrix->n == 0) return NULL;
    cholmod_factor *copy = cholmod_copy_factor((cholmod_factor *)matrix->at_hand, &matrix->common);
    check_memory(&matrix->common);
    return (SparseFactor *)copy;
}

void sparse_use(Sparse *matrix, const SparseFactor *factor)
{
    matrix->at_hand = (const cholmod_factor *)factor;
}

void sparse_factor_destroy(Sparse *matrix, SparseFactor *factor)
{
    cholmod_factor *owned = (cholmod_factor *)factor;
    if (owned) cholmod_free_factor(&owned, &matrix->common);
}

SparseInfo sparse_info(const Sparse *matrix)
{
    return matrix->info;
}

#define TEXT(x)               #x
#define VERSION_TEXT(a, b, c) TEXT(a) "." TEXT(b) "." TEXT(c)

const char *sparse_version(void)
{
    return VERSION_TEXT(CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION);
}
