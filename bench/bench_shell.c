/* A sheet of 8192 triangles, one thread: assembly, factorisation, Newton. */
#include "base/clock.h"
#include "base/memory.h"
#include "bench/bench.h"
#include "shell/shapes.h"
#include "shell/shell.h"
#include "solve/newton.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { CELLS = 64, REPEATS = 30 };

typedef struct Sheet {
    Shell *shell;
    System *sys;
    double *p, *x, *gradient;
} Sheet;

/* 0.1 m square, held at x = 0, magnetised along x in a field across. */
static Sheet make_sheet(BendingModel bending)
{
    Sheet s;
    MeshFile file;
    Error err;
    if (!shape_sheet((double[]){0.1, 0.1}, (int[]){CELLS, CELLS}, PATTERN_RIGHT, &file, &err)) abort();
    Mesh *mesh = mesh_create(&file, 0, NULL, &err);
    mesh_file_clear(&file);
    s.shell = shell_create(mesh);
    s.shell->thickness = 1e-3, s.shell->poisson = 0.45, s.shell->density = 1000, s.shell->bending = bending;
    for (int v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; mesh->rest[v][0] < 1e-9 && i < 3; i++) shell_fix(s.shell, v, i);
    for (int e = 0; e < mesh->edge_count; e++)
        if (mesh->rest[mesh->edges[e][0]][0] < 1e-9 && mesh->rest[mesh->edges[e][1]][0] < 1e-9)
            shell_clamp(s.shell, e);
    s.sys = shell_system(s.shell);
    s.p = mem_alloc((size_t)s.shell->params.size, sizeof(double));
    s.x = mem_alloc((size_t)shell_dof_count(s.shell), sizeof(double));
    s.gradient = mem_alloc((size_t)shell_dof_count(s.shell), sizeof(double));
    shell_default_params(s.shell, s.p);
    for (int f = 0; f < mesh->face_count; f++)
        s.p[s.shell->young + f] = 1e5, s.p[s.shell->magnetization + 3 * f] = 1e4;
    s.p[s.shell->flux_density + 2] = 2e-3;
    shell_rest_state(s.shell, s.x);
    return s;
}

/* Rolled by half a radian in all. */
static void bend(Sheet *s)
{
    const double k = 5;
    for (int v = 0; v < s->shell->mesh->vertex_count; v++) {
        double x = s->shell->mesh->rest[v][0];
        s->x[3 * v] = sin(k * x) / k;
        s->x[3 * v + 2] = (1 - cos(k * x)) / k;
    }
}

static void free_sheet(Sheet *s)
{
    system_destroy(s->sys);
    shell_destroy(s->shell);
    mem_free(s->p);
    mem_free(s->x);
    mem_free(s->gradient);
}

/* Best of many: the machine's other work only ever adds. */
static double hessian_seconds(Sheet *s)
{
    Point at = {.x = s->x, .p = s->p};
    double best = INFINITY;
    for (int k = 0; k < REPEATS; k++) {
        double start = clock_seconds();
        system_hessian(s->sys, &at, s->gradient);
        best = fmin(best, clock_seconds() - start);
    }
    return best;
}

static double factor_seconds(Sheet *s)
{
    double best = INFINITY;
    for (int k = 0; k < REPEATS; k++) {
        double start = clock_seconds();
        if (!system_factor(s->sys, 1e-6)) abort();
        best = fmin(best, clock_seconds() - start);
    }
    return best;
}

void bench_shell_hessian(void)
{
    static const char *const names[] = {[BENDING_MIDEDGE] = "midedge", [BENDING_HINGE] = "hinge"};
    for (BendingModel bending = BENDING_MIDEDGE; bending <= BENDING_HINGE; bending++) {
        Sheet s = make_sheet(bending);
        char name[80];
        bend(&s);
        double seconds = hessian_seconds(&s);
        snprintf(name, sizeof name, "shell_hessian_%s_us_per_triangle", names[bending]);
        bench_print(name, 1e6 * seconds / s.shell->mesh->face_count, "us");
        free_sheet(&s);
    }
}

void bench_newton(void)
{
    static const char *const names[] = {[BENDING_MIDEDGE] = "midedge", [BENDING_HINGE] = "hinge"};
    for (BendingModel bending = BENDING_MIDEDGE; bending <= BENDING_HINGE; bending++) {
        Sheet s = make_sheet(bending);
        NewtonDef def = newton_default();
        char name[80];
        double start = clock_seconds();
        NewtonInfo info = newton_minimize(s.sys, &def, &(Point){.p = s.p}, s.x, NULL);
        double seconds = clock_seconds() - start;
        SparseInfo sparse = system_info(s.sys);
        if (info.status != NEWTON_CONVERGED) abort();
        snprintf(name, sizeof name, "newton_%s_ms_per_iteration", names[bending]);
        bench_print(name, 1e3 * seconds / info.iterations, "ms");
        snprintf(name, sizeof name, "other_over_newton%s", bending == BENDING_HINGE ? "_hinge" : "");
        bench_print(name, 1 - (sparse.factor_seconds + sparse.solve_seconds) / seconds, "ratio");
        free_sheet(&s);
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
    Sheet s = make_sheet(BENDING_MIDEDGE);
    bend(&s);
    double assembly = hessian_seconds(&s), factor = factor_seconds(&s),
           speed = system_info(s.sys).factor_flops / factor;
    bench_print("factor_ms", 1e3 * factor, "ms");
    bench_print("assembly_over_factor", assembly / factor, "ratio");
    bench_print("factor_over_dgemm", speed / dgemm_flops(), "ratio");
    free_sheet(&s);
}
