/* Rods that touch, held vertices that are moved, and crossings. */
#include "solve/march.h"
#include "solve/ramp.h"
#include "tests/self_fixture.h"

/* ---- Rods, held vertices, crossings ---- */

enum { LOOSE = 8, FIRST = 5 };

/* Loose segments, whose positions begin at dof 5: some crosswise, some along each other. */
typedef struct Loose {
    double rest[LOOSE][3], mass[LOOSE + 2], p[2];
    int edges[LOOSE / 2][2], part[LOOSE];
    SelfContactDef def;
} Loose;

static void loose_make(Loose *l, bool along)
{
    *l = (Loose){.p = {1, 0}};
    for (int k = 0; k < LOOSE / 2; k++) {
        l->edges[k][0] = 2 * k, l->edges[k][1] = 2 * k + 1;
        for (int v = 2 * k; v < 2 * k + 2; v++) {
            int way = along || k % 2 == 0 ? 0 : 1;
            l->part[v] = k;
            l->rest[v][way] = v % 2 ? 0.02 : -0.02;
            l->rest[v][2] = 0.01 * k;
        }
    }
    l->def = (SelfContactDef){.vertex_count = LOOSE,
                              .first = FIRST,
                              .edge_count = LOOSE / 2,
                              .edges = (const int(*)[2])l->edges,
                              .rest = (const double(*)[3])l->rest,
                              .part = l->part,
                              .distance = 2e-3,
                              .stiffness = 0,
                              .friction = 1};
}

static double turn_about(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* How high the segment at y is above that at x, where they cross as seen from above; 0 where they do not. */
static double height_above(const double *x, const double *y)
{
    double a = turn_about(x, x + 3, y), b = turn_about(x, x + 3, y + 3);
    double c = turn_about(y, y + 3, x), d = turn_about(y, y + 3, x + 3);
    if (!(a * b < 0 && c * d < 0)) return 0;
    double s = a / (a - b), t = c / (c - d);
    return y[2] + s * (y[5] - y[2]) - x[2] - t * (x[5] - x[2]);
}

/* Each segment is above the one before it, as long as they have crossed. */
static void expect_order(const double *x, bool along, bool crosses[LOOSE / 2])
{
    for (int m = 1; m < LOOSE / 2; m++) {
        const double *own = x + 6 * m;
        double height = along ? own[2] - own[-4] : height_above(own - 6, own);
        crosses[m] = crosses[m] && height != 0;
        assert_true(!crosses[m] || height > 0);
    }
}

/* Segments that fly into each other stay above each other as long as they cross, and those along each other anyway. */
static void test_rods(void **unused)
{
    (void)unused;
    const double speeds[] = {2, 2, 12};
    for (int run = 0; run < 3; run++) {
        Loose l;
        bool along = run == 1, crosses[LOOSE / 2] = {0, 1, 1, 1};
        loose_make(&l, along);
        int dofs = FIRST + 3 * LOOSE + 1, met = 0;
        for (int v = 0; v < LOOSE + 2; v++) l.mass[v] = 1e-3;
        System *sys = system_create(dofs, &(DofClass){.count = dofs, .size = 0.05}, 1);
        system_add(sys, kinetic_inertia_term(masses_fixed(dofs / 3, l.mass)));
        system_add(sys, self_contact_term(&l.def));
        for (int i = 0; i < FIRST; i++) system_fix(sys, i);
        system_fix(sys, dofs - 1);
        system_prepare(sys);
        State state = system_state(sys);
        memcpy(state.x + FIRST, l.rest, sizeof l.rest);
        for (int v = 0; v < LOOSE; v++) state.v[FIRST + 3 * v + 2] = speeds[run] * (1.5 - v / 2);
        for (int k = 0; k < 40; k++) {
            MarchInfo info;
            MarchDef def = march_default();
            assert_true(march_step(sys, &def, 1e-3, l.p, &state, &info));
            met += self_contact_figures(system_term(sys, 1), state.x, 1).pairs > 0;
            expect_order(state.x + FIRST, along, crosses);
        }
        assert_true(met > 0 && (run == 2 || crosses[1]));
        state_destroy(&state);
        system_destroy(sys);
    }
}

/* Held vertices are never pulled back: a trial that they would pass through is not finite. */
static void test_held(void **unused)
{
    (void)unused;
    Loose l;
    bool fixed[3 * LOOSE] = {0};
    double from[FIRST + 3 * LOOSE] = {0}, x[FIRST + 3 * LOOSE];
    loose_make(&l, false);
    for (int i = 0; i < 6; i++) fixed[i] = true;
    l.def.fixed = fixed;
    Term term = self_contact_term(&l.def);
    memcpy(from + FIRST, l.rest, sizeof l.rest);
    memcpy(x, from, sizeof x);
    x[FIRST + 2] += 0.005, x[FIRST + 5] += 0.005;
    term.ops->project(term.self, from, x);
    assert_true(x[FIRST + 2] == 0.005);
    x[FIRST + 2] += 0.02, x[FIRST + 5] += 0.02;
    term.ops->project(term.self, from, x);
    assert_true(isnan(x[FIRST + 2]));
    memcpy(x, from, sizeof x);
    for (int v = 2; v < 4; v++) x[FIRST + 3 * v + 2] -= 0.03; /* a loose one, through the held one */
    double way[FIRST + 3 * LOOSE];
    for (int i = 0; i < FIRST + 3 * LOOSE; i++) way[i] = x[i] - from[i];
    double reach =
        term.ops->reach(term.self, &(Point){.x = from}, way); /* 10 mm of 30, a tenth of them left */
    assert_true(reach > 0.29 && reach <= 0.3 + 1e-12);
    term.ops->project(term.self, from, x);
    assert_true(x[FIRST + 6 + 2] > 0 && x[FIRST + 6 + 2] < 2e-3);
    term.ops->destroy(term.self);
}

/* The first segment rises by 30 mm in a step, and drives the others before it. */
static bool rise(void *self, double time, double *x)
{
    const Loose *l = self;
    for (int v = 0; v < 2; v++) x[FIRST + 3 * v + 2] = l->rest[v][2] + 30 * time;
    return true;
}

static void test_driven(void **unused)
{
    (void)unused;
    Loose l;
    bool fixed[3 * LOOSE] = {0}, crosses[LOOSE / 2] = {0, 1, 1, 1};
    loose_make(&l, false);
    for (int i = 0; i < 6; i++) fixed[i] = true;
    l.def.fixed = fixed;
    int dofs = FIRST + 3 * LOOSE + 1;
    for (int v = 0; v < LOOSE + 2; v++) l.mass[v] = 1e-3;
    System *sys = system_create(dofs, &(DofClass){.count = dofs, .size = 0.05}, 1);
    system_add(sys, kinetic_inertia_term(masses_fixed(dofs / 3, l.mass)));
    system_add(sys, self_contact_term(&l.def));
    for (int i = 0; i < FIRST + 6; i++) system_fix(sys, i);
    system_fix(sys, dofs - 1);
    system_prepare(sys);
    State state = system_state(sys);
    memcpy(state.x + FIRST, l.rest, sizeof l.rest);
    int refused = 0;
    for (int k = 0; k < 5; k++) {
        MarchInfo info;
        MarchDef def = march_default();
        def.move = rise, def.self = &l;
        assert_true(march_step(sys, &def, 1e-3, l.p, &state, &info));
        refused += info.refused;
        assert_true(fabs(state.x[FIRST + 2] - 0.03 * (k + 1)) < 1e-12);
        expect_order(state.x + FIRST, false, crosses);
    }
    assert_true(refused > 0 && crosses[1]);
    state_destroy(&state);
    system_destroy(sys);
}

/* In statics the same: a sheet that is held as a whole is moved through another one, which is held where it stands out. */
typedef struct Lift {
    const Mesh *mesh;
    double height; /* m */
} Lift;

static bool lift(void *self, double from, double to, double *x)
{
    Lift *l = self;
    double part = ramp_part(from, to);
    for (int v = 0; v < l->mesh->vertex_count; v++)
        if (!l->mesh->vertex_component[v]) x[3 * v + 2] += part * (l->height - x[3 * v + 2]);
    return true;
}

static void test_lifted(void **unused)
{
    (void)unused;
    SelfBody b = flying_sheets(4, false, 1, 0);
    Shell *shell = b.body.shell;
    const Mesh *mesh = shell->mesh;
    for (int v = 0; v < mesh->vertex_count; v++) {
        if (mesh->vertex_component[v] && mesh->rest[v][0] < 0.0125) continue;
        for (int i = 0; i < 3; i++) shell_fix(shell, v, i);
    }
    System *sys = self_system(shell, &b.def, false, true, false);
    State state = system_state(sys);
    shell_rest_state(shell, state.x);
    Lift way = {mesh, 8e-3};
    RampDef def = ramp_default();
    def.move = lift, def.self = &way;
    RampInfo info = ramp_solve(sys, &shell->params, &def, b.body.p, b.body.p, &state);
    assert_true(info.reached == 1 && info.refused > 0 && info.newton.status == NEWTON_CONVERGED);
    assert_true(self_contact_figures(system_term(sys, shell_term_row_count), state.x, 1).pairs > 0);
    assert_int_equal(self_contact_crossings(&b.def, state.x, NULL, 0), 0);
    state_destroy(&state);
    system_destroy(sys);
    body_clear(&b.body);
}

static void test_crossings(void **unused)
{
    (void)unused;
    SelfBody b = flying_sheets(4, false, 1, 0);
    const Mesh *mesh = b.body.shell->mesh;
    int pairs[4][2];
    assert_int_equal(self_crossings(&b), 0);
    for (int v = 0; v < mesh->vertex_count; v++)
        if (mesh->vertex_component[v]) b.body.state.x[3 * v + 2] -= 0.0065;
    int count = self_contact_crossings(&b.def, b.body.state.x, pairs, 4);
    assert_true(count > 4);
    for (int k = 0; k < 4; k++)
        assert_true(mesh->vertex_component[mesh->edges[pairs[k][0]][0]] !=
                    mesh->vertex_component[mesh->faces[pairs[k][1]][0]]);
    body_clear(&b.body);
    Loose l;
    double x[FIRST + 3 * LOOSE] = {0};
    loose_make(&l, false);
    memcpy(x + FIRST, l.rest, sizeof l.rest);
    assert_int_equal(self_contact_crossings(&l.def, x, pairs, 4), 0);
    x[FIRST + 8] = x[FIRST + 11] = 1e-4;
    assert_int_equal(self_contact_crossings(&l.def, x, pairs, 4), 1);
    assert_true(pairs[0][0] == 0 && pairs[0][1] == 1);
}

/* A triangle in four, so that all of it is in one plane but for the rounding of its coordinates, in many places. */
static void test_flat(void **unused)
{
    (void)unused;
    static const int faces[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}},
                     edges[9][2] = {{0, 3}, {3, 1}, {1, 4}, {4, 2}, {2, 5}, {5, 0}, {3, 4}, {4, 5}, {5, 3}};
    static const int middles[3][2] = {{0, 1}, {1, 2}, {2, 0}};
    for (int trial = 0; trial < 200; trial++) {
        double x[6][3];
        for (int v = 0; v < 3; v++)
            for (int i = 0; i < 3; i++) x[v][i] = sin(1 + 9 * trial + 3 * v + i);
        for (int m = 0; m < 3; m++)
            for (int i = 0; i < 3; i++) x[3 + m][i] = (x[middles[m][0]][i] + x[middles[m][1]][i]) / 2;
        SelfContactDef def = {.vertex_count = 6,
                              .face_count = 4,
                              .edge_count = 9,
                              .faces = faces,
                              .edges = edges,
                              .rest = (const double(*)[3])x};
        assert_int_equal(self_contact_crossings(&def, x[0], NULL, 0), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rods),   cmocka_unit_test(test_held),      cmocka_unit_test(test_driven),
        cmocka_unit_test(test_lifted), cmocka_unit_test(test_crossings), cmocka_unit_test(test_flat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
