/* The direct solver on sheets of more and more triangles: factors and solves, by one thread and by two in turn. */
#include "base/clock.h"
#include "bench/bench.h"
#include "bench/sheet.h"
#include <math.h>
#include <stdio.h>

/* Best of so many, in which the sheet of 8192 triangles takes a few seconds. */
static int repeats(int cells)
{
    return cells > 200 ? 3 : cells > 100 ? 8 : 40;
}

static void measure(Sheet *s, Workers *workers, double seconds[2])
{
    enum { SOLVES = 5 };
    system_set_workers(s->sys, workers);
    double start = clock_seconds();
    if (!system_factor(s->sys, 1e-6)) bench_fail("the sheet's Hessian has no factor");
    seconds[0] = fmin(seconds[0], clock_seconds() - start);
    for (int k = 0; k < SOLVES; k++) {
        double *x = s->state.v; /* room */
        start = clock_seconds();
        system_solve(s->sys, s->gradient, x);
        seconds[1] = fmin(seconds[1], clock_seconds() - start);
    }
}

static void print(const Sheet *s, const char *bending, const char *what, double seconds)
{
    char name[80];
    snprintf(name, sizeof name, "solver_%s_%d_%s_ms", bending, s->shell->mesh->face_count, what);
    bench_print(name, 1e3 * seconds, "ms");
}

static void sheet(int cells, BendingModel bending, const char *name)
{
    Sheet s = sheet_create_fine(cells, bending, false);
    Workers *workers = workers_create(2);
    double one[2] = {INFINITY, INFINITY}, two[2] = {INFINITY, INFINITY};
    sheet_bend(&s);
    system_hessian(s.sys, &(Point){.x = s.state.x, .p = s.p, .memory = s.state.memory}, s.gradient);
    for (int k = 0; k < repeats(cells); k++) {
        measure(&s, NULL, one);
        measure(&s, workers, two);
    }
    print(&s, name, "factor", one[0]);
    print(&s, name, "factor_2_threads", two[0]);
    print(&s, name, "solve", one[1]);
    print(&s, name, "solve_2_threads", two[1]);
    sheet_destroy(&s);
    workers_destroy(workers);
}

void bench_solver(void)
{
    static const int cells[] = {32, 64, 128, 256};
    for (int k = 0; k < 4; k++) {
        sheet(cells[k], BENDING_HINGE, "hinge");
        sheet(cells[k], BENDING_MIDEDGE, "midedge");
    }
}
