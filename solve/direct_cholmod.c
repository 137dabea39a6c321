#include "base/memory.h"
#include "solve/direct_row.h"
#include "solve/supernodal.h"
#include <cholmod.h>
#include <pthread.h>
#include <string.h>

/* From this many entries of the matrix on, nested dissection: it saves a tenth of the factor's work on sheets with angles of hinges and
 * half with one angle per edge, and gives a tree that threads can share (docs/solver.md). Its own analysis takes some five
 * times longer than AMD's and never pays for what is coupled to few others; of a pattern that soon is another one (sheets that
 * touch: L has 1.56 or 1.38 times the nonzeros with 80 000 entries, 2.45 or 2.3 with 200 000) it pays later. */
static const int METIS_FROM[] = {[DIRECT_OFTEN] = 60000, [DIRECT_SELDOM] = 150000};

/* Where columns of L are alike over many rows (CHOLMOD's rule: 40 operations for each of its numbers), supernodal.h factors
 * in a structure of CHOLMOD's; chains, and with them all that has multipliers, are factored by its simplicial LL^T or
 * LDL^T, whose solves take half the time there. */
typedef struct Analysis {
    int n, negative;
    DirectCost cost;
    Supernodal *plan; /* NULL: simplicial, with what follows the solution here */
    double *solution; /* [n] of a plan's solves                                */
    cholmod_common common;
    cholmod_factor *symbolic;
    cholmod_dense *b, *x, *work_y, *work_e;
} Analysis;

/* Numbers of a factor: of a plan, with room for so many, or columns if simplicial. */
typedef struct Numbers {
    double *values; /* NULL: none */
    long room;
    cholmod_factor *columns; /* NULL: none */
} Numbers;

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

static long *widen(const int *from, size_t count)
{
    long *to = mem_alloc(count, sizeof *to);
    for (size_t k = 0; k < count; k++) to[k] = from[k];
    return to;
}

static void check_memory(const cholmod_common *common)
{
    if (common->status != CHOLMOD_OUT_OF_MEMORY && common->status != CHOLMOD_TOO_LARGE) return;
    mem_exhausted("the sparse factorisation");
}

static void set_options(cholmod_common *common, int ordering)
{
    common->print = 0;
    common->nmethods = 1;
    common->method[0].ordering = ordering;
    common->postorder = ordering != CHOLMOD_NATURAL; /* one that is given has been postordered */
}

/* METIS draws from the C library's random numbers, seeded anew in each call: two at once would draw from one row. */
static pthread_mutex_t one_dissection = PTHREAD_MUTEX_INITIALIZER;

static cholmod_factor *analyse_alone(cholmod_sparse *a, cholmod_common *common)
{
    pthread_mutex_lock(&one_dissection);
    cholmod_factor *factor = cholmod_l_analyze(a, common);
    pthread_mutex_unlock(&one_dissection);
    return factor;
}

/* What L will be, its supernodes if it is to have any; with indices of 64 bits: it may have more numbers than an int can
 * count, though the matrix has not. The caller frees it. */
static cholmod_factor *analyse_pattern(const Pattern *pattern, cholmod_common *common)
{
    cholmod_sparse a = view(pattern, NULL);
    a.p = widen(pattern->start, (size_t)pattern->n + 1);
    a.i = widen(pattern->rows, a.nzmax);
    a.itype = CHOLMOD_LONG;
    bool dissects = common->method[0].ordering == CHOLMOD_METIS;
    cholmod_factor *factor = dissects ? analyse_alone(&a, common) : cholmod_l_analyze(&a, common);
    check_memory(common);
    mem_free(a.p);
    mem_free(a.i);
    return factor;
}

int *direct_order(const Pattern *pattern, DirectUse use)
{
    cholmod_common common;
    cholmod_l_start(&common);
    set_options(&common, pattern->start[pattern->n] >= METIS_FROM[use] ? CHOLMOD_METIS : CHOLMOD_AMD);
    cholmod_factor *factor = analyse_pattern(pattern, &common);
    const long *order = factor->Perm;
    int *rank = mem_alloc((size_t)pattern->n, sizeof *rank);
    for (int k = 0; k < pattern->n; k++) rank[order[k]] = k;
    cholmod_l_free_factor(&factor, &common);
    cholmod_l_finish(&common);
    return rank;
}

/* False where supernodes do not pay. */
static bool analyse_supernodal(Analysis *analysis, const Pattern *pattern)
{
    cholmod_common common;
    cholmod_l_start(&common);
    set_options(&common, CHOLMOD_NATURAL);
    cholmod_factor *factor = analyse_pattern(pattern, &common);
    if (factor->is_super) {
        SupernodalDef def = {(int)factor->nsuper, factor->super, factor->pi, factor->s};
        analysis->plan = supernodal_create(pattern, &def);
        analysis->solution = mem_alloc((size_t)analysis->n, sizeof *analysis->solution);
        long bytes = supernodal_size(analysis->plan) * (long)sizeof(double);
        analysis->cost = (DirectCost){.nonzeros = (long)common.lnz, .bytes = bytes, .flops = common.fl};
    }
    cholmod_l_free_factor(&factor, &common);
    cholmod_l_finish(&common);
    return analysis->plan != NULL;
}

static void analyse_simplicial(Analysis *analysis, const Pattern *pattern)
{
    cholmod_common *common = &analysis->common;
    cholmod_sparse a = view(pattern, NULL);
    cholmod_start(common);
    set_options(common, CHOLMOD_NATURAL);
    common->supernodal = CHOLMOD_SIMPLICIAL;
    common->final_ll = analysis->negative == 0; /* LDL' would accept an indefinite matrix */
    common->quick_return_if_not_posdef = 1;
    analysis->symbolic = cholmod_analyze(&a, common);
    check_memory(common);
    analysis->b = cholmod_zeros((size_t)pattern->n, 1, CHOLMOD_REAL, common);
    check_memory(common);
    long numbers = (long)analysis->symbolic->nzmax;
    analysis->cost = (DirectCost){.nonzeros = (long)common->lnz,
                                  .bytes = numbers * (long)(sizeof(double) + sizeof(int)),
                                  .flops = common->fl};
}

static void *analyse(const Pattern *pattern, int negative)
{
    Analysis *analysis = mem_alloc(1, sizeof *analysis);
    analysis->n = pattern->n;
    analysis->negative = negative;
    if (negative > 0 || !analyse_supernodal(analysis, pattern)) analyse_simplicial(analysis, pattern);
    return analysis;
}

static void clear_simplicial(Analysis *analysis)
{
    cholmod_common *common = &analysis->common;
    cholmod_free_factor(&analysis->symbolic, common);
    cholmod_free_dense(&analysis->b, common);
    cholmod_free_dense(&analysis->x, common);
    cholmod_free_dense(&analysis->work_y, common);
    cholmod_free_dense(&analysis->work_e, common);
    cholmod_finish(common);
}

static void forget(void *self)
{
    Analysis *analysis = self;
    if (!analysis->plan) clear_simplicial(analysis);
    supernodal_destroy(analysis->plan);
    mem_free(analysis->solution);
    mem_free(analysis);
}

static DirectCost cost_of(const void *self)
{
    return ((const Analysis *)self)->cost;
}

static void drop(void *self, void *of)
{
    Analysis *analysis = self;
    Numbers *numbers = of;
    if (numbers->columns) cholmod_free_factor(&numbers->columns, &analysis->common);
    mem_free(numbers->values);
    mem_free(numbers);
}

/* For a plan's factor, in the memory at hand if there is enough of it: fresh memory costs half a factorisation, and patterns
 * of what touches follow each other. Where it was too little, with some to spare. */
static void give_room(Numbers *numbers, long size)
{
    if (numbers->room >= size) return;
    mem_free(numbers->values);
    numbers->room = numbers->room > 0 ? size + size / 8 : size;
    numbers->values = mem_alloc((size_t)numbers->room, sizeof *numbers->values);
}

static void *make_room(void *self, void *other_self, void *other)
{
    Analysis *analysis = self;
    Numbers *numbers = mem_alloc(1, sizeof *numbers), *from = other;
    if (from) {
        *numbers = (Numbers){.values = from->values, .room = from->room};
        from->values = NULL;
        drop(other_self, from);
    }
    if (analysis->plan) {
        give_room(numbers, supernodal_size(analysis->plan));
        return numbers;
    }
    mem_free(numbers->values);
    *numbers = (Numbers){.columns = cholmod_copy_factor(analysis->symbolic, &analysis->common)};
    check_memory(&analysis->common);
    return numbers;
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

/* cholmod_factorize returns true for an indefinite matrix, too. */
static bool factor_simplicial(Analysis *analysis, const Pattern *pattern, double *values,
                              cholmod_factor *columns)
{
    cholmod_common *common = &analysis->common;
    cholmod_sparse a = view(pattern, values);
    cholmod_factorize(&a, columns, common);
    check_memory(common);
    bool complete = common->status == CHOLMOD_OK && columns->minor == (size_t)analysis->n;
    return complete && (analysis->negative == 0 || count_negative(columns) == analysis->negative);
}

static bool factor(void *self, const Pattern *pattern, double *values, void *of, Workers *workers)
{
    Analysis *analysis = self;
    Numbers *numbers = of;
    if (analysis->plan) return supernodal_factor(analysis->plan, pattern, values, numbers->values, workers);
    return factor_simplicial(analysis, pattern, values, numbers->columns);
}

static const double *solve(void *self, void *of, const double *b, Workers *workers)
{
    Analysis *analysis = self;
    const Numbers *numbers = of;
    size_t bytes = (size_t)analysis->n * sizeof *b;
    if (analysis->plan) {
        memcpy(analysis->solution, b, bytes);
        supernodal_solve(analysis->plan, numbers->values, analysis->solution, workers);
        return analysis->solution;
    }
    memcpy(analysis->b->x, b, bytes);
    cholmod_solve2(CHOLMOD_A, numbers->columns, analysis->b, NULL, &analysis->x, NULL, &analysis->work_y,
                   &analysis->work_e, &analysis->common);
    check_memory(&analysis->common);
    return analysis->x->x;
}

#define TEXT(x)               #x
#define VERSION_TEXT(a, b, c) TEXT(a) "." TEXT(b) "." TEXT(c)

const DirectRow direct_cholmod = {
    .version = "CHOLMOD " VERSION_TEXT(CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION),
    .analyse = analyse,
    .forget = forget,
    .cost = cost_of,
    .make_room = make_room,
    .drop = drop,
    .factor = factor,
    .solve = solve};
