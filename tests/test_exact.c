/* Closed forms: the hard-magnetic elastica on every triangulation. */
#include "base/random.h"
#include "solve/eigen.h"
#include "solve/newton.h"
#include "tests/shell_fixture.h"
#include <math.h>

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
    Shell *shell = shell_of_mesh(&file);
    shell->thickness = THICKNESS, shell->poisson = 0, shell->density = 1000;
    hold_root(shell, true);
    return shell;
}

/* Magnetised along x, load number q = 12 M B L^2/(Y h^2) with B along direction. */
static Body make_problem(ShapePattern pattern, int cells, double q, const double direction[3])
{
    Shell *shell = make_strip(pattern, cells);
    Body s = body_create(shell, shell_system(shell), YOUNG);
    for (int f = 0; f < shell->mesh->face_count; f++) s.p[shell->magnetization + 3 * f] = MAGNETIZATION;
    double B = q * YOUNG * THICKNESS * THICKNESS / (12 * MAGNETIZATION * LENGTH * LENGTH);
    for (int i = 0; i < 3; i++) s.p[shell->flux.uniform + i] = B * direction[i];
    return s;
}

/* Mean position of the end x = L, over L. */
static void mean_tip(const Body *s, double *along, double *up)
{
    const Mesh *mesh = s->shell->mesh;
    int count = 0;
    *along = *up = 0;
    for (int v = 0; v < mesh->vertex_count; v++) {
        if (fabs(mesh->rest[v][0] - LENGTH) > 1e-9) continue;
        *along += s->state.x[3 * v] / LENGTH;
        *up += s->state.x[3 * v + 2] / LENGTH;
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
        Body s = make_problem((ShapePattern)pattern, 32, 4, (double[]){0, 0, 1});
        NewtonDef def = newton_default();
        NewtonInfo info = newton_minimize(s.sys, &def, &(Point){.p = s.p}, &s.state, NULL);
        assert_int_equal(info.status, NEWTON_CONVERGED);
        double along, up;
        mean_tip(&s, &along, &up);
        print_message("pattern %d: tip %.6f %.6f, %d iterations\n", pattern, along, up, info.iterations);
        assert_true(fabs(along - 0.671058757753) < 1e-3 && fabs(up - 0.669964181278) < 1e-3);
        body_clear(&s);
    }
    assert_int_equal(mem_live_count(), blocks);
}

/* The equilibrium that stays in the plane. */
static void compress(Body *s)
{
    Shell *shell = s->shell;
    for (int v = 0; v < shell->mesh->vertex_count; v++) shell_fix(shell, v, 2);
    System *planar = shell_system(shell);
    NewtonDef def = newton_default();
    NewtonInfo info = newton_minimize(planar, &def, &(Point){.p = s->p}, &s->state, NULL);
    assert_int_equal(info.status, NEWTON_CONVERGED);
    system_destroy(planar);
}

/* Antiparallel: the straight strip's lowest eigenvalue changes sign at q = pi^2/4, and above it the strip
 * buckles. */
static void test_buckling(void **state)
{
    (void)state;
    for (int above = 0; above < 2; above++) {
        double q = (above ? 1.01 : 0.99) * M_PI * M_PI / 4, along, up;
        Body s = make_problem(PATTERN_RIGHT, 32, q, (double[]){-1, 0, 0});
        double lowest[3];
        compress(&s);
        Point straight = state_point(&s.state, s.p);
        assert_true(eigen_lowest(s.sys, &straight, NULL, 3, lowest, NULL));
        print_message("q = %.4f: lowest eigenvalues of the straight strip %.3e %.3e %.3e N/m\n", q, lowest[0],
                      lowest[1], lowest[2]);
        assert_true(above ? lowest[0] < 0 : lowest[0] > 0);
        assert_true(lowest[0] < lowest[1] && lowest[1] < lowest[2]);
        NewtonDef def = newton_default();
        NewtonInfo info = newton_minimize(s.sys, &def, &(Point){.p = s.p}, &s.state, NULL);
        assert_int_equal(info.status, NEWTON_CONVERGED);
        mean_tip(&s, &along, &up);
        print_message("q = %.4f: tip height %.2e L, %d iterations\n", q, up, info.iterations);
        assert_true(above ? fabs(up) > 0.01 : fabs(up) < 1e-6);
        body_clear(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_elastica), cmocka_unit_test(test_buckling)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
