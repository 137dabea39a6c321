/* Finite motion of a sheet from a velocity (shell/turn.h), the stress that a step was to bring, and what they are for: thin
 * sheets that turn far, and strips that leave their plane. */
#include "base/random.h"
#include "shell/turn.h"
#include "solve/eigen.h"
#include "solve/ramp.h"
#include "tests/shell_fixture.h"
#include <math.h>

static Shell *make_sheet(double length, double width, int cells, int across, double thickness)
{
    Shell *shell = shell_of_sheet((double[]){length, width}, (int[]){cells, across}, PATTERN_RIGHT);
    shell->thickness = thickness, shell->poisson = 0, shell->density = 1000;
    return shell;
}

static double *make_vector(const Shell *shell)
{
    return mem_alloc((size_t)shell_dof_count(shell), sizeof(double));
}

static void follow(const Shell *shell, const double *x, const double *d, double a, double *to)
{
    Turn *turn = turn_create(shell);
    for (int i = 0; i < shell_dof_count(shell); i++) to[i] = x[i] + a * d[i];
    turn_follow(turn, x, d, a, to);
    turn_destroy(turn);
}

/* The velocity of a hinge turn about x = 0 becomes the turn, at any angle. */
static void test_hinge(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Shell *shell = make_sheet(0.1, 0.03, 8, 3, 1e-3);
    hold_root(shell, false);
    double *x = make_vector(shell), *d = make_vector(shell), *to = make_vector(shell), worst = 0;
    shell_rest_state(shell, x);
    for (int v = 0; v < shell->mesh->vertex_count; v++) d[3 * v + 2] = x[3 * v];
    follow(shell, x, d, 2.5, to);
    for (int v = 0; v < shell->mesh->vertex_count; v++)
        worst = fmax(worst, hypot(to[3 * v] - x[3 * v] * cos(2.5), to[3 * v + 2] - x[3 * v] * sin(2.5)));
    print_message("a hinge turned by 2.5: off by %.1e of its length\n", worst / 0.1);
    assert_true(worst < 1e-13);
    shell_destroy(shell);
    mem_free(x);
    mem_free(d);
    mem_free(to);
    assert_int_equal(mem_live_count(), blocks);
}

/* A strip that rolls up keeps its lengths: turn k of the k-th column of cells. */
static void test_roll(void **state)
{
    (void)state;
    enum { CELLS = 16, ACROSS = 2 };
    Shell *shell = make_sheet(0.1, 0.0125, CELLS, ACROSS, 1e-3);
    hold_root(shell, false);
    System *sys = shell_system(shell);
    State end = system_state(sys);
    double *x = make_vector(shell), *d = make_vector(shell), *to = end.x;
    double *p = mem_alloc((size_t)shell->params.size, sizeof *p);
    shell_default_params(shell, p);
    shell_rest_state(shell, x);
    for (int v = 0; v < shell->mesh->vertex_count; v++) {
        int column = v % (CELLS + 1);
        for (int k = 0; k < column; k++) d[3 * v + 2] += 0.1 / CELLS * k;
    }
    follow(shell, x, d, 0.3, to);
    Point at = state_point(&end, p);
    double rolled = system_term_energy(sys, 0, &at, NULL);
    for (int i = 0; i < shell_dof_count(shell); i++) to[i] = x[i] + 0.3 * d[i];
    double straight = system_term_energy(sys, 0, &at, NULL);
    print_message("rolled up by %.1f: stretching energy %.1e J, straight %.1e J\n", 0.3 * (CELLS - 1), rolled,
                  straight);
    assert_true(rolled < 1e-20 * straight);
    system_destroy(sys);
    shell_destroy(shell);
    mem_free(x);
    mem_free(d);
    state_destroy(&end);
    mem_free(p);
}

/* From any state: the straight step to first order, and what is held stays. */
static void test_first_order(void **state)
{
    (void)state;
    Shell *shell = make_sheet(0.1, 0.05, 6, 4, 1e-3);
    hold_root(shell, false);
    shell_fix(shell, 20, 1);
    Random random = random_seed(4);
    int positions = 3 * shell->mesh->vertex_count;
    double *x = make_vector(shell), *d = make_vector(shell), *to = make_vector(shell), off[2] = {0};
    shell_rest_state(shell, x);
    for (int i = 0; i < positions; i++) {
        x[i] += 2e-3 * random_signed(&random);
        if (!shell->fixed[i]) d[i] = 0.05 * random_signed(&random);
    }
    for (int half = 0; half < 2; half++) {
        double a = half ? 5e-5 : 1e-4;
        follow(shell, x, d, a, to);
        for (int i = 0; i < positions; i++) {
            off[half] = fmax(off[half], fabs(to[i] - x[i] - a * d[i]));
            if (shell->fixed[i]) assert_true(to[i] == x[i]);
        }
    }
    print_message("away from the straight step: %.2e, half as far %.2e m\n", off[0], off[1]);
    assert_true(fabs(off[0] / off[1] - 4) < 0.02 && off[0] < 1e-7);
    shell_destroy(shell);
    mem_free(x);
    mem_free(d);
    mem_free(to);
}

/* v'Hv of a flat sheet stretched by l, v across the plane: only the stress acts. */
static double across(const Shell *shell, System *sys, const double *p, double l, const double *from,
                     const double *step)
{
    double *gradient = make_vector(shell), *v = make_vector(shell), sum = 0;
    State state = system_state(sys);
    shell_rest_state(shell, state.x);
    for (int i = 0; i < 3 * shell->mesh->vertex_count; i++) state.x[i] *= l;
    for (int i = 0; i < shell->mesh->vertex_count; i++) v[3 * i + 2] = sin(1 + i);
    Point at = state_point(&state, p);
    at.x_from = from, at.step = step;
    system_hessian(sys, &at, gradient);
    system_multiply(sys, v, gradient);
    for (int i = 0; i < shell_dof_count(shell); i++) sum += v[i] * gradient[i];
    state_destroy(&state);
    mem_free(gradient);
    mem_free(v);
    return sum;
}

/* Stretched from l0 to l: the strain that the step was to bring, (l0^2 - 1)/2 + l0 (l - l0), is that of a stretch m with
 * m^2 = 1 + 2 of it. Thin, so that bending is nothing beside it. */
static void test_extrapolated_stress(void **state)
{
    (void)state;
    const double l0 = 1.1, l = 1.4, m = sqrt(l0 * l0 + 2 * l0 * (l - l0));
    Shell *shell = make_sheet(0.1, 0.05, 6, 4, 1e-9);
    System *sys = shell_system(shell);
    double *from = make_vector(shell), *step = make_vector(shell);
    double *p = mem_alloc((size_t)shell->params.size, sizeof *p);
    shell_default_params(shell, p);
    shell_rest_state(shell, from);
    for (int i = 0; i < 3 * shell->mesh->vertex_count; i++) step[i] = (l - l0) * from[i], from[i] *= l0;
    double extrapolated = across(shell, sys, p, l, from, step), own = across(shell, sys, p, m, NULL, NULL);
    print_message("stiffness across: %.9g, of that stretch %.9g, of the step's end %.9g\n", extrapolated, own,
                  across(shell, sys, p, l, NULL, NULL));
    assert_true(fabs(extrapolated / own - 1) < 1e-11);
    system_destroy(sys);
    shell_destroy(shell);
    mem_free(from);
    mem_free(step);
    mem_free(p);
}

static RampInfo solve(Body *b)
{
    RampDef def = ramp_default();
    return ramp_solve(b->sys, &b->shell->params, &def, NULL, b->p, &b->state);
}

static double height(const Body *b)
{
    double most = 0;
    for (int v = 0; v < b->shell->mesh->vertex_count; v++) most = fmax(most, fabs(b->state.x[3 * v + 2]));
    return most;
}

/* A strip on edge, 200 x 10 mm, buckles sideways under its weight from rho g h L^3/D = 18.17 on (12.85 of sqrt(EI GJ)/L^3 a
 * length, GJ = 2 D b): flat below, out of its plane and stable above, from the flat state, thick and thin. */
static void test_strips_buckle(void **state)
{
    (void)state;
    const double length = 0.2, young = 3e9, thicknesses[] = {1e-3, 2e-4, 4e-5}, loads[] = {0.9, 1.15, 3, 11};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++) {
            Shell *shell = make_sheet(length, 0.01, 60, 3, thicknesses[i]);
            hold_root(shell, true);
            Body b = body_create(shell, shell_system(shell), young);
            double rigidity = young * pow(thicknesses[i], 3) / 12;
            b.p[shell->gravity + 1] = -loads[k] * 18.17 * rigidity / (1000 * thicknesses[i] * pow(length, 3));
            RampInfo info = solve(&b);
            double lowest, flat = height(&b);
            print_message("L/h %4.0f, load %5.2f: %s after %3d iterations, %.4f m out of plane\n",
                          length / thicknesses[i], loads[k], newton_status_name(info.newton.status),
                          info.newton.iterations, flat);
            assert_true(info.newton.status == NEWTON_CONVERGED && info.steps == 1 &&
                        info.newton.iterations <= 200); /* 3 to 148; other roundings, other ways */
            assert_true(loads[k] < 1 ? flat < 1e-9 : flat > 0.005);
            Point at = state_point(&b.state, b.p);
            assert_true(eigen_lowest(b.sys, &at, NULL, 1, &lowest, NULL) && lowest > 0);
            body_clear(&b);
        }
}

/* Sheets of 100 x 25 mm that swing about an edge until they hang down: the mass centre ends half a length below it. */
static void test_sheets_hang(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double thickness, young, density;
    } rows[] = {{"rubber", 1e-3, 1e6, 1100},
                {"PET", 5e-5, 3e9, 1400},
                {"aluminium foil", 1.6e-5, 7e10, 2700},
                {"steel", 1e-3, 2e11, 7800}};
    for (int i = 0; i < 4; i++) {
        Shell *shell = make_sheet(0.1, 0.025, 16, 4, rows[i].thickness);
        hold_root(shell, false);
        Body b = body_create(shell, shell_system(shell), rows[i].young);
        b.p[shell->gravity + 2] = -9.81 * rows[i].density / shell->density;
        RampInfo info = solve(&b);
        int tip = 2 * 17 + 16;
        print_message("%s: %s after %d iterations, tip at %.6f m\n", rows[i].name,
                      newton_status_name(info.newton.status), info.newton.iterations, b.state.x[3 * tip + 2]);
        assert_true(info.newton.status == NEWTON_CONVERGED && info.steps == 1 &&
                    info.newton.iterations <= 60);
        assert_true(fabs(b.state.x[3 * tip + 2] + 0.1) < 2e-4 && fabs(b.state.x[3 * tip]) < 1e-6);
        body_clear(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hinge),         cmocka_unit_test(test_roll),
        cmocka_unit_test(test_first_order),   cmocka_unit_test(test_extrapolated_stress),
        cmocka_unit_test(test_strips_buckle), cmocka_unit_test(test_sheets_hang)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
