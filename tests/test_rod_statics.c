/* Equilibria of discrete rods: the exact discrete inverse, convergence to the curve, the cantilevers of the
 * paper's section 5.3, both forms against each other, point loads, magnetised rods in uniform fields and
 * beside a magnet. */
#include "base/random.h"
#include "rod/stations.h"
#include "tests/rod_fixture.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

/* The conical one falls into another equilibrium unless its weight comes on in steps. */
static const int ramp_steps[REFERENCE_COUNT] = {1, 10, 10};

static void test_discrete_inverse(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    for (int c = 0; c < REFERENCE_COUNT; c++) {
        double young = c == REFERENCE_WAVE ? 27e6 : reference_rods[c].young;
        Resting o = resting_create(&reference_rods[c], young, 200);
        double *g = mem_alloc((size_t)o.layout.dofs, sizeof *g);
        Point at = state_point(&o.state, o.p);
        Evaluation left = system_gradient(o.hanging, &at, g);
        rod_natural_state(o.rod, &o.layout, o.p, o.state.x);
        RampInfo info = rod_relax(o.rod, o.hanging, ramp_steps[c], o.p, &o.state);
        double off = resting_distance_of(&o, o.state.x);
        print_message("%-8s residual %.1e of the forces, round trip %.1e m in %d iterations\n",
                      reference_rods[c].name, left.gradient_max / left.force_scale, off,
                      info.newton.iterations);
        assert_int_equal(info.newton.status, NEWTON_CONVERGED);
        assert_true(left.gradient_max <= 1e-13 * left.force_scale && off <= 1e-12);
        mem_free(g);
        resting_clear(&o);
    }
    assert_int_equal(mem_live_count(), blocks);
}

/* From the natural strains of the continuous rod, taken in the elements' middles: second order. */
static double forward_error(int c, int elements)
{
    double young = c == REFERENCE_WAVE ? 27e6 : reference_rods[c].young;
    Resting o = resting_create(&reference_rods[c], young, elements);
    size_t stations = 2 * (size_t)elements + 1;
    Vec3 *moment = mem_alloc(2 * stations, sizeof *moment), *strain = moment + stations;
    RodSection section = reference_section(young);
    rod_moments(&o.curve, reference_weight(section), moment);
    rod_natural_strains(&o.curve, rod_alike(&section), moment, o.frames, strain);
    for (int e = 0; e < elements; e++) {
        vec3_store(o.p + o.rod->natural_strain + 3 * e, strain[2 * e + 1]);
        o.rod->bow[e] = vec3(0, 0, 0);
    }
    rod_natural_state(o.rod, &o.layout, o.p, o.state.x);
    RampInfo info = rod_relax(o.rod, o.hanging, ramp_steps[c], o.p, &o.state);
    assert_int_equal(info.newton.status, NEWTON_CONVERGED);
    double off = resting_distance_of(&o, o.state.x);
    mem_free(moment);
    resting_clear(&o);
    return off;
}

/* The errors that docs/rods.md quotes for N = 200, measured with another program, are upper bounds. */
static void test_forward(void **state)
{
    (void)state;
    static const double known[] = {1.8e-5, 6.0e-5, 5.2e-5}; /* m; the wave's at N = 800 */
    for (int c = 0; c < REFERENCE_COUNT; c++) {
        int elements = c == REFERENCE_WAVE ? 800 : 200;
        double coarse = forward_error(c, elements / 2), off = forward_error(c, elements),
               fine = forward_error(c, 2 * elements);
        print_message("%-8s %.2e m off at %d elements; orders %.3f, %.3f\n", reference_rods[c].name, off,
                      elements, log2(coarse / off), log2(off / fine));
        assert_true(off <= known[c] && fabs(log2(coarse / off) - 2) < 0.1 &&
                    fabs(log2(off / fine) - 2) < 0.1);
    }
}

/* A straight rod clamped horizontally falls; the shape that it takes, inverted, is straight again [the
 * paper's section 5.3, which loses more than a hundredth of the length of the softest one]. */
static void test_cantilevers(void **state)
{
    (void)state;
    static const double young[] = {1e5, 3.1622776601683795e5, 1e6, 1e7, 1e9};
    static const double tip_angle[] = {-90.000, -89.989, -89.121, -52.350, -0.726}; /* degrees */
    enum { N = 200 };
    for (int k = 0; k < 5; k++) {
        double radius = 2.225e-3, off = 0;
        RodSection section = rod_circle(radius, young[k], 0.5, reference_density);
        Rod *rod = rod_create(N, 0.2, rod_circle(radius, 1, 0.5, reference_density), NULL);
        double *p = mem_alloc((size_t)rod->params.size, sizeof *p);
        rod_default_params(rod, young[k], p);
        p[rod->gravity + 2] = -reference_gravity;
        RodLayout layout = rod_layout(rod, false);
        System *sys = rod_hanging_system(rod);
        State hanging = system_state(sys);
        rod_natural_state(rod, &layout, p, hanging.x);
        RampInfo info = rod_relax(rod, sys, 1, p, &hanging);
        RodCurve curve;
        Vec3 moment[2 * N + 1], natural[N + 1];
        rod_curve_of(rod, &layout, hanging.x, &curve);
        rod_moments(&curve, reference_weight(section), moment);
        rod_invert(&curve, rod_alike(&section), moment, NULL, natural);
        for (int i = 0; i <= N; i++) off = fmax(off, fabs(natural[i].z));
        double angle = atan2(curve.t[2 * N].z, curve.t[2 * N].x) * 180 / M_PI;
        print_message("E = %8.3g Pa: tip at %.3f degrees, %d iterations; inverted: max |z| = %.1e L\n",
                      young[k], angle, info.newton.iterations, off / 0.2);
        assert_int_equal(info.newton.status, NEWTON_CONVERGED);
        assert_true(off <= 1e-4 * 0.2 && fabs(angle - tip_angle[k]) < 2e-3);
        system_destroy(sys);
        rod_destroy(rod);
        rod_curve_clear(&curve);
        mem_free(p);
        state_destroy(&hanging);
    }
}

/* The form with positions and multipliers finds the same equilibrium; its multipliers are what hangs below.
 */
static void test_both_forms(void **state)
{
    (void)state;
    for (int c = 0; c < 2; c++) {
        Resting o = resting_create(&reference_rods[c], reference_rods[c].young, 100);
        Rod *rod = o.rod;
        RodLayout layout = rod_layout(rod, true);
        System *sys = rod_system(rod, reference_rods[c].young, false);
        double off = 0;
        State other = system_state(sys);
        rod_natural_state(rod, &layout, o.p, other.x);
        RampInfo info = rod_relax(rod, sys, ramp_steps[c], o.p, &other);
        for (int e = 0; e < rod->elements; e++) {
            double weight = rod->unit[0].mass * rod_element_length(rod, 0) * (rod->elements - e - 0.5) *
                            reference_gravity;
            off = fmax(off, fabs(other.x[layout.multiplier + 3 * e + 2] + weight));
        }
        print_message("%-8s with positions %.1e m off, multipliers %.1e N\n", reference_rods[c].name,
                      resting_distance(&o, other.x), off);
        assert_int_equal(info.newton.status, NEWTON_CONVERGED);
        assert_true(resting_distance(&o, other.x) < 1e-12 && off < 1e-12);
        system_destroy(sys);
        state_destroy(&other);
        resting_clear(&o);
    }
}

/* Moments at the clamp are those of statics, for a force at the end and a field along and across the tangent.
 */
static void test_moments(void **state)
{
    (void)state;
    enum { N = 400 };
    double *p;
    Rod *rod = rod_plain(N, 0.1, 1e6, NULL, &p);
    Vec3 force = vec3(2e-4, 3e-4, -5e-4), M = vec3(3e4, -1e4, 2e4), B = vec3(0.01, -0.02, 0.03);
    for (int e = 0; e < N; e++) vec3_store(p + rod->magnetization + 3 * e, M);
    vec3_store(p + rod->flux.uniform, B);
    vec3_store(p + rod->load + 3 * N, force);
    rod_sum_loads(rod, p);
    RodLayout layout = rod_layout(rod, false);
    System *sys = rod_hanging_system(rod);
    double *place = mem_alloc(3 * (N + 1), sizeof *place);
    State bent = system_state(sys);
    rod_natural_state(rod, &layout, p, bent.x);
    assert_int_equal(rod_relax(rod, sys, 1, p, &bent).newton.status, NEWTON_CONVERGED);
    rod_places(rod, &layout, bent.x, N + 1, place);
    Vec3 couple = vec3(0, 0, 0), moment[N + 1];
    for (int e = 0; e < N; e++)
        for (int k = 0; k < 2; k++)
            couple = vec3_axpy(rod->unit[0].area * rod_element_length(rod, 0) / 2,
                               vec3_cross(quat_rotate(rod_reference(&layout, bent.x, e + k), M), B), couple);
    Vec3 expected = vec3_add(couple, vec3_cross(vec3_load(place + 3 * N), force));
    rod_node_moments(rod, &layout, bent.x, p, moment);
    double off = vec3_length(vec3_sub(moment[0], expected));
    print_message("moment at the clamp: %.1e of it off\n", off / vec3_length(expected));
    assert_true(off < 3e-4 * vec3_length(expected));
    system_destroy(sys);
    rod_destroy(rod);
    mem_free(p);
    mem_free(place);
    state_destroy(&bent);
}

/* A straight rod with a couple at its end is a helix about the couple, to whose axis its tangent has the same angle as at the
 * clamp: of radius EI sin(angle)/|C| and pitch 2 pi EI cos(angle)/|C|, whatever GJ is. Turns: C L/EI. */
static double off_the_helix(double poisson, double turns, int elements, bool positions, NewtonInfo *info)
{
    const double angle = 0.7, L = 0.1, young = 1e6;
    RodSection unit = rod_circle(1e-3, 1, poisson, 1000);
    Rod *rod = rod_create(elements, L, unit, &(RodActs){.couples = true});
    RodLayout layout = rod_layout(rod, positions);
    double *p = params_vector(&rod->params), k = turns / L, worst = 0;
    rod_default_params(rod, young, p);
    Vec3 axis = vec3(cos(angle), 0, sin(angle));
    vec3_store(p + rod->couple + 3 * elements, vec3_scale(k * young * unit.bend1, axis));
    System *sys = positions ? rod_system(rod, young, false) : rod_hanging_system(rod);
    State bent = system_state(sys);
    rod_natural_state(rod, &layout, p, bent.x);
    *info = rod_relax(rod, sys, 10, p, &bent).newton;
    double *place = mem_alloc(3 * (size_t)layout.nodes, sizeof *place);
    rod_places(rod, &layout, bent.x, layout.nodes, place);
    for (int i = 0; i <= elements; i++) {
        double s = L * i / elements, turn = k * s;
        Vec3 start = vec3(1, 0, 0), across = vec3_sub(start, vec3_scale(cos(angle), axis));
        Vec3 x = vec3_axpy(sin(turn) / k, across, vec3_scale(s * cos(angle), axis));
        x = vec3_axpy((1 - cos(turn)) / k, vec3_cross(axis, across), x);
        worst = fmax(worst, vec3_length(vec3_sub(vec3_load(place + 3 * i), x)));
    }
    mem_free(place);
    state_destroy(&bent);
    system_destroy(sys);
    mem_free(p);
    rod_destroy(rod);
    return worst / L;
}

/* Where GJ = EI the strain is constant, as in the elements: to rounding, however far it is wound up. Else of second order. */
static void test_end_couple(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        NewtonInfo info[3];
        bool positions = k % 2;
        double turns = (const double[]){1, 3, 8, 15}[k / 2];
        double round = off_the_helix(0, turns, 50, positions, &info[0]),
               coarse = off_the_helix(0.4, turns, 50, positions, &info[1]),
               fine = off_the_helix(0.4, turns, 100, positions, &info[2]);
        print_message(
            "end couple, %2g rad, %s: %.1e L off a helix (%d iterations); GJ < EI: %.1e, order %.2f\n", turns,
            positions ? "positions" : "hanging", round, info[0].iterations, coarse, log2(coarse / fine));
        for (int i = 0; i < 3; i++) assert_int_equal(info[i].status, NEWTON_CONVERGED);
        /* With positions a last step below Newton's tolerance is taken or not by the rounding of forces. */
        assert_true(round < (positions ? 1e-9 : 1e-14) && coarse < 2e-3 &&
                    fabs(log2(coarse / fine) - 2) < 0.05);
    }
}

/* The natural state, with positions. */
static State with_positions(const Rod *rod, const System *sys, const double *p)
{
    RodLayout layout = rod_layout(rod, true);
    State state = system_state(sys);
    rod_natural_state(rod, &layout, p, state.x);
    return state;
}

/* A rod magnetised along its tangent has a magnetic pole at either end: beside a magnet, whose field has a
 * potential, it rests as if a force A M B of the place where its end is acted there. Returns how far off the
 * end is. */
static double pole_error(int elements)
{
    double *p, M = 5e4, at[3] = {0.1, 0.05, 0.2}, moment[3] = {2, -4, 12};
    Rod *loaded = rod_plain(elements, 0.1, 1e6, NULL, &p);
    mem_free(p);
    FluxField *magnet = flux_field_dipole(at, moment);
    FluxFields fields = {0};
    int k = flux_fields_add(&fields, magnet);
    Rod *rod = rod_plain(elements, 0.1, 1e6, &fields, &p);
    p[rod->flux.scale + k] = 1;
    for (int e = 0; e < elements; e++) p[rod->magnetization + 3 * e] = M;
    System *sys = rod_system(rod, 1e6, false);
    State beside = with_positions(rod, sys, p);
    assert_int_equal(rod_relax(rod, sys, 1, p, &beside).newton.status, NEWTON_CONVERGED);

    FluxSample sample;
    const double *end = beside.x + 3 * elements;
    flux_field_eval(magnet, end, (FluxPlace){0}, &sample);
    p[rod->flux.scale + k] = 0;
    vec3_store(p + rod->load + 3 * elements, vec3_scale(rod->unit[0].area * M, vec3_load(sample.flux)));
    rod_sum_loads(rod, p);
    System *other = rod_system(loaded, 1e6, false);
    State pulled = with_positions(loaded, other, p);
    assert_int_equal(rod_relax(loaded, other, 1, p, &pulled).newton.status, NEWTON_CONVERGED);
    double off = vec3_length(vec3_sub(vec3_load(pulled.x + 3 * elements), vec3_load(end)));
    assert_true(vec3_length(vec3_sub(vec3_load(end), vec3(0.1, 0, 0))) > 0.01);
    system_destroy(sys);
    system_destroy(other);
    rod_destroy(rod);
    rod_destroy(loaded);
    mem_free(p);
    state_destroy(&beside);
    state_destroy(&pulled);
    return off;
}

static void test_pole(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    double off[3];
    for (int k = 0; k < 3; k++) off[k] = pole_error(50 << k);
    print_message("beside a magnet: end %.1e m off at 200 elements; orders %.3f, %.3f\n", off[2],
                  log2(off[0] / off[1]), log2(off[1] / off[2]));
    assert_true(off[2] < 1e-6 && fabs(log2(off[1] / off[2]) - 2) < 0.1);
    assert_int_equal(mem_live_count(), blocks);
}

/* A rod that is to rest on a curve beside a magnet: no force is left, and it comes back there. */
static void test_balance_in_field(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Resting o = resting_create(&reference_rods[REFERENCE_HELIX], 5e6, 60);
    double at[3] = {0, 0, -0.12}, moment[3] = {0, 3, 8};
    FluxFields fields = {0};
    int k = flux_fields_add(&fields, flux_field_dipole(at, moment));
    Rod *rod = rod_create(60, rod_length(o.rod), o.rod->unit[0], &(RodActs){.fields = fields});
    double *p = params_vector(&rod->params);
    memcpy(p, o.p, (size_t)o.rod->params.size * sizeof *p);
    memcpy(rod->bow, o.rod->bow, 60 * sizeof *rod->bow);
    rod->strand[0] = o.rod->strand[0];
    p[rod->flux.scale + k] = 1;
    for (int e = 0; e < 60; e++) vec3_store(p + rod->magnetization + 3 * e, vec3(2e4, 5e3, -3e3));
    RodLayout layout = rod_layout(rod, true);
    double *g = mem_alloc((size_t)layout.dofs, sizeof *g);
    System *sys = rod_system(rod, 5e6, false);
    State rest = system_state(sys);
    rod_copy_state(rod, &o.layout, o.state.x, &layout, rest.x);
    rod_balance(rod, sys, &layout, 0, rest.x, p);
    Point point = state_point(&rest, p);
    Evaluation left = system_gradient(sys, &point, g);
    for (int i = 0; i < layout.reference; i++)
        if (!system_is_fixed(sys, i)) assert_true(fabs(g[i]) <= 1e-12 * left.force_scale);
    assert_int_equal(rod_relax(rod, sys, 1, p, &rest).newton.status, NEWTON_CONVERGED);
    print_message("beside a magnet: %.1e m off the curve\n", resting_distance(&o, rest.x));
    assert_true(resting_distance(&o, rest.x) < 1e-12);
    system_destroy(sys);
    rod_destroy(rod);
    mem_free(p);
    mem_free(g);
    state_destroy(&rest);
    resting_clear(&o);
    assert_int_equal(mem_live_count(), blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_discrete_inverse),
        cmocka_unit_test(test_forward),
        cmocka_unit_test(test_cantilevers),
        cmocka_unit_test(test_both_forms),
        cmocka_unit_test(test_moments),
        cmocka_unit_test(test_end_couple),
        cmocka_unit_test(test_pole),
        cmocka_unit_test(test_balance_in_field),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
