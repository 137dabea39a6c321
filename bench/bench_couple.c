/* What it costs when elements change: a sheet of 8192 triangles whose free quarter is folded over, with springs between
 * what lies on each other; the fold moves to and fro by a row, and with it all pairs. */
#include "base/clock.h"
#include "base/memory.h"
#include "bench/bench.h"
#include "bench/sheet.h"
#include "shell/terms.h"
#include "solve/element.h"
#include <math.h>
#include <stdio.h>

enum { CELLS = 64, MOST_ROWS = 24, FIRSTS = 4 };

/* Linear springs of vertices; which depends on the time alone. */
typedef struct Fold {
    int rows, count, at, pairs[MOST_ROWS * (CELLS + 1)][2];
} Fold;

static int fold_count(const void *self)
{
    return ((const Fold *)self)->count;
}

static int fold_size(const void *self)
{
    (void)self;
    return 6;
}

static void fold_dofs(const void *self, int e, int *dof)
{
    for (int i = 0; i < 6; i++) dof[i] = 3 * ((const Fold *)self)->pairs[e][i / 3] + i % 3;
}

static bool fold_update(void *self, const Point *at)
{
    Fold *fold = self;
    int line = at->time > 0 ? 3 * CELLS / 4 : 3 * CELLS / 4 - 1;
    if (fold->at == line) return false;
    fold->at = line, fold->count = 0;
    for (int k = 1; k <= fold->rows; k++)
        for (int j = 0; j <= CELLS; j++) {
            int *pair = fold->pairs[fold->count++];
            pair[0] = j * (CELLS + 1) + line - k, pair[1] = j * (CELLS + 1) + line + k;
        }
    return true;
}

static Pack fold_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    (void)self, (void)pack, (void)at;
    const double k = 0.1;
    Pack energy = {0};
    if (H) element_clear(H, 6);
    for (int i = 0; i < 3; i++) {
        Pack d = x[i] - x[3 + i];
        energy += k / 2 * d * d;
        if (g) g[i] = k * d, g[3 + i] = -k * d;
        if (H) H[TERM_LOWER(i, i)] = H[TERM_LOWER(3 + i, 3 + i)] = pack_set(k);
        if (H) H[TERM_LOWER(3 + i, i)] = pack_set(-k);
    }
    return energy;
}

static const TermOps fold_ops = {.name = "fold",
                                 .count = fold_count,
                                 .size = fold_size,
                                 .dofs = fold_dofs,
                                 .update = fold_update,
                                 .eval = fold_eval,
                                 .destroy = mem_free};

/* The sheet's terms and the springs. */
static System *folded_system(const Shell *shell, int rows)
{
    int positions = 3 * shell->mesh->vertex_count;
    DofClass classes[] = {{.count = positions, .size = 0.1},
                          {.first = positions, .count = shell->mesh->edge_count, .size = 1}};
    System *sys = system_create(shell_dof_count(shell), classes, 2);
    for (int t = 0; t < shell_term_row_count; t++) system_add(sys, shell_term_rows[t].create(shell));
    Fold *fold = mem_alloc(1, sizeof *fold);
    fold->rows = rows;
    system_add(sys, (Term){&fold_ops, fold});
    for (int i = 0; i < positions; i++)
        if (shell->fixed[i]) system_fix(sys, i);
    system_prepare(sys);
    system_build(sys);
    return sys;
}

/* Of a factor that is the first of its list: the least of a few. */
static double first_factor_seconds(System *sys, Sheet *s)
{
    double best = INFINITY;
    for (int k = 0; k < FIRSTS; k++) {
        sheet_hessian_seconds(sys, s, (double[]){k % 2, k % 2});
        double start = clock_seconds();
        if (!system_factor(sys, 1e-6)) bench_fail("the folded sheet's Hessian has no factor");
        best = fmin(best, clock_seconds() - start);
    }
    return best;
}

static void time_couple(Sheet *s, int rows, const char *name)
{
    System *sys = folded_system(s->shell, rows);
    char text[80];
    double nonzeros = (double)system_info(sys).factor_nonzeros;
    double seconds =
        sheet_hessian_seconds(sys, s, (double[]){0, 1}) - sheet_hessian_seconds(sys, s, (double[]){1, 1});
    double first = first_factor_seconds(sys, s), factor = sheet_factor_seconds(sys);
    snprintf(text, sizeof text, "couple_%s_over_factor", name);
    bench_print(text, seconds / factor, "ratio");
    snprintf(text, sizeof text, "couple_%s_analysis_over_factor", name);
    bench_print(text, (first - factor) / factor, "ratio");
    snprintf(text, sizeof text, "couple_%s_fill", name);
    bench_print(text, (double)system_info(sys).factor_nonzeros / nonzeros, "ratio");
    system_destroy(sys);
}

void bench_couple(void)
{
    Sheet s = sheet_create(BENDING_MIDEDGE, false);
    sheet_bend(&s);
    time_couple(&s, 4, "same_order");
    time_couple(&s, MOST_ROWS, "new_order");
    sheet_destroy(&s);
}
