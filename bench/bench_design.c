/* Whole jobs, by the program, as users run them. */
#include "base/clock.h"
#include "bench/bench.h"
#include <stdio.h>
#include <stdlib.h>

static void job(const char *name, const char *scene, const char *options)
{
    char command[1024];
    snprintf(command, sizeof command,
             "'%s' run '%s/scenes/%s.yaml' --force --quiet --no-picture -o bench_%s %s", PROGRAM, SOURCE_DIR,
             scene, scene, options);
    double start = clock_seconds();
    if (system(command)) bench_fail("the job of %s fails", name);
    bench_print(name, clock_seconds() - start, "s");
}

void bench_design(void)
{
    job("hexagram_gauss_newton_seconds", "hexagram", "--set design.tolerance=1e-6");
    job("hexagram_mma_seconds", "hexagram",
        "--set design.optimizer=mma --set design.iterations=50 --set design.tolerance=1e-6");
    job("hexagram_lbfgs_seconds", "hexagram",
        "--set design.optimizer=lbfgs --set design.iterations=50 --set design.tolerance=1e-6");
    job("kirigami_height_seconds", "kirigami_height", "");
    job("letter_a_m_seconds", "letter_a_m", "");
    job("letter_a_seconds", "letter_a", "");
    job("letter_a_hinge_seconds", "letter_a", "--set shell.bending=hinge");
}
