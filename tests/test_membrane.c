/* Stretching of shells of either material against closed forms: uniaxial and equibiaxial stretch in plane stress, and
 * what each bears of being crushed. */
#include "solve/newton.h"
#include "tests/shell_fixture.h"
#include <math.h>

static const double SIDE = 0.1, THICKNESS = 1e-3, YOUNG = 1e5;

/* A flat square that stays in its plane and does not slide along x = 0 and y = 0. */
static Shell *make_square(MembraneMaterial material, double poisson)
{
    Shell *shell = shell_of_sheet((double[]){SIDE, SIDE}, (int[]){5, 3}, PATTERN_CROSSED);
    shell->material = material, shell->poisson = poisson;
    shell->thickness = THICKNESS, shell->density = 1000, shell->bending = BENDING_HINGE;
    for (int v = 0; v < shell->mesh->vertex_count; v++) {
        shell_fix(shell, v, 2);
        for (int i = 0; i < 2; i++)
            if (shell->mesh->rest[v][i] < 1e-9) shell_fix(shell, v, i);
    }
    return shell;
}

static NewtonInfo solve(Body *b)
{
    NewtonDef def = newton_default();
    def.step_tol = 1e-12;
    return newton_minimize(b->sys, &def, &(Point){.p = b->p}, &b->state, NULL);
}

/* By the body, along x, on what is held at x = SIDE, over the side's rest section. */
static double pull(const Body *b)
{
    double *gradient = mem_alloc((size_t)shell_dof_count(b->shell), sizeof *gradient), sum = 0;
    Point at = state_point(&b->state, b->p);
    system_gradient(b->sys, &at, gradient);
    for (int v = 0; v < b->shell->mesh->vertex_count; v++)
        if (b->shell->mesh->rest[v][0] > SIDE - 1e-9) sum += gradient[3 * v];
    mem_free(gradient);
    return sum / (SIDE * THICKNESS);
}

static double energy(const Body *b)
{
    Point at = state_point(&b->state, b->p);
    return system_term_energy(b->sys, 0, &at, NULL) / (SIDE * SIDE * THICKNESS);
}

typedef struct Form {
    double across, stress, energy; /* of stretch l; the stress is dW/dl of a side of the unit square */
} Form;

/* l, l^-nu; mu (l - l^(-1-2nu)), of which W is the integral. */
static Form uniaxial(double nu, double l)
{
    double mu = YOUNG / (2 * (1 + nu));
    return (Form){pow(l, -nu), mu * (l - pow(l, -1 - 2 * nu)),
                  mu * ((l * l - 1) / 2 - (nu > 0 ? (1 - pow(l, -2 * nu)) / (2 * nu) : log(l)))};
}

/* l, l; mu (l - l^(-1-4k)), k = nu/(1-nu): for nu = 1/2 the usual l - l^-5. */
static Form equibiaxial(double nu, double l)
{
    double mu = YOUNG / (2 * (1 + nu)), k = nu / (1 - nu);
    return (Form){l, mu * (l - pow(l, -1 - 4 * k)),
                  mu * ((l * l - 1) - (k > 0 ? (1 - pow(l, -4 * k)) / (2 * k) : 2 * log(l)))};
}

static void check_form(double nu, double l, Form form, bool held_across)
{
    Shell *shell = make_square(MEMBRANE_NEO_HOOKEAN, nu);
    for (int v = 0; v < shell->mesh->vertex_count; v++)
        for (int i = 0; i < (held_across ? 2 : 1); i++)
            if (shell->mesh->rest[v][i] > SIDE - 1e-9) shell_fix(shell, v, i);
    Body b = body_create(shell, shell_system(shell), YOUNG);
    for (int v = 0; v < shell->mesh->vertex_count; v++) {
        b.state.x[3 * v] *= l;
        if (held_across) b.state.x[3 * v + 1] *= l;
    }
    assert_int_equal(solve(&b).status, NEWTON_CONVERGED);
    for (int v = 0; v < shell->mesh->vertex_count; v++) {
        const double *X = shell->mesh->rest[v], *x = b.state.x + 3 * v;
        assert_true(fabs(x[0] - l * X[0]) < 1e-9 * SIDE && fabs(x[1] - form.across * X[1]) < 1e-9 * SIDE);
    }
    assert_true(fabs(pull(&b) - form.stress) < 1e-9 * fabs(form.stress));
    assert_true(fabs(energy(&b) - form.energy) < 1e-9 * form.energy);
    body_clear(&b);
}

static void test_closed_forms(void **state)
{
    (void)state;
    const double poisson[] = {0, 0.3, 0.45, 0.5}, stretch[] = {0.8, 0.99, 1.001, 1.5, 3};
    for (int n = 0; n < 4; n++)
        for (int k = 0; k < 5; k++) {
            check_form(poisson[n], stretch[k], uniaxial(poisson[n], stretch[k]), false);
            check_form(poisson[n], stretch[k], equibiaxial(poisson[n], stretch[k]), true);
        }
}

/* Equibiaxial, all held: the pull of the sides. */
static double squeezed(MembraneMaterial material, double nu, double l)
{
    Shell *shell = make_square(material, nu);
    Body b = body_create(shell, shell_system(shell), YOUNG);
    for (int v = 0; v < shell->mesh->vertex_count; v++)
        for (int i = 0; i < 2; i++) b.state.x[3 * v + i] *= l;
    double stress = pull(&b);
    body_clear(&b);
    return stress;
}

/* St. Venant-Kirchhoff, Y/(1-nu) l (l^2 - 1)/2, bears most at l = 3^(-1/2) and nothing without area; neo-Hookean always more. */
static void test_crushed(void **state)
{
    (void)state;
    const double poisson[] = {0, 0.3, 0.5};
    for (int n = 0; n < 3; n++) {
        double nu = poisson[n], before = 0;
        for (double l = 0.9; l > 0.05; l *= 0.8) {
            double green = squeezed(MEMBRANE_ST_VENANT_KIRCHHOFF, nu, l),
                   exact = YOUNG / (1 - nu) * l * (l * l - 1) / 2;
            double neo = squeezed(MEMBRANE_NEO_HOOKEAN, nu, l);
            assert_true(fabs(green / exact - 1) < 1e-12 && fabs(neo / equibiaxial(nu, l).stress - 1) < 1e-9);
            assert_true(neo < before && (l > 0.57 || neo < 1.5 * green));
            before = neo;
        }
        assert_true(before < -5 * YOUNG);
    }
}

/* Pulled along x and free across, St. Venant-Kirchhoff has c^2 = 1 - 2 nu G of its width left, and none from G = 1/(2 nu) on: it is
 * at rest so, but no sheet any more. */
static void test_flattened(void **state)
{
    (void)state;
    const double poisson[] = {0.2, 0.3, 0.5}, parts[] = {0.9, 0.99, 1.01, 1.3};
    for (int n = 0; n < 3; n++)
        for (int k = 0; k < 4; k++) {
            double nu = poisson[n], strain = parts[k] / (2 * nu), width = sqrt(fmax(1 - parts[k], 0));
            Shell *shell = make_square(MEMBRANE_ST_VENANT_KIRCHHOFF, nu);
            for (int v = 0; v < shell->mesh->vertex_count; v++)
                if (shell->mesh->rest[v][0] > SIDE - 1e-9) shell_fix(shell, v, 0);
            Body b = body_create(shell, shell_system(shell), YOUNG);
            for (int v = 0; v < shell->mesh->vertex_count; v++) b.state.x[3 * v] *= sqrt(1 + 2 * strain);
            NewtonStatus status = solve(&b).status;
            assert_int_equal(status, parts[k] < 1 ? NEWTON_CONVERGED : NEWTON_TANGLED);
            for (int v = 0; v < shell->mesh->vertex_count; v++)
                assert_true(fabs(b.state.x[3 * v + 1] - width * shell->mesh->rest[v][1]) < 1e-6 * SIDE);
            body_clear(&b);
        }
}

/* No energy where there is no area: a step there is refused. */
static void test_no_area(void **state)
{
    (void)state;
    Shell *shell = make_square(MEMBRANE_NEO_HOOKEAN, 0.3);
    Body b = body_create(shell, shell_system(shell), YOUNG);
    for (int v = 0; v < shell->mesh->vertex_count; v++) b.state.x[3 * v] = 0;
    assert_true(isinf(energy(&b)));
    body_clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_closed_forms), cmocka_unit_test(test_crushed),
                                       cmocka_unit_test(test_flattened), cmocka_unit_test(test_no_area)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
