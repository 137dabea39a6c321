#include "base/memory.h"
#include "base/pack.h"
#include "solve/dense.h"
#include "solve/supernodal_private.h"
#include <string.h>

/* What one task takes, fixed, for chunks decide which sums are made how. */
enum { COLUMNS = 64, GROUP = 8, ROWS = 128, TILE = 256 };

typedef struct Factoring {
    const Supernodal *plan;
    const Pattern *pattern;
    const double *values;
    double *numbers;
    atomic_bool failed;
} Factoring;

/* A supernode at work: its columns of L over the whole height, and the update that they leave. */
typedef struct Front {
    const Factoring *job;
    const Supernode *node;
    double *desk, *columns, *update;
    int done, panel; /* columns done, and those at hand */
} Front;

static int least(int a, int b)
{
    return a < b ? a : b;
}

static double *update_of(const Front *f, const Supernode *node)
{
    return (node->kept ? f->job->plan->work : f->desk) + node->update_at;
}

static void add_matrix(const Front *f, int column)
{
    const Pattern *pattern = f->job->pattern;
    double *to = f->columns + (long)column * f->node->height;
    for (int k = pattern->start[f->node->first + column]; k < pattern->start[f->node->first + column + 1];
         k++)
        to[f->job->plan->slots[k]] += f->job->values[k];
}

/* to[places[i]] += from[i]. Rows mostly come in runs. */
static void add_rows(int count, const int *places, const double *from, double *to)
{
    enum { RUN = 8 };
    int i = 0;
    for (; i + RUN <= count; i += RUN) {
        if (places[i + RUN - 1] == places[i] + RUN - 1) {
            double *at = to + places[i];
            for (int k = 0; k < RUN; k++) at[k] += from[i + k];
        } else {
            for (int k = 0; k < RUN; k++) to[places[i + k]] += from[i + k];
        }
    }
    for (; i < count; i++) to[places[i]] += from[i];
}

/* Where a column of the front begins; its rows are those of the whole supernode. */
static double *front_column(const Front *f, int column)
{
    const Supernode *node = f->node;
    return column < node->width ? f->columns + (long)column * node->height
                                : f->update + (long)(column - node->width) * node->below - node->width;
}

/* Columns first .. last of the front take what a child left for them. */
static void add_child(const Front *f, const Supernode *child, int first, int last)
{
    const Supernodal *plan = f->job->plan;
    const int *places = plan->places + child->at;
    const double *update = update_of(f, child);
    int count = child->rows - child->width, low = 0, high = count;
    while (low < high) {
        int middle = (low + high) / 2;
        if (places[middle] < first)
            low = middle + 1;
        else
            high = middle;
    }
    for (int j = low; j < count && places[j] < last; j++)
        add_rows(count - j, places + j, update + (long)j * child->below + j, front_column(f, places[j]));
}

/* The columns first .. last of the front, of its own or of its update: the matrix's and what the children left. Few at a
 * time, so that they stay in the nearest cache. */
static void assemble_columns(const Front *f, int first, int last)
{
    const Supernode *node = f->node;
    int top = first < node->width ? 0 : node->width + (first - node->width) / PACK_LANES * PACK_LANES;
    dense_clear(node->height - top, last - first, front_column(f, first) + top,
                first < node->width ? node->height : node->below);
    for (int c = first; c < last && c < node->width; c++) add_matrix(f, c);
    for (int s = node->child; s >= 0; s = f->job->plan->nodes[s].sibling)
        add_child(f, &f->job->plan->nodes[s], first, last);
}

static void assemble_task(void *self, int task)
{
    const Front *f = self;
    int width = f->node->width, end = least((task + 1) * COLUMNS, f->node->height);
    for (int first = task * COLUMNS, last; first < end; first = last) {
        last = least(first + GROUP, end);
        if (first < width) last = least(last, width);
        assemble_columns(f, first, last);
    }
}

/* A panel of columns is reduced by those before it and factored: its diagonal block, then the rows below. */
static bool factor_diagonal(const Front *f)
{
    long ld = f->node->height;
    double *a = f->columns + f->done, *diagonal = a + f->done * ld;
    dense_subtract_square(f->panel, f->done, a, ld, diagonal, ld);
    return dense_cholesky(f->panel, diagonal, ld);
}

static void panel_task(void *self, int task)
{
    const Front *f = self;
    long ld = f->node->height;
    int first = f->done + f->panel + task * ROWS, left = f->node->height - first,
        rows = left < ROWS ? left : ROWS;
    double *a = f->columns + first, *diagonal = f->columns + f->done + f->done * ld;
    dense_subtract(rows, f->panel, f->done, a, f->columns + f->done, ld, a + f->done * ld, ld);
    dense_follow(rows, f->panel, diagonal, a + f->done * ld, ld);
}

/* Tile `task` of the update's lower triangle, row by row. */
static void update_task(void *self, int task)
{
    const Front *f = self;
    const Supernode *node = f->node;
    int i = 0, j = task;
    while (j > i) j -= ++i;
    int rows = node->below - i * TILE < TILE ? node->below - i * TILE : TILE;
    const double *a = f->columns + node->width;
    double *to = f->update + i * TILE + (long)j * TILE * node->below;
    if (i == j)
        dense_subtract_square(rows, node->width, a + i * TILE, node->height, to, node->below);
    else
        dense_subtract(rows, TILE, node->width, a + i * TILE, a + j * TILE, node->height, to, node->below);
}

static bool factor_node(const Factoring *job, const Supernode *node, double *desk, Workers *workers)
{
    Front f = {.job = job, .node = node, .desk = desk, .columns = job->numbers + node->numbers_at};
    f.update = update_of(&f, node);
    workers_run(workers, chunks_of(node->height, COLUMNS), assemble_task, &f);
    for (; f.done < node->width; f.done += f.panel) {
        f.panel = node->width - f.done < DENSE_PANEL ? node->width - f.done : DENSE_PANEL;
        if (!factor_diagonal(&f)) return false;
        workers_run(workers, chunks_of(node->height - f.done - f.panel, ROWS), panel_task, &f);
    }
    int tiles = chunks_of(node->below, TILE);
    workers_run(workers, tiles * (tiles + 1) / 2, update_task, &f);
    return true;
}

static void branch_task(void *self, int task)
{
    Factoring *job = self;
    const Branch *branch = &job->plan->branches[task];
    Desk *desk = job->plan->desks;
    while (atomic_flag_test_and_set(&desk->taken)) desk++;
    for (int s = branch->first; s <= branch->last && !atomic_load(&job->failed); s++)
        if (!factor_node(job, &job->plan->nodes[s], desk->work, NULL)) atomic_store(&job->failed, true);
    atomic_flag_clear(&desk->taken);
}

static void set_desks(Supernodal *plan, int count)
{
    if (count <= plan->desk_count) return;
    plan->desks = mem_resize(plan->desks, (size_t)plan->desk_count, (size_t)count, sizeof *plan->desks);
    for (; plan->desk_count < count; plan->desk_count++)
        plan->desks[plan->desk_count] =
            (Desk){ATOMIC_FLAG_INIT, mem_alloc((size_t)plan->desk_size, sizeof(double))};
}

bool supernodal_factor(Supernodal *plan, const Pattern *pattern, const double *values, double *numbers,
                       Workers *workers)
{
    Factoring job = {.plan = plan, .pattern = pattern, .values = values, .numbers = numbers};
    set_desks(plan, workers_count(workers));
    if (!plan->work) plan->work = mem_alloc((size_t)plan->work_size, sizeof *plan->work);
    workers_run(workers, plan->branch_count, branch_task, &job);
    bool good = !atomic_load(&job.failed);
    for (int s = 0; good && s < plan->count; s++)
        if (plan->nodes[s].branch < 0) good = factor_node(&job, &plan->nodes[s], NULL, workers);
    return good;
}
