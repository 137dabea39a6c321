/* Every row of every term list: value, gradient, Hessian and parameter products against each other. */
#include "base/memory.h"
#include "shell/shapes.h"
#include "shell/terms.h"
#include "solve/check.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

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
    Mesh *mesh = mesh_create(&file, 0, NULL, &err);
    mesh_file_clear(&file);
    assert_non_null(mesh);
    Shell *shell = shell_create(mesh);
    shell->thickness = 1e-3, shell->poisson = 0.4, shell->density = 1200, shell->bending = bending;
    if (field) {
        flux_fields_add(&shell->fields, &shell->params, field);
        flux_fields_add(&shell->fields, &shell->params,
                        flux_field_dipole((double[]){0, 0, -0.06}, (double[]){0.3, 0.1, 0.2}));
    }
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
        for (int i = 0; i < 3; i++) p[shell->magnetization + 3 * f + i] = 5e4 * random_signed(random);
    }
    if (shell->fields.count) p[shell->field_scale + 1] = 0; /* off: what it would do is known too */
    for (int e = 0; e < shell->mesh->edge_count; e++) p[shell->fold + e] = 0.5 + random_uniform(random);
    for (int i = 0; i < 3; i++) {
        p[shell->flux_density + i] = 0.05 * random_signed(random);
        p[shell->gravity + i] = 10 * random_signed(random);
    }
    for (int i = 0; i < 3 * shell->mesh->vertex_count; i++) p[shell->load + i] = 1e-3 * random_signed(random);
    return p;
}

static void check_rows(BendingModel bending, FluxField *field)
{
    Random random = random_seed(17);
    Shell *shell = make_shell(bending, field);
    double *p = make_params(shell, &random);
    double *x = mem_alloc((size_t)shell_dof_count(shell), sizeof *x), dof_size[TERM_MAX_DOF];
    shell_rest_state(shell, x);
    for (int i = 0; i < shell_dof_count(shell); i++)
        x[i] += (i < 3 * shell->mesh->vertex_count ? 2e-3 : 0.3) * random_signed(&random);
    for (int i = 0; i < TERM_MAX_DOF; i++) dof_size[i] = i < 18 ? 1e-3 : 1;
    Point at = {.x = x, .p = p, .time = 0.3};
    for (int r = 0; r < shell_term_row_count; r++) {
        Term term = shell_term_rows[r].create(shell);
        if (term.ops->accept) term.ops->accept(term.self, x);
        TermError worst = check_term(&term, &shell->params, &at, dof_size, &random);
        print_message("%-10s gradient %.1e  hessian %.1e  param_forward %.1e  param %.1e\n",
                      shell_term_rows[r].name, worst.gradient, worst.hessian, worst.forward, worst.adjoint);
        assert_true(worst.gradient < 1e-7);
        assert_true(worst.hessian < 1e-7);
        assert_true(worst.forward < 1e-7);
        assert_true(worst.adjoint < 1e-11);
        term.ops->destroy(term.self);
    }
    mem_free(x);
    mem_free(p);
    shell_destroy(shell);
}

static void test_midedge(void **state)
{
    (void)state;
    check_rows(BENDING_MIDEDGE, NULL);
}

static void test_hinge(void **state)
{
    (void)state;
    check_rows(BENDING_HINGE, NULL);
}

static void test_dipole(void **state)
{
    (void)state;
    check_rows(BENDING_MIDEDGE, flux_field_dipole((double[]){0.01, 0.02, 0.05}, (double[]){0.1, -0.2, 0.5}));
}

static void test_formula(void **state)
{
    (void)state;
    static const char *const expressions[] = {"0.05*sin(40*x)*cos(t)", "x*z*10", "0.02*exp(20*y)-3*x*y"};
    static const char *const variables[] = {"x", "y", "z", "r", "t", NULL};
    Formula *formula = formula_create(expressions, 3, NULL, 0, variables, NULL);
    assert_non_null(formula);
    check_rows(BENDING_MIDEDGE, flux_field_formula(formula, 0.06));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_midedge),
        cmocka_unit_test(test_hinge),
        cmocka_unit_test(test_dipole),
        cmocka_unit_test(test_formula),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
