/* Every term of a rod, in both forms, against differences; both forms against each other; the discrete
 * inverse; how far and how fast equilibria converge. */
#include "base/memory.h"
#include "base/random.h"
#include "rod/inverse.h"
#include "rod/terms.h"
#include "solve/check.h"
#include "solve/newton.h"
#include "solve/ramp.h"
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
static void add_fields(Rod *rod)
{
    static const char *const expressions[] = {"0.05*sin(40*x)*cos(t)", "x*z*10", "0.02*exp(20*y)-3*x*y"};
    static const char *const variables[] = {"x", "y", "z", "r", "t", NULL};
    Formula *formula = formula_create(expressions, 3, NULL, 0, variables, NULL);
    assert_non_null(formula);
    flux_fields_add(&rod->fields, &rod->params, flux_field_formula(formula, 0.1));
    for (int k = 0; k < 2; k++)
        flux_fields_add(&rod->fields, &rod->params,
                        flux_field_dipole((double[]){0.05, 0.05, 0.2 - 0.5 * k}, (double[]){1, -2, 5}));
}

static Rod *random_rod(Random *random, bool fields, double **params)
{
    Rod *rod = rod_create(ELEMENTS, 0.1, rod_ellipse(1e-3, 0.7e-3, 1, 0.4, 1200), 3e-6);
    if (fields) add_fields(rod);
    double *p = mem_alloc((size_t)rod->params.size, sizeof *p);
    rod_default_params(rod, 1e6, p);
    for (int e = 0; e < ELEMENTS; e++) {
        p[rod->young + e] *= 1 + 0.3 * random_signed(random);
        vec3_store(p + rod->natural_strain + 3 * e, random_vec3(random, 60));
        vec3_store(p + rod->magnetization + 3 * e, random_vec3(random, 5e4));
        rod->bow[e] = random_vec3(random, 1e-3);
    }
    for (int i = 0; i <= ELEMENTS; i++) vec3_store(p + rod->load + 3 * i, random_vec3(random, 1e-3));
    vec3_store(p + rod->flux_density, random_vec3(random, 0.03));
    vec3_store(p + rod->gravity, random_vec3(random, 9));
    for (int k = 0; k < rod->fields.count; k++) p[rod->field_scale + k] = 1 - 0.5 * k;
    rod_sum_loads(rod, p);
    rod->frame = quat_exp(random_vec3(random, 2));
    *params = p;
    return rod;
}

/* Any rotations with turns between neighbours up to `turn`, any positions and multipliers. */
static double *random_state(const Rod *rod, const RodLayout *layout, double turn, Random *random)
{
    Quat q[ELEMENTS + 1] = {rod->frame};
    double *x = mem_alloc((size_t)layout->dofs, sizeof *x);
    for (int e = 0; e < ELEMENTS; e++) q[e + 1] = quat_mul(q[e], quat_exp(random_vec3(random, turn)));
    rod_set_state(rod, layout, q, x);
    for (int i = 0; layout->position >= 0 && i < 3 * layout->nodes; i++) x[i] += 2e-3 * random_signed(random);
    for (int i = 0; layout->multiplier >= 0 && i < 3 * rod->elements; i++)
        x[layout->multiplier + i] = 1e-3 * random_signed(random);
    return x;
}

/* Turns so small that the series is used, and so large that it is not. */
static void check_rows(bool fields)
{
    Random random = random_seed(3);
    double *p, dof_size[TERM_MAX_DOF];
    Rod *rod = random_rod(&random, fields, &p);
    for (int r = 0; r < 2 * rod_term_row_count; r++) {
        const RodTermRow *row = &rod_term_rows[r / 2];
        RodLayout layout = rod_layout(rod, fields || row->form == ROD_WITH_POSITIONS);
        double *x = random_state(rod, &layout, r % 2 ? 1.2 : 0.2, &random);
        Term term = row->create(rod, layout, 50);
        bool link = row->form == ROD_WITH_POSITIONS;
        for (int i = 0; i < TERM_MAX_DOF; i++)
            dof_size[i] = !link ? (i < 6 ? 1 : 1e-3) : i < 6 ? 1e-2 : i < 12 ? 1 : 1e-3;
        Point at = {.x = x, .p = p, .time = 0.3};
        TermError worst = check_term(&term, &rod->params, &at, dof_size, &random);
        print_message("%-10s gradient %.1e  hessian %.1e  param_forward %.1e  param %.1e\n", row->name,
                      worst.gradient, worst.hessian, worst.forward, worst.adjoint);
        assert_true(worst.gradient < 1e-9 && worst.hessian < 1e-9 && worst.forward < 1e-9 &&
                    worst.adjoint < 1e-11);
        term.ops->destroy(term.self);
        mem_free(x);
    }
    mem_free(p);
    rod_destroy(rod);
}

static void test_derivatives(void **state)
{
    (void)state;
    check_rows(false);
    check_rows(true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_derivatives)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
