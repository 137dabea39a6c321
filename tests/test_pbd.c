/* The preview rod: what it keeps (frames, momenta, lengths), where it comes to rest, how fast it is. */
#include "base/clock.h"
#include "base/memory.h"
#include "rod/inverse.h"
#include "rod/pbd.h"
#include <math.h>
#include "tests/rod_reference.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

enum { MOST = 60 };

/* In all three directions. */
static Vec3 alike(double stretch)
{
    return vec3(stretch, stretch, stretch);
}

static double apart(Vec3 a, Vec3 b)
{
    return vec3_length(vec3_sub(a, b));
}

static double length_of(const Vec3 *x, int elements)
{
    double sum = 0;
    for (int e = 0; e < elements; e++) sum += apart(x[e], x[e + 1]);
    return sum;
}

/* The rod whose equilibrium is the helix of test_rod.c, with places[elements + 1] of that equilibrium. */
static PbdRodDef sagging_helix(int elements, Vec3 *places)
{
    static Vec3 strain[MOST];
    static Vec3 moment[2 * MOST + 1], strains[2 * MOST + 1];
    static RodFrame frames[2 * MOST + 1];
    RodCurve curve;
    assert_true(rod_curve_create(reference_helix, NULL, 0, 19.565163762857, elements, &curve, NULL));
    RodSection section = rod_circle(1.5e-3, 5e6, 0.5, 1200);
    rod_moments(&curve, (RodLoads){.line = vec3(0, 0, -9.8 * section.mass)}, moment);
    rod_frenet(&curve, frames);
    rod_natural_strains(&curve, rod_alike(&section), moment, frames, strains);
    for (int e = 0; e < elements; e++) strain[e] = strains[2 * e + 1];
    for (int i = 0; i <= elements; i++) places[i] = curve.x[2 * i];
    PbdRodDef def = {.elements = elements,
                     .length = curve.length,
                     .section = section,
                     .stretch = alike(5e6 * M_PI * 1.5e-3 * 1.5e-3),
                     .start = ROD_CLAMPED,
                     .natural_strain = strain,
                     .position = places[0],
                     .clamp = quat_from_axes(frames[0].n0, frames[0].n1, frames[0].n2),
                     .gravity = vec3(0, 0, -9.8),
                     .drag = 5,
                     .substeps = 100,
                     .sweeps = 1};
    rod_curve_clear(&curve);
    return def;
}

/* A straight rod along x with bending and twisting stiffness of about 1e-3 N m^2, 20 g/m, 0.2 m. */
static PbdRodDef straight(int elements, const Vec3 *strain)
{
    return (PbdRodDef){
        .elements = elements,
        .length = 0.2,
        .section = {.twist = 0.5e-3, .bend1 = 1e-3, .bend2 = 2e-3, .mass = 0.02, .reach = 1e-3},
        .stretch = alike(1e3),
        .start = ROD_CLAMPED,
        .natural_strain = strain,
        .clamp = quat_identity(),
        .drag = 20,
        .substeps = 20,
        .sweeps = 4};
}

static PbdRod *run(const PbdRodDef *def, double dt, int steps)
{
    PbdRod *rod = pbd_rod_create(def);
    for (int k = 0; k < steps; k++) pbd_rod_step(rod, dt);
    return rod;
}

static double off_orthonormal(const PbdRod *rod, int elements)
{
    RodFrame f[MOST];
    double worst = 0;
    pbd_rod_frames(rod, f);
    for (int e = 0; e < elements; e++)
        worst = fmax(worst, fmax(apart(vec3_cross(f[e].n0, f[e].n1), f[e].n2),
                                 apart(vec3_cross(f[e].n1, f[e].n2), f[e].n0)));
    return worst;
}

/* With constant natural strains the nodes of the natural shape lie on one helix, and stay there. */
static void test_natural_shape(void **state)
{
    (void)state;
    enum { N = 12 };
    Vec3 strain[N];
    const double k = 20, t = 15, square = k * k + t * t;
    for (int e = 0; e < N; e++) strain[e] = vec3(t, 0, k);
    PbdRodDef def = straight(N, strain);
    PbdRod *rod = run(&def, 0.01, 20);
    const Vec3 *x = pbd_rod_positions(rod);
    double worst = 0;
    for (int i = 0; i <= N; i++) {
        /* The axis is along (t, 0, k), through the point k/square along n1. */
        double s = 0.2 * i / N, turn = sqrt(square) * s, r = k / square, rise = t * s / square;
        Vec3 across = vec3(k / sqrt(square), 0, -t / sqrt(square));
        Vec3 exact = vec3_axpy(rise, vec3(t, 0, k), vec3_scale(r * sin(turn), across));
        exact.y += r * (1 - cos(turn));
        worst = fmax(worst, apart(exact, x[i]));
    }
    PbdRodSums sums = pbd_rod_sums(rod);
    assert_true(worst < 1e-13 && sums.kinetic < 1e-20 && sums.elastic < 1e-20);
    pbd_rod_destroy(rod);
}

/* Rest of the helix: its distance from the exact equilibrium, for what a step is made of. */
static void test_helix_comes_to_rest(void **state)
{
    (void)state;
    static const struct {
        int elements, substeps, sweeps;
        double most; /* m */
    } rows[] = {{50, 100, 1, 6e-4}, {50, 10, 10, 9e-4}, {50, 20, 5, 8e-4}, {50, 20, 1, 1.2e-2},
                {50, 4, 4, 5e-2},   {30, 100, 1, 6e-4}, {30, 20, 1, 3e-3}};
    long blocks = mem_live_count();
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        Vec3 places[MOST + 1];
        PbdRodDef def = sagging_helix(rows[k].elements, places);
        def.substeps = rows[k].substeps, def.sweeps = rows[k].sweeps;
        double seconds = clock_thread_seconds(), worst = 0, exact = length_of(places, def.elements);
        PbdRod *rod = run(&def, 0.01, 300);
        seconds = clock_thread_seconds() - seconds;
        const Vec3 *x = pbd_rod_positions(rod);
        for (int i = 0; i <= def.elements; i++) worst = fmax(worst, apart(x[i], places[i]));
        PbdRodSums sums = pbd_rod_sums(rod);
        print_message("%d elements, %3d substeps of %2d sweeps: off by %.2f mm, stretched %+.2f %%, "
                      "kinetic/elastic %.0e, %.1f M element-sweeps/s\n",
                      def.elements, def.substeps, def.sweeps, worst * 1e3,
                      100 * (length_of(x, def.elements) / exact - 1), sums.kinetic / sums.elastic,
                      300e-6 * def.elements * def.substeps * def.sweeps / seconds);
        assert_true(worst < rows[k].most && off_orthonormal(rod, def.elements) < 1e-14);
        pbd_rod_destroy(rod);
    }
    assert_int_equal(mem_live_count(), blocks);
}

/* Without gravity and supports: both momenta stay, while the rod straightens and swings. */
static void test_floating(void **state)
{
    (void)state;
    enum { N = 20 };
    Vec3 strain[N] = {{0}}, start[N];
    for (int e = 0; e < N; e++) start[e] = vec3(4 * sin(e), 3 + e * 0.3, 5 * cos(0.4 * e));
    PbdRodDef def = straight(N, strain);
    def.start_strain = start, def.drag = 0, def.start = ROD_FREE;
    double turning[2] = {0};
    for (int trial = 0; trial < 2; trial++) {
        PbdRod *rod = pbd_rod_create(&def);
        double first = pbd_rod_sums(rod).elastic, impulse = 0, most = 0, mass = 0.02 * 0.2;
        for (int k = 0; k < 100; k++) {
            pbd_rod_step(rod, 1e-3);
            PbdRodSums sums = pbd_rod_sums(rod);
            impulse = fmax(impulse, vec3_length(sums.momentum));
            turning[trial] = fmax(turning[trial], vec3_length(sums.spin));
            most = fmax(most, sums.kinetic);
            assert_true(sums.kinetic + sums.elastic < first * 1.001);
        }
        double part = sqrt(2 * most * mass); /* of the momentum that parts of it had */
        turning[trial] /= part * 0.2;
        print_message("floating, %d substeps: momentum %.0e, spin %.0e of what parts of it had\n",
                      def.substeps, impulse / part, turning[trial]);
        assert_true(impulse < 3e-11 * part);
        pbd_rod_destroy(rod);
        def.substeps *= 4;
    }
    assert_true(turning[0] < 1e-3 && turning[1] < 0.3 * turning[0]);
}

/* Falls freely against the drag: v' = g - drag v, implicit. */
static void test_drag(void **state)
{
    (void)state;
    Vec3 strain[5] = {{0}};
    PbdRodDef def = straight(5, strain);
    def.start = ROD_FREE, def.gravity = vec3(0, 0, -9.81);
    PbdRod *rod = run(&def, 0.01, 10);
    double speed = 9.81 / 20 * (1 - pow(1 / (1 + 20 * 0.01 / def.substeps), 10 * def.substeps));
    for (int i = 0; i <= 5; i++) assert_true(apart(pbd_rod_velocities(rod)[i], vec3(0, 0, -speed)) < 1e-9);
    pbd_rod_destroy(rod);
}

/* A thousand steps of the falling helix without drag. What unfinished sweeps leave of the constraints counts
 * as elastic energy, so that the sum may rise, but stays within bounds; and motion dies down. */
static void test_energy(void **state)
{
    (void)state;
    static const int sweeps[2] = {2, 10};
    static const double bound[2] = {0.3, 1e-6};
    for (int k = 0; k < 2; k++) {
        Vec3 places[MOST + 1];
        PbdRodDef def = sagging_helix(20, places);
        def.drag = 0, def.substeps = 10, def.sweeps = sweeps[k];
        PbdRod *rod = pbd_rod_create(&def);
        PbdRodSums sums = pbd_rod_sums(rod);
        double first = sums.potential + sums.elastic, scale = 8.3e-2 * 0.3 * 0.06, most = 0, fast[4] = {0};
        for (int i = 0; i < 1000; i++) {
            pbd_rod_step(rod, 0.01);
            sums = pbd_rod_sums(rod);
            most = fmax(most, sums.kinetic + sums.elastic + sums.potential - first);
            fast[i / 250] = fmax(fast[i / 250], sums.kinetic);
        }
        print_message("%2d sweeps: energy at most %+.1e of the weight's work; kinetic %.1e %.1e %.1e %.1e\n",
                      def.sweeps, most / scale, fast[0] / scale, fast[1] / scale, fast[2] / scale,
                      fast[3] / scale);
        assert_true(most < bound[k] * scale && fast[0] < 0.5 * scale && fast[3] < 0.5 * fast[0]);
        pbd_rod_destroy(rod);
    }
}

/* A rod bent into the mirror image of its natural arc goes back to the arc. */
static void test_bent_backwards(void **state)
{
    (void)state;
    enum { N = 20 };
    Vec3 natural[N], mirrored[N];
    for (int e = 0; e < N; e++) natural[e] = vec3(0, 0, 12), mirrored[e] = vec3(0, 0, -12);
    PbdRodDef def = straight(N, natural);
    PbdRod *rest = pbd_rod_create(&def);
    def.start_strain = mirrored;
    PbdRod *rod = pbd_rod_create(&def);
    Vec3 end = pbd_rod_positions(rest)[N];
    assert_true(end.y > 0.1 && apart(pbd_rod_positions(rod)[N], vec3(end.x, -end.y, 0)) < 1e-3);
    for (int k = 0; k < 200; k++) pbd_rod_step(rod, 0.01);
    print_message("bent backwards: the end comes back to %.0e m\n", apart(pbd_rod_positions(rod)[N], end));
    assert_true(apart(pbd_rod_positions(rod)[N], end) < 1e-4);
    pbd_rod_destroy(rest);
    pbd_rod_destroy(rod);
}

/* How far a unit force along z lifts the end: the virtual work of its moments at the joints. */
static double compliance(const PbdRod *rod, const PbdRodDef *def)
{
    RodFrame f[MOST];
    const Vec3 *x = pbd_rod_positions(rod);
    double sum = 0, h = def->length / def->elements;
    pbd_rod_frames(rod, f);
    for (int e = 0; e < def->elements; e++) {
        Vec3 m = vec3_cross(vec3_sub(x[def->elements], x[e]), vec3(0, 0, 1));
        double twist = vec3_dot(m, vec3_unit(vec3_add(f[e].n0, f[e == 0 ? 0 : e - 1].n0)));
        double bend2 = vec3_dot(m, m) - twist * twist;
        sum += (e == 0 ? h / 2 : h) * (twist * twist / def->section.twist + bend2 / def->section.bend1);
    }
    return sum;
}

/* Small forces at the end: F L^3/(3 EI) about each axis; and of a rod with a corner, which twists. */
static void test_stiffness(void **state)
{
    (void)state;
    enum { N = 16 };
    Vec3 strain[N] = {{0}}, force[N + 1] = {{0}};
    PbdRodDef def = straight(N, strain);
    def.force = force, def.sweeps = 20;
    force[N] = vec3(0, 2e-3, 2e-3);
    PbdRod *rod = run(&def, 0.01, 300);
    Vec3 end = pbd_rod_positions(rod)[N];
    double beam = 2e-3 * pow(0.2, 3) / 3, y = end.y / (beam / 2e-3) - 1, z = end.z / (beam / 1e-3) - 1;
    pbd_rod_destroy(rod);
    for (int e = 9; e < 12; e++) strain[e] = vec3(0, 0, 40);
    def.section.bend1 = def.section.bend2 = 0.01;
    force[N] = vec3(0, 0, 1e-3);
    rod = pbd_rod_create(&def);
    double exact = 1e-3 * compliance(rod, &def);
    for (int k = 0; k < 300; k++) pbd_rod_step(rod, 0.01);
    double w = pbd_rod_positions(rod)[N].z / exact - 1;
    print_message("a beam's end: off by %+.1e and %+.1e about the two axes; a corner's %+.1e\n", y, z, w);
    assert_true(fabs(y) < 4e-3 && fabs(z) < 4e-3 && fabs(w) < 3e-3);
    pbd_rod_destroy(rod);
}

static double depth(const Vec3 *x, int elements)
{
    double low = 0;
    for (int i = 0; i <= elements; i++) low = fmax(low, -x[i].z);
    return low;
}

/* Both ends held: the sag of a clamped and simply supported beam, w L^4/(184.6 EI); then the end is led in.
 */
static void test_held_end(void **state)
{
    (void)state;
    enum { N = 20 };
    Vec3 strain[N] = {{0}};
    PbdRodDef def = straight(N, strain);
    def.end = ROD_PINNED, def.sweeps = 20, def.gravity = vec3(0, 0, -0.5);
    PbdRod *rod = run(&def, 0.01, 200);
    const Vec3 *x = pbd_rod_positions(rod);
    double low = depth(x, N), exact = 0.02 * 0.5 * pow(0.2, 4) / (184.6 * 1e-3);
    print_message("a held beam sags by %+.1e too much\n", low / exact - 1);
    assert_true(fabs(low / exact - 1) < 3e-2 && apart(x[N], vec3(0.2, 0, 0)) < 1e-15);
    for (int k = 0; k < 200; k++) {
        pbd_rod_lead(rod, true, vec3(0.2 - 0.05 * k / 199, 0, 0), quat_identity());
        pbd_rod_step(rod, 0.01);
    }
    low = depth(x, N);
    print_message("led in by a quarter: %.0f mm deep, stretched by %+.1e\n", low * 1e3,
                  length_of(x, N) / 0.2 - 1);
    assert_true(low > 0.04 && apart(x[N], vec3(0.15, 0, 0)) < 1e-15 &&
                fabs(length_of(x, N) / 0.2 - 1) < 2e-2);
    pbd_rod_destroy(rod);
}

/* Where a rod of so many sweeps comes to rest. */
static PbdRod *settle(PbdRodDef def, Vec3 flux_density)
{
    def.sweeps = 20, def.substeps = 20;
    PbdRod *rod = pbd_rod_create(&def);
    pbd_rod_set_field(rod, flux_density);
    for (int k = 0; k < 300; k++) pbd_rod_step(rod, 0.01);
    return rod;
}

/* Stretch by its own weight, m g L/(2 EA), and Timoshenko's cantilever: F L/(kappa G A) + F L^3/(3 EI) each way. */
static void test_stretch_and_shear(void **state)
{
    (void)state;
    enum { N = 16 };
    Vec3 strain[N] = {{0}}, force[N + 1] = {{0}}, stretched[N];
    PbdRodDef def = straight(N, strain);
    def.stretch = vec3(1, 0.3, 0.2), def.gravity = vec3(9.81, 0, 0);
    PbdRod *rod = settle(def, vec3(0, 0, 0));
    double exact = 0.02 * 9.81 * 0.2 * 0.2 / 2, got = pbd_rod_positions(rod)[N].x - 0.2;
    pbd_rod_stretches(rod, stretched);
    print_message("its own weight: off by %+.1e\n", got / exact - 1);
    assert_true(fabs(got / exact - 1) < 1e-6);
    assert_true(fabs(stretched[0].x / (0.02 * 9.81 * 0.2 * (1 - 0.5 / N)) - 1) < 1e-6);
    pbd_rod_destroy(rod);
    def.gravity = vec3(0, 0, 0), def.force = force, force[N] = vec3(0, 1e-4, 1e-4);
    rod = settle(def, vec3(0, 0, 0));
    double bend = 1e-4 * pow(0.2, 3) / 3, y = bend / 2e-3 + 1e-4 * 0.2 / 0.3,
           z = bend / 1e-3 + 1e-4 * 0.2 / 0.2;
    Vec3 end = pbd_rod_positions(rod)[N];
    print_message("Timoshenko's cantilever: off by %+.1e, %+.1e\n", end.y / y - 1, end.z / z - 1);
    assert_true(fabs(end.y / y - 1) < 2e-3 && fabs(end.z / z - 1) < 2e-3);
    pbd_rod_destroy(rod);
}

typedef enum Span { CLAMPS, HINGES, TURNED } Span;

/* What a beam does in its middle, in parts of what it should: its sag w L^2/(8 kappa G A) and, between clamps, w L^4/(384 EI),
 * between hinges 5 times that; and where one of the clamps is turned by theta, theta L/8. */
static double deflection(Span span, int elements)
{
    const double sag = 0.02 * 0.05 * pow(0.2, 4) / (384 * 1e-3), angle = 0.02;
    const double shear = 0.02 * 0.05 * pow(0.2, 2) / (8 * 1e2);
    const double exact[] = {[CLAMPS] = sag + shear, [HINGES] = 5 * sag + shear, [TURNED] = angle * 0.2 / 8};
    Vec3 strain[MOST] = {{0}};
    PbdRodDef def = straight(elements, strain);
    def.start = def.end = span == HINGES ? ROD_PINNED : ROD_CLAMPED;
    def.end_frame = span == TURNED ? quat_exp(vec3(0, 0, angle)) : quat_identity();
    if (span != TURNED) def.gravity = vec3(0, 0, -0.05);
    def.stretch = alike(1e2);
    PbdRod *rod = settle(def, vec3(0, 0, 0));
    const Vec3 *x = pbd_rod_positions(rod);
    double got = span == TURNED ? -x[elements / 2].y : depth(x, elements);
    pbd_rod_destroy(rod);
    return got / exact[span];
}

/* Second order. */
static void test_supports(void **state)
{
    (void)state;
    static const char *const names[] = {"clamps", "hinges", "a turned clamp"};
    for (Span span = CLAMPS; span <= TURNED; span++) {
        double coarse = deflection(span, 8) - 1, fine = deflection(span, 16) - 1;
        print_message("%s: off by %+.1e, %+.1e\n", names[span], coarse, fine);
        assert_true(fabs(fine) < 4e-2 && fabs(fine) < fmax(0.3 * fabs(coarse), 2e-3));
    }
}

/* Magnetised by m per length along its tangent, in a weak field across: m B L^3/(3 EI). */
static void test_magnets(void **state)
{
    (void)state;
    enum { N = 20 };
    Vec3 strain[N] = {{0}}, magnet[N];
    double m = 2, B = 2e-4;
    for (int e = 0; e < N; e++) magnet[e] = vec3(m * 0.2 / N, 0, 0);
    PbdRodDef def = straight(N, strain);
    def.magnet = magnet;
    PbdRod *rod = settle(def, vec3(0, 0, B));
    double exact = m * B * pow(0.2, 3) / (3 * 1e-3), got = pbd_rod_positions(rod)[N].z,
           energy = pbd_rod_sums(rod).magnetic / (-m * B * got);
    print_message("a magnet's end: off by %+.1e, its energy by %+.1e\n", got / exact - 1, energy - 1);
    assert_true(fabs(got / exact - 1) < 3e-3 && fabs(energy - 1) < 1e-3);
    pbd_rod_destroy(rod);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_natural_shape),
        cmocka_unit_test(test_helix_comes_to_rest),
        cmocka_unit_test(test_floating),
        cmocka_unit_test(test_drag),
        cmocka_unit_test(test_energy),
        cmocka_unit_test(test_bent_backwards),
        cmocka_unit_test(test_stiffness),
        cmocka_unit_test(test_held_end),
        cmocka_unit_test(test_stretch_and_shear),
        cmocka_unit_test(test_supports),
        cmocka_unit_test(test_magnets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
