/* Closed forms: the hard-magnetic elastica on every triangulation. */
#include "base/memory.h"
#include "base/random.h"
#include "shell/shapes.h"
#include "shell/shell.h"
#include "solve/eigen.h"
#include "solve/newton.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

static const double LENGTH = 0.02, WIDTH = 0.005, THICKNESS = 4e-4, YOUNG = 1e6, MAGNETIZATION = 1e5;

enum { UNSTRUCTURED = PATTERN_CROSSED + 1 }; /* a triangulation of no order */

/* Vertices within the strip moved at random, by up to 0.3 cells; at the ends they stay on their lines. */
static void scatter(MeshFile *file, int cells)
{
    Random random = random_seed(21);
    double cell = LENGTH / cells;
    for (int v = 0; v < file->vertex_count; v++) {
        double *x = file->vertices[v];
        double along = 0.3 * cell * random_signed(&random), across = 0.3 * cell * random_signed(&random);
        if (x[0] > 1e-9 && x[0] < LENGTH - 1e-9) x[0] += along;
        if (x[1] > 1e-9 && x[1] < WIDTH - 1e-9) x[1] += across;
    }
}

/* A strip along x, clamped at x = 0. */
static Shell *make_strip(ShapePattern pattern, int cells)
{
    MeshFile file = {0};
    Error err;
    bool unstructured = (int)pattern == UNSTRUCTURED;
    assert_true(shape_sheet((double[]){LENGTH, WIDTH}, (int[]){cells, cells / 4},
                            unstructured ? PATTERN_ALTERNATE : pattern, &file, &err));
    if (unstructured) scatter(&file, cells);
    Mesh *mesh = mesh_create(&file, 0, NULL, &err);
    mesh_file_clear(&file);
    assert_non_null(mesh);
    Shell *shell = shell_create(mesh);
    shell->thickness = THICKNESS, shell->poisson = 0, shell->density = 1000;
    for (int e = 0; e < mesh->edge_count; e++) {
        const int *v = mesh->edges[e];
        if (mesh->rest[v[0]][0] > 1e-9 || mesh->rest[v[1]][0] > 1e-9) continue;
        shell_clamp(shell, e);
        for (int i = 0; i < 6; i++) shell_fix(shell, v[i / 3], i % 3);
    }
    return shell;
}

typedef struct Strip {
    Shell *shell;
    System *sys;
    double *p, *x;
} Strip;

/* Magnetised along x, load number q = 12 M B L^2/(Y h^2) with B along direction. */
static Strip make_problem(ShapePattern pattern, int cells, double q, const double direction[3])
{
    Strip s = {.shell = make_strip(pattern, cells)};
    s.sys = shell_system(s.shell);
    s.p = mem_alloc((size_t)s.shell->params.size, sizeof(double));
    s.x = mem_alloc((size_t)shell_dof_count(s.shell), sizeof(double));
    shell_default_params(s.shell, s.p);
    shell_rest_state(s.shell, s.x);
    for (int f = 0; f < s.shell->mesh->face_count; f++) {
        s.p[s.shell->young + f] = YOUNG;
        s.p[s.shell->magnetization + 3 * f] = MAGNETIZATION;
    }
    double B = q * YOUNG * THICKNESS * THICKNESS / (12 * MAGNETIZATION * LENGTH * LENGTH);
    for (int i = 0; i < 3; i++) s.p[s.shell->flux_density + i] = B * direction[i];
    return s;
}

static void free_problem(Strip *s)
{
    system_destroy(s->sys);
    shell_destroy(s->shell);
    mem_free(s->p);
    mem_free(s->x);
}

/* Mean position of the end x = L, over L. */
static void mean_tip(const Strip *s, double *along, double *up)
{
    const Mesh *mesh = s->shell->mesh;
    int count = 0;
    *along = *up = 0;
    for (int v = 0; v < mesh->vertex_count; v++) {
        if (fabs(mesh->rest[v][0] - LENGTH) > 1e-9) continue;
        *along += s->x[3 * v] / LENGTH;
        *up += s->x[3 * v + 2] / LENGTH;
        count++;
    }
    *along /= count;
    *up /= count;
}

/* q = 4, B across: tip at (0.671058757753, 0.669964181278) L  [docs: shell checks]. */
static void test_elastica(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    for (int pattern = PATTERN_RIGHT; pattern <= UNSTRUCTURED; pattern++) {
        Strip s = make_problem((ShapePattern)pattern, 32, 4, (double[]){0, 0, 1});
        NewtonDef def = newton_default();
        NewtonInfo info = newton_minimize(s.sys, &def, &(Point){.p = s.p}, s.x, NULL);
        assert_int_equal(info.status, NEWTON_CONVERGED);
        double along, up;
        mean_tip(&s, &along, &up);
        print_message("pattern %d: tip %.6f %.6f, %d iterations\n", pattern, along, up, info.iterations);
        assert_true(fabs(along - 0.671058757753) < 1e-3 && fabs(up - 0.669964181278) < 1e-3);
        free_problem(&s);
    }
    assert_int_equal(mem_live_count(), blocks);
}

/* The equilibrium that stays in the plane. */
static void compress(Strip *s)
{
    Shell *shell = s->shell;
    for (int v = 0; v < shell->mesh->vertex_count; v++) shell_fix(shell, v, 2);
    System *planar = shell_system(shell);
    NewtonDef def = newton_default();
    assert_int_equal(newton_minimize(planar, &def, &(Point){.p = s->p}, s->x, NULL).status, NEWTON_CONVERGED);
    system_destroy(planar);
}

/* Antiparallel: the straight strip's lowest eigenvalue changes sign at q = pi^2/4, and above it the strip
 * buckles. */
static void test_buckling(void **state)
{
    (void)state;
    for (int above = 0; above < 2; above++) {
        double q = (above ? 1.01 : 0.99) * M_PI * M_PI / 4, along, up;
        Strip s = make_problem(PATTERN_RIGHT, 32, q, (double[]){-1, 0, 0});
        double lowest[3];
        compress(&s);
        Point straight = {.x = s.x, .p = s.p};
        assert_true(eigen_lowest(s.sys, &straight, 3, lowest, NULL));
        print_message("q = %.4f: lowest eigenvalues of the straight strip %.3e %.3e %.3e N/m\n", q, lowest[0],
                      lowest[1], lowest[2]);
        assert_true(above ? lowest[0] < 0 : lowest[0] > 0);
        assert_true(lowest[0] < lowest[1] && lowest[1] < lowest[2]);
        NewtonDef def = newton_default();
        NewtonInfo info = newton_minimize(s.sys, &def, &(Point){.p = s.p}, s.x, NULL);
        assert_int_equal(info.status, NEWTON_CONVERGED);
        mean_tip(&s, &along, &up);
        print_message("q = %.4f: tip height %.2e L, %d iterations\n", q, up, info.iterations);
        assert_true(above ? fabs(up) > 0.01 : fabs(up) < 1e-6);
        free_problem(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_elastica), cmocka_unit_test(test_buckling)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
