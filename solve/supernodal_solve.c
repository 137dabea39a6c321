#include "solve/dense.h"
#include "solve/supernodal_private.h"
#include <string.h>

/* What one task takes of a supernode of the crown, fixed as in a factorisation. */
enum { ROWS = 64, COLUMNS = 8, PANEL = 128 };

typedef struct Solving {
    const Supernodal *plan;
    const double *numbers;
    double *x;
} Solving;

/* A supernode at work: its own unknowns and those below, side by side. */
typedef struct Front {
    const Supernode *node;
    const double *columns;
    double *y;
    int done, panel;
} Front;

static void forward_task(void *self, int task)
{
    const Front *f = self;
    long ld = f->node->height;
    int first = f->done + f->panel + task * ROWS, left = f->node->height - first,
        rows = left < ROWS ? left : ROWS;
    dense_multiply(rows, f->panel, f->columns + first + f->done * ld, ld, f->y + f->done, f->y + first);
}

static void backward_task(void *self, int task)
{
    const Front *f = self;
    long ld = f->node->height;
    int first = f->done + task * COLUMNS, left = f->done + f->panel - first,
        columns = left < COLUMNS ? left : COLUMNS, under = f->done + f->panel;
    dense_multiply_transposed(f->node->height - under, columns, f->columns + under + first * ld, ld,
                              f->y + under, f->y + first);
}

static Front front_of(const Solving *job, const Supernode *node, double *y)
{
    return (Front){.node = node, .columns = job->numbers + node->numbers_at, .y = y};
}

/* x: the node's own unknowns; targets: of the rows below, in `vector`. y: room. */
static void forward_node(const Solving *job, const Supernode *node, double *x, double *vector, double *y,
                         Workers *workers)
{
    Front f = front_of(job, node, y);
    const int *targets = job->plan->targets + node->at;
    long ld = node->height;
    memcpy(y, x, (size_t)node->width * sizeof *y);
    memset(y + node->width, 0, (size_t)node->below * sizeof *y);
    for (; f.done < node->width; f.done += f.panel) {
        f.panel = node->width - f.done < PANEL ? node->width - f.done : PANEL;
        dense_forward(f.panel, f.columns + f.done * (ld + 1), ld, y + f.done);
        workers_run(workers, chunks_of(node->height - f.done - f.panel, ROWS), forward_task, &f);
    }
    memcpy(x, y, (size_t)node->width * sizeof *y);
    for (int i = 0; i < node->rows - node->width; i++) vector[targets[i]] += y[node->width + i];
}

static void backward_node(const Solving *job, const Supernode *node, double *x, const double *vector,
                          double *y, Workers *workers)
{
    Front f = front_of(job, node, y);
    const int *targets = job->plan->targets + node->at;
    long ld = node->height;
    memcpy(y, x, (size_t)node->width * sizeof *y);
    for (int i = 0; i < node->below; i++)
        y[node->width + i] = i < node->rows - node->width ? vector[targets[i]] : 0;
    for (f.done = (node->width - 1) / PANEL * PANEL; f.done >= 0; f.done -= PANEL) {
        f.panel = node->width - f.done < PANEL ? node->width - f.done : PANEL;
        workers_run(workers, chunks_of(f.panel, COLUMNS), backward_task, &f);
        dense_backward(f.panel, f.columns + f.done * (ld + 1), ld, y + f.done);
    }
    memcpy(x, y, (size_t)node->width * sizeof *y);
}

static void branch_forward(void *self, int task)
{
    const Solving *job = self;
    const Branch *branch = &job->plan->branches[task];
    double *vector = job->plan->vector + branch->vector_at, *room = vector + branch->columns + branch->border;
    memcpy(vector, job->x + branch->column, (size_t)branch->columns * sizeof *vector);
    memset(vector + branch->columns, 0, (size_t)branch->border * sizeof *vector);
    for (int s = branch->first; s <= branch->last; s++) {
        const Supernode *node = &job->plan->nodes[s];
        forward_node(job, node, vector + node->first - branch->column, vector, room, NULL);
    }
}

static void branch_backward(void *self, int task)
{
    const Solving *job = self;
    const Branch *branch = &job->plan->branches[task];
    const int *rows = job->plan->rows + job->plan->nodes[branch->last].at;
    double *vector = job->plan->vector + branch->vector_at, *room = vector + branch->columns + branch->border;
    for (int i = 0; i < branch->border; i++) vector[branch->columns + i] = job->x[rows[i]];
    for (int s = branch->last; s >= branch->first; s--) {
        const Supernode *node = &job->plan->nodes[s];
        backward_node(job, node, vector + node->first - branch->column, vector, room, NULL);
    }
    memcpy(job->x + branch->column, vector, (size_t)branch->columns * sizeof *vector);
}

/* What the branches leave for the crown, one after the other. */
static void add_borders(const Solving *job)
{
    const Supernodal *plan = job->plan;
    for (int b = 0; b < plan->branch_count; b++) {
        const Branch *branch = &plan->branches[b];
        const int *rows = plan->rows + plan->nodes[branch->last].at;
        const double *border = plan->vector + branch->vector_at + branch->columns;
        for (int i = 0; i < branch->border; i++) job->x[rows[i]] += border[i];
    }
}

void supernodal_solve(Supernodal *plan, const double *numbers, double *x, Workers *workers)
{
    Solving job = {plan, numbers, x};
    double *room = plan->vector + plan->crown_at;
    workers_run(workers, plan->branch_count, branch_forward, &job);
    add_borders(&job);
    for (int s = 0; s < plan->count; s++) {
        const Supernode *node = &plan->nodes[s];
        if (node->branch < 0) forward_node(&job, node, x + node->first, x, room, workers);
    }
    for (int s = plan->count - 1; s >= 0; s--) {
        const Supernode *node = &plan->nodes[s];
        if (node->branch < 0) backward_node(&job, node, x + node->first, x, room, workers);
    }
    workers_run(workers, plan->branch_count, branch_backward, &job);
}
