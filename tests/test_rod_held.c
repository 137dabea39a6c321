/* Equilibria of discrete rods that are held at both ends: the exact discrete inverse, and straight rods that are pushed together. */
#include "tests/rod_fixture.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* The helix held at both ends, with a force and a couple of the last clamp that are given: its natural strains hold it there
 * to rounding, it comes back from a push, and its clamp does what was given. */
static void test_balance_between_clamps(void **state)
{
    (void)state;
    enum { N = 60 };
    const Vec3 force = {1e-3, 2e-3, 1.5e-2}, couple = {2e-5, -1e-5, 3e-5};
    long blocks = mem_live_count();
    Resting o = resting_create(&reference_rods[REFERENCE_HELIX], 5e6, N);
    RodLayout layout = rod_layout(o.rod, true);
    o.rod->end = ROD_CLAMPED;
    System *sys = rod_system(o.rod, 5e6, false);
    State rest = system_state(sys);
    rod_copy_state(o.rod, &o.layout, o.state.x, &layout, rest.x);
    double *load = o.p + o.rod->load + 3 * N, *g = mem_alloc((size_t)layout.dofs, sizeof *g);
    vec3_store(load, force);
    rod_balance_end(o.rod, sys, &layout, 0, couple, rest.x, o.p);
    vec3_store(load, vec3(0, 0, 0));
    for (int k = 0; k < 2; k++) {
        Point at = state_point(&rest, o.p);
        Evaluation left = system_gradient(sys, &at, g);
        Vec3 holds = vec3_load(g + layout.position + 3 * N),
             turns = quat_rotate(rod_reference(&layout, rest.x, N), vec3_load(g + layout.turn + 3 * N));
        print_message("between clamps: forces left %.0e of theirs, %.1e m off the curve; the clamp's force "
                      "off by %.0e N, "
                      "its couple by %.0e N m\n",
                      left.gradient_max / left.force_scale, resting_distance(&o, rest.x),
                      vec3_length(vec3_sub(holds, force)), vec3_length(vec3_sub(turns, couple)));
        assert_true(left.gradient_max < 1e-12 * left.force_scale && resting_distance(&o, rest.x) < 1e-12);
        assert_true(vec3_length(vec3_sub(holds, force)) < 1e-12);
        assert_true(vec3_length(vec3_sub(turns, couple)) < 1e-14);
        for (int i = 3; k == 0 && i < 3 * N; i++) rest.x[layout.turn + i] = 2e-2 * sin(i);
        if (k == 0) assert_int_equal(rod_relax(o.rod, sys, 1, o.p, &rest).newton.status, NEWTON_CONVERGED);
    }
    system_destroy(sys);
    mem_free(g);
    state_destroy(&rest);
    resting_clear(&o);
    assert_int_equal(mem_live_count(), blocks);
}

typedef struct Ends {
    RodLayout layout;
    double shortening;
} Ends;

/* The last node towards (1 - shortening, 0, 0) and the frame of the world's axes, a part of the way. */
static bool push_end(void *self, double from, double until, double *x)
{
    const Ends *ends = self;
    int last = ends->layout.nodes - 1;
    double part = ramp_part(from, until);
    double *place = x + 3 * last, *to = x + ends->layout.reference + 4 * last;
    place[0] += part * (1 - ends->shortening - place[0]);
    for (int i = 1; i < 3; i++) place[i] -= part * place[i];
    Quat now = rod_reference(&ends->layout, x, last);
    Quat next = quat_mul(now, quat_exp(vec3_scale(-part, quat_log(now))));
    to[0] = next.w;
    vec3_store(to + 1, next.v);
    return true;
}

static const double elastica_K = 1.6857503548125961, elastica_E = 1.4674622093394272; /* k = sin 30 degrees */

static double elastica_shortening(void)
{
    return 2 * (1 - elastica_E / elastica_K);
}

/* How a rod is pushed: from an arc of a strain at the start, with another natural one, to an end that much
 * nearer. */
typedef struct Push {
    RodSupport support;
    int elements;
    double start, natural, shortening; /* 1/m, 1/m, m */
} Push;

static void set_arc(const Rod *rod, double strain, double *p)
{
    for (int e = 0; e < rod->elements; e++) p[rod->natural_strain + 3 * e + 1] = strain;
}

/* Euler's elastica, pushed together by d = 2 (1 - E(k)/K(k)) of its length: between hinges P L^2/EI = 4
 * K(k)^2, between clamps four times that; both deflect by k/K(k). Returns P L^2/EI. */
static double elastica_force(Push push, double *deflection, NewtonInfo *info)
{
    double *p, young = 1e6;
    int elements = push.elements;
    Rod *rod = rod_plain(elements, 1, young, NULL, &p);
    rod->start = rod->end = push.support;
    Ends ends = {rod_layout(rod, true), push.shortening};
    System *sys = rod_system(rod, young, false);
    State state = system_state(sys);
    set_arc(rod, push.start, p);
    rod_natural_state(rod, &ends.layout, p, state.x);
    set_arc(rod, push.natural, p);
    RampDef def = ramp_default();
    def.newton = rod_newton();
    def.steps = 10, def.move = push_end, def.self = &ends;
    *info = ramp_solve(sys, &rod->params, &def, NULL, p, &state).newton;
    *deflection = 0;
    const double *x = state.x;
    for (int i = 0; i <= elements; i++) *deflection = fmax(*deflection, hypot(x[3 * i + 1], x[3 * i + 2]));
    double force = fabs(x[ends.layout.multiplier]) / (young * rod->unit[0].bend1);
    system_destroy(sys);
    rod_destroy(rod);
    mem_free(p);
    state_destroy(&state);
    return force;
}

static void test_held_ends(void **state)
{
    (void)state;
    double K2 = elastica_K * elastica_K, deflection, off[2];
    for (RodSupport support = ROD_PINNED; support <= ROD_CLAMPED; support++) {
        bool clamped = support == ROD_CLAMPED;
        for (int k = 0; k < 2; k++) {
            NewtonInfo info;
            Push push = {support, k ? 100 : 50, 0.5, 0, elastica_shortening()};
            double force = elastica_force(push, &deflection, &info);
            off[k] = fabs(force / ((clamped ? 16 : 4) * K2) - 1);
            print_message("elastica between %s, %d elements: %s, force %.1e off, deflection %.1e L off\n",
                          clamped ? "clamps" : "hinges", k ? 100 : 50, newton_status_name(info.status),
                          off[k], fabs(deflection - 0.5 / elastica_K));
            assert_int_equal(info.status, NEWTON_CONVERGED);
            assert_true(off[k] < (k ? 4e-4 : 1.6e-3) &&
                        fabs(deflection - 0.5 / elastica_K) < (k ? 2e-4 : 8e-4));
        }
        assert_true(fabs(log2(off[0] / off[1]) - 2) < 0.2);
    }
}

/* Rods that are straight, or all but, pushed along themselves by much and by little: the axial force depends
 * on no turn of theirs until they buckle (system_gap). Euler's load grows by half of the shortening. */
static void test_pushed(void **state)
{
    (void)state;
    static const double natural[] = {0, 1e-6, 1e-3};
    for (RodSupport support = ROD_PINNED; support <= ROD_CLAMPED; support++)
        for (int k = 0; k < 6; k++) {
            NewtonInfo info;
            bool little = k / 3;
            double d = little ? 1e-3 : elastica_shortening(), deflection, own = natural[k % 3],
                   load = little ? M_PI * M_PI * (1 + d / 2) : 4 * elastica_K * elastica_K;
            double force = elastica_force((Push){support, 100, own, own, d}, &deflection, &info),
                   off = fabs(force / (support == ROD_PINNED ? load : 4 * load) - 1);
            print_message("%s, natural strain %g 1/m, %g nearer: %d iterations, force %.1e off\n",
                          support == ROD_PINNED ? "hinges" : "clamps", own, d, info.iterations, off);
            assert_int_equal(info.status, NEWTON_CONVERGED);
            assert_true(info.iterations < 500 && off < (own > 1e-4 ? 1e-2 : 1e-3));
        }
}

/* A straight rod whose ends are as far apart as it is long needs no force; rounding of its length leaves
 * little. */
static void test_straight(void **state)
{
    (void)state;
    NewtonInfo info;
    double deflection, force = elastica_force((Push){ROD_CLAMPED, 100, 0, 0, 0}, &deflection, &info);
    assert_int_equal(info.status, NEWTON_CONVERGED);
    print_message("straight between clamps: force %.1e EI/L^2, deflection %.1e L\n", force, deflection);
    assert_true(force < 1e-4 && deflection < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_balance_between_clamps),
        cmocka_unit_test(test_pushed),
        cmocka_unit_test(test_straight),
        cmocka_unit_test(test_held_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
