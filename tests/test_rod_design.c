/* dF/du of designs of rods against central differences and against the forward tangent: magnetisation,
 * stiffness, natural strains and fields, with a free and with a held end, in a uniform field and in one more that
 * varies in space; of Kirchhoff's and of Cosserat rods. */
#include "base/memory.h"
#include "base/random.h"
#include "optim/objectives.h"
#include "optim/static_design.h"
#include "tests/rod_fixture.h"
#include "tests/rod_taper.h"
#include "solve/tangent.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

enum { N = 24 };

typedef struct Fixture {
    Rod *rod;
    RodLayout layout;
    Design design;
    Case load;
    StaticDesign *sd;
} Fixture;

static const double young = 1e6, length = 0.05;

/* What acts beside uniform fields and weight; or how the section is. */
typedef enum Around { NOTHING, DIPOLE, COUPLE, WOUND, POTENTIAL, TAPERED, LED, AROUND_COUNT } Around;

static const char *const around_names[] = {
    "",          ", in a dipole's field",     ", with couples", ", wound up by a couple", ", in a potential",
    ", tapered", ", both ends led and turned"};

static RodActs acts_of(Around around)
{
    RodActs acts = {.couples = around == COUPLE || around == WOUND};
    const char *u = "0.5*(y+s)^2*exp(20*z)*L";
    if (around == DIPOLE)
        flux_fields_add(&acts.fields,
                        flux_field_dipole((double[]){0.03, 0.03, 0.03}, (double[]){0.2, 0.5, -0.4}));
    if (around == POTENTIAL)
        rod_potentials_add(
            &acts.potentials,
            rod_potential_create(formula_create(&u, 1, NULL, 0, rod_place_variables, NULL), length));
    return acts;
}

/* The ends move nearer, and turn by so much against each other, evenly. */
typedef struct Led {
    RodLayout layout;
    Vec3 place[2];
    Quat frame[2];
} Led;

static bool lead(void *self, double from, double to, double *x)
{
    const Led *led = self;
    (void)from;
    for (int k = 0; k < 2; k++) {
        int node = k ? led->layout.nodes - 1 : 0;
        double *frame = x + led->layout.reference + 4 * node;
        Vec3 way = vec3(k ? -0.01 : 0.002, 0.004, k ? -0.006 : 0), turn = vec3(k ? 4 : -1, 0.6, 0.3);
        Quat turned = quat_mul(quat_exp(vec3_scale(to, turn)), led->frame[k]);
        vec3_store(x + led->layout.position + 3 * node, vec3_axpy(to, way, led->place[k]));
        frame[0] = turned.w;
        vec3_store(frame + 1, turned.v);
    }
    return true;
}

/* From the natural shape. */
static void lead_ends(const Rod *rod, const RodLayout *layout, System *sys, const double *p, State *state)
{
    Led led = {.layout = *layout};
    for (int k = 0; k < 2; k++) {
        led.place[k] = vec3_load(state->x + layout->position + 3 * k * rod->elements);
        led.frame[k] = rod_reference(layout, state->x, k * rod->elements);
    }
    RampDef def = ramp_default();
    def.newton = rod_newton();
    def.steps = 10, def.move = lead, def.self = &led;
    assert_int_equal(ramp_solve(sys, &rod->params, &def, NULL, p, state).newton.status, NEWTON_CONVERGED);
}

/* The shape is one that a magnetisation along the rod takes in a field across it. */
static Fixture fixture_create(RodSupport end, Around around, bool cosserat, Random *random)
{
    RodActs acts = acts_of(around);
    Fixture f = {.rod = rod_create(N, length, rod_circle(0.5e-3, 1, 0.4, 1800), &acts)};
    Rod *rod = f.rod;
    rod->end = end, rod->cosserat = cosserat;
    if (around == TAPERED) rod_taper(rod, 1e-3, 0.8e-3, (double[]){0.5, 0.8}, 0.4, 1800);
    f.layout = rod_layout(rod, true);
    double *p = mem_alloc((size_t)rod->params.size, sizeof *p), target[N + 1][3];
    int nodes[N + 1];
    rod_default_params(rod, young, p);
    for (int e = 0; e < N; e++) {
        vec3_store(p + rod->natural_strain + 3 * e,
                   vec3(3 * random_signed(random), 8, 6 * random_signed(random)));
        vec3_store(p + rod->magnetization + 3 * e,
                   vec3(2e4, 5e3 * random_signed(random), 5e3 * random_signed(random)));
    }
    vec3_store(p + rod->flux.uniform, vec3(0.004, -0.01, 0.015));
    if (around == DIPOLE) p[rod->flux.scale] = 1;
    if (around == COUPLE) {
        vec3_store(p + rod->couple + 3 * N, vec3(6e-7, -4e-7, 8e-7));
        vec3_store(p + rod->couple + 3 * (N / 2), vec3(-3e-7, 5e-7, 2e-7));
    }
    vec3_store(p + rod->gravity, vec3(0, 0, -9.81));
    if (around == WOUND) vec3_store(p + rod->couple + 3 * N, vec3(3e-6, 1e-6, 4e-6)); /* 5 EI/L */
    for (int i = 0; i <= N; i++) {
        double s = length * i / N;
        nodes[i] = i;
        vec3_store(target[i], vec3(s - 2 * s * s, 0.2 * s * s / length, 5 * s * s));
    }
    System *sys = rod_system(rod, young, false);
    double *x = mem_alloc((size_t)f.layout.dofs, sizeof *x);
    rod_natural_state(rod, &f.layout, p, x);
    f.load = case_create("only", p, (size_t)rod->params.size, 0);
    *case_add_objective(&f.load) = objective_target(N + 1, nodes, (const double(*)[3])target, 1);
    case_start(&f.load, sys, x);
    if (around == WOUND)
        assert_int_equal(rod_relax(rod, sys, cosserat ? 40 : 10, p, &f.load.state).reached, 1);
    if (around == LED) lead_ends(rod, &f.layout, sys, p, &f.load.state);
    mem_free(p);
    mem_free(x);
    f.design.case_count = 1;
    return f;
}

static void fixture_start(Fixture *f, const char *block, Unknown unknown)
{
    StaticDesignDef def = static_design_default();
    def.newton.step_cap = 1.5;
    unknown.block = params_find(&f->rod->params, block);
    unknown.group_count = unknown.block->count;
    design_add(&f->design, unknown);
    f->sd = static_design_create(&f->design, &f->rod->params, &f->load, &def);
}

static void fixture_clear(Fixture *f)
{
    static_design_destroy(f->sd);
    design_clear(&f->design);
    case_clear(&f->load);
    rod_destroy(f->rod);
}

/* dF along v by the forward tangent, with the factor that the evaluation left. */
static double tangent_slope(const Fixture *f, const double *u, const double *v)
{
    size_t dofs = (size_t)f->layout.dofs, size = (size_t)f->rod->params.size;
    double *dp = mem_alloc(2 * size, sizeof *dp), *p = dp + size, *dx = mem_alloc(2 * dofs, sizeof *dx),
           *gx = dx + dofs, slope = 0;
    memcpy(p, f->load.stages[0].p, size * sizeof *p);
    design_apply(&f->design, 0, u, p);
    design_forward(&f->design, 0, u, v, dp);
    Point at = state_point(&f->load.state, p);
    system_param_forward(f->load.sys, &at, dp, dx);
    tangent_solve(f->load.sys, &at, false, dx, dx);
    f->load.objectives[0].ops->value(f->load.objectives[0].self, 1, f->load.state.x, p, gx, dp);
    for (size_t i = 0; i < dofs; i++) slope -= gx[i] * dx[i];
    mem_free(dp);
    mem_free(dx);
    return slope;
}

static void check(RodSupport end, Around around, bool cosserat, const char *block, Unknown unknown)
{
    long blocks = mem_live_count();
    Random random = random_seed(11);
    Fixture f = fixture_create(end, around, cosserat, &random);
    fixture_start(&f, block, unknown);
    size_t n = (size_t)f.design.size;
    double *u = mem_alloc(4 * n, sizeof *u), *g = u + n, *v = u + 2 * n, *moved = u + 3 * n, slope = 0, F4[4];
    CaseInfo info;
    design_read(&f.design, 0, f.load.stages[0].p, u);
    assert_true(isfinite(static_design_evaluate(f.sd, u, g, &info)));
    static_design_accept(f.sd);
    double terms = 0; /* of which the slope is the sum */
    for (size_t i = 0; i < n; i++)
        v[i] = random_signed(&random), slope += g[i] * v[i], terms += fabs(g[i] * v[i]);
    double tangent = tangent_slope(&f, u, v), h = 1e-3;
    for (int k = 0; k < 4; k++) {
        static const double steps[4] = {-2, -1, 1, 2};
        for (size_t i = 0; i < n; i++) moved[i] = u[i] + steps[k] * h * v[i];
        F4[k] = static_design_evaluate(f.sd, moved, NULL, &info);
    }
    double difference = (8 * (F4[2] - F4[1]) - (F4[3] - F4[0])) / (12 * h);
    print_message("%-15s %s%s%s: tangent %.1e, differences %.1e\n", block, end == ROD_FREE ? "free" : "held",
                  around_names[around], cosserat ? ", stretching" : "", fabs(slope - tangent) / terms,
                  fabs(slope - difference) / terms);
    assert_true(fabs(slope - tangent) < 1e-11 * terms && fabs(slope - difference) < 1e-6 * terms);
    mem_free(u);
    fixture_clear(&f);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_gradients(void **state)
{
    (void)state;
    for (int k = 0; k < 4 * AROUND_COUNT; k++) {
        RodSupport end = k % 2 ? ROD_PINNED : ROD_FREE;
        Around around = (Around)(k / 2 % AROUND_COUNT);
        bool stretches = k / 2 / AROUND_COUNT;
        if (around == WOUND && end != ROD_FREE) continue;
        if (around == LED && end == ROD_FREE) continue;
        if (around == LED) end = ROD_CLAMPED;
        check(end, around, stretches, "magnetization",
              (Unknown){.lower = -INFINITY, .upper = INFINITY, .scale = 1e4});
        check(end, around, stretches, "young",
              (Unknown){.map = UNKNOWN_LOG, .scale = 0.7, .lower = 1e4, .upper = 1e8});
        check(end, around, stretches, "natural_strain",
              (Unknown){.lower = -INFINITY, .upper = INFINITY, .scale = 10});
        check(end, around, stretches, "flux_density",
              (Unknown){.lower = -1, .upper = 1, .scale = 0.01, .per_case = true});
        Unknown factor = {.lower = -9, .upper = 9, .scale = 1};
        if (around == DIPOLE) check(end, around, stretches, "field_scale", factor);
        if (around == POTENTIAL) check(end, around, stretches, "potential_scale", factor);
        if (around == COUPLE || around == WOUND)
            check(end, around, stretches, "couple",
                  (Unknown){.lower = -1, .upper = 1, .scale = 1e-7, .per_case = true});
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_gradients)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
