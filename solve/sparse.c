#include "solve/sparse.h"
#include "base/clock.h"
#include "base/memory.h"
#include <assert.h>
#include <cblas.h>
#include <cholmod.h>
#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* From this many unknowns on, nested dissection saves a quarter of the factor's work (docs/speed: about 32k triangles
 * with one angle per edge); its own analysis takes a few times longer, once. */
enum { METIS_FROM = 90000 };

struct Sparse {
    int n;
    cholmod_common common;
    cholmod_sparse *a; /* lower triangle, permuted; every diagonal entry is the first of its column */
    cholmod_factor *factor;
    cholmod_dense *b, *x, *work_y, *work_e;
    int *rank; /* [n] where unknown i went */
    double *values;
    double *diagonal; /* [n] kept aside while a shift stands on the diagonal */
    SparseInfo info;
};

/* libgomp, which CHOLMOD loads: its supernodal kernel has four threads compiled in and ignores OMP_NUM_THREADS, which
 * doubles the time on two cores. Declared here because clang ships no omp.h. */
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
static void list_elements(int n, int element_count, const long *start, const int *dofs, long **first, int **elements)
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
        qsort(pattern.rows + pattern.start[column], (size_t)(count - pattern.start[column]), sizeof(int), compare_int);
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
        .nrow = (size_t)n, .ncol = (size_t)n, .nzmax = (size_t)pattern->start[n], .p = pattern->start,
        .i = pattern->rows, .x = values, .stype = -1, .itype = CHOLMOD_INT,
        .xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN, .dtype = CHOLMOD_DOUBLE, .sorted = 1, .packed = 1,
    };
}

static void check_memory(const cholmod_common *common)
{
    if (common->status != CHOLMOD_OUT_OF_MEMORY && common->status != CHOLMOD_TOO_LARGE) return;
    fprintf(stderr, "slender: out of memory in the sparse factorisation\n");
    exit(1);
}

/* rank[i] = where the fill-reducing ordering puts unknown i. */
static int *order(int n, const Pattern *pattern, cholmod_common *common)
{
    cholmod_sparse a = view(n, pattern, NULL);
    common->nmethods = 1;
    common->method[0].ordering = n >= METIS_FROM ? CHOLMOD_METIS : CHOLMOD_AMD;
    cholmod_factor *factor = cholmod_analyze(&a, common);
    check_memory(common);
    int *rank = mem_alloc((size_t)n, sizeof *rank);
    for (int k = 0; k < n; k++) rank[((int *)factor->Perm)[k]] = k;
    cholmod_free_factor(&factor, common);
    return rank;
}

static void start_cholmod(cholmod_common *common)
{
    openblas_set_num_threads(1); /* the same bits every time; threads are ours to use elsewhere */
    omp_set_max_active_levels(0);
    cholmod_start(common);
    common->print = 0;
    common->final_ll = 1; /* simplicial LDL' would accept an indefinite matrix */
    common->quick_return_if_not_posdef = 1;
}

Sparse *sparse_create(int n, int element_count, const long *element_start, const int *element_dofs)
{
    Sparse *matrix = mem_alloc(1, sizeof *matrix);
    matrix->n = n;
    start_cholmod(&matrix->common);
    if (n == 0) return matrix;

    Pattern plain = build_pattern(n, element_count, element_start, element_dofs, NULL);
    matrix->rank = order(n, &plain, &matrix->common);
    mem_free(plain.start);
    mem_free(plain.rows);

    Pattern pattern = build_pattern(n, element_count, element_start, element_dofs, matrix->rank);
    matrix->values = mem_alloc((size_t)pattern.start[n] + 1, sizeof(double));
    matrix->diagonal = mem_alloc((size_t)n, sizeof(double));
    cholmod_sparse a = view(n, &pattern, matrix->values);
    matrix->a = mem_copy(&a, 1, sizeof a);
    matrix->common.method[0].ordering = CHOLMOD_NATURAL;
    matrix->common.postorder = 0; /* the ordering above is already postordered */
    matrix->factor = cholmod_analyze(matrix->a, &matrix->common);
    check_memory(&matrix->common);
    matrix->info.factor_nonzeros = (long)matrix->common.lnz;
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
    if (finite) cholmod_factorize(matrix->a, matrix->factor, &matrix->common);
    check_memory(&matrix->common);
    for (int i = 0; i < matrix->n; i++) matrix->values[start[matrix->rank[i]]] = matrix->diagonal[i];
    matrix->info.factorizations++;
    matrix->info.factor_seconds += clock_seconds() - begin;
    /* cholmod_factorize returns true for an indefinite matrix, too. */
    return finite && matrix->common.status == CHOLMOD_OK && matrix->factor->minor == (size_t)matrix->n;
}

void sparse_solve(Sparse *matrix, const double *b, double *x)
{
    if (matrix->n == 0) return;
    double begin = clock_seconds();
    double *from = matrix->b->x;
    for (int i = 0; i < matrix->n; i++) from[matrix->rank[i]] = b[i];
    cholmod_solve2(CHOLMOD_A, matrix->factor, matrix->b, NULL, &matrix->x, NULL, &matrix->work_y, &matrix->work_e,
                   &matrix->common);
    check_memory(&matrix->common);
    const double *to = matrix->x->x;
    for (int i = 0; i < matrix->n; i++) x[i] = to[matrix->rank[i]];
    matrix->info.solves++;
    matrix->info.solve_seconds += clock_seconds() - begin;
}

void sparse_multiply(const Sparse *matrix, const double *x, double *y)
{
    int n = matrix->n;
    if (n == 0) return;
    const int *start = matrix->a->p, *rows = matrix->a->i;
    double *from = mem_alloc(2 * (size_t)n, sizeof *from), *to = from + n;
    for (int i = 0; i < n; i++) from[matrix->rank[i]] = x[i];
    for (int column = 0; column < n; column++) {
        to[column] += matrix->values[start[column]] * from[column];
        for (int k = start[column] + 1; k < start[column + 1]; k++) {
            to[rows[k]] += matrix->values[k] * from[column];
            to[column] += matrix->values[k] * from[rows[k]];
        }
    }
    for (int i = 0; i < n; i++) y[i] = to[matrix->rank[i]];
    mem_free(from);
}

SparseInfo sparse_info(const Sparse *matrix)
{
    return matrix->info;
}

#define TEXT(x) #x
#define VERSION_TEXT(a, b, c) TEXT(a) "." TEXT(b) "." TEXT(c)

const char *sparse_version(void)
{
    return VERSION_TEXT(CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION);
}

const char *sparse_blas_version(void)
{
    return openblas_get_config();
}

bool sparse_blas_is_fast(void)
{
    Dl_info where;
    void *dgemm = dlsym(RTLD_DEFAULT, "dgemm_");
    return dgemm && dladdr(dgemm, &where) && where.dli_fname && strstr(where.dli_fname, "openblas");
}
