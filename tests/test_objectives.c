/* Every objective: gradient against differences of the value, Gauss-Newton product against differences of the
 * gradient. */
#include "base/random.h"
#include "optim/objectives.h"
#include "shell/smoothness.h"
#include "tests/shell_fixture.h"
#include <math.h>
#include <string.h>

static Shell *make_shell(void)
{
    MeshFile file;
    Error err;
    assert_true(shape_hexagram(0.04, 2, &file, &err));
    return shell_of_mesh(&file);
}

typedef struct Fixture {
    Shell *shell;
    int dofs, params;
    double *x, *p, *vx, *vp, *dx, *dp, *hx, *hp;
} Fixture;

static Fixture make_fixture(void)
{
    Fixture f = {.shell = make_shell()};
    Random random = random_seed(11);
    f.dofs = shell_dof_count(f.shell), f.params = f.shell->params.size;
    double **vectors[] = {&f.x, &f.vx, &f.dx, &f.hx, &f.p, &f.vp, &f.dp, &f.hp};
    for (int k = 0; k < 8; k++) {
        int n = k < 4 ? f.dofs : f.params;
        *vectors[k] = mem_alloc((size_t)n, sizeof(double));
        for (int i = 0; (k % 4 < 2) && i < n; i++) (*vectors[k])[i] = random_signed(&random);
    }
    return f;
}

static void free_fixture(Fixture *f)
{
    double *vectors[] = {f->x, f->vx, f->dx, f->hx, f->p, f->vp, f->dp, f->hp};
    for (int k = 0; k < 8; k++) mem_free(vectors[k]);
    shell_destroy(f->shell);
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* Values and gradients at x + s vx, p + s vp; all objectives are at most quadratic, so central differences
 * are exact. */
static double value_at(Fixture *f, Objective objective, double s, double *dx, double *dp)
{
    double *x = mem_copy(f->x, (size_t)f->dofs, sizeof *x), *p = mem_copy(f->p, (size_t)f->params, sizeof *p);
    for (int i = 0; i < f->dofs; i++) x[i] += s * f->vx[i];
    for (int i = 0; i < f->params; i++) p[i] += s * f->vp[i];
    if (dx) memset(dx, 0, (size_t)f->dofs * sizeof *dx);
    if (dp) memset(dp, 0, (size_t)f->params * sizeof *dp);
    double value = objective.ops->value(objective.self, objective.weight, x, p, dx, dp);
    mem_free(x);
    mem_free(p);
    return value;
}

static void check(Fixture *f, Objective objective, bool squares)
{
    double weight = objective.weight,
           slope =
               weight * (value_at(f, objective, 1, NULL, NULL) - value_at(f, objective, -1, NULL, NULL)) / 2;
    value_at(f, objective, 0, f->dx, f->dp);
    double exact = dot(f->dofs, f->dx, f->vx) + dot(f->params, f->dp, f->vp);
    assert_true(fabs(slope - exact) < 1e-12 * (fabs(slope) + 1));
    /* 2 J^T J v is the whole second derivative of a sum of squares of linear residuals. */
    memset(f->hx, 0, (size_t)f->dofs * sizeof *f->hx);
    memset(f->hp, 0, (size_t)f->params * sizeof *f->hp);
    if (objective.ops->product)
        objective.ops->product(objective.self, weight, f->x, f->p, f->vx, f->vp, f->hx, f->hp);
    double curvature = dot(f->dofs, f->hx, f->vx) + dot(f->params, f->hp, f->vp);
    double second = weight * (value_at(f, objective, 1, NULL, NULL) + value_at(f, objective, -1, NULL, NULL) -
                              2 * value_at(f, objective, 0, NULL, NULL));
    assert_true(squares ? curvature > 0 && fabs(curvature - second) < 1e-11 * curvature : curvature == 0);
    objective_destroy(objective);
}

static const ParamBlock *block_of(const Fixture *f, const char *name)
{
    return params_find(&f->shell->params, name);
}

static void test_rows(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Fixture f = make_fixture();
    int vertices[3] = {0, 4, 7};
    double target[3][3] = {{1, 2, 3}, {-1, 0, 1}, {0.5, 0.5, 0.5}};
    check(&f, objective_target(3, vertices, (const double(*)[3])target, 0.7), true);
    target[0][0] = target[1][2] = NAN; /* these coordinates do not count */
    check(&f, objective_target(3, vertices, (const double(*)[3])target, 0.7), true);
    check(&f, objective_height(3, vertices, -2), false);
    check(&f, objective_height_at(3, vertices, 0.3, 0.6), true);
    check(&f, shell_smoothness(f.shell, block_of(&f, "magnetization"), 1.5), true);
    check(&f, shell_smoothness(f.shell, block_of(&f, "fold"), 2.5), true);
    free_fixture(&f);
    assert_int_equal(mem_live_count(), blocks);
}

/* Rows that are not quadratic: gradient against small differences, and where all residuals vanish (x, p as given by the
 * caller) 2 J^T J v against the second difference. */
static void check_curved(Fixture *f, Objective objective, bool at_zero)
{
    double weight = objective.weight, h = 1e-4, F[5];
    for (int k = -2; k <= 2; k++) F[k + 2] = weight * value_at(f, objective, k * h, NULL, NULL);
    value_at(f, objective, 0, f->dx, f->dp);
    double exact = dot(f->dofs, f->dx, f->vx) + dot(f->params, f->dp, f->vp);
    double slope = (8 * (F[3] - F[1]) - (F[4] - F[0])) / (12 * h);
    if (!at_zero) {
        assert_true(fabs(slope - exact) < 1e-8 * (fabs(slope) + 1e-3));
    } else {
        memset(f->hx, 0, (size_t)f->dofs * sizeof *f->hx);
        memset(f->hp, 0, (size_t)f->params * sizeof *f->hp);
        objective.ops->product(objective.self, weight, f->x, f->p, f->vx, f->vp, f->hx, f->hp);
        double curvature = dot(f->dofs, f->hx, f->vx) + dot(f->params, f->hp, f->vp);
        double second = (16 * (F[1] + F[3]) - (F[0] + F[4]) - 30 * F[2]) / (12 * h * h);
        assert_true(fabs(F[2]) < 1e-20 && fabs(curvature - second) < 1e-6 * fabs(second));
    }
    objective_destroy(objective);
}

static void test_point_rows(void **state)
{
    (void)state;
    Fixture f = make_fixture();
    int vertices[3] = {1, 5, 6};
    Probe mean = {vertices, masses_fixed(3, (double[]){0.2, 0.5, 0.3})},
          centre = probe_center(shell_masses(f.shell)),
          vertex = {&vertices[1], masses_fixed(1, (double[]){1})};
    const double points[3][3] = {{-1, 0, 0.1}, {0.2, 0.1, 0}, {0.3, 0.9, -0.2}};
    for (int i = 0; i < f.params; i++) f.p[i] = 1 + 0.5 * f.p[i]; /* no mass is 0 */
    for (int k = 0; k < 5; k++) {                                 /* at five places */
        for (int i = 0; i < f.dofs; i++) f.x[i] = sin(7 * i + k);
        check_curved(&f, objective_waypoint(&mean, points[0], 0.7), false);
        check_curved(&f, objective_polyline(&mean, 3, points, 0.4, 1.3), false);
        check_curved(&f, objective_waypoint(&centre, points[0], 0.7), false);
        check_curved(&f, objective_polyline(&centre, 3, points, 0.4, 1.3), false);
        check_curved(&f, objective_arc(&centre, points, 0.9), false);
        check_curved(&f, objective_polyline(&vertex, 3, points, 1e-3, 1.3), false);
        check_curved(&f, objective_arc(&vertex, points, 0.9), false);
    }
    for (int i = 0; i < 3; i++) f.x[15 + i] = points[1][i];
    check_curved(&f, objective_waypoint(&vertex, points[1], 0.7), true);
    check_curved(&f, objective_arc(&vertex, points, 0.9), true);
    for (int i = 0; i < 3; i++) f.x[15 + i] = (points[0][i] + points[1][i]) / 2; /* inside a segment */
    check_curved(&f, objective_polyline(&vertex, 3, points, 0.01, 1.3), true);
    double at[3];
    vec3_store(at, probe_at(&centre, f.x, f.p));
    check_curved(&f, objective_waypoint(&centre, at, 0.7), true);
    masses_clear(&mean.masses);
    masses_clear(&vertex.masses);
    probe_clear(&centre);
    free_fixture(&f);
}

/* Points near the line of three segments, as it is seen along y, and on it. */
static void test_cloud(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Fixture f = make_fixture();
    int segments[3][2] = {{0, 4}, {4, 7}, {7, 9}};
    double points[5][3];
    for (int k = 0; k < 5; k++) /* within a segment, beyond the ends, near a corner */
        for (int i = 0; i < 3; i++)
            points[k][i] = (k < 3 ? 0.6 * f.x[3 * segments[k][0] + i] + 0.4 * f.x[3 * segments[k][1] + i]
                                  : f.x[3 * (k == 3 ? 0 : 7) + i]) +
                           0.1 * (k + i);
    PointCloud cloud = {3, 5, segments, points, 0.4};
    check_curved(&f, objective_cloud(&cloud, 1.3), false);
    cloud.blend = 1e-3;
    check_curved(&f, objective_cloud(&cloud, 1.3), false);
    for (int k = 0; k < 5; k++) points[k][1] = NAN;
    check_curved(&f, objective_cloud(&cloud, 1.3), false);
    cloud.blend = 0.4;
    check_curved(&f, objective_cloud(&cloud, 1.3), false);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            points[k][i] = 0.6 * f.x[3 * segments[k][0] + i] + 0.4 * f.x[3 * segments[k][1] + i];
    cloud.point_count = 3, cloud.blend = 1e-3; /* in space, where the segments do not cross */
    check_curved(&f, objective_cloud(&cloud, 1.3), true);
    /* A point's distance to a straight line, to its end, and between two equal halves of it. */
    double x[9] = {0, 0, 0, 1, 5, 0, 2, -5, 0}, seen[3][3] = {{0.5, NAN, 0.25}, {3, NAN, 0}, {1, NAN, 2}};
    PointCloud exact = {2, 3, (int[2][2]){{0, 1}, {1, 2}}, seen, 1e-3};
    Objective objective = objective_cloud(&exact, 1);
    assert_true(fabs(objective.ops->value(objective.self, 1, x, NULL, NULL, NULL) - (0.0625 + 1 + 4)) <
                1e-14);
    objective_destroy(objective);
    free_fixture(&f);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_curve_distances(void **state)
{
    (void)state;
    double x[3] = {0.5, 0.25, 0}, one = 1, r = sqrt(0.5);
    int vertex = 0;
    Probe probe = {&vertex, masses_fixed(1, &one)};
    const double corner[3][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}},
                 quarter[3][3] = {{1, 0, 0}, {r, r, 0}, {0, 1, 0}};
    Objective polyline = objective_polyline(&probe, 3, corner, 1e-3, 1),
              arc = objective_arc(&probe, quarter, 1);
    assert_true(fabs(objective_distance(&polyline, x, NULL) - 0.25) < 1e-15);
    assert_true(fabs(polyline.ops->value(polyline.self, 1, x, NULL, NULL, NULL) - 0.0625) < 1e-15);
    assert_true(fabs(objective_distance(&arc, x, NULL) - (1 - sqrt(0.3125))) < 1e-14);
    x[0] = 0.5, x[1] = -0.5; /* beyond the arc's start, and of two equal segments */
    assert_true(fabs(objective_distance(&arc, x, NULL) - r) < 1e-14);
    x[0] = x[1] = 0, x[2] = 2;
    assert_true(fabs(objective_distance(&arc, x, NULL) - sqrt(5)) < 1e-14);
    Objective waypoint = objective_waypoint(&probe, corner[0], 1);
    Objective height = objective_height(1, &vertex, 1);
    assert_true(fabs(objective_distance(&waypoint, x, NULL) - 2) < 1e-15 &&
                isnan(objective_distance(&height, x, NULL)));
    objective_destroy(height);
    objective_destroy(polyline);
    objective_destroy(arc);
    objective_destroy(waypoint);
    masses_clear(&probe.masses);
}

enum { CONTROL_STEPS = 9, PAIRS = 2 };

/* A control in the shell's first rows of magnetisation, the pairs after it. */
static void test_field_rows(void **state)
{
    (void)state;
    Fixture f = make_fixture();
    int at = f.shell->magnetization, omega = at + 3 * CONTROL_STEPS, alpha = omega + PAIRS,
        beta = alpha + 3 * PAIRS;
    for (ControlKind kind = CONTROL_FRAME; kind <= CONTROL_HARMONIC; kind++) {
        Control control = {.kind = kind,
                           .from = at,
                           .rows = control_rows(kind, CONTROL_STEPS, kind == CONTROL_KNOT ? 4 : 3),
                           .width = 3,
                           .steps = CONTROL_STEPS,
                           .duration = 2};
        check(&f, objective_field_magnitude(&control, 0.3), true);
        check(&f, objective_field_smoothness(&control, 0.3), true);
        check_curved(&f, objective_dmp(&control, PAIRS, omega, alpha, beta, 0.8), false);
    }
    Control control = {.kind = CONTROL_FRAME,
                       .from = at,
                       .rows = CONTROL_STEPS,
                       .width = 3,
                       .steps = CONTROL_STEPS,
                       .duration = 2};
    for (int n = 1; n <= CONTROL_STEPS; n++)
        for (int i = 0; i < 3; i++) {
            double t = control_time(&control, n), *b = &f.p[at + 3 * (n - 1) + i];
            *b = 0;
            for (int j = 0; j < PAIRS; j++)
                *b += f.p[alpha + 3 * j + i] * cos(f.p[omega + j] * t) +
                      f.p[beta + 3 * j + i] * sin(f.p[omega + j] * t);
        }
    check_curved(&f, objective_dmp(&control, PAIRS, omega, alpha, beta, 0.8), true);
    free_fixture(&f);
}

/* Amplitudes that a DMP row begins with: no others fit the field better, and they are those of a field that is made of its
 * harmonics. */
static void test_dmp_start(void **state)
{
    (void)state;
    enum {
        STEPS = 9,
        OMEGA = 3 * STEPS,
        ALPHA = OMEGA + PAIRS,
        BETA = ALPHA + 3 * PAIRS,
        ALL = BETA + 3 * PAIRS
    };
    Control control = {
        .kind = CONTROL_FRAME, .rows = STEPS, .width = 3, .steps = STEPS, .start = 1, .duration = 4};
    double p[ALL] = {0}, dp[ALL] = {0};
    for (int k = 0; k < 3 * STEPS; k++) p[k] = sin(k * k);
    objective_dmp_start(&control, PAIRS, OMEGA, ALPHA, BETA, p);
    Objective row = objective_dmp(&control, PAIRS, OMEGA, ALPHA, BETA, 1);
    assert_true(row.ops->value(row.self, 1, NULL, p, NULL, dp) > 1);
    for (int k = ALPHA; k < ALL; k++) assert_true(fabs(dp[k]) < 1e-13);
    for (int n = 1; n <= STEPS; n++)
        p[3 * n - 1] = 0.3 * cos(p[OMEGA] * control_time(&control, n)) -
                       2 * sin(p[OMEGA + 1] * control_time(&control, n));
    for (int k = ALPHA; k < ALL; k++) p[k] = 0;
    objective_dmp_start(&control, PAIRS, OMEGA, ALPHA, BETA, p);
    assert_true(fabs(p[ALPHA + 2] - 0.3) < 1e-14 && fabs(p[BETA + 5] + 2) < 1e-14);
    objective_destroy(row);
}

/* A spline goes through its knots and is linear where they are; harmonics have the whole time as period. */
static void test_controls(void **state)
{
    (void)state;
    double p[15], value[3], before[3], after[3];
    Control knots = {.kind = CONTROL_KNOT, .rows = 5, .width = 3, .steps = 8, .start = 1, .duration = 4};
    for (int k = 0; k < 15; k++) p[k] = sin(k);
    for (int k = 0; k < 5; k++) {
        control_value(&knots, 1, 1 + k, p, value);
        for (int i = 0; i < 3; i++) assert_true(fabs(value[i] - p[3 * k + i]) < 1e-15);
        double h = 1e-6; /* one slope on both sides */
        control_value(&knots, 1, 1 + k - h, p, before);
        control_value(&knots, 1, 1 + k + h, p, after);
        for (int i = 0; k > 0 && k < 4 && i < 3; i++)
            assert_true(fabs((after[i] - value[i]) - (value[i] - before[i])) < 1e-10);
    }
    for (int k = 0; k < 15; k++) p[k] = 2 + k / 3;
    control_value(&knots, 1, 3.3, p, value);
    assert_true(fabs(value[1] - 4.3) < 1e-14);
    Control harmonics = {
        .kind = CONTROL_HARMONIC, .rows = 3, .width = 1, .steps = 8, .start = 1, .duration = 4};
    p[0] = 5, p[1] = 2, p[2] = 3;
    control_value(&harmonics, 1, 2, p, value); /* a quarter of the period */
    assert_true(fabs(value[0] - 8) < 1e-14);
    control_value(&harmonics, 8, 5, p, value);
    assert_true(fabs(value[0] - 7) < 1e-14);
}

static void test_young_smoothness(void **state)
{
    (void)state;
    Fixture f = make_fixture();
    double *young = f.p + f.shell->young;
    for (int i = 0; i < f.shell->mesh->face_count; i++) young[i] = 3 + sin(5 * i);
    check_curved(&f, shell_smoothness(f.shell, block_of(&f, "young"), 0.7), false);
    for (int i = 0; i < f.shell->mesh->face_count; i++) young[i] = 3;
    check_curved(&f, shell_smoothness(f.shell, block_of(&f, "young"), 0.7), true);
    double *thickness = f.p + f.shell->face_thickness;
    for (int i = 0; i < f.shell->mesh->face_count; i++) thickness[i] = 2 + sin(3 * i);
    check_curved(&f, shell_smoothness(f.shell, block_of(&f, "thickness"), 0.7), false);
    free_fixture(&f);
}

/* Closed forms. */
static void test_values(void **state)
{
    (void)state;
    Fixture f = make_fixture();
    int vertices[2] = {1, 2};
    double target[2][3] = {{0}, {0}};
    memset(f.x, 0, (size_t)f.dofs * sizeof *f.x);
    f.x[3] = 3, f.x[4] = 4, f.x[8] = 2;
    Objective objective = objective_target(2, vertices, (const double(*)[3])target, 1);
    assert_true(objective.ops->value(objective.self, 1, f.x, f.p, NULL, NULL) == 29);
    objective_destroy(objective);
    objective = objective_height(2, vertices, 1);
    assert_true(objective.ops->value(objective.self, 1, f.x, f.p, NULL, NULL) == 1);
    objective_destroy(objective);
    objective = shell_smoothness(f.shell, block_of(&f, "magnetization"), 1);
    for (int i = 0; i < 3 * f.shell->mesh->face_count; i++) f.p[f.shell->magnetization + i] = 5;
    assert_true(objective.ops->value(objective.self, 1, f.x, f.p, NULL, NULL) == 0);
    f.p[f.shell->magnetization] = 7; /* one face: 4 for each of its inner edges */
    int inner = 0;
    for (int i = 0; i < 3; i++)
        inner += !mesh_edge_is_boundary(f.shell->mesh, f.shell->mesh->face_edges[0][i]);
    assert_true(objective.ops->value(objective.self, 1, f.x, f.p, NULL, NULL) == 4 * inner);
    objective_destroy(objective);
    objective = shell_smoothness(f.shell, block_of(&f, "young"), 1);
    for (int i = 0; i < f.shell->mesh->face_count; i++) f.p[f.shell->young + i] = i ? 1e5 : 1e7;
    double jump = log(100), value = objective.ops->value(objective.self, 1, f.x, f.p, NULL, NULL);
    assert_true(fabs(value - jump * jump * inner) < 1e-12 * value);
    objective_destroy(objective);
    objective = shell_smoothness(f.shell, block_of(&f, "fold"), 1);
    for (int i = 0; i < f.shell->mesh->edge_count; i++) f.p[f.shell->fold + i] = 1;
    f.p[f.shell->fold + f.shell->mesh->face_edges[0][0]] = 4; /* 9 to each of two edges of its faces */
    int beside = mesh_edge_is_boundary(f.shell->mesh, f.shell->mesh->face_edges[0][0]) ? 1 : 2;
    assert_true(objective.ops->value(objective.self, 1, f.x, f.p, NULL, NULL) == 9 * 2 * beside);
    objective_destroy(objective);
    free_fixture(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows),       cmocka_unit_test(test_point_rows),
        cmocka_unit_test(test_field_rows), cmocka_unit_test(test_curve_distances),
        cmocka_unit_test(test_cloud),      cmocka_unit_test(test_dmp_start),
        cmocka_unit_test(test_controls),   cmocka_unit_test(test_young_smoothness),
        cmocka_unit_test(test_values)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
