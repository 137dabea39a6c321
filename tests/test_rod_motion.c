/* Rods in motion: back to the curve from the natural shape, frequencies, a pendulum, and what a small push
 * does to the wave that is unstable at 23 MPa and stable at 27. */
#include "base/random.h"
#include "solve/eigen.h"
#include "solve/march.h"
#include "tests/rod_fixture.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

typedef struct Moving {
    RodLayout layout;
    System *sys;
    MarchDef def;
    State now;
    double *p;
} Moving;

static Moving moving_create(const Rod *rod, double young, double *p)
{
    Moving m = {
        .layout = rod_layout(rod, true), .sys = rod_system(rod, young, true), .def = march_default(), .p = p};
    m.def.newton.cg_iterations = 0;
    m.def.newton.step_cap = 1.5;
    m.now = system_state(m.sys);
    return m;
}

static void moving_clear(Moving *m)
{
    system_destroy(m->sys);
    state_destroy(&m->now);
}

static int step(Moving *m, double dt)
{
    MarchInfo info;
    assert_true(march_step(m->sys, &m->def, dt, m->p, &m->now, &info));
    assert_int_equal(info.refused, 0);
    return info.newton.iterations;
}

static void test_relaxing(void **state)
{
    (void)state;
    for (int c = 0; c < 2; c++) {
        Resting o = resting_create(&reference_rods[c], reference_rods[c].young, 60);
        o.p[o.rod->damping] = 4 * o.rod->unit[0].mass; /* 4/s */
        Moving m = moving_create(o.rod, reference_rods[c].young, o.p);
        rod_natural_state(o.rod, &m.layout, o.p, m.now.x);
        int iterations = 0;
        for (int k = 0; k < 300; k++) iterations += step(&m, 1 / 60.0);
        print_message("%-8s from its natural shape: %.1e m off after 5 s, %.2f iterations a step\n",
                      reference_rods[c].name, resting_distance(&o, m.now.x), iterations / 300.0);
        assert_true(resting_distance(&o, m.now.x) < 1e-6);
        moving_clear(&m);
        resting_clear(&o);
    }
}

/* From upward crossing to upward crossing of a coordinate's mean, with linear interpolation between steps. */
static double frequency(Moving *m, int dof, double mean, double dt, int steps)
{
    double first = 0, last = 0, before = m->now.x[dof] - mean;
    int crossings = 0;
    for (int k = 1; k <= steps; k++) {
        step(m, dt);
        double now = m->now.x[dof] - mean;
        if (before < 0 && now >= 0) {
            last = (k - now / (now - before)) * dt;
            if (crossings++ == 0) first = last;
        }
        before = now;
    }
    return crossings > 1 ? (crossings - 1) / (last - first) : 0;
}

/* The lowest frequency of a rod at rest, Hz, and its mode. The Hessian's eigenvalue is that of unit masses;
 * the mode's Rayleigh quotient with the nodes' masses is off by the square of what they differ by, at the
 * ends. */
static double lowest_frequency(const Resting *o, const Moving *m, double young, double *mode)
{
    System *sys = rod_system(o->rod, young, false);
    double lambda, inertia = 0;
    State rest = state_clone(&m->now);
    for (int e = o->rod->elements - 1, i = 2; e >= 0;
         e--, i = 2) /* the multipliers of rest: what hangs below */
        rest.x[m->layout.multiplier + 3 * e + i] = o->p[o->rod->gravity + 2] * o->rod->unit[0].mass *
                                                   rod_element_length(o->rod, 0) *
                                                   (o->rod->elements - e - 0.5);
    Point at = state_point(&rest, o->p);
    assert_true(eigen_lowest(sys, &at, NULL, 1, &lambda, mode));
    Masses masses = rod_masses(o->rod);
    for (int i = 0; i < 3 * m->layout.nodes; i++) inertia += masses.fixed[i / 3] * mode[i] * mode[i];
    system_destroy(sys);
    masses_clear(&masses);
    state_destroy(&rest);
    return sqrt(lambda / inertia) / (2 * M_PI);
}

/* The second variation with inertia has lowest frequencies of 2.16 Hz (helix) and 1.35 Hz (conical); pushed
 * along its lowest mode the rod swings with that of the mode. */
static void test_frequencies(void **state)
{
    (void)state;
    static const double known[] = {2.16, 1.35};
    for (int c = 0; c < 2; c++) {
        enum { N = 100 };
        Resting o = resting_create(&reference_rods[c], reference_rods[c].young, N);
        Moving m = moving_create(o.rod, reference_rods[c].young, o.p);
        rod_copy_state(o.rod, &o.layout, o.state.x, &m.layout, m.now.x);
        double *mode = mem_alloc((size_t)m.layout.dofs, sizeof *mode),
               f = lowest_frequency(&o, &m, reference_rods[c].young, mode);
        int axis = 3 * N + (fabs(mode[3 * N]) > fabs(mode[3 * N + 1]) ? 0 : 1);
        for (int i = 0; i < 3 * (N + 1); i++) m.now.v[i] = 0.1 * mode[i]; /* about 1 mm */
        double swing = frequency(&m, axis, m.now.x[axis], 2e-3, 4000);
        print_message("%-8s lowest frequency %.4f Hz, swings at %.4f Hz\n", reference_rods[c].name, f, swing);
        assert_true(fabs(f / known[c] - 1) < 4e-3 && fabs(swing / f - 1) < 4e-3);
        mem_free(mode);
        moving_clear(&m);
        resting_clear(&o);
    }
}

/* A stiff rod hinged at its upper end: w^2 = 3 g/(2 L). */
static void test_pendulum(void **state)
{
    (void)state;
    enum { N = 10 };
    double length = 0.3, young = 1e9, g = 9.8;
    Rod *rod = rod_create(N, length, rod_circle(2e-3, 1, 0.4, 1000), NULL);
    double *p = mem_alloc((size_t)rod->params.size, sizeof *p);
    rod_default_params(rod, young, p);
    p[rod->gravity + 2] = -g;
    rod->start = ROD_PINNED;
    rod->strand[0].frame = quat_from_axes(vec3(0, 0, -1), vec3(1, 0, 0), vec3(0, -1, 0));
    Moving m = moving_create(rod, young, p);
    rod_natural_state(rod, &m.layout, p, m.now.x);
    for (int i = 1; i <= N; i++) m.now.v[3 * i] = 0.02 * i / N;
    double f = frequency(&m, 3 * N, 0, 1e-3, 4000), expected = sqrt(3 * g / (2 * length)) / (2 * M_PI);
    print_message("pendulum: %.4f Hz, expected %.4f\n", f, expected);
    assert_true(fabs(f / expected - 1) < 3e-3); /* lumped masses: 1/(2 N^2) */
    moving_clear(&m);
    rod_destroy(rod);
    mem_free(p);
}

/* Where the wave is after 10 s of a push of 1e-4 m/s. */
static double pushed(double young)
{
    enum { N = 200 };
    Resting o = resting_create(&reference_rods[REFERENCE_WAVE], young, N);
    o.p[o.rod->damping] = 2 * o.rod->unit[0].mass;
    Moving m = moving_create(o.rod, young, o.p);
    Random random = random_seed(5);
    rod_copy_state(o.rod, &o.layout, o.state.x, &m.layout, m.now.x);
    for (int i = 3; i < 3 * (N + 1); i++) m.now.v[i] = 1e-4 * random_signed(&random);
    for (int k = 0; k < 600; k++) step(&m, 1 / 60.0);
    double off = resting_distance(&o, m.now.x);
    print_message("wave at %.0f MPa: %.1e m away after 10 s\n", young * 1e-6, off);
    moving_clear(&m);
    resting_clear(&o);
    return off;
}

static void test_pushed_waves(void **state)
{
    (void)state;
    assert_true(pushed(23e6) > 0.03);
    assert_true(pushed(27e6) < 1e-5);
}

/* ---- Natural strains from a motion ---- */

enum { PIECES = 40 };

/* A rod's state at three times; its places as curves that know their nodes only. */
typedef struct Seen {
    RodCurve curves[3];
    double times[3];
    double *state; /* the one that natural strains are of */
} Seen;

static Seen seen_create(const Moving *m)
{
    Seen seen = {.state = mem_alloc((size_t)m->layout.dofs, sizeof(double))};
    for (int k = 0; k < 3; k++)
        seen.curves[k] = (RodCurve){.elements = PIECES, .x = mem_alloc(2 * PIECES + 1, sizeof(Vec3))};
    return seen;
}

static void seen_clear(Seen *seen)
{
    for (int k = 0; k < 3; k++) rod_curve_clear(&seen->curves[k]);
    mem_free(seen->state);
}

static void see(Seen *seen, int k, const Moving *m, double time, bool keep)
{
    for (int i = 0; i <= PIECES; i++)
        seen->curves[k].x[2 * i] = vec3_load(m->now.x + m->layout.position + 3 * i);
    seen->times[k] = time;
    if (keep) memcpy(seen->state, m->now.x, (size_t)m->layout.dofs * sizeof *seen->state);
}

/* By the balance of forces at what was seen at time `at`; strain[PIECES][3]. */
static void find_strains(const Rod *rod, Seen *seen, int at, const double *p, double *strain)
{
    const RodCurve *const three[] = {&seen->curves[0], &seen->curves[1], &seen->curves[2]};
    Vec3 inertia[2 * PIECES + 1], drag[2 * PIECES + 1];
    double *q = mem_copy(p, (size_t)rod->params.size, sizeof *q);
    RodLayout layout = rod_layout(rod, true);
    System *sys = rod_system(rod, 1e6, false);
    Masses masses = rod_masses(rod);
    const double *mass = masses.fixed;
    rod_inertia(three, seen->times, at, rod_alike(&(RodSection){.mass = 1}), 0, inertia);
    rod_inertia(three, seen->times, at, rod_alike(&(RodSection){.mass = 0}), p[rod->damping], drag);
    for (int i = 0; i <= PIECES; i++)
        vec3_store(q + rod->load + 3 * i,
                   vec3_axpy(mass[i], inertia[2 * i], vec3_scale(mass[i] / rod->unit[0].mass, drag[2 * i])));
    rod_balance(rod, sys, &layout, 0, seen->state, q);
    memcpy(strain, q + rod->natural_strain, 3 * PIECES * sizeof *strain);
    system_destroy(sys);
    masses_clear(&masses);
    mem_free(q);
}

static double apart(const double *a, const double *b)
{
    double most = 0;
    for (int i = 0; i < 3 * PIECES; i++) most = fmax(most, fabs(a[i] - b[i]));
    return most;
}

static Rod *curly_rod(double **p)
{
    Rod *rod = rod_create(PIECES, 0.2, rod_circle(1e-3, 1, 0.4, 1200), NULL);
    *p = params_vector(&rod->params);
    rod_default_params(rod, 2e6, *p);
    (*p)[rod->gravity + 2] = -9.81;
    (*p)[rod->damping] = 2e-3;
    for (int e = 0; e < PIECES; e++)
        vec3_store(*p + rod->natural_strain + 3 * e, vec3(3, 6 + 0.2 * e, 8 * cos(0.1 * e)));
    return rod;
}

/* What implicit Euler took for accelerations is the backward difference: natural strains come back to rounding, whatever the
 * step. */
static void test_strains_of_steps(void **state)
{
    (void)state;
    double *p, strain[3 * PIECES];
    Rod *rod = curly_rod(&p);
    Moving m = moving_create(rod, 2e6, p);
    Seen seen = seen_create(&m);
    rod_natural_state(rod, &m.layout, p, m.now.x);
    for (int k = 0; k < 12; k++) {
        step(&m, 5e-3);
        if (k >= 9) see(&seen, k - 9, &m, 5e-3 * k, k == 11);
    }
    find_strains(rod, &seen, 2, p, strain);
    double off = apart(strain, p + rod->natural_strain);
    print_message("natural strains of a motion: off by %.0e of up to 14 1/m\n", off);
    assert_true(off < 1e-7);
    seen_clear(&seen);
    moving_clear(&m);
    mem_free(p);
    rod_destroy(rod);
}

/* Central differences of a motion that is known more finely than it is sampled: second order in the time between samples. */
static void test_strains_of_samples(void **state)
{
    (void)state;
    enum { MIDDLE = 1000, COUNT = 4, FINEST = 0 };
    const double dt = 5e-5;
    const int apart_by[COUNT] = {1, 20, 40, 80};
    double *p, strain[COUNT][3 * PIECES], off[COUNT];
    Rod *rod = curly_rod(&p);
    Moving m = moving_create(rod, 2e6, p);
    Seen seen[COUNT];
    for (int c = 0; c < COUNT; c++) seen[c] = seen_create(&m);
    rod_natural_state(rod, &m.layout, p, m.now.x);
    for (int k = 1; k <= MIDDLE + apart_by[COUNT - 1]; k++) {
        step(&m, dt);
        for (int c = 0; c < COUNT; c++)
            if ((k - MIDDLE) % apart_by[c] == 0 && abs(k - MIDDLE) <= apart_by[c])
                see(&seen[c], 1 + (k - MIDDLE) / apart_by[c], &m, k * dt, k == MIDDLE);
    }
    for (int c = 0; c < COUNT; c++) {
        find_strains(rod, &seen[c], 1, p, strain[c]);
        off[c] = apart(strain[c], c == FINEST ? p + rod->natural_strain : strain[FINEST]);
        print_message("samples %.2f ms apart: natural strains off by %.1e 1/m\n", apart_by[c] * dt * 1e3,
                      off[c]);
        seen_clear(&seen[c]);
    }
    assert_true(off[FINEST] < 0.15 && off[1] < 0.05);
    for (int c = 2; c < COUNT; c++) assert_true(fabs(log2(off[c] / off[c - 1]) - 2) < 0.15);
    moving_clear(&m);
    mem_free(p);
    rod_destroy(rod);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_relaxing),         cmocka_unit_test(test_frequencies),
        cmocka_unit_test(test_pendulum),         cmocka_unit_test(test_pushed_waves),
        cmocka_unit_test(test_strains_of_steps), cmocka_unit_test(test_strains_of_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
