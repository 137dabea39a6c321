/* dF/du of designs of rods against central differences and against the forward tangent: magnetisation,
 * stiffness, natural strains and fields, with a free and with a held end, in a uniform field and in one more that
 * varies in space. */
#include "base/memory.h"
#include "base/random.h"
#include "optim/objectives.h"
#include "optim/static_design.h"
#include "rod/rod.h"
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

/* The shape is one that a magnetisation along the rod takes in a field across it. */
static Fixture fixture_create(RodSupport end, bool field, Random *random)
{
    FluxFields fields = {0};
    if (field)
        flux_fields_add(&fields, flux_field_dipole((double[]){0.03, 0.03, 0.03}, (double[]){0.2, 0.5, -0.4}));
    Fixture f = {.rod = rod_create(N, length, rod_circle(0.5e-3, 1, 0.4, 1800), M_PI * 0.25e-6, &fields)};
    Rod *rod = f.rod;
    rod->end = end;
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
    if (field) p[rod->flux.scale] = 1;
    vec3_store(p + rod->gravity, vec3(0, 0, -9.81));
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
    system_solve(f->load.sys, dx, dx);
    f->load.objectives[0].ops->value(f->load.objectives[0].self, 1, f->load.state.x, p, gx, dp);
    for (size_t i = 0; i < dofs; i++) slope -= gx[i] * dx[i];
    mem_free(dp);
    mem_free(dx);
    return slope;
}

static void check(RodSupport end, bool field, const char *block, Unknown unknown)
{
    long blocks = mem_live_count();
    Random random = random_seed(11);
    Fixture f = fixture_create(end, field, &random);
    fixture_start(&f, block, unknown);
    size_t n = (size_t)f.design.size;
    double *u = mem_alloc(4 * n, sizeof *u), *g = u + n, *v = u + 2 * n, *moved = u + 3 * n, slope = 0, F4[4];
    CaseInfo info;
    design_read(&f.design, 0, f.load.stages[0].p, u);
    assert_true(isfinite(static_design_evaluate(f.sd, u, g, &info)));
    static_design_accept(f.sd);
    for (size_t i = 0; i < n; i++) v[i] = random_signed(&random), slope += g[i] * v[i];
    double tangent = tangent_slope(&f, u, v), h = 1e-3;
    for (int k = 0; k < 4; k++) {
        static const double steps[4] = {-2, -1, 1, 2};
        for (size_t i = 0; i < n; i++) moved[i] = u[i] + steps[k] * h * v[i];
        F4[k] = static_design_evaluate(f.sd, moved, NULL, &info);
    }
    double difference = (8 * (F4[2] - F4[1]) - (F4[3] - F4[0])) / (12 * h);
    print_message("%-15s %s%s: tangent %.1e, differences %.1e\n", block, end == ROD_FREE ? "free" : "held",
                  field ? ", in a dipole's field" : "", fabs(slope / tangent - 1),
                  fabs(slope / difference - 1));
    assert_true(fabs(slope / tangent - 1) < 1e-10 && fabs(slope / difference - 1) < 1e-6);
    mem_free(u);
    fixture_clear(&f);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_gradients(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        RodSupport end = k % 2 ? ROD_PINNED : ROD_FREE;
        bool field = k / 2;
        check(end, field, "magnetization", (Unknown){.lower = -INFINITY, .upper = INFINITY, .scale = 1e4});
        check(end, field, "young", (Unknown){.map = UNKNOWN_LOG, .scale = 0.7, .lower = 1e4, .upper = 1e8});
        check(end, field, "natural_strain", (Unknown){.lower = -INFINITY, .upper = INFINITY, .scale = 10});
        check(end, field, "flux_density",
              (Unknown){.lower = -1, .upper = 1, .scale = 0.01, .per_case = true});
        if (field) check(end, field, "field_scale", (Unknown){.lower = -9, .upper = 9, .scale = 1});
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_gradients)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
