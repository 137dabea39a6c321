/* A body that does not pass through itself: derivatives, motions, and what a resumed run needs. */
#include "base/workers.h"
#include "solve/check.h"
#include "solve/march.h"
#include "tests/self_fixture.h"

/* ---- Derivatives ---- */

enum { STRANDS = 8, ENDS = 2 * STRANDS };

/* Single edges, each a piece of its own, here and there in a box: rods of one segment, or the long sides of faces. */
typedef struct Tangle {
    double rest[ENDS + STRANDS][3], memory[3 * (ENDS + STRANDS)], p[3];
    int edges[STRANDS][2], faces[STRANDS][3], part[ENDS + STRANDS];
    double outsides[ENDS + STRANDS], thick[STRANDS]; /* of vertices, and of edges and faces */
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

/* Each with a thickness of its own. */
static void tangle_thin(Tangle *t, Random *random)
{
    for (int v = 0; v < ENDS + STRANDS; v++) t->outsides[v] = 0.25 * (0.8 + 0.2 * random_signed(random));
    for (int k = 0; k < STRANDS; k++) t->thick[k] = 0.25 * (0.8 + 0.2 * random_signed(random));
    t->def.vertex_outside = t->outsides, t->def.edge_outside = t->def.face_outside = t->thick;
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
        if (run % 2) tangle_thin(&t, &random);
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

/* Whatever the speed and the step, flat or edge on. */
static void check_thrown(double speed, bool on_edge, double dt, double mu)
{
    SelfBody b = flying_sheets(mu > 0 ? 7 : 6, on_edge, speed, mu);
    int refused = 0, crossings = 0, steps = (int)fmax(0.03 / (speed * dt), 30);
    double least = INFINITY, force = 0;
    for (int step = 0; step < steps; step++) {
        refused += march(&b, dt, 1, NULL);
        SelfContactFigures figures = self_figures(&b);
        crossings += self_crossings(&b);
        least = fmin(least, figures.distance);
        force = fmax(force, figures.force);
    }
    print_message("%g m/s, %g ms%s: nearest %.3f D, %.2g N, %d refused\n", speed, 1e3 * dt,
                  on_edge ? ", edge on" : "", least / b.def.distance, force, refused);
    assert_true(crossings == 0 && least > 0 && least < b.def.distance && force > 0);
    body_clear(&b.body);
}

static void test_thrown(void **unused)
{
    (void)unused;
    const double speeds[] = {1, 3, 10, 100};
    for (int k = 0; k < 8; k++) check_thrown(speeds[k / 2], k % 2, 1e-3, k % 2 ? 0.5 : 0);
    for (int k = 0; k < 4; k++) check_thrown(speeds[2 + k / 2], k % 2, 1e-4, 0);
}

static void test_folded(void **unused)
{
    (void)unused;
    for (int contact = 0; contact < 2; contact++) {
        SelfBody b = folding_strip((int[]){24, 5}, contact, 0, 0);
        SelfField field = {b.body.shell->flux.uniform, 0.2};
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
        b.body.p[b.body.shell->flux.uniform + 2] = 0.01 * k;
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
        SelfBody b = flying_sheets(6, false, 3, 0.5);
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
    SelfBody b = flying_sheets(6, false, 0.2, 0.5);
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
