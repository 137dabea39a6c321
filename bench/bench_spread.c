/* Factors that are spread over processes: a sheet of 131 072 triangles by CHOLMOD in one thread and by MUMPS in all processes that
 * this is started as, in turn: mpirun -n 2 build/bench/bench spread. */
#include "base/clock.h"
#include "bench/bench.h"
#include "bench/sheet.h"
#include "solve/ranks.h"
#include <math.h>
#include <stdio.h>

enum { CELLS = 256, REPEATS = 3, SOLVES = 5 };

/* Of the first process, whose clock runs on while it waits for others. */
typedef struct Least {
    double factor, solve, factor_cpu, solve_cpu; /* s */
} Least;

static void take(double *least, double *least_cpu, double from, double from_cpu)
{
    *least = fmin(*least, clock_seconds() - from);
    *least_cpu = fmin(*least_cpu, clock_thread_seconds() - from_cpu);
}

static void measure(System *sys, const Sheet *s, Least *least)
{
    double start = clock_seconds(), cpu = clock_thread_seconds();
    if (!system_factor(sys, 1e-6)) bench_fail("the sheet's Hessian has no factor");
    take(&least->factor, &least->factor_cpu, start, cpu);
    for (int k = 0; k < SOLVES; k++) {
        start = clock_seconds(), cpu = clock_thread_seconds();
        system_solve(sys, s->gradient, s->state.v); /* room */
        take(&least->solve, &least->solve_cpu, start, cpu);
    }
}

static void print(const char *solver, const char *what, double value, const char *unit)
{
    char name[80];
    snprintf(name, sizeof name, "spread_hinge_%d_%s_%s", 2 * CELLS * CELLS, solver, what);
    bench_print(name, value, unit);
}

static void print_least(const char *solver, const Least *least)
{
    print(solver, "factor_ms", 1e3 * least->factor, "ms");
    print(solver, "factor_cpu_ms", 1e3 * least->factor_cpu, "ms");
    print(solver, "solve_ms", 1e3 * least->solve, "ms");
    print(solver, "solve_cpu_ms", 1e3 * least->solve_cpu, "ms");
}

void bench_spread(void)
{
    Error err;
    ranks_start();
    if (!direct_is_ready(DIRECT_MUMPS, &err)) {
        printf("# spread: %s\n", err.text);
        return;
    }
    Sheet s = sheet_create_fine(CELLS, BENDING_HINGE, false);
    System *spread = shell_system(s.shell);
    system_set_direct(spread, DIRECT_MUMPS);
    sheet_bend(&s);
    Point at = {.x = s.state.x, .p = s.p, .memory = s.state.memory};
    system_hessian(s.sys, &at, s.gradient);
    system_hessian(spread, &at, s.gradient);
    Least cholmod = {INFINITY, INFINITY, INFINITY, INFINITY}, mumps = cholmod;
    for (int k = 0; k < REPEATS; k++) {
        measure(s.sys, &s, &cholmod);
        measure(spread, &s, &mumps);
    }
    SparseInfo info = system_info(spread);
    char name[40];
    snprintf(name, sizeof name, "mumps_%d_processes", ranks_count());
    print_least("cholmod", &cholmod);
    print_least(name, &mumps);
    print("cholmod", "factor_megabytes", 1e-6 * (double)system_info(s.sys).factor_bytes, "MB");
    print(name, "numbers_megabytes", 8e-6 * (double)info.factor_nonzeros, "MB");
    print(name, "most_megabytes", 1e-6 * (double)info.process_bytes, "MB");
    print(name, "all_megabytes", 1e-6 * (double)info.all_bytes, "MB");
    system_destroy(spread);
    sheet_destroy(&s);
}
