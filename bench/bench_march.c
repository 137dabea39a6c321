/* Implicit Euler on a sheet of 8192 triangles that falls under its weight, one edge clamped. */
#include "base/clock.h"
#include "bench/bench.h"
#include "bench/sheet.h"
#include "solve/march.h"
#include <math.h>
#include <stdio.h>

/* Steps from rest until a tenth of a second; the largest force left of any step's end, N. */
static void march(BendingModel bending, double dt, int threads, const char *name)
{
    Sheet s = sheet_create(bending, true);
    Workers *workers = workers_create(threads);
    system_set_workers(s.sys, workers);
    MarchDef def = march_default();
    int steps = (int)lround(0.1 / dt), newton = 0, factorizations = 0, cg = 0;
    double force = 0, start = clock_seconds();
    for (int n = 0; n < steps; n++) {
        MarchInfo info;
        if (!march_step(s.sys, &def, dt, s.p, &s.state, &info))
            bench_fail("%s: the motion stops in step %d", name, n);
        newton += info.newton.iterations, factorizations += info.newton.factorizations;
        cg += info.newton.cg_iterations;
        force = fmax(force, info.newton.gradient_max);
    }
    char text[80];
    snprintf(text, sizeof text, "march_%s_ms_per_step", name);
    bench_print(text, 1e3 * (clock_seconds() - start) / steps, "ms");
    snprintf(text, sizeof text, "march_%s_newton_per_step", name);
    bench_print(text, (double)newton / steps, "");
    snprintf(text, sizeof text, "march_%s_factorizations_per_step", name);
    bench_print(text, (double)factorizations / steps, "");
    snprintf(text, sizeof text, "march_%s_cg_per_step", name);
    bench_print(text, (double)cg / steps, "");
    snprintf(text, sizeof text, "march_%s_force_left", name);
    bench_print(text, force, "N");
    sheet_destroy(&s);
    workers_destroy(workers);
}

void bench_march(void)
{
    march(BENDING_HINGE, 1e-3, 1, "hinge_1ms");
    march(BENDING_HINGE, 1e-2, 1, "hinge_10ms");
    march(BENDING_MIDEDGE, 1e-3, 1, "midedge_1ms");
    march(BENDING_MIDEDGE, 1e-2, 1, "midedge_10ms");
    march(BENDING_HINGE, 1e-3, 2, "hinge_1ms_2_threads");
    march(BENDING_HINGE, 1e-2, 2, "hinge_10ms_2_threads");
    march(BENDING_MIDEDGE, 1e-3, 2, "midedge_1ms_2_threads");
    march(BENDING_MIDEDGE, 1e-2, 2, "midedge_10ms_2_threads");
}
