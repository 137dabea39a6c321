/* A body that does not pass through itself: derivatives, motions, adjoints, and what a resumed run needs. */
#include "base/workers.h"
#include "optim/objectives.h"
#include "optim/trajectory_adjoint.h"
#include "solve/check.h"
#include "solve/march.h"
#include "tests/self_fixture.h"

/* ---- Derivatives ---- */

enum { STRANDS = 8, ENDS = 2 * STRANDS };

/* Single edges, each a piece of its own, here and there in a box: rods of one segment, or the long sides of faces. */
typedef struct Tangle {
    double rest[ENDS + STRANDS][3], memory[3 * (ENDS + STRANDS)], p[3];
    int edges[STRANDS][2], faces[STRANDS][3], part[ENDS + STRANDS];
    SelfContactDef def;
    Params params;
} Tangle;

static void tangle_make(Tangle *t, Random *random, bool faces, double parallel)
{
    *t = (Tangle){0};
    for (int k = 0; k < STRANDS; k++) {
        t->edges[k][0] = t->faces[k][0] = 2 * k, t->edges[k][1] = t->faces[k][1] = 2 * k + 1;
        t->faces[k][2] = ENDS + k;
        t->part[2 * k] = t->part[2 * k + 1] = t->part[ENDS + k] = k;
        for (int i = 0; i < 3; i++) {
            double centre = 0.4 * random_signed(random), way = random_signed(random);
            if (k % 2) way = t->rest[2 * k - 1][i] - t->rest[2 * k - 2][i] + parallel * way;
            t->rest[2 * k][i] = centre - way / 2, t->rest[2 * k + 1][i] = centre + way / 2;
            t->rest[ENDS + k][i] = centre + random_signed(random);
        }
    }
    memcpy(t->memory, t->rest, sizeof t->memory);
    t->def = (SelfContactDef){.vertex_count = faces ? ENDS + STRANDS : ENDS,
                              .face_count = faces ? STRANDS : 0,
                              .edge_count = STRANDS,
                              .faces = (const int(*)[3])t->faces,
                              .edges = (const int(*)[2])t->edges,
                              .rest = (const double(*)[3])t->rest,
                              .part = t->part,
                              .distance = 0.5,
                              .stiffness = params_add(&t->params, "stiffness", "J", 1, 1, false),
                              .friction = params_add(&t->params, "friction", "", 1, 1, false),
                              .slip_speed = 1};
    t->p[0] = 3, t->p[1] = 0.4;
}

/* Near a random point no class changes, nothing begins to slip and nothing stands still, but rarely: then differences are
 * worse. */
static void check_derivatives(Term (*create)(const SelfContactDef *), bool faces, double parallel)
{
    Random random = random_seed(17);
    const double size[12] = {1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3};
    double products = 0, worst = 0;
    int fine = 0, elements = 0;
    for (int run = 0; run < 20; run++) {
        Tangle t;
        tangle_make(&t, &random, faces, parallel);
        Term term = create(&t.def);
        Point at = {
            .x = t.memory, .p = t.p, .memory = t.memory, .x_lag = t.memory, .x_prev = t.memory, .dt = 1e-3};
        TermError error = check_term(&term, &t.params, &at, 3 * t.def.vertex_count, size, &random);
        elements += term.ops->count(term.self);
        products = fmax(products, check_products(error));
        fine += check_differences(error) < 1e-7;
        worst = fmax(worst, check_differences(error));
        term.ops->destroy(term.self);
        params_clear(&t.params);
    }
    print_message("%d of 20 to 1e-7, worst %.1e, products %.1e, %d elements\n", fine, worst, products,
                  elements);
    assert_true(fine >= 16 && worst < 1e-4 && products < 1e-11 && elements > 400);
}

static void test_contact_derivatives(void **unused)
{
    (void)unused;
    for (int k = 0; k < 4; k++) check_derivatives(self_contact_term, k % 2, k / 2 ? 0.01 : 1);
}

static void test_friction_derivatives(void **unused)
{
    (void)unused;
    for (int k = 0; k < 4; k++) check_derivatives(self_friction_term, k % 2, k / 2 ? 0.01 : 1);
}

/* ---- Motions ---- */

static int march(SelfBody *b, double dt, int steps, SelfField *field)
{
    MarchDef def = march_default();
    int refused = 0;
    if (field) def.load = self_load, def.self = field;
    for (int k = 0; k < steps; k++) {
        MarchInfo info;
        assert_true(march_step(b->body.sys, &def, dt, b->body.p, &b->body.state, &info));
        refused += info.refused;
    }
    return refused;
}

static void test_thrown(void **unused)
{
    (void)unused;
    const double speeds[] = {1, 3, 10};
    for (int k = 0; k < 6; k++) {
        SelfBody b = flying_sheets(6 + k % 2, speeds[k / 2], k % 2 ? 0.5 : 0);
        int refused = 0, crossings = 0;
        double least = INFINITY, force = 0;
        for (int step = 0; step < 30; step++) {
            refused += march(&b, 1e-3, 1, NULL);
            SelfContactFigures figures = self_figures(&b);
            crossings += self_crossings(&b);
            least = fmin(least, figures.distance);
            force = fmax(force, figures.force);
        }
        print_message("%g m/s: nearest %.3f D, %.2g N, %d refused\n", speeds[k / 2], least / b.def.distance,
                      force, refused);
        assert_true(crossings == 0 && least > 0 && least < b.def.distance && force > 0);
        body_clear(&b.body);
    }
}

static void test_folded(void **unused)
{
    (void)unused;
    for (int contact = 0; contact < 2; contact++) {
        SelfBody b = folding_strip((int[]){24, 5}, contact, 0, 0);
        SelfField field = {b.body.shell->flux_density, 0.2};
        int crossings = 0;
        for (int k = 0; k < 20; k++) {
            march(&b, 2e-3, 5, &field);
            crossings += self_crossings(&b);
        }
        assert_true((crossings > 0) == !contact);
        if (contact) {
            SelfContactFigures figures = self_figures(&b);
            assert_true(figures.pairs > 20 && figures.distance > 0.3 * b.def.distance);
        }
        body_clear(&b.body);
    }
}

/* In statics the same: a turn of the sheet's follows is pulled back where it would pass through. */
static void test_statics(void **unused)
{
    (void)unused;
    SelfBody b = folding_strip((int[]){24, 5}, true, 0, 0);
    System *sys = self_system(b.body.shell, &b.def, false, true, false);
    State state = system_state(sys);
    shell_rest_state(b.body.shell, state.x);
    for (int k = 1; k <= 5; k++) {
        NewtonDef def = newton_default();
        b.body.p[b.body.shell->flux_density + 2] = 0.01 * k;
        NewtonInfo info = newton_minimize(sys, &def, &(Point){.p = b.body.p}, &state, NULL);
        assert_int_equal(info.status, NEWTON_CONVERGED);
        assert_int_equal(self_contact_crossings(&b.def, state.x, NULL, 0), 0);
    }
    SelfContactFigures figures =
        self_contact_figures(system_term(sys, shell_term_row_count), state.x, b.body.p[b.def.stiffness]);
    assert_true(figures.pairs > 0);
    state_destroy(&state);
    system_destroy(sys);
    body_clear(&b.body);
}

/* Lists, and so bits, depend neither on threads nor on what was before. */
static void test_threads(void **unused)
{
    (void)unused;
    const int threads[] = {1, 2, 5};
    SelfBody first = {0};
    for (int k = 0; k < 3; k++) {
        SelfBody b = flying_sheets(6, 3, 0.5);
        Workers *workers = workers_create(threads[k]);
        system_set_workers(b.body.sys, workers);
        march(&b, 1e-3, 12, NULL);
        system_set_workers(b.body.sys, NULL);
        workers_destroy(workers);
        if (k == 0) {
            first = b;
            continue;
        }
        assert_memory_equal(first.body.state.x, b.body.state.x, (size_t)b.body.state.dofs * sizeof(double));
        body_clear(&b.body);
    }
    body_clear(&first.body);
}

/* The second sheet near the first: what follows is slow against the margin. */
static SelfBody near_sheets(void)
{
    SelfBody b = flying_sheets(6, 0.2, 0.5);
    const Mesh *mesh = b.body.shell->mesh;
    for (int v = 0; v < mesh->vertex_count; v++)
        if (mesh->vertex_component[v]) b.body.state.x[3 * v + 2] -= 5.4e-3;
    return b;
}

static void test_resumed(void **unused)
{
    (void)unused;
    SelfBody whole = near_sheets(), other = near_sheets();
    march(&whole, 2e-4, 10, NULL);
    march(&other, 2e-4, 13, NULL); /* so that it has seen other lists */
    state_copy(&other.body.state, &whole.body.state);
    const System *sys = whole.body.sys;
    double *anchor = mem_copy(system_anchor(sys), (size_t)system_anchor_count(sys), sizeof *anchor);
    assert_true(self_figures(&whole).pairs > 0);
    march(&whole, 2e-4, 12, NULL);
    system_restore_factor(other.body.sys, anchor, other.body.p);
    march(&other, 2e-4, 12, NULL);
    assert_memory_equal(whole.body.state.x, other.body.state.x,
                        (size_t)whole.body.state.dofs * sizeof(double));
    mem_free(anchor);
    body_clear(&whole.body);
    body_clear(&other.body);
}

/* ---- Adjoints ---- */

enum { STEPS = 14, UNKNOWNS = 3 };

typedef struct Fixture {
    SelfBody body;
    Design design;
    Objective objective;
    TrajectoryProblem problem;
    double u[UNKNOWNS];
} Fixture;

static void make(Fixture *f, double mu)
{
    *f = (Fixture){.body = flying_sheets(5, 2, mu)};
    const Mesh *mesh = f->body.body.shell->mesh;
    const char *const names[UNKNOWNS] = {"young", "self_stiffness", "self_friction"};
    int *all = mem_alloc((size_t)mesh->vertex_count, sizeof *all);
    for (int v = 0; v < mesh->vertex_count; v++) all[v] = v;
    f->objective = objective_target(mesh->vertex_count, all, (const double(*)[3])mesh->rest, 1);
    f->objective.first = f->objective.last = STEPS;
    f->design.case_count = 1;
    for (int k = 0; k < (mu > 0 ? UNKNOWNS : UNKNOWNS - 1); k++) {
        const ParamBlock *block = params_find(&f->body.body.shell->params, names[k]);
        design_add(&f->design, (Unknown){.block = block,
                                         .group_count = 1,
                                         .group = mem_alloc((size_t)block->count, sizeof(int)),
                                         .map = UNKNOWN_LOG,
                                         .scale = 1,
                                         .lower = -INFINITY,
                                         .upper = INFINITY});
    }
    design_read(&f->design, 0, f->body.body.p, f->u);
    f->problem = (TrajectoryProblem){.sys = f->body.body.sys,
                                     .design = &f->design,
                                     .params = &f->body.body.shell->params,
                                     .objectives = &f->objective,
                                     .objective_count = 1,
                                     .start = &f->body.body.state,
                                     .step = 1e-3,
                                     .steps = STEPS,
                                     .p = f->body.body.p};
    mem_free(all);
}

static void clear(Fixture *f)
{
    design_clear(&f->design);
    objective_destroy(f->objective);
    body_clear(&f->body.body);
}

/* dF along v from the motion's tangent. */
static double tangent_slope(const Fixture *f, Trajectory *t, const double *v)
{
    int n = f->body.body.state.dofs, size = f->body.body.shell->params.size;
    double *dx = mem_alloc((STEPS + 1) * (size_t)n, sizeof *dx), slope = 0;
    double *gx = mem_alloc((size_t)n, sizeof *gx), *dp = mem_alloc((size_t)size, sizeof *dp);
    trajectory_tangent(t, v, dx);
    f->objective.ops->value(f->objective.self, 1, trajectory_frame(t, STEPS).x, f->body.body.p, gx, dp);
    for (int i = 0; i < n; i++) slope += gx[i] * dx[STEPS * n + i];
    mem_free(dx);
    mem_free(gx);
    mem_free(dp);
    return slope;
}

static double value_at(const Fixture *f, const TrajectoryDef *def, const double *v, double a)
{
    double u[UNKNOWNS] = {0};
    for (int k = 0; k < f->design.size; k++) u[k] = f->u[k] + a * v[k];
    Trajectory *t = trajectory_create(&f->problem, def);
    TrajectoryInfo info;
    double F = trajectory_evaluate(t, u, NULL, &info);
    trajectory_destroy(t);
    return F;
}

static void check_adjoint(long factor_memory, double mu)
{
    Fixture f;
    make(&f, mu);
    TrajectoryDef def = trajectory_default();
    def.march.newton.energy_tol = 1e-15;
    def.factor_memory = factor_memory;
    Trajectory *t = trajectory_create(&f.problem, &def);
    TrajectoryInfo info;
    const double v[UNKNOWNS] = {0.7, -0.4, 0.9};
    double gradient[UNKNOWNS] = {0}, adjoint = 0, best = INFINITY;
    assert_true(isfinite(trajectory_evaluate(t, f.u, gradient, &info)));
    trajectory_accept(t);
    for (int k = 0; k < f.design.size; k++) adjoint += gradient[k] * v[k];
    double tangent = tangent_slope(&f, t, v);
    for (double h = 1e-3; h > 1e-7; h /= 10) {
        double F[4];
        for (int k = 0; k < 4; k++) F[k] = value_at(&f, &def, v, (double[]){-2, -1, 1, 2}[k] * h);
        best = fmin(best, fabs(adjoint / ((8 * (F[2] - F[1]) - (F[3] - F[0])) / (12 * h)) - 1));
    }
    print_message("adjoint against tangent %.1e, against differences %.1e\n", fabs(adjoint / tangent - 1),
                  best);
    assert_true(fabs(adjoint / tangent - 1) < 1e-11 && best < 1e-4);
    trajectory_destroy(t);
    clear(&f);
}

static void test_adjoint(void **unused)
{
    (void)unused;
    for (int k = 0; k < 4; k++) check_adjoint(k % 2 ? 1L << 30 : 0, k / 2 ? 0.4 : 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_contact_derivatives),
        cmocka_unit_test(test_friction_derivatives),
        cmocka_unit_test(test_thrown),
        cmocka_unit_test(test_folded),
        cmocka_unit_test(test_statics),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_resumed),
        cmocka_unit_test(test_adjoint),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
