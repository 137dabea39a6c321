/* Every term of a shell in motion: value, gradient, Hessian and products with what else it depends on, against each
 * other. */
#include "shell/terms.h"
#include "solve/check.h"
#include "tests/cloud_fixture.h"
#include "tests/shell_fixture.h"
#include "tests/flux_fixture.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { CELLS = 5 };

/* A curved, irregular sheet with a clamped edge, another pose, and every parameter at work. */
static Shell *make_shell(BendingModel bending, FluxField *field)
{
    MeshFile file = {0};
    Error err;
    double size[2] = {0.05, 0.03};
    int cells[2] = {CELLS, CELLS - 2};
    assert_true(shape_sheet(size, cells, PATTERN_CROSSED, &file, &err));
    Random random = random_seed(3);
    for (int v = 0; v < file.vertex_count; v++) {
        double *x = file.vertices[v];
        x[0] += 1e-3 * random_signed(&random), x[1] += 1e-3 * random_signed(&random);
        x[2] = 4e-3 * sin(80 * x[0]) + 20 * x[1] * x[1] + 5e-4 * random_signed(&random);
    }
    FluxFields fields = {0};
    if (field) {
        flux_fields_add(&fields, field);
        flux_fields_add(&fields, flux_field_dipole((double[]){0, 0, -0.06}, (double[]){0.3, 0.1, 0.2}));
    }
    Shell *shell = shell_in_fields(&file, &fields);
    const Mesh *mesh = shell->mesh;
    shell->thickness = 1e-3, shell->poisson = 0.4, shell->density = 1200, shell->bending = bending;
    for (int e = 0; e < mesh->edge_count; e++) {
        const int *v = mesh->edges[e];
        if (v[0] % (CELLS + 1) || v[1] % (CELLS + 1) || v[1] >= (CELLS + 1) * (CELLS - 1)) continue;
        shell_clamp(shell, e);
        for (int i = 0; i < 6; i++) shell_fix(shell, v[i / 3], i % 3);
    }
    return shell;
}

static double *make_params(const Shell *shell, Random *random)
{
    double *p = mem_alloc((size_t)shell->params.size, sizeof *p);
    shell_default_params(shell, p);
    for (int f = 0; f < shell->mesh->face_count; f++) {
        p[shell->young + f] = 1e5 * (1 + random_uniform(random));
        p[shell->face_thickness + f] *= 0.5 + random_uniform(random);
        p[shell->face_density + f] *= 0.5 + random_uniform(random);
        for (int i = 0; i < 3; i++) p[shell->magnetization + 3 * f + i] = 5e4 * random_signed(random);
    }
    disturb_fields(&shell->fields, &shell->flux, 2e-3, random, p);
    if (shell->fields.count) p[shell->flux.scale + 1] = 0; /* off: what it would do is known too */
    for (int e = 0; e < shell->mesh->edge_count; e++) p[shell->fold + e] = 0.5 + random_uniform(random);
    p[shell->damping] = 0.02;
    for (int i = 0; i < 3; i++) {
        p[shell->flux.uniform + i] = 0.05 * random_signed(random);
        p[shell->gravity + i] = 10 * random_signed(random);
    }
    for (int i = 0; i < 3 * shell->mesh->vertex_count; i++) p[shell->load + i] = 1e-3 * random_signed(random);
    return p;
}

static void check_rows(Shell *shell)
{
    Random random = random_seed(17);
    double *p = make_params(shell, &random);
    System *sys = shell_dynamic_system(shell);
    State now = system_state(sys);
    double *x = now.x, dof_size[TERM_MAX_DOF];
    shell_rest_state(shell, x);
    for (int i = 0; i < shell_dof_count(shell); i++)
        x[i] += (i < 3 * shell->mesh->vertex_count ? 2e-3 : 0.3) * random_signed(&random);
    for (int i = 0; i < TERM_MAX_DOF; i++) dof_size[i] = i < 18 ? 1e-3 : 1;
    system_accept(sys, x, now.memory);
    Point at = state_point(&now, p);
    at.time = 0.3, at.dt = 0.01;
    for (int t = 0; t < system_term_count(sys); t++) {
        Point own = system_term_point(sys, t, &at);
        TermError error =
            check_term(system_term(sys, t), &shell->params, &own, system_dof_count(sys), dof_size, &random);
        print_message("%-10s gradient %.1e  hessian %.1e  param_forward %.1e  param %.1e  prev_forward %.1e  "
                      "prev %.1e\n",
                      system_term(sys, t)->ops->name, error.gradient, error.hessian, error.forward,
                      error.adjoint, error.prev_forward, error.prev);
        assert_true(check_differences(error) < 1e-7 && check_products(error) < 1e-11);
    }
    system_destroy(sys);
    state_destroy(&now);
    mem_free(p);
    shell_destroy(shell);
}

static void test_midedge(void **state)
{
    (void)state;
    check_rows(make_shell(BENDING_MIDEDGE, NULL));
}

static void test_hinge(void **state)
{
    (void)state;
    check_rows(make_shell(BENDING_HINGE, NULL));
}

static void test_neo_hookean(void **state)
{
    (void)state;
    const double poisson[] = {0, 0.3, 0.5};
    for (int k = 0; k < 3; k++) {
        Shell *shell = make_shell(BENDING_HINGE, NULL);
        shell->material = MEMBRANE_NEO_HOOKEAN, shell->poisson = poisson[k];
        check_rows(shell);
    }
}

static void test_dipole(void **state)
{
    (void)state;
    check_rows(make_shell(BENDING_MIDEDGE,
                          flux_field_dipole((double[]){0.01, 0.02, 0.05}, (double[]){0.1, -0.2, 0.5})));
}

static void test_formula(void **state)
{
    (void)state;
    static const char *const expressions[] = {"0.05*sin(40*x)*cos(t)", "x*z*10", "0.02*exp(20*y)-3*x*y"};
    static const char *const variables[] = {"x", "y", "z", "r", "t", NULL};
    Formula *formula = formula_create(expressions, 3, NULL, 0, variables, NULL);
    assert_non_null(formula);
    check_rows(make_shell(BENDING_MIDEDGE, flux_field_formula(formula, 0.06)));
}

/* A term whose elements change. */
static void test_changing(void **state)
{
    (void)state;
    Random random = random_seed(4);
    Cloud cloud = cloud_create();
    System *sys = cloud_system(&cloud);
    State now = cloud_state(sys);
    double dof_size[6] = {0.1, 0.1, 0.1, 0.1, 0.1, 0.1};
    Point at = state_point(&now, cloud.p);
    at.x_prev = now.x, at.v_prev = now.v, at.dt = 0.1;
    TermError error = check_term(system_term(sys, 1), &cloud.params, &at, CLOUD_DOFS, dof_size, &random);
    assert_true(cloud_springs(sys)->count > 2 * PACK_LANES);
    assert_true(check_differences(error) < 1e-7 && check_products(error) < 1e-11);
    state_destroy(&now);
    system_destroy(sys);
    params_clear(&cloud.params);
}

/* ---- Terms that leave something out, or get it wrong: the check must see it ---- */

static const TermOps *right; /* of the term that is spoilt */

static Pack no_eval(const void *self, int pack, const Point *at, const Pack *x, Pack *g, Pack *H)
{
    (void)pack, (void)at, (void)x;
    int size = right->size(self);
    for (int i = 0; g && i < size; i++) g[i] = pack_set(0);
    for (int i = 0; H && i < TERM_LOWER(size, 0); i++) H[i] = pack_set(0);
    return pack_set(0);
}

/* Forgets that the start's velocity counts. */
static void half_prev(const void *self, int pack, const Point *at, const Pack *x, const Pack *w, Pack *dx,
                      Pack *dv)
{
    right->prev(self, pack, at, x, w, dx, dv);
    for (int i = 0; i < 3; i++) dv[i] = pack_set(0);
}

static void half_prev_forward(const void *self, int pack, const Point *at, const Pack *x, const Pack *dx,
                              const Pack *dv, Pack *r)
{
    Pack none[3] = {{0}};
    (void)dv;
    right->prev_forward(self, pack, at, x, dx, none, r);
}

typedef enum Spoil {
    NO_PARAM,
    NO_PARAM_FORWARD,
    NO_PARAMS,
    NO_PREVS,
    HALF_PREV,
    HALF_PREVS,
    NO_EVAL,
    SPOILS
} Spoil;

static TermOps spoil(const TermOps *ops, Spoil how)
{
    TermOps wrong = *ops;
    if (how == NO_PARAM || how == NO_PARAMS) wrong.param = NULL;
    if (how == NO_PARAM_FORWARD || how == NO_PARAMS) wrong.param_forward = NULL;
    if (how == NO_PREVS) wrong.prev = NULL, wrong.prev_forward = NULL;
    if (how == HALF_PREV || how == HALF_PREVS) wrong.prev = half_prev;
    if (how == HALF_PREVS) wrong.prev_forward = half_prev_forward;
    if (how == NO_EVAL) wrong.eval = no_eval;
    return wrong;
}

static bool can_be(const TermOps *ops, Spoil how)
{
    bool velocity = !strcmp(ops->name, "inertia");
    return how == NO_EVAL    ? true
           : how < NO_PREVS  ? ops->param != NULL
           : how == NO_PREVS ? ops->prev != NULL
                             : velocity;
}

/* In statics too, and wherever the caller says that a step begins. */
static void test_blind(void **state)
{
    (void)state;
    Random random = random_seed(23);
    Shell *shell = make_shell(BENDING_MIDEDGE, NULL);
    double *p = make_params(shell, &random), dof_size[TERM_MAX_DOF];
    System *sys = shell_dynamic_system(shell);
    State now = system_state(sys);
    double *x = now.x;
    shell_rest_state(shell, x);
    for (int i = 0; i < shell_dof_count(shell); i++) x[i] += 1e-3 * random_signed(&random);
    for (int i = 0; i < TERM_MAX_DOF; i++) dof_size[i] = i < 18 ? 1e-3 : 1;
    Point at = state_point(&now, p);
    at.x_prev = x;
    int seen[SPOILS] = {0};
    system_accept(sys, x, now.memory);
    for (int t = 0; t < system_term_count(sys); t++)
        for (int how = 0; how < SPOILS; how++) {
            Term term = *system_term(sys, t);
            right = term.ops;
            if (!can_be(right, (Spoil)how)) continue;
            TermOps wrong = spoil(right, (Spoil)how);
            term.ops = &wrong;
            Point own = system_term_point(sys, t, &at);
            TermError error =
                check_term(&term, &shell->params, &own, system_dof_count(sys), dof_size, &random);
            if (check_differences(error) < 1e-3 && check_products(error) < 1e-3)
                fail_msg("%s passes, spoilt in the way %d", right->name, how);
            seen[how]++;
        }
    for (int how = 0; how < SPOILS; how++) assert_true(seen[how] > 0);
    system_destroy(sys);
    state_destroy(&now);
    mem_free(p);
    shell_destroy(shell);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_midedge), cmocka_unit_test(test_hinge),   cmocka_unit_test(test_neo_hookean),
        cmocka_unit_test(test_dipole),  cmocka_unit_test(test_formula), cmocka_unit_test(test_changing),
        cmocka_unit_test(test_blind),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
