/* Factors by MUMPS [Amestoy, Duff, L'Excellent, Koster 2001; Amestoy, Buttari, L'Excellent, Mary 2019]: multifrontal, spread
 * over the processes of the run. Each keeps an instance for every factor; what the first one tells of a job all do together. */
#include "base/memory.h"
#include "solve/direct_row.h"
#include "solve/ranks_private.h"
#include <dmumps_c.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

/* Of the manual, which counts from 1. */
#define ICNTL(m, i) (m)->icntl[(i)-1]
#define CNTL(m, i)  (m)->cntl[(i)-1]
#define INFOG(m, i) (m)->infog[(i)-1]

enum { BEGIN = -1, END = -2, ANALYSE = 1, FACTOR = 2, SOLVE = 3 }; /* jobs */

typedef struct Instance {
    int number;
    DMUMPS_STRUC_C mumps;
    struct Instance *next; /* of another process's list */
} Instance;

/* ---- In every process ---- */

static void perform(DMUMPS_STRUC_C *mumps, int job)
{
    if (job == BEGIN) {
        mumps->par = 1;                /* the first one works, too */
        mumps->sym = 2;                /* LDL^T: of a definite one (1) signs of pivots are not looked at */
        mumps->comm_fortran = -987654; /* all processes */
    }
    mumps->job = job;
    dmumps_c(mumps);
    if (job == BEGIN) ICNTL(mumps, 1) = ICNTL(mumps, 2) = ICNTL(mumps, 3) = -1, ICNTL(mumps, 4) = 0;
}

/* ---- In the others ---- */

static Instance *served;

void mumps_serve(RanksOrder order)
{
    Instance **at = &served;
    if (order.job == BEGIN) {
        Instance *added = mem_alloc(1, sizeof *added);
        *added = (Instance){.number = order.instance, .next = served};
        served = added;
    }
    while ((*at)->number != order.instance) at = &(*at)->next;
    Instance *instance = *at;
    perform(&instance->mumps, order.job);
    if (order.job != END) return;
    *at = instance->next;
    mem_free(instance);
}

/* ---- In the first: what all do together ---- */

/* Threads solve load cases side by side: an order, and what all do for it, is one thread's. */
static pthread_mutex_t one_order = PTHREAD_MUTEX_INITIALIZER;

static void all_do(Instance *instance, int job)
{
    static int count;
    pthread_mutex_lock(&one_order);
    if (job == BEGIN) instance->number = count++;
    ranks_tell((RanksOrder){instance->number, job});
    perform(&instance->mumps, job);
    pthread_mutex_unlock(&one_order);
}

/* Of what is no matter of the matrix: memory that a process has not, and sizes that an int cannot count. */
static void check(const DMUMPS_STRUC_C *mumps)
{
    char where[80];
    if (INFOG(mumps, 1) >= 0) return;
    snprintf(where, sizeof where, "MUMPS (its error %d, %d)", INFOG(mumps, 1), INFOG(mumps, 2));
    mem_exhausted(where);
}

/* ---- Analysis ---- */

typedef struct Analysis {
    int n, negative, *rows, *columns, *order; /* from 1 */
    long entries;
    Instance *first; /* analysed, for the first factor; NULL: it is taken */
    DirectCost cost;
    double *solution; /* [n] */
} Analysis;

static void set_controls(DMUMPS_STRUC_C *mumps, int negative)
{
    ICNTL(mumps, 6) = 0;  /* no permutation to a large diagonal                        */
    ICNTL(mumps, 7) = 1;  /* in the order that is given                                */
    ICNTL(mumps, 12) = 1; /* without 2 x 2 pivots that are chosen before there are any values */
    ICNTL(mumps, 13) = 1; /* no ScaLAPACK at the root, which tells no signs of pivots  */
    ICNTL(mumps, 28) = 1; /* which the first process analyses                          */
    if (negative > 0) return;
    ICNTL(mumps, 8) = 0; /* not scaled: nothing is compared            */
    CNTL(mumps, 1) = 0;  /* no pivoting: a definite matrix needs none  */
}

/* MUMPS keeps the pointers. */
static Instance *begin_instance(const Analysis *analysis)
{
    Instance *instance = mem_alloc(1, sizeof *instance);
    DMUMPS_STRUC_C *mumps = &instance->mumps;
    all_do(instance, BEGIN);
    check(mumps);
    set_controls(mumps, analysis->negative);
    mumps->n = analysis->n;
    mumps->nnz = analysis->entries;
    mumps->irn = analysis->rows;
    mumps->jcn = analysis->columns;
    mumps->perm_in = analysis->order;
    all_do(instance, ANALYSE);
    check(mumps);
    return instance;
}

static void end_instance(Instance *instance)
{
    if (!instance) return;
    all_do(instance, END);
    mem_free(instance);
}

static void list_entries(Analysis *analysis, const Pattern *pattern)
{
    int n = pattern->n;
    size_t entries = (size_t)pattern->start[n];
    analysis->rows = mem_alloc(entries, sizeof(int));
    analysis->columns = mem_alloc(entries, sizeof(int));
    analysis->order = mem_alloc((size_t)n, sizeof(int));
    for (int c = 0; c < n; c++) {
        analysis->order[c] = c + 1;
        for (int k = pattern->start[c]; k < pattern->start[c + 1]; k++)
            analysis->rows[k] = pattern->rows[k] + 1, analysis->columns[k] = c + 1;
    }
}

/* Counts that an int cannot hold are given in millions, as less than 0. */
static double counted(int value)
{
    return value < 0 ? -1e6 * value : value;
}

/* Its work space stays with a factor (measured: 1.33 on sheets of 15 000 and 91 000 unknowns), and each process has buffers. */
static const double KEPT = 1.35, INSTANCE_BYTES = 1e5;

static void *analyse(const Pattern *pattern, int negative)
{
    Analysis *analysis = mem_alloc(1, sizeof *analysis);
    *analysis = (Analysis){.n = pattern->n, .negative = negative, .entries = pattern->start[pattern->n]};
    list_entries(analysis, pattern);
    analysis->solution = mem_alloc((size_t)pattern->n, sizeof(double));
    analysis->first = begin_instance(analysis);
    const DMUMPS_STRUC_C *mumps = &analysis->first->mumps;
    double numbers = counted(INFOG(mumps, 20)),
           bytes = KEPT * numbers * sizeof(double) + INSTANCE_BYTES * ranks_count();
    analysis->cost = (DirectCost){.nonzeros = (long)numbers, .bytes = (long)bytes, .flops = mumps->rinfog[0]};
    return analysis;
}

static void forget(void *self)
{
    Analysis *analysis = self;
    end_instance(analysis->first);
    mem_free(analysis->rows);
    mem_free(analysis->columns);
    mem_free(analysis->order);
    mem_free(analysis->solution);
    mem_free(analysis);
}

static DirectCost cost_of(const void *self)
{
    return ((const Analysis *)self)->cost;
}

/* ---- Numbers ---- */

static void drop(void *self, void *numbers)
{
    (void)self;
    end_instance(numbers);
}

static void *make_room(void *self, void *other_self, void *other)
{
    Analysis *analysis = self;
    Instance *first = analysis->first;
    (void)other_self;
    end_instance(other);
    analysis->first = NULL;
    return first ? first : begin_instance(analysis);
}

/* More than was foreseen is needed where pivots have been put off. */
static bool is_short(const DMUMPS_STRUC_C *mumps)
{
    static const int errors[] = {-8, -9, -14, -17, -20};
    for (size_t k = 0; k < sizeof errors / sizeof *errors; k++)
        if (INFOG(mumps, 1) == errors[k]) return true;
    return false;
}

static void note_memory(Analysis *analysis, const DMUMPS_STRUC_C *mumps)
{
    const long MB = 1000000;
    DirectCost *cost = &analysis->cost;
    long most = MB * INFOG(mumps, 18), all = MB * INFOG(mumps, 19);
    if (most > cost->process_bytes) cost->process_bytes = most;
    if (all > cost->all_bytes) cost->all_bytes = all;
}

static bool factor(void *self, const Pattern *pattern, double *values, void *of, Workers *workers)
{
    enum { SINGULAR = -10, PERCENT_MOST = 1000 };
    Analysis *analysis = self;
    Instance *instance = of;
    DMUMPS_STRUC_C *mumps = &instance->mumps;
    (void)pattern, (void)workers;
    mumps->a = values;
    all_do(instance, FACTOR);
    for (; is_short(mumps) && ICNTL(mumps, 14) < PERCENT_MOST; all_do(instance, FACTOR))
        ICNTL(mumps, 14) *= 2;
    if (INFOG(mumps, 1) == SINGULAR) return false;
    check(mumps);
    note_memory(analysis, mumps);
    return INFOG(mumps, 12) == analysis->negative;
}

static const double *solve(void *self, void *of, const double *b, Workers *workers)
{
    Analysis *analysis = self;
    Instance *instance = of;
    (void)workers;
    memcpy(analysis->solution, b, (size_t)analysis->n * sizeof *b);
    instance->mumps.nrhs = 1;
    instance->mumps.rhs = analysis->solution;
    all_do(instance, SOLVE);
    check(&instance->mumps);
    return analysis->solution;
}

static bool ready(Error *err)
{
    if (!ranks_count())
        return error_set(
            err,
            "mumps is not in this process: the program slender starts what it needs, its library does not");
    return ranks_take_turns() || error_set(err, "mumps needs an MPI in which threads may take turns");
}

const DirectRow direct_mumps = {.version = "MUMPS " MUMPS_VERSION,
                                .spread = true,
                                .ready = ready,
                                .analyse = analyse,
                                .forget = forget,
                                .cost = cost_of,
                                .make_room = make_room,
                                .drop = drop,
                                .factor = factor,
                                .solve = solve};
