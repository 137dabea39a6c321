/* The adjoint of a motion in time: against the tangent, against differences, with and without kept factors,
 * for fields over time, magnetisation, stiffness, folds and the start; cut steps, moved vertices, and contact with
 * friction included.
 */
#include "base/random.h"
#include "optim/objectives.h"
#include "optim/trajectory_adjoint.h"
#include "tests/shell_fixture.h"
#include "world/obstacle_shapes.h"
#include <math.h>
#include <string.h>

enum { STEPS = 12, GOALS = 4 };

typedef struct Fixture {
    Shell *shell;
    Design design;
    Control control;
    Objective objectives[GOALS];
    TrajectoryProblem problem;
    TrajectoryDef def;
    State start;
    double *u, *v, *gradient;
} Fixture;

/* The held edge shakes. */
static bool shake(void *self, double time, double *x)
{
    const Shell *shell = self;
    for (int v = 0; v < shell->mesh->vertex_count; v++)
        if (shell->mesh->rest[v][0] < 1e-9) x[3 * v + 2] = 2e-4 * sin(400 * time);
    return true;
}

typedef enum Ground { NO_GROUND, LAGGED, IMPLICIT } Ground;

/* A slope under the strip and a ball that is rolled over it, with friction; middles of edges and faces touch, too. */
static void add_ground(Shell *shell, bool implicit)
{
    Obstacle *list = mem_alloc(2, sizeof *list);
    list[0] = obstacle_plane((double[]){0, 0, -2.5e-4}, (double[]){0.05, 0.02, 1});
    list[1] = obstacle_sphere((double[]){0.008, 0.002, 2.3e-3}, 2e-3, false);
    list[1].feature = 1e-3;
    list[1].motion.move = (Timed){.first = TIMED_ALONE,
                                  .formula = formula_create((const char *[]){"0.1*t", "0", "-0.01*t"}, 3,
                                                            NULL, 0, (const char *const[]){"t", NULL}, NULL)};
    list[1].motion.turn = (Timed){.first = TIMED_ALONE,
                                  .formula = formula_create((const char *[]){"0", "50*t", "10*t"}, 3, NULL, 0,
                                                            (const char *const[]){"t", NULL}, NULL)};
    WorldBody body = shell_world_body(shell);
    shell->world = world_create(&body, list, 2);
    shell->world->rubs = true, shell->world->implicit = implicit;
    shell->world->slip_speed = 0.01;
    world_add_params(shell->world, &shell->params);
}

static Shell *make_shell(BendingModel bending, Ground ground)
{
    Shell *shell = shell_of_sheet((double[]){0.012, 0.004}, (int[]){6, 2}, PATTERN_ALTERNATE);
    shell->thickness = 4e-4, shell->poisson = 0.4, shell->density = 1000, shell->bending = bending;
    hold_root(shell, true);
    if (ground) add_ground(shell, ground == IMPLICIT);
    return shell;
}

static void add_unknowns(Fixture *f, ControlKind kind)
{
    Params *params = &f->shell->params;
    int rows = control_rows(kind, STEPS, kind == CONTROL_KNOT ? 5 : 2);
    f->control = (Control){.kind = kind,
                           .from = params_add(params, "control", "T", rows, 3, false),
                           .to = f->shell->flux.uniform,
                           .rows = rows,
                           .width = 3,
                           .steps = STEPS,
                           .duration = 1e-3 * STEPS};
    f->design.case_count = 1;
    const char *const names[] = {"control", "magnetization", "young", "fold", "thickness", "density"};
    const double scales[] = {0.01, 1e4, 1, 0.2, 0.2, 0.2};
    for (int k = 0; k < 6; k++) {
        const ParamBlock *block = params_find(params, names[k]);
        design_add(&f->design, (Unknown){.block = block,
                                         .group_count = block->count,
                                         .map = k < 2 ? UNKNOWN_LINEAR : UNKNOWN_LOG,
                                         .scale = scales[k],
                                         .lower = -INFINITY,
                                         .upper = INFINITY});
    }
}

static void start_params(Fixture *f, double *p, Random *random)
{
    shell_default_params(f->shell, p);
    for (int k = 0; k < f->shell->mesh->face_count; k++) {
        p[f->shell->young + k] = 1e5 * (1 + 0.2 * random_signed(random));
        for (int i = 0; i < 3; i++)
            p[f->shell->magnetization + 3 * k + i] = (i == 0 ? 5e4 : 0) + 1e4 * random_signed(random);
    }
    p[f->shell->damping] = 1e-5;
    if (f->shell->world) {
        p[f->shell->gravity + 2] = -200;
        p[f->shell->world->stiffness] = 100;
        p[f->shell->world->friction] = 0.5, p[f->shell->world->friction + 1] = 0.3;
    }
    for (int i = 0; i < 3 * f->control.rows; i++) p[f->control.from + i] = 0.02 * random_signed(random);
}

static void make(Fixture *f, BendingModel bending, Ground ground, ControlKind kind, bool moving)
{
    Random random = random_seed(7);
    *f = (Fixture){.shell = make_shell(bending, ground), .def = trajectory_default()};
    f->def.march.implicit = ground == IMPLICIT;
    add_unknowns(f, kind);
    size_t size = (size_t)f->design.size;
    double *p = mem_alloc((size_t)f->shell->params.size, sizeof *p);
    f->u = mem_alloc(size, sizeof(double));
    f->v = mem_alloc(size, sizeof(double));
    f->gradient = mem_alloc(size, sizeof(double));
    start_params(f, p, &random);
    design_read(&f->design, 0, p, f->u);
    for (size_t i = 0; i < size; i++) f->v[i] = random_signed(&random);
    System *sys = shell_dynamic_system(f->shell);
    State start = f->start = system_state(sys);
    shell_rest_state(f->shell, start.x);
    for (int i = 0; i < system_position_count(sys); i++)
        if (!system_is_fixed(sys, i))
            start.x[i] += 5e-5 * random_signed(&random), start.v[i] = 0.05 * random_signed(&random);
    system_accept(sys, start.x, start.memory);
    int tip = mesh_group(f->shell->mesh, "tip", 0)->members[0], others[2] = {tip, 3};
    const double goal[1][3] = {{0.010, 0.002, 0.004}},
                 goals[2][3] = {{0.011, 0.001, 0.003}, {0.006, 0, 0.001}};
    f->objectives[0] = objective_target(1, &tip, goal, 1e4);
    f->objectives[0].first = 4, f->objectives[0].last = STEPS;
    f->objectives[1] = objective_target(2, others, goals, 2e4);
    f->objectives[1].first = f->objectives[1].last = 7;
    Probe center = probe_center(shell_masses(f->shell));
    f->objectives[2] = objective_waypoint(&center, goals[1], 3e4);
    f->objectives[2].first = 5, f->objectives[2].last = STEPS;
    probe_clear(&center);
    f->objectives[3] = objective_height(1, &tip, -3);
    f->objectives[3].first = f->objectives[3].last = STEPS;
    if (moving) f->def.march.move = shake, f->def.march.self = f->shell;
    f->problem = (TrajectoryProblem){.sys = sys,
                                     .design = &f->design,
                                     .params = &f->shell->params,
                                     .controls = &f->control,
                                     .objectives = f->objectives,
                                     .control_count = 1,
                                     .objective_count = GOALS,
                                     .start = &f->start,
                                     .step = 1e-3,
                                     .steps = STEPS,
                                     .p = p};
}

static void clear(Fixture *f)
{
    for (int k = 0; k < GOALS; k++) objective_destroy(f->objectives[k]);
    system_destroy(f->problem.sys);
    mem_free(f->problem.p);
    design_clear(&f->design);
    shell_destroy(f->shell);
    state_destroy(&f->start);
    double *owned[] = {f->u, f->v, f->gradient};
    for (int k = 0; k < 3; k++) mem_free(owned[k]);
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* dF by the tangent's motion. */
static double by_tangent(Fixture *f, Trajectory *t)
{
    int dofs = shell_dof_count(f->shell);
    size_t all = (size_t)(STEPS + 1) * (size_t)dofs, params = (size_t)f->shell->params.size;
    double *dx = mem_alloc(all, sizeof *dx), *seed = mem_alloc((size_t)dofs, sizeof *seed), sum = 0,
           *dp = mem_alloc(params, sizeof *dp), *gp = mem_alloc(params, sizeof *gp);
    trajectory_tangent(t, f->v, dx);
    design_forward(&f->design, 0, f->u, f->v, dp);
    for (int k = 0; k < GOALS; k++)
        for (int n = f->objectives[k].first; n <= f->objectives[k].last; n++) {
            memset(seed, 0, (size_t)dofs * sizeof *seed);
            f->objectives[k].ops->value(f->objectives[k].self, f->objectives[k].weight,
                                        trajectory_frame(t, n).x, trajectory_params(t, n), seed, gp);
            sum += dot(dofs, seed, dx + (size_t)n * (size_t)dofs);
        }
    sum += dot((int)params, gp, dp);
    mem_free(dx);
    mem_free(seed);
    mem_free(dp);
    mem_free(gp);
    return sum;
}

/* dF by central differences along f->v, or of the start along its own free positions' (dx, dv). */
static double by_differences(Fixture *f, double h, const double *dx, const double *dv)
{
    int dofs = shell_dof_count(f->shell), size = f->design.size;
    double F[2], *u = mem_alloc((size_t)size, sizeof *u);
    State start = state_clone(&f->start);
    for (int side = 0; side < 2; side++) {
        double s = side ? h : -h;
        Fixture g = *f;
        TrajectoryInfo info;
        for (int i = 0; i < size; i++) u[i] = f->u[i] + (dx ? 0 : s * f->v[i]);
        for (int i = 0; i < dofs; i++) {
            start.x[i] = f->start.x[i] + (dx ? s * dx[i] : 0);
            start.v[i] = f->start.v[i] + (dv ? s * dv[i] : 0);
        }
        g.problem.start = &start;
        Trajectory *t = trajectory_create(&g.problem, &g.def);
        F[side] = trajectory_evaluate(t, u, NULL, &info);
        trajectory_destroy(t);
    }
    mem_free(u);
    state_destroy(&start);
    return (F[1] - F[0]) / (2 * h);
}

static void check_start(Fixture *f, Trajectory *t, double *worst)
{
    size_t dofs = (size_t)shell_dof_count(f->shell);
    double *work = mem_alloc(4 * dofs, sizeof *work), *gx = work, *gv = work + dofs, *dx = gv + dofs,
           *dv = dx + dofs;
    Random random = random_seed(9);
    trajectory_gradients(t, NULL, gx, gv);
    for (int i = 0; i < system_position_count(f->problem.sys); i++)
        if (!system_is_fixed(f->problem.sys, i))
            dx[i] = 1e-3 * random_signed(&random), dv[i] = random_signed(&random);
    double exact = dot((int)dofs, gx, dx) + dot((int)dofs, gv, dv), seen = by_differences(f, 1e-4, dx, dv);
    *worst = fabs(exact - seen) / fabs(exact);
    mem_free(work);
}

static const char *const kinds[] = {"frame", "knot", "harmonic"};

/* The same gradient where no factors are kept: its largest difference. */
static double off_without_factors(Fixture *f)
{
    TrajectoryInfo info;
    double *again = mem_alloc((size_t)f->design.size, sizeof *again), worst = 0;
    f->def.factor_memory = 0;
    Trajectory *t = trajectory_create(&f->problem, &f->def);
    trajectory_evaluate(t, f->u, again, &info);
    for (int i = 0; i < f->design.size; i++) worst = fmax(worst, fabs(again[i] - f->gradient[i]));
    trajectory_destroy(t);
    mem_free(again);
    return worst;
}

static void check(BendingModel bending, ControlKind kind, bool moving, bool cuts)
{
    Fixture f;
    TrajectoryInfo info;
    make(&f, bending, NO_GROUND, kind, moving);
    if (cuts) f.def.march.newton.max_iterations = 6;
    f.def.march.newton.energy_tol = 1e-14;
    Trajectory *t = trajectory_create(&f.problem, &f.def);
    double F = trajectory_evaluate(t, f.u, f.gradient, &info), start_error;
    assert_true(isfinite(F));
    assert_true(!cuts || info.march.refused > 0);
    trajectory_accept(t);
    double adjoint = dot(f.design.size, f.gradient, f.v), tangent = by_tangent(&f, t);
    double seen = by_differences(&f, 1e-4, NULL, NULL);
    check_start(&f, t, &start_error);
    trajectory_destroy(t);

    double worst = off_without_factors(&f);
    print_message("%s %-8s%s%s: tangent %.1e, differences %.1e, of the start %.1e\n",
                  bending == BENDING_HINGE ? "hinge  " : "midedge", kinds[kind], moving ? " moving" : "",
                  cuts ? " cuts" : "", fabs(adjoint - tangent) / fabs(tangent),
                  fabs(adjoint - seen) / fabs(seen), start_error);
    assert_true(fabs(adjoint - tangent) < 1e-11 * fabs(tangent));
    assert_true(fabs(adjoint - seen) < 1e-6 * fabs(seen) && start_error < 1e-6);
    assert_true(worst == 0); /* the same factors, made again */
    clear(&f);
}

static void test_gradients(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    for (ControlKind kind = CONTROL_FRAME; kind <= CONTROL_HARMONIC; kind++) {
        check(BENDING_HINGE, kind, false, false);
        check(BENDING_MIDEDGE, kind, true, false);
    }
    check(BENDING_HINGE, CONTROL_KNOT, true, true);
    check(BENDING_MIDEDGE, CONTROL_FRAME, false, true);
    assert_int_equal(mem_live_count(), blocks);
}

/* The unknowns of the ground, too. Where contacts come and go differences of one size mislead: the best of several. */
static void check_ground(BendingModel bending, Ground ground, ControlKind kind)
{
    Fixture f;
    TrajectoryInfo info;
    make(&f, bending, ground, kind, true);
    f.def.march.newton.energy_tol = 1e-16;
    Trajectory *t = trajectory_create(&f.problem, &f.def);
    double F = trajectory_evaluate(t, f.u, f.gradient, &info), seen = INFINITY;
    assert_true(isfinite(F));
    WorldSums sums = {0};
    trajectory_accept(t);
    State end = trajectory_frame(t, STEPS);
    Point at = state_point(&end, trajectory_params(t, STEPS));
    world_measure(f.shell->world, &at, &sums);
    double adjoint = dot(f.design.size, f.gradient, f.v), tangent = by_tangent(&f, t);
    trajectory_destroy(t);
    for (double h = 1e-3; h > 5e-7; h /= 10)
        seen = fmin(seen, fabs(by_differences(&f, h, NULL, NULL) / adjoint - 1));
    double worst = off_without_factors(&f);
    print_message("%s %-8s %s: %g touch; tangent %.1e, differences %.1e; %d Newton iterations\n",
                  bending == BENDING_HINGE ? "hinge  " : "midedge", kinds[kind],
                  ground == IMPLICIT ? "implicit" : "lagged", sums.contact.touching,
                  fabs(adjoint / tangent - 1), seen, info.march.newton.iterations);
    assert_true(sums.contact.touching > 5 && fabs(adjoint / tangent - 1) < 1e-11 && seen < 1e-4 &&
                worst == 0);
    clear(&f);
}

static void test_ground(void **state)
{
    (void)state;
    for (Ground ground = LAGGED; ground <= IMPLICIT; ground++) {
        check_ground(BENDING_HINGE, ground, CONTROL_KNOT);
        check_ground(BENDING_MIDEDGE, ground, CONTROL_FRAME);
    }
}

/* v'(2 J^T J)v is twice the squared residuals' change to first order. */
static void test_product(void **state)
{
    (void)state;
    Fixture f;
    TrajectoryInfo info;
    make(&f, BENDING_HINGE, NO_GROUND, CONTROL_FRAME, false);
    f.problem.objective_count = 3;
    Trajectory *t = trajectory_create(&f.problem, &f.def);
    int dofs = shell_dof_count(f.shell), tip = mesh_group(f.shell->mesh, "tip", 0)->members[0];
    double *dx = mem_alloc((size_t)(STEPS + 1) * (size_t)dofs, sizeof *dx),
           *out = mem_alloc((size_t)f.design.size, sizeof *out),
           *dp = mem_alloc((size_t)f.shell->params.size, sizeof *dp);
    assert_true(isfinite(trajectory_evaluate(t, f.u, f.gradient, &info)));
    trajectory_accept(t);
    trajectory_product(t, f.v, out);
    trajectory_tangent(t, f.v, dx);
    double expected = 0;
    for (int i = 0; i < 3; i++) {
        for (int n = 4; n <= STEPS; n++) expected += 2e4 * pow(dx[n * dofs + 3 * tip + i], 2);
        expected += 4e4 * (pow(dx[7 * dofs + 3 * tip + i], 2) + pow(dx[7 * dofs + 9 + i], 2));
    }
    Probe center = probe_center(shell_masses(f.shell));
    design_forward(&f.design, 0, f.u, f.v, dp);
    for (int n = 5; n <= STEPS; n++) {
        Vec3 dq = probe_change(&center, trajectory_frame(t, n).x, trajectory_params(t, n), dx + n * dofs, dp);
        expected += 6e4 * vec3_dot(dq, dq);
    }
    assert_true(fabs(dot(f.design.size, out, f.v) - expected) < 1e-10 * expected);
    probe_clear(&center);
    mem_free(dp);
    mem_free(dx);
    mem_free(out);
    trajectory_destroy(t);
    clear(&f);
}

/* A restored motion goes on bit by bit. */
static void test_restore(void **state)
{
    (void)state;
    Fixture f;
    TrajectoryInfo info;
    make(&f, BENDING_MIDEDGE, NO_GROUND, CONTROL_KNOT, false);
    f.def.march.newton.max_iterations = 6; /* with sub-steps */
    size_t size = (size_t)f.design.size;
    Trajectory *a = trajectory_create(&f.problem, &f.def);
    assert_true(isfinite(trajectory_evaluate(a, f.u, f.gradient, &info)));
    trajectory_accept(a);
    TrajectoryState kept = trajectory_state(a);
    System *other = shell_dynamic_system(f.shell);
    Fixture g = f;
    g.problem.sys = other;
    Trajectory *b = trajectory_create(&g.problem, &g.def);
    trajectory_restore(b, f.u, &kept);
    double *work = mem_alloc(4 * size, sizeof *work), F[2];
    trajectory_product(a, f.v, work);
    trajectory_product(b, f.v, work + size);
    assert_memory_equal(work, work + size, size * sizeof *work);
    for (size_t i = 0; i < size; i++) f.u[i] += 0.02 * f.v[i];
    F[0] = trajectory_evaluate(a, f.u, work, &info);
    F[1] = trajectory_evaluate(b, f.u, work + size, &info);
    assert_true(F[0] == F[1] && isfinite(F[0]));
    assert_memory_equal(work, work + size, size * sizeof *work);
    mem_free(work);
    trajectory_destroy(a);
    trajectory_destroy(b);
    system_destroy(other);
    clear(&f);
}

/* The default tolerance leaves less than 1e-7 in a gradient. */
static void test_tolerance(void **state)
{
    (void)state;
    for (BendingModel bending = BENDING_MIDEDGE; bending <= BENDING_HINGE; bending++) {
        Fixture f;
        TrajectoryInfo info;
        make(&f, bending, NO_GROUND, CONTROL_FRAME, false);
        int size = f.design.size;
        double *exact = mem_alloc((size_t)size, sizeof *exact), norm = 0, off = 0;
        Trajectory *t = trajectory_create(&f.problem, &f.def);
        trajectory_evaluate(t, f.u, f.gradient, &info);
        trajectory_destroy(t);
        f.def.march.newton.energy_tol = 0, f.def.march.newton.step_tol = 1e-13,
        f.def.march.newton.force_tol = 1e-12;
        f.def.march.newton.cg_iterations = 0;
        t = trajectory_create(&f.problem, &f.def);
        trajectory_evaluate(t, f.u, exact, &info);
        for (int i = 0; i < size; i++)
            norm = fmax(norm, fabs(exact[i])), off = fmax(off, fabs(exact[i] - f.gradient[i]));
        print_message("gradient at the default tolerance: off by %.1e\n", off / norm);
        assert_true(off < 1e-7 * norm);
        mem_free(exact);
        trajectory_destroy(t);
        clear(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_gradients), cmocka_unit_test(test_ground),
                                       cmocka_unit_test(test_product), cmocka_unit_test(test_restore),
                                       cmocka_unit_test(test_tolerance)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
