/* A sheet of 8192 triangles, one thread: assembly, factorisation, Newton. */
#include "base/clock.h"
#include "base/memory.h"
#include "bench/bench.h"
#include "bench/sheet.h"
#include "solve/newton.h"
#include <math.h>
#include <stdio.h>

static void time_hessian(BendingModel bending, const char *name, int threads)
{
    Sheet s = sheet_create(bending, false);
    Workers *workers = workers_create(threads);
    char text[80];
    system_set_workers(s.sys, workers);
    sheet_bend(&s);
    double seconds = sheet_hessian_seconds(s.sys, &s, (double[2]){0, 0});
    snprintf(text, sizeof text, "system_hessian_%s_us_per_triangle_%d_threads", name, threads);
    bench_print(text, 1e6 * seconds / s.shell->mesh->face_count, "us");
    sheet_destroy(&s);
    workers_destroy(workers);
}

void bench_shell_hessian(void)
{
    for (int threads = 1; threads <= 2; threads++) {
        time_hessian(BENDING_MIDEDGE, "midedge", threads);
        time_hessian(BENDING_HINGE, "hinge", threads);
    }
}

void bench_newton(void)
{
    static const char *const names[] = {[BENDING_MIDEDGE] = "midedge", [BENDING_HINGE] = "hinge"};
    for (BendingModel bending = BENDING_MIDEDGE; bending <= BENDING_HINGE; bending++) {
        Sheet s = sheet_create(bending, false);
        NewtonDef def = newton_default();
        char name[80];
        double start = clock_seconds();
        NewtonInfo info = newton_minimize(s.sys, &def, &(Point){.p = s.p}, &s.state, NULL);
        double seconds = clock_seconds() - start;
        SparseInfo sparse = system_info(s.sys);
        if (info.status != NEWTON_CONVERGED)
            bench_fail("newton_%s: %s", names[bending], newton_status_name(info.status));
        snprintf(name, sizeof name, "newton_%s_ms_per_iteration", names[bending]);
        bench_print(name, 1e3 * seconds / info.iterations, "ms");
        snprintf(name, sizeof name, "other_over_newton%s", bending == BENDING_HINGE ? "_hinge" : "");
        bench_print(name, 1 - (sparse.factor_seconds + sparse.solve_seconds) / seconds, "ratio");
        sheet_destroy(&s);
    }
}

void dgemm_(const char *ta, const char *tb, const int *m, const int *n, const int *k, const double *alpha,
            const double *a, const int *lda, const double *b, const int *ldb, const double *beta, double *c,
            const int *ldc, size_t la, size_t lb);

static double dgemm_flops(void)
{
    enum { N = 768 };
    const int n = N;
    const double one = 1, zero = 0;
    double *a = mem_alloc(3 * (size_t)N * N, sizeof *a), best = INFINITY;
    for (int i = 0; i < 2 * N * N; i++) a[i] = 1e-3 * (i % 97);
    for (int k = 0; k < 8; k++) {
        double start = clock_seconds();
        dgemm_("N", "N", &n, &n, &n, &one, a, &n, a + N * N, &n, &zero, a + 2 * N * N, &n, 1, 1);
        best = fmin(best, clock_seconds() - start);
    }
    mem_free(a);
    return 2.0 * N * N * N / best;
}

void bench_factor(void)
{
    Sheet s = sheet_create(BENDING_MIDEDGE, false);
    sheet_bend(&s);
    double assembly = sheet_hessian_seconds(s.sys, &s, (double[2]){0, 0}),
           factor = sheet_factor_seconds(s.sys), speed = system_info(s.sys).factor_flops / factor,
           dgemm = dgemm_flops();
    bench_print("factor_ms", 1e3 * factor, "ms");
    bench_print("assembly_over_factor", assembly / factor, "ratio");
    bench_print("factor_over_dgemm", speed / dgemm, "ratio");
    bench_print("dgemm_gigaflops", 1e-9 * dgemm, "GF/s");
    sheet_destroy(&s);
}
