/* Rods that stretch and shear: closed forms of statics (own weight, Timoshenko's cantilever, Haringx's column) and of
 * motion (a bar that vibrates along itself), both forms against each other, the discrete inverse, and Kirchhoff's rod as
 * their limit. */
#include "rod/inverse.h"
#include "solve/march.h"
#include "tests/rod_fixture.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static const double length = 0.2, young = 1e6, poisson = 0.3, density = 1200;

/* A rod of one system with numbers of its own, clamped at the origin along x. */
typedef struct Bar {
    Rod *rod;
    RodLayout layout;
    System *sys;
    double *p;
    State now;
} Bar;

static Rod *make_rod(int elements, RodSection unit, bool cosserat)
{
    Rod *rod = rod_create(elements, length, unit, NULL);
    rod->cosserat = cosserat;
    return rod;
}

static Bar bar_create(Rod *rod, bool positions)
{
    Bar bar = {.rod = rod, .layout = rod_layout(rod, positions), .p = params_vector(&rod->params)};
    rod_default_params(rod, young, bar.p);
    bar.sys = positions ? rod_system(rod, young, false) : rod_hanging_system(rod);
    bar.now = system_state(bar.sys);
    rod_natural_state(rod, &bar.layout, bar.p, bar.now.x);
    return bar;
}

static void bar_clear(Bar *bar)
{
    state_destroy(&bar->now);
    system_destroy(bar->sys);
    mem_free(bar->p);
    rod_destroy(bar->rod);
}

static void bar_relax(Bar *bar, int steps)
{
    rod_sum_loads(bar->rod, bar->p);
    RampInfo info = rod_relax(bar->rod, bar->sys, steps, bar->p, &bar->now);
    assert_int_equal(info.newton.status, NEWTON_CONVERGED);
}

static Vec3 place_of(const Bar *bar, int node)
{
    double *place = mem_alloc(3 * (size_t)bar->layout.nodes, sizeof *place);
    rod_places(bar->rod, &bar->layout, bar->now.x, bar->layout.nodes, place);
    Vec3 v = vec3_load(place + 3 * node);
    mem_free(place);
    return v;
}

static Vec3 tip_of(const Bar *bar)
{
    return place_of(bar, bar->rod->elements);
}

/* A bar that hangs is longer by rho g L^2/(2 E). */
static void test_own_weight(void **state)
{
    (void)state;
    for (int positions = 0; positions < 2; positions++) {
        Rod *rod = make_rod(7, rod_circle(5e-3, 1, poisson, density), true);
        Bar bar = bar_create(rod, positions);
        bar.p[rod->gravity] = 9.81;
        bar_relax(&bar, 1);
        double exact = density * 9.81 * length * length / (2 * young), got = tip_of(&bar).x - length;
        print_message("stretched by %.6e m, %.1e off\n", got, fabs(got / exact - 1));
        assert_true(fabs(got / exact - 1) < 1e-12);
        bar_clear(&bar);
    }
}

/* F L/(kappa G A) + F L^3/(3 E I), both ways across an ellipse; a circle is one. */
static void test_timoshenko(void **state)
{
    (void)state;
    enum { N = 100 };
    for (int k = 0; k < 6; k++) {
        double a1 = 30e-3, a2 = k < 4 ? 12e-3 : a1, F = 1e-4;
        bool positions = k % 2, second = k / 2 == 1;
        RodSection unit = rod_ellipse(a1, a2, 1, poisson, density);
        Rod *rod = make_rod(N, unit, true);
        Bar bar = bar_create(rod, positions);
        bar.p[rod->load + 3 * N + (second ? 2 : 1)] = F;
        bar_relax(&bar, 1);
        double bend = F * pow(length, 3) / (3 * young * (second ? unit.bend1 : unit.bend2)),
               shear = F * length / (young * (second ? unit.shear2 : unit.shear1));
        double got = second ? tip_of(&bar).z : tip_of(&bar).y;
        print_message("tip %.6e m (%.1f %% shear), %.1e off\n", got, 100 * shear / (bend + shear),
                      fabs(got / (bend + shear) - 1));
        assert_true(shear > 0.005 * bend && fabs(got / (bend + shear) - 1) < 5e-5);
        bar_clear(&bar);
    }
}

/* Cowper's coefficients: 6 (1 + nu)/(7 + 6 nu) of a circle; of an ellipse without Poisson's ratio 0.9 along, 0.75 across
 * where it is flat. */
static void test_shear_coefficients(void **state)
{
    (void)state;
    double nu = 0.37, G = 1 / (2 * (1 + nu));
    RodSection circle = rod_circle(2e-3, 1, nu, 1), flat = rod_ellipse(1, 1e-4, 1, 0, 1);
    assert_float_equal(circle.shear1 / (G * circle.stretch), 6 * (1 + nu) / (7 + 6 * nu), 1e-14);
    assert_float_equal(circle.shear2, circle.shear1, 0);
    assert_float_equal(flat.shear1 / (0.5 * flat.stretch), 0.9, 1e-7);
    assert_float_equal(flat.shear2 / (0.5 * flat.stretch), 0.75, 1e-7);
    RodSection steel = rod_section_of(circle, 2e11);
    assert_float_equal(steel.stretch / 2e11, M_PI * 4e-6, 1e-18);
    assert_float_equal(steel.shear2 / circle.shear2, 2e11, 1e-3);
}

/* Is the column stable under a load P along itself? */
static bool stands(Bar *bar, double P)
{
    Rod *rod = bar->rod;
    const RodLayout *layout = &bar->layout;
    int N = rod->elements;
    double *x = bar->now.x, *g = mem_alloc((size_t)layout->dofs, sizeof *g);
    rod_natural_state(rod, layout, bar->p, x);
    bar->p[rod->load + 3 * N] = -P;
    rod_sum_loads(rod, bar->p);
    for (int e = 0; e < N; e++) {
        x[layout->strain + 3 * e] = -P / (young * rod->unit[0].stretch);
        if (layout->multiplier >= 0) x[layout->multiplier + 3 * e] = -P;
    }
    if (layout->position >= 0) rod_places(rod, layout, x, layout->nodes, x + layout->position);
    Point at = state_point(&bar->now, bar->p);
    Evaluation now = system_hessian(bar->sys, &at, g);
    assert_true(now.gradient_max <= 1e-9 * P);
    mem_free(g);
    return system_factor(bar->sys, 0);
}

/* Clamped and free: P (1 + P (1/(kappa G A) - 1/EA)) = pi^2 EI/(4 L^2), Haringx's load where EA is large; Engesser's would
 * be another one. */
static void test_haringx(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        bool positions = k % 2, stiff = k / 2;
        RodSection unit = rod_circle(0.2 * length, 1, poisson, density);
        if (stiff) unit.stretch *= 1e6;
        Bar bar = bar_create(make_rod(100, unit, true), positions);
        double euler = M_PI * M_PI * young * unit.bend1 / (4 * length * length),
               c = 1 / (young * unit.shear1) - 1 / (young * unit.stretch),
               exact = (sqrt(1 + 4 * euler * c) - 1) / (2 * c), engesser = euler / (1 + euler * c);
        double low = 0.5 * euler, high = 1.2 * euler;
        while (high - low > 1e-7 * euler) {
            double P = (low + high) / 2;
            *(stands(&bar, P) ? &low : &high) = P;
        }
        print_message("P/Euler's: %.5f, %.5f by Haringx, %.5f by Engesser\n", low / euler, exact / euler,
                      engesser / euler);
        assert_true(fabs(low / exact - 1) < 5e-5 && fabs(low / engesser - 1) > 2e-3);
        bar_clear(&bar);
    }
}

/* The form with positions finds what the hanging one does; its multipliers are what is beyond; and the natural strains
 * that balance the state are those that it has. */
static void test_both_forms(void **state)
{
    (void)state;
    enum { N = 24 };
    Vec3 tip[2];
    for (int positions = 0; positions < 2; positions++) {
        Rod *rod = make_rod(N, rod_ellipse(8e-3, 5e-3, 1, poisson, density), true);
        Bar bar = bar_create(rod, positions);
        for (int e = 0; e < N; e++) vec3_store(bar.p + rod->natural_strain + 3 * e, vec3(3, 4, -6));
        vec3_store(bar.p + rod->gravity, vec3(0, 2, -9.81));
        bar.p[rod->load + 3 * N + 1] = 0.05;
        rod_natural_state(rod, &bar.layout, bar.p, bar.now.x);
        bar_relax(&bar, 10);
        tip[positions] = tip_of(&bar);
        double *p = mem_copy(bar.p, (size_t)rod->params.size, sizeof *p), off = 0, moved = 0;
        double *x = mem_copy(bar.now.x, (size_t)bar.layout.dofs, sizeof *x);
        memset(x + bar.layout.strain, 0, 3 * N * sizeof *x);
        rod_balance(rod, bar.sys, &bar.layout, 0, x, p);
        for (int i = 0; i < 3 * N; i++) {
            off = fmax(off, fabs(p[rod->natural_strain + i] - bar.p[rod->natural_strain + i]));
            moved = fmax(moved, fabs(x[bar.layout.strain + i] - bar.now.x[bar.layout.strain + i]));
        }
        print_message("balanced: natural strains %.1e /m off, strains %.1e\n", off, moved);
        assert_true(off < 1e-9 && moved < 1e-12);
        mem_free(p);
        mem_free(x);
        bar_clear(&bar);
    }
    assert_true(vec3_length(vec3_sub(tip[0], tip[1])) < 1e-13);
}

/* Carries a load; hanging, or between clamps that come nearer by a fifth. */
static void limit_shape(bool held, double stiffer, Vec3 *middle, int *iterations)
{
    enum { N = 40 };
    RodSection unit = rod_circle(3e-3, 1, poisson, density);
    unit.stretch *= stiffer, unit.shear1 *= stiffer, unit.shear2 *= stiffer;
    Rod *rod = make_rod(N, unit, stiffer > 0);
    if (held) rod->end = ROD_CLAMPED;
    Bar bar = bar_create(rod, held);
    for (int e = 0; e < N; e++) bar.p[rod->natural_strain + 3 * e + 1] = 2;
    vec3_store(bar.p + rod->gravity, vec3(0, 1, -9.81));
    bar.p[rod->load + 3 * (N / 2) + 1] = 2e-2;
    rod_natural_state(rod, &bar.layout, bar.p, bar.now.x);
    rod_sum_loads(rod, bar.p);
    RampDef def = ramp_default();
    def.newton.step_cap = 1.5;
    def.newton.step_tol = 1e-11;
    def.steps = 10;
    *iterations = 0;
    Vec3 from = place_of(&bar, N);
    for (int k = 1; k <= (held ? 10 : 1); k++) {
        if (held) vec3_store(bar.now.x + 3 * N, vec3_scale(1 - 0.02 * k, from));
        RampInfo info = ramp_solve(bar.sys, &rod->params, &def, NULL, bar.p, &bar.now);
        assert_int_equal(info.newton.status, NEWTON_CONVERGED);
        *iterations += info.newton.iterations;
    }
    *middle = place_of(&bar, held ? N / 2 : N);
    bar_clear(&bar);
}

/* Kirchhoff's rod is left by as much as 1/EA, over all decades; and takes no more Newton iterations. */
static void test_limit(void **state)
{
    (void)state;
    for (int held = 0; held < 2; held++) {
        Vec3 exact, now;
        int least, iterations;
        double first = 0, last = 0;
        limit_shape(held, 0, &exact, &least);
        for (double stiffer = 1; stiffer < 2e6; stiffer *= 100) {
            limit_shape(held, stiffer, &now, &iterations);
            last = vec3_length(vec3_sub(now, exact));
            if (stiffer == 100) first = last;
            print_message("%s, EA times %.0e: %.2e m off, %d iterations (Kirchhoff: %d)\n",
                          held ? "held" : "hanging", stiffer, last, iterations, least);
            assert_true(iterations < 2 * least);
        }
        double slope = log10(last / first) / 4;
        print_message("slope %.4f\n", slope);
        assert_true(fabs(slope + 1) < 1e-2);
    }
}

/* Of a bar between a clamp and a free end the mode sin(pi x/2L) is one of the discrete bar, too, with (2/h) sqrt(E/rho)
 * sin(pi h/4L); implicit Euler takes it as it takes one spring. */
static void test_vibration(void **state)
{
    (void)state;
    enum { N = 20, STEPS = 100 };
    Rod *rod = make_rod(N, rod_circle(4e-3, 1, poisson, density), true);
    RodLayout layout = rod_layout(rod, true);
    double *p = params_vector(&rod->params), h = length / N, wave = sqrt(young / density);
    rod_default_params(rod, young, p);
    System *sys = rod_system(rod, young, true);
    State now = system_state(sys);
    rod_natural_state(rod, &layout, p, now.x);
    double omega = 2 / h * wave * sin(M_PI * h / (4 * length)), dt = 2 * M_PI / omega / 80, v = 1e-3, q = 0,
           off = 0;
    for (int i = 0; i <= N; i++) now.v[3 * i] = v * sin(M_PI * i / (2 * N));
    assert_true(fabs(omega / (M_PI / 2 * wave / length) - 1) < 1e-3);
    for (int k = 0; k < STEPS; k++) {
        MarchDef def = march_default();
        MarchInfo info;
        def.newton.energy_tol = 0;
        assert_true(march_step(sys, &def, dt, p, &now, &info));
        double next = (q + dt * v) / (1 + omega * omega * dt * dt);
        v = (next - q) / dt, q = next;
        off = fmax(off, fabs(now.x[3 * N] - length - q));
    }
    print_message("a bar of %.1f Hz along itself: %.1e m off in a motion of %.1e m\n", omega / (2 * M_PI),
                  off, 1e-3 / omega);
    assert_true(off < 1e-9 * 1e-3 / omega);
    state_destroy(&now);
    system_destroy(sys);
    mem_free(p);
    rod_destroy(rod);
}

/* Pushed by EA and more an element would go backwards: that is no equilibrium, by neither form. So thick a rod does not
 * buckle before. */
static void test_pushed_through(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        double part = k < 2 ? 0.9 : 1.1;
        Rod *rod = make_rod(2, rod_circle(10 * length, 1, poisson, density), true);
        Bar bar = bar_create(rod, k % 2);
        bar.p[rod->load + 3 * rod->elements] = -part * rod->unit->stretch * young;
        rod_sum_loads(rod, bar.p);
        RampInfo info = rod_relax(rod, bar.sys, 1, bar.p, &bar.now);
        double least = rod_least_stretch(&bar.layout, bar.now.x, NULL);
        print_message("pushed by %.1f EA: %s, %.3f of its length\n", part,
                      newton_status_name(info.newton.status), least);
        if (k < 2) {
            assert_int_equal(info.newton.status, NEWTON_CONVERGED);
            assert_true(fabs(least - (1 - part)) < 1e-9);
        } else {
            assert_int_equal(info.newton.status, NEWTON_TANGLED);
            assert_true(!rod_is_tangled(least));
        }
        bar_clear(&bar);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_own_weight),         cmocka_unit_test(test_timoshenko),
        cmocka_unit_test(test_shear_coefficients), cmocka_unit_test(test_haringx),
        cmocka_unit_test(test_both_forms),         cmocka_unit_test(test_limit),
        cmocka_unit_test(test_vibration),          cmocka_unit_test(test_pushed_through)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
