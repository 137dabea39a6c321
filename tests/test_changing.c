/* Terms whose elements change: steps of time, their adjoint, what a resumed run needs, threads, and steps that may not go
 * all the way. */
#include "optim/objectives.h"
#include "optim/trajectory_adjoint.h"
#include "solve/march.h"
#include "tests/cloud_fixture.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

enum { STEPS = 24 };

static const double DT = 0.02;

static void march(System *sys, const Cloud *cloud, int steps, State *state)
{
    MarchDef def = march_default();
    double p[5];
    memcpy(p, cloud->p, sizeof p);
    for (int k = 0; k < steps; k++) {
        MarchInfo info;
        assert_true(march_step(sys, &def, DT, p, state, &info));
        assert_int_equal(info.refused, 0);
    }
}

static void test_threads(void **unused)
{
    (void)unused;
    Cloud cloud = cloud_create();
    State ends[3];
    const int threads[] = {1, 2, 5};
    for (int k = 0; k < 3; k++) {
        System *sys = cloud_system(&cloud);
        Workers *workers = workers_create(threads[k]);
        system_set_workers(sys, workers);
        ends[k] = cloud_state(sys);
        march(sys, &cloud, STEPS, &ends[k]);
        assert_true(cloud_springs(sys)->changes > 10);
        assert_memory_equal(ends[0].x, ends[k].x, CLOUD_DOFS * sizeof(double));
        system_destroy(sys);
        workers_destroy(workers);
    }
    for (int k = 0; k < 3; k++) state_destroy(&ends[k]);
    params_clear(&cloud.params);
}

/* From its state and the point of its factor another system goes on bit by bit, though it has seen other lists. */
static void test_resumed(void **unused)
{
    (void)unused;
    Cloud cloud = cloud_create();
    System *whole = cloud_system(&cloud), *other = cloud_system(&cloud);
    State state = cloud_state(whole);
    march(whole, &cloud, STEPS / 2, &state);
    State resumed = state_clone(&state);
    double *anchor = mem_copy(system_anchor(whole), (size_t)system_anchor_count(whole), sizeof *anchor);
    march(whole, &cloud, STEPS / 2, &state);
    system_restore_factor(other, anchor, cloud.p);
    march(other, &cloud, STEPS / 2, &resumed);
    assert_memory_equal(state.x, resumed.x, CLOUD_DOFS * sizeof(double));
    mem_free(anchor);
    state_destroy(&state);
    state_destroy(&resumed);
    system_destroy(whole);
    system_destroy(other);
    params_clear(&cloud.params);
}

/* ---- The adjoint ---- */

typedef struct Fixture {
    Cloud cloud;
    System *sys;
    State start;
    Design design;
    Objective objective;
    TrajectoryProblem problem;
    double u[2];
} Fixture;

static void make(Fixture *f)
{
    *f = (Fixture){.cloud = cloud_create()};
    int all[CLOUD_VERTICES];
    double target[CLOUD_VERTICES][3] = {{0}};
    f->sys = cloud_system(&f->cloud);
    f->start = cloud_state(f->sys);
    for (int v = 0; v < CLOUD_VERTICES; v++) all[v] = v;
    f->objective = objective_target(CLOUD_VERTICES, all, (const double(*)[3])target, 1);
    f->objective.first = f->objective.last = STEPS;
    f->design.case_count = 1;
    const char *const names[] = {"stiffness", "damping"};
    for (int k = 0; k < 2; k++) {
        const ParamBlock *block = params_find(&f->cloud.params, names[k]);
        design_add(&f->design, (Unknown){.block = block,
                                         .group_count = 1,
                                         .map = UNKNOWN_LOG,
                                         .scale = 1,
                                         .lower = -INFINITY,
                                         .upper = INFINITY});
    }
    design_read(&f->design, 0, f->cloud.p, f->u);
    f->problem = (TrajectoryProblem){.sys = f->sys,
                                     .design = &f->design,
                                     .params = &f->cloud.params,
                                     .objectives = &f->objective,
                                     .objective_count = 1,
                                     .start = &f->start,
                                     .step = DT,
                                     .steps = STEPS,
                                     .p = f->cloud.p};
}

static void clear(Fixture *f)
{
    system_destroy(f->sys);
    params_clear(&f->cloud.params);
    state_destroy(&f->start);
    design_clear(&f->design);
    objective_destroy(f->objective);
}

static double value_at(const Fixture *f, const TrajectoryDef *def, const double *u)
{
    Trajectory *t = trajectory_create(&f->problem, def);
    TrajectoryInfo info;
    double F = trajectory_evaluate(t, u, NULL, &info);
    trajectory_destroy(t);
    return F;
}

/* dF along v from the motion's tangent. */
static double tangent_slope(const Fixture *f, Trajectory *t, const double *v)
{
    double *dx = mem_alloc((STEPS + 1) * (size_t)CLOUD_DOFS, sizeof *dx), slope = 0;
    double *gx = mem_alloc(CLOUD_DOFS, sizeof *gx), dp[5] = {0};
    trajectory_tangent(t, v, dx);
    f->objective.ops->value(f->objective.self, 1, trajectory_frame(t, STEPS).x, f->cloud.p, gx, dp);
    for (int i = 0; i < CLOUD_DOFS; i++) slope += gx[i] * dx[STEPS * CLOUD_DOFS + i];
    mem_free(dx);
    mem_free(gx);
    return slope;
}

static void check_adjoint(long factor_memory)
{
    Fixture f;
    make(&f);
    TrajectoryDef def = trajectory_default();
    def.march.newton.energy_tol = 1e-15;
    def.factor_memory = factor_memory;
    Trajectory *t = trajectory_create(&f.problem, &def);
    TrajectoryInfo info;
    const double v[2] = {0.7, -0.4};
    double gradient[2], h = 1e-4, F[4];
    assert_true(isfinite(trajectory_evaluate(t, f.u, gradient, &info)));
    assert_true(cloud_springs(f.sys)->changes > 10);
    trajectory_accept(t);
    double adjoint = gradient[0] * v[0] + gradient[1] * v[1], tangent = tangent_slope(&f, t, v);
    for (int k = 0; k < 4; k++) {
        const double a[4] = {-2, -1, 1, 2};
        F[k] = value_at(&f, &def, (double[]){f.u[0] + a[k] * h * v[0], f.u[1] + a[k] * h * v[1]});
    }
    double differences = (8 * (F[2] - F[1]) - (F[3] - F[0])) / (12 * h);
    print_message("adjoint against tangent %.1e, against differences %.1e\n", fabs(adjoint / tangent - 1),
                  fabs(adjoint / differences - 1));
    assert_true(fabs(adjoint / tangent - 1) < 1e-11 && fabs(adjoint / differences - 1) < 1e-7);
    trajectory_destroy(t);
    clear(&f);
}

static void test_adjoint_kept(void **unused)
{
    (void)unused;
    check_adjoint(1L << 30);
}

static void test_adjoint_made_again(void **unused)
{
    (void)unused;
    check_adjoint(0);
}

/* ---- reach: the height of a weight over a floor that repels by -c log z ---- */

static const double WEIGHT = 3, FLOOR = 1e-4;
static bool crossed;

static int one(const void *self)
{
    (void)self;
    return 1;
}

static void first_dof(const void *self, int e, int *dof)
{
    (void)self, (void)e;
    dof[0] = 0;
}

static Pack floor_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    (void)self, (void)pack, (void)at;
    crossed |= !(x[0][0] > 0);
    if (g) g[0] = WEIGHT - FLOOR / x[0];
    if (H) H[0] = FLOOR / (x[0] * x[0]);
    return pack_set(WEIGHT * x[0][0] - FLOOR * log(x[0][0]));
}

static double floor_reach(const void *self, const Point *at, const double *d)
{
    (void)self;
    return d[0] < -0.9 * at->x[0] ? -0.9 * at->x[0] / d[0] : 1;
}

static void no_destroy(void *self)
{
    (void)self;
}

static void test_reach(void **unused)
{
    (void)unused;
    static const TermOps ops = {.name = "floor",
                                .count = one,
                                .size = one,
                                .dofs = first_dof,
                                .eval = floor_eval,
                                .reach = floor_reach,
                                .destroy = no_destroy};
    System *sys = system_create(1, &(DofClass){.count = 1, .size = 1}, 1);
    system_add(sys, (Term){&ops, NULL});
    system_prepare(sys);
    State state = system_state(sys);
    state.x[0] = 0.1;
    NewtonDef def = newton_default();
    NewtonInfo info = newton_minimize(sys, &def, &(Point){0}, &state, NULL);
    assert_int_equal(info.status, NEWTON_CONVERGED);
    assert_true(fabs(state.x[0] - FLOOR / WEIGHT) < 1e-9 * FLOOR);
    assert_false(crossed);
    state_destroy(&state);
    system_destroy(sys);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads),      cmocka_unit_test(test_resumed),
        cmocka_unit_test(test_adjoint_kept), cmocka_unit_test(test_adjoint_made_again),
        cmocka_unit_test(test_reach),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
