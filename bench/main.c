/* Speed of what slender exists for: one line per figure, "name value unit". Without arguments all cases run,
 * else those that are named. bench/README.md says how they are measured and against what. */
#include "bench/bench.h"
#include "cli/kernels_start.h"
#include "solve/kernels.h"
#include "solve/ranks.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name;
    void (*run)(void);
} cases[] = {
    {"shell_hessian", bench_shell_hessian},
    {"newton", bench_newton},
    {"factor", bench_factor},
    {"couple", bench_couple},
    {"solver", bench_solver},
    {"spread", bench_spread},
    {"march", bench_march},
    {"contact", bench_contact},
    {"crumple", bench_crumple},
    {"trajectory", bench_trajectory},
    {"equilibria", bench_equilibria},
    {"design", bench_design},
    {"rod", bench_rod},
    {"spline", bench_spline},
    {"draw", bench_draw},
    {"scale", bench_scale},
    {"solid", bench_solid},
};

enum { CASE_COUNT = sizeof cases / sizeof *cases };

void bench_print(const char *name, double value, const char *unit)
{
    printf("%s %.4g %s\n", name, value, unit);
    fflush(stdout);
}

_Noreturn void bench_fail(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fprintf(stderr, "bench: ");
    vfprintf(stderr, format, args);
    fprintf(stderr, "\n");
    va_end(args);
    exit(1);
}

int main(int argc, char **argv)
{
    kernels_start(argv);
    if (ranks_are_given()) ranks_start();
    if (ranks_serve()) return 0;
    for (int a = 1; a < argc; a++) {
        int known = 0;
        for (int k = 0; k < CASE_COUNT; k++) known |= !strcmp(argv[a], cases[k].name);
        if (known) continue;
        fprintf(stderr, "there is no case '%s'; there are", argv[a]);
        for (int k = 0; k < CASE_COUNT; k++) fprintf(stderr, " %s", cases[k].name);
        fprintf(stderr, "\n");
        return 2;
    }
    printf("kernels %s\n", kernels_name());
    for (int k = 0; k < CASE_COUNT; k++) {
        int wanted = argc == 1;
        for (int a = 1; a < argc; a++) wanted |= !strcmp(argv[a], cases[k].name);
        if (wanted) cases[k].run();
    }
    ranks_end();
    return 0;
}
