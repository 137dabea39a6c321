#include "bench/sheet.h"
#include "base/clock.h"
#include "base/memory.h"
#include "bench/bench.h"
#include "surface/shapes.h"
#include <math.h>

enum { REPEATS = 30 };

Sheet sheet_create_fine(int cells, BendingModel bending, bool dynamic)
{
    Sheet s;
    MeshFile file;
    Error err;
    if (!shape_sheet((double[]){0.1, 0.1}, (int[]){cells, cells}, PATTERN_RIGHT, &file, &err))
        bench_fail("%s", err.text);
    Mesh *mesh = mesh_create(&file, 0, NULL, &err);
    mesh_file_clear(&file);
    s.shell = shell_create(mesh, NULL);
    s.shell->thickness = 1e-3, s.shell->poisson = 0.45, s.shell->density = 1000, s.shell->bending = bending;
    for (int v = 0; v < mesh->vertex_count; v++)
        for (int i = 0; mesh->rest[v][0] < 1e-9 && i < 3; i++) shell_fix(s.shell, v, i);
    for (int e = 0; e < mesh->edge_count; e++)
        if (mesh->rest[mesh->edges[e][0]][0] < 1e-9 && mesh->rest[mesh->edges[e][1]][0] < 1e-9)
            shell_clamp(s.shell, e);
    s.sys = dynamic ? shell_dynamic_system(s.shell) : shell_system(s.shell);
    system_build(s.sys);
    s.p = mem_alloc((size_t)s.shell->params.size, sizeof(double));
    s.state = system_state(s.sys);
    s.gradient = mem_alloc((size_t)shell_dof_count(s.shell), sizeof(double));
    shell_default_params(s.shell, s.p);
    for (int f = 0; f < mesh->face_count; f++)
        s.p[s.shell->young + f] = 1e5, s.p[s.shell->magnetization + 3 * f] = 1e4;
    s.p[s.shell->flux.uniform + 2] = dynamic ? 0 : 2e-3;
    s.p[s.shell->gravity + 2] = dynamic ? -9.81 : 0;
    shell_rest_state(s.shell, s.state.x);
    return s;
}

Sheet sheet_create(BendingModel bending, bool dynamic)
{
    return sheet_create_fine(64, bending, dynamic);
}

void sheet_bend(Sheet *s)
{
    const double k = 5;
    for (int v = 0; v < s->shell->mesh->vertex_count; v++) {
        double x = s->shell->mesh->rest[v][0];
        s->state.x[3 * v] = sin(k * x) / k;
        s->state.x[3 * v + 2] = (1 - cos(k * x)) / k;
    }
}

double sheet_hessian_seconds(System *sys, Sheet *s, const double times[2])
{
    double best = INFINITY;
    for (int k = 0; k < REPEATS; k++) {
        Point at = {.x = s->state.x, .p = s->p, .memory = s->state.memory, .time = times[k % 2]};
        double start = clock_seconds();
        system_hessian(sys, &at, s->gradient);
        best = fmin(best, clock_seconds() - start);
    }
    return best;
}

double sheet_factor_seconds(System *sys)
{
    double best = INFINITY;
    for (int k = 0; k < REPEATS; k++) {
        double start = clock_seconds();
        if (!system_factor(sys, 1e-6)) bench_fail("the sheet's Hessian has no factor");
        best = fmin(best, clock_seconds() - start);
    }
    return best;
}

void sheet_destroy(Sheet *s)
{
    system_destroy(s->sys);
    shell_destroy(s->shell);
    mem_free(s->p);
    state_destroy(&s->state);
    mem_free(s->gradient);
}
