#include "base/memory.h"
#include "solve/dense.h"
#include "solve/direct.h"
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
struct Direct {
    int shares, n, negative;
    int *rank;
    DirectCost cost;
    Supernodal *plan; /* NULL: simplicial, with what follows the solution here */
    double *solution; /* [n] of a plan's solves                                */
    cholmod_common common;
    cholmod_factor *symbolic;
    cholmod_dense *b, *x, *work_y, *work_e;
};

/* Numbers of a plan's factor, and for how many there is room. */
typedef struct Room {
    double *numbers; /* NULL: none */
    long count;
} Room;

struct Factor {
    int shares;
    Direct *direct;
    Room room;               /* of a plan                */
    cholmod_factor *columns; /* if simplicial, else NULL */
};

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
static bool analyse_supernodal(Direct *direct, const Pattern *pattern)
{
    cholmod_common common;
    cholmod_l_start(&common);
    set_options(&common, CHOLMOD_NATURAL);
    cholmod_factor *factor = analyse_pattern(pattern, &common);
    if (factor->is_super) {
        SupernodalDef def = {(int)factor->nsuper, factor->super, factor->pi, factor->s};
        direct->plan = supernodal_create(pattern, &def);
        direct->solution = mem_alloc((size_t)direct->n, sizeof *direct->solution);
        long bytes = supernodal_size(direct->plan) * (long)sizeof(double);
        direct->cost = (DirectCost){(long)common.lnz, bytes, common.fl};
    }
    cholmod_l_free_factor(&factor, &common);
    cholmod_l_finish(&common);
    return direct->plan != NULL;
}

static void analyse_simplicial(Direct *direct, const Pattern *pattern)
{
    cholmod_common *common = &direct->common;
    cholmod_sparse a = view(pattern, NULL);
    cholmod_start(common);
    set_options(common, CHOLMOD_NATURAL);
    common->supernodal = CHOLMOD_SIMPLICIAL;
    common->final_ll = direct->negative == 0; /* LDL' would accept an indefinite matrix */
    common->quick_return_if_not_posdef = 1;
    direct->symbolic = cholmod_analyze(&a, common);
    check_memory(common);
    direct->b = cholmod_zeros((size_t)pattern->n, 1, CHOLMOD_REAL, common);
    check_memory(common);
    long numbers = (long)direct->symbolic->nzmax;
    direct->cost =
        (DirectCost){(long)common->lnz, numbers * (long)(sizeof(double) + sizeof(int)), common->fl};
}

Direct *direct_analyse(const Pattern *pattern, const int *rank, int negative)
{
    Direct *direct = mem_alloc(1, sizeof *direct);
    direct->shares = 1;
    direct->n = pattern->n;
    direct->negative = negative;
    direct->rank = mem_copy(rank, (size_t)pattern->n, sizeof *rank);
    if (negative > 0 || !analyse_supernodal(direct, pattern)) analyse_simplicial(direct, pattern);
    return direct;
}

Direct *direct_share(Direct *direct)
{
    direct->shares++;
    return direct;
}

static void clear_simplicial(Direct *direct)
{
    cholmod_common *common = &direct->common;
    cholmod_free_factor(&direct->symbolic, common);
    cholmod_free_dense(&direct->b, common);
    cholmod_free_dense(&direct->x, common);
    cholmod_free_dense(&direct->work_y, common);
    cholmod_free_dense(&direct->work_e, common);
    cholmod_finish(common);
}

void direct_release(Direct *direct)
{
    if (!direct || --direct->shares > 0) return;
    if (!direct->plan) clear_simplicial(direct);
    supernodal_destroy(direct->plan);
    mem_free(direct->solution);
    mem_free(direct->rank);
    mem_free(direct);
}

const int *direct_rank(const Direct *direct)
{
    return direct->rank;
}

DirectCost direct_cost(const Direct *direct)
{
    return direct->cost;
}

/* That of a factor which nobody else has. */
static Room take_room(Factor *factor)
{
    if (!factor || factor->shares > 1) return (Room){0};
    Room room = factor->room;
    factor->room = (Room){0};
    return room;
}

/* Room for a factor, the one at hand if there is enough of it: fresh memory costs half a factorisation, and patterns of what
 * touches follow each other. Where it was too little, with some to spare. */
static Room make_room(Room old, long size)
{
    if (old.count >= size) return old;
    mem_free(old.numbers);
    long count = old.count > 0 ? size + size / 8 : size;
    return (Room){mem_alloc((size_t)count, sizeof(double)), count};
}

/* Its numbers are still to come. */
static Factor *new_factor(Direct *direct, Room room)
{
    Factor *factor = mem_alloc(1, sizeof *factor);
    *factor = (Factor){.shares = 1, .direct = direct};
    if (direct->plan) {
        factor->room = make_room(room, supernodal_size(direct->plan));
    } else {
        mem_free(room.numbers);
        factor->columns = cholmod_copy_factor(direct->symbolic, &direct->common);
        check_memory(&direct->common);
    }
    direct->shares++;
    return factor;
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
static bool factor_simplicial(Direct *direct, const Pattern *pattern, double *values, cholmod_factor *columns)
{
    cholmod_common *common = &direct->common;
    cholmod_sparse a = view(pattern, values);
    cholmod_factorize(&a, columns, common);
    check_memory(common);
    bool complete = common->status == CHOLMOD_OK && columns->minor == (size_t)direct->n;
    return complete && (direct->negative == 0 || count_negative(columns) == direct->negative);
}

bool direct_factor(Direct *direct, const Pattern *pattern, double *values, Factor **factor, Workers *workers)
{
    if (!*factor || (*factor)->shares > 1 || (*factor)->direct != direct) {
        Room room = take_room(*factor);
        factor_release(*factor);
        *factor = new_factor(direct, room);
    }
    if (!dense_is_finite(pattern->start[pattern->n], values)) return false;
    if (direct->plan)
        return supernodal_factor(direct->plan, pattern, values, (*factor)->room.numbers, workers);
    return factor_simplicial(direct, pattern, values, (*factor)->columns);
}

Factor *factor_share(Factor *factor)
{
    if (factor) factor->shares++;
    return factor;
}

void factor_release(Factor *factor)
{
    if (!factor || --factor->shares > 0) return;
    if (factor->columns) cholmod_free_factor(&factor->columns, &factor->direct->common);
    mem_free(factor->room.numbers);
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

const double *factor_solve(const Factor *factor, const double *b, Workers *workers)
{
    Direct *direct = factor->direct;
    size_t bytes = (size_t)direct->n * sizeof *b;
    if (direct->plan) {
        memcpy(direct->solution, b, bytes);
        supernodal_solve(direct->plan, factor->room.numbers, direct->solution, workers);
        return direct->solution;
    }
    memcpy(direct->b->x, b, bytes);
    cholmod_solve2(CHOLMOD_A, factor->columns, direct->b, NULL, &direct->x, NULL, &direct->work_y,
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
