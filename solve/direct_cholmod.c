#include "base/memory.h"
#include "solve/direct.h"
#include "solve/kernels.h"
#include <cholmod.h>
#include <string.h>

/* From this many unknowns on, nested dissection saves a quarter of the factor's work (docs/speed: about 32k
 * triangles with one angle per edge); its own analysis takes a few times longer, once. */
enum { METIS_FROM = 90000 };

struct Direct {
    int shares, n, negative;
    int *rank;
    cholmod_common common;
    cholmod_factor *symbolic;
    cholmod_dense *b, *x, *work_y, *work_e;
};

struct Factor {
    int shares;
    Direct *direct;
    cholmod_factor *numbers;
};

/* libgomp, which CHOLMOD loads: its supernodal kernel has four threads compiled in and ignores
 * OMP_NUM_THREADS, which doubles the time on two cores. A setting of the calling thread. Declared here because clang
 * ships no omp.h. */
void omp_set_max_active_levels(int levels);

/* A CHOLMOD view of a pattern; values may be NULL. */
static cholmod_sparse view(const Pattern *pattern, double *values)
{
    return (cholmod_sparse){
        .nrow = (size_t)pattern->n,
        .ncol = (size_t)pattern->n,
        .nzmax = (size_t)pattern->start[pattern->n],
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

int *direct_order(const Pattern *pattern)
{
    cholmod_common common;
    cholmod_sparse a = view(pattern, NULL);
    start_cholmod(&common, true);
    common.method[0].ordering = pattern->n >= METIS_FROM ? CHOLMOD_METIS : CHOLMOD_AMD;
    cholmod_factor *factor = cholmod_analyze(&a, &common);
    check_memory(&common);
    const int *order = factor->Perm;
    int *rank = mem_alloc((size_t)pattern->n, sizeof *rank);
    for (int k = 0; k < pattern->n; k++) rank[order[k]] = k;
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
    return rank;
}

Direct *direct_analyse(const Pattern *pattern, const int *rank, int negative)
{
    Direct *direct = mem_alloc(1, sizeof *direct);
    cholmod_common *common = &direct->common;
    cholmod_sparse a = view(pattern, NULL);
    direct->shares = 1;
    direct->n = pattern->n;
    direct->negative = negative;
    direct->rank = mem_copy(rank, (size_t)pattern->n, sizeof *rank);
    start_cholmod(common, negative == 0);
    common->method[0].ordering = CHOLMOD_NATURAL;
    common->postorder = 0; /* the ordering is already postordered */
    direct->symbolic = cholmod_analyze(&a, common);
    check_memory(common);
    direct->b = cholmod_zeros((size_t)pattern->n, 1, CHOLMOD_REAL, common);
    check_memory(common);
    return direct;
}

Direct *direct_share(Direct *direct)
{
    direct->shares++;
    return direct;
}

void direct_release(Direct *direct)
{
    if (!direct || --direct->shares > 0) return;
    cholmod_common *common = &direct->common;
    cholmod_free_factor(&direct->symbolic, common);
    cholmod_free_dense(&direct->b, common);
    cholmod_free_dense(&direct->x, common);
    cholmod_free_dense(&direct->work_y, common);
    cholmod_free_dense(&direct->work_e, common);
    cholmod_finish(common);
    mem_free(direct->rank);
    mem_free(direct);
}

const int *direct_rank(const Direct *direct)
{
    return direct->rank;
}

DirectCost direct_cost(const Direct *direct)
{
    const cholmod_factor *factor = direct->symbolic;
    long numbers = (long)(factor->is_super ? factor->xsize : factor->nzmax);
    long bytes = numbers * (long)sizeof(double) + (factor->is_super ? 0 : numbers * (long)sizeof(int));
    return (DirectCost){(long)direct->common.lnz, bytes, direct->common.fl};
}

/* Its numbers are still to come. */
static Factor *new_factor(Direct *direct)
{
    Factor *factor = mem_alloc(1, sizeof *factor);
    *factor = (Factor){1, direct, cholmod_copy_factor(direct->symbolic, &direct->common)};
    check_memory(&direct->common);
    direct->shares++;
    return factor;
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

bool direct_factor(Direct *direct, const Pattern *pattern, double *values, Factor **factor)
{
    if (!*factor || (*factor)->shares > 1 || (*factor)->direct != direct) {
        factor_release(*factor);
        *factor = new_factor(direct);
    }
    if (!all_finite(values, pattern->start[pattern->n])) return false;
    cholmod_common *common = &direct->common;
    cholmod_factor *numbers = (*factor)->numbers;
    cholmod_sparse a = view(pattern, values);
    omp_set_max_active_levels(0);
    cholmod_factorize(&a, numbers, common);
    check_memory(common);
    /* cholmod_factorize returns true for an indefinite matrix, too. */
    bool complete = common->status == CHOLMOD_OK && numbers->minor == (size_t)direct->n;
    return complete && (direct->negative == 0 || count_negative(numbers) == direct->negative);
}

Factor *factor_share(Factor *factor)
{
    if (factor) factor->shares++;
    return factor;
}

void factor_release(Factor *factor)
{
    if (!factor || --factor->shares > 0) return;
    cholmod_free_factor(&factor->numbers, &factor->direct->common);
    direct_release(factor->direct);
    mem_free(factor);
}

int factor_size(const Factor *factor)
{
    return factor->direct->n;
}

const int *factor_rank(const Factor *factor)
{
    return factor->direct->rank;
}

const double *factor_solve(const Factor *factor, const double *b)
{
    Direct *direct = factor->direct;
    memcpy(direct->b->x, b, (size_t)direct->n * sizeof *b);
    cholmod_solve2(CHOLMOD_A, factor->numbers, direct->b, NULL, &direct->x, NULL, &direct->work_y,
                   &direct->work_e, &direct->common);
    check_memory(&direct->common);
    return direct->x->x;
}

#define TEXT(x)               #x
#define VERSION_TEXT(a, b, c) TEXT(a) "." TEXT(b) "." TEXT(c)

const char *direct_version(void)
{
    return VERSION_TEXT(CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION);
}
