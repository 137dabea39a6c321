/* Every term of a rod, in both forms, against differences; both forms against each other; the discrete
 * inverse; how far and how fast equilibria converge. */
#include "base/memory.h"
#include "base/random.h"
#include "rod/inverse.h"
#include "rod/terms.h"
#include "solve/check.h"
#include "solve/newton.h"
#include "solve/ramp.h"
#include "tests/flux_fixture.h"
#include "tests/rod_taper.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

enum { ELEMENTS = 11 };

static Vec3 random_vec3(Random *random, double size)
{
    return vec3(size * random_signed(random), size * random_signed(random), size * random_signed(random));
}

/* A formula and a dipole beside the rod, of which a term is to know value, gradient and curvature; and another
 * one that is off, of which it is to know what it would do. */
static FluxFields make_fields(void)
{
    FluxFields fields = {0};
    static const char *const expressions[] = {"0.05*sin(40*x)*cos(t)", "x*z*10", "0.02*exp(20*y)-3*x*y"};
    static const char *const variables[] = {"x", "y", "z", "r", "t", NULL};
    Formula *formula = formula_create(expressions, 3, NULL, 0, variables, NULL);
    assert_non_null(formula);
    flux_fields_add(&fields, flux_field_formula(formula, 0.1));
    for (int k = 0; k < 2; k++)
        flux_fields_add(&fields,
                        flux_field_dipole((double[]){0.05, 0.05, 0.2 - 0.5 * k}, (double[]){1, -2, 5}));
    return fields;
}

/* One that depends on all that it may, and one that is off. */
static RodPotentials make_potentials(void)
{
    RodPotentials potentials = {0};
    static const char *const expressions[] = {"0.3*sin(30*x)*(y+z*z)*cos(t)+2*r^2*s/L", "5*x*x+exp(10*y)*z"};
    for (int k = 0; k < 2; k++) {
        Formula *formula = formula_create(&expressions[k], 1, NULL, 0, rod_place_variables, NULL);
        assert_non_null(formula);
        rod_potentials_add(&potentials, rod_potential_create(formula, 0.1));
    }
    return potentials;
}

static Rod *random_rod(Random *random, bool varies, bool cosserat, int strands, double **params)
{
    RodActs acts = {.couples = true};
    if (varies) acts.fields = make_fields(), acts.potentials = make_potentials();
    const double length[] = {0.1, 0.07, 0.12};
    Rod *rod = rod_create_strands(strands, ELEMENTS, length, rod_circle(1e-3, 1, 0.4, 1200), &acts);
    rod_taper(rod, 2e-3, 1.2e-3, (double[]){0.4, 0.7}, 0.4, 1200);
    rod->cosserat = cosserat;
    double *p = mem_alloc((size_t)rod->params.size, sizeof *p);
    rod_default_params(rod, 1e6, p);
    for (int e = 0; e < rod->elements; e++) {
        p[rod->young + e] *= 1 + 0.3 * random_signed(random);
        vec3_store(p + rod->natural_strain + 3 * e, random_vec3(random, 60));
        vec3_store(p + rod->magnetization + 3 * e, random_vec3(random, 5e4));
        rod->bow[e] = random_vec3(random, 1e-3);
    }
    for (int i = 0; i < rod_node_count(rod); i++)
        vec3_store(p + rod->load + 3 * i, random_vec3(random, 1e-3));
    for (int i = 0; i < rod_node_count(rod); i++)
        vec3_store(p + rod->couple + 3 * i, random_vec3(random, 1e-4));
    for (int k = 0; k < rod->potentials.count; k++) p[rod->potential_scale + k] = 1.5 * (1 - k);
    vec3_store(p + rod->flux.uniform, random_vec3(random, 0.03));
    vec3_store(p + rod->gravity, random_vec3(random, 9));
    for (int k = 0; k < rod->fields.count; k++) p[rod->flux.scale + k] = 1 - 0.5 * k;
    disturb_fields(&rod->fields, &rod->flux, 2e-3, random, p);
    p[rod->damping] = 0.02;
    rod_sum_loads(rod, p);
    for (int k = 0; k < strands; k++) rod->strand[k].frame = quat_exp(random_vec3(random, 2));
    *params = p;
    return rod;
}

/* Any rotations with turns between neighbours up to `turn`, any positions, strains and multipliers. */
static double *random_state(const Rod *rod, const RodLayout *layout, double turn, Random *random)
{
    Quat q[3 * (ELEMENTS + 1)];
    double *x = mem_alloc((size_t)layout->dofs, sizeof *x);
    for (int i = 0; i < layout->nodes; i++)
        q[i] = i % (ELEMENTS + 1) ? quat_mul(q[i - 1], quat_exp(random_vec3(random, turn)))
                                  : rod->strand[i / (ELEMENTS + 1)].frame;
    rod_set_state(rod, layout, q, x);
    for (int i = 0; layout->position >= 0 && i < 3 * layout->nodes; i++) x[i] += 2e-3 * random_signed(random);
    for (int i = 0; layout->multiplier >= 0 && i < 3 * rod->elements; i++)
        x[layout->multiplier + i] = 1e-3 * random_signed(random);
    for (int i = 0; layout->strain >= 0 && i < 3 * rod->elements; i++)
        x[layout->strain + i] = 0.3 * random_signed(random);
    return x;
}

static double dof_size(const RodLayout *layout, int dof)
{
    return layout->position >= 0 && dof < layout->turn            ? 1e-2
           : layout->multiplier >= 0 && dof >= layout->multiplier ? 1e-3
                                                                  : 1;
}

static void check_form(const Rod *rod, const double *p, bool positions, double turn, Random *random)
{
    RodLayout layout = rod_layout(rod, positions);
    System *sys = positions ? rod_system(rod, 1e6, true) : rod_hanging_system(rod);
    double *x = random_state(rod, &layout, turn, random), size[TERM_MAX_DOF];
    Point at = {.x = x, .p = p, .time = 0.3, .dt = 0.01};
    for (int t = 0; t < system_term_count(sys); t++) {
        const Term *term = system_term(sys, t);
        int dof[TERM_MAX_DOF];
        term->ops->dofs(term->self, 0, dof);
        for (int i = 0; i < term->ops->size(term->self); i++) size[i] = dof_size(&layout, dof[i]);
        TermError error = check_term(term, &rod->params, &at, system_dof_count(sys), size, random);
        print_message("%-10s gradient %.1e  hessian %.1e  param_forward %.1e  param %.1e  prev_forward %.1e  "
                      "prev %.1e\n",
                      term->ops->name, error.gradient, error.hessian, error.forward, error.adjoint,
                      error.prev_forward, error.prev);
        assert_true(check_differences(error) < 1e-9 && check_products(error) < 1e-11);
    }
    system_destroy(sys);
    mem_free(x);
}

/* In motion too; turns so small that the series is used, and so large that it is not. */
static void check_rod(bool fields, bool cosserat, int strands)
{
    Random random = random_seed(3);
    double *p;
    Rod *rod = random_rod(&random, fields, cosserat, strands, &p);
    for (int k = 0; k < 2; k++) {
        if (!fields) check_form(rod, p, false, k ? 1.2 : 0.2, &random);
        check_form(rod, p, true, k ? 1.2 : 0.2, &random);
    }
    mem_free(p);
    rod_destroy(rod);
}

static void test_derivatives(void **state)
{
    (void)state;
    for (int strands = 1; strands <= 3; strands += 2)
        for (int k = 0; k < 4; k++) check_rod(k % 2, k / 2, strands);
}

/* Where forces are in balance their whole derivative is H + S: by it the gradient changes when the references have taken a
 * small turn. And S is skew. */
static void check_whole_derivative(bool positions)
{
    Random random = random_seed(5);
    double *p;
    Rod *rod = random_rod(&random, false, false, 1, &p);
    RodLayout layout = rod_layout(rod, positions);
    System *sys = positions ? rod_system(rod, 1e6, false) : rod_hanging_system(rod);
    double *x = random_state(rod, &layout, 0.3, &random);
    if (positions) rod_places(rod, &layout, x, layout.nodes, x);
    rod_balance(rod, sys, &layout, 0, x, p);
    size_t n = (size_t)layout.dofs;
    double *g = mem_alloc(5 * n, sizeof *g), *d = g + n, *r = g + 2 * n, *w = g + 3 * n, *moved = g + 4 * n;
    Point at = {.x = x, .p = p};
    Evaluation left = system_hessian(sys, &at, g);
    assert_true(left.gradient_max <= 1e-13 * left.force_scale);
    for (int i = 0; i < layout.dofs; i++)
        if (!system_is_fixed(sys, i))
            d[i] = dof_size(&layout, i) * random_signed(&random), w[i] = d[i] * random_signed(&random);
    system_multiply(sys, d, r);
    double skew = 0, off = 0, largest = 0, h = 1e-3, *S = mem_alloc(2 * n, sizeof *S), *T = S + n;
    system_circulate(sys, &at, d, S);
    system_circulate(sys, &at, w, T);
    for (size_t i = 0; i < n; i++) skew += w[i] * S[i] + d[i] * T[i], r[i] += S[i];
    double *sum = mem_alloc(n, sizeof *sum);
    for (int k = -1; k <= 1; k += 2) {
        for (size_t i = 0; i < n; i++) moved[i] = x[i] + k * h * d[i];
        system_accept(sys, moved, NULL);
        system_gradient(sys, &(Point){.x = moved, .p = p}, g);
        for (size_t i = 0; i < n; i++) sum[i] += k * g[i] / (2 * h);
    }
    for (int i = 0; i < layout.dofs; i++) {
        if (system_is_fixed(sys, i)) continue;
        off = fmax(off, fabs(sum[i] - r[i]) / dof_size(&layout, i));
        largest = fmax(largest, fabs(r[i]) / dof_size(&layout, i));
    }
    print_message("%s: gradient against H + S: %.1e; skew to %.1e\n", positions ? "positions" : "hanging",
                  off / largest, fabs(skew));
    assert_true(off < 1e-4 * largest && fabs(skew) < 1e-18);
    mem_free(sum);
    mem_free(S);
    mem_free(g);
    mem_free(x);
    mem_free(p);
    system_destroy(sys);
    rod_destroy(rod);
}

static void test_whole_derivative(void **state)
{
    (void)state;
    check_whole_derivative(false);
    check_whole_derivative(true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_derivatives),
                                       cmocka_unit_test(test_whole_derivative)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
