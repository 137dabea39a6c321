/* Stability of clamped-free rods: the curves of the reference table, columns and beams with closed forms. */
#include "base/clock.h"
#include "base/memory.h"
#include "rod/inverse.h"
#include "rod/stability.h"
#include <math.h>
#include "tests/rod_reference.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

static double down = -0.00318, up = 0.00318, omega_20pi = 62.83185307179586, omega_63 = 63;

typedef struct Reference {
    const char *name;
    RodCurvePoint *point;
    void *self;
    double range, young;
    int index;
    double eigenvalue, eigenvalue_off, critical, conjugate; /* 1/m^2, MPa, m */
    double coarse; /* error of the critical modulus at 200 elements */
} Reference;

static const Reference references[] = {
    {"helix", reference_helix, &down, 19.565163762857, 5e6, 0, 25.780, 5e-4, 1.97845, 0, 1e-6},
    {"conical", reference_conical, NULL, 7.88691715750555, 3.5e6, 0, 24.434, 5e-4, 2.23759, 0, 1e-6},
    {"wave_20pi", reference_wave, &omega_20pi, .302598403658, 23e6, 1, -8.08, 5e-3, 24.5274, .0168, 5e-5},
    {"wave_63", reference_wave, &omega_63, .301915337162638, 23e6, 1, -8.19, 5e-3, 24.5392, .0169, 5e-4},
    {"standing", reference_helix, &up, 19.565163762857, 5e6, 2, -128.8, 5e-2, 20.3696, .1195, 1e-6},
};

enum { REFERENCES = sizeof references / sizeof *references };

/* A rod with room for its own data. */
typedef struct Rod {
    RodEquilibrium at;
    Vec3 *k, *m, *K, *F;
} Rod;

static Rod rod_create(int elements, double length, RodSection section)
{
    Rod rod = {.k = mem_alloc(2 * (size_t)elements + 1, sizeof(Vec3)),
               .m = mem_alloc(2 * (size_t)elements + 1, sizeof(Vec3)),
               .K = mem_alloc(3 * (size_t)elements, sizeof(Vec3)),
               .F = mem_alloc(3 * (size_t)elements, sizeof(Vec3))};
    for (int i = 0; i < 3 * elements; i++) rod.K[i] = rod_stiffness(&section, 1);
    rod.at = (RodEquilibrium){elements, length, rod.k, rod.m, rod.K, rod.F};
    return rod;
}

static void scale(Rod *rod, Vec3 factor)
{
    for (int i = 0; i < 3 * rod->at.elements; i++) {
        Vec3 *K = &rod->K[i];
        *K = vec3(factor.x * K->x, factor.y * K->y, factor.z * K->z);
    }
}

static void rod_clear(Rod *rod)
{
    mem_free(rod->k);
    mem_free(rod->m);
    mem_free(rod->K);
    mem_free(rod->F);
}

typedef enum Framing { BISHOP, FRENET, SPUN } Framing;

/* The curve under its own weight. */
static Rod rod_of(const Reference *r, int elements, Framing framing)
{
    RodCurve curve;
    Error err;
    int stations = 2 * elements + 1;
    assert_true(rod_curve_create(r->point, r->self, 0, r->range, elements, &curve, &err));
    RodSection section = rod_circle(1.5e-3, r->young, 0.5, 1200);
    Rod rod = rod_create(elements, curve.length, section);
    RodLoads weight = {.line = vec3(0, 0, -9.8 * section.mass)};
    RodFrame *frames = mem_alloc((size_t)stations, sizeof *frames);
    rod_frenet(&curve, frames);
    if (framing == BISHOP) rod_bishop(&curve, frames[0].n1, frames);
    for (int j = 0; framing == SPUN && j < stations; j++)
        frames[j] = rod_turned(frames[j], -6 * M_PI * (exp(j / (stations - 1.0)) - 1) / (exp(1) - 1));
    rod_strains(&curve, frames, rod.k);
    rod_moments(&curve, weight, rod.m);
    for (int j = 0; j < stations; j++) rod.m[j] = rod_to_frame(frames[j], rod.m[j]);
    for (int i = 0; i < 3 * elements; i++) {
        int j = i / 3 * 2 + i % 3;
        rod.F[i] =
            rod_to_frame(frames[j], vec3_scale(curve.length * (1 - j / (stations - 1.0)), weight.line));
    }
    mem_free(frames);
    rod_curve_clear(&curve);
    return rod;
}

/* A straight rod of length 1 under the force at each station, in the frame. */
static Rod straight(int elements, RodSection section, Vec3 (*force)(double s))
{
    Rod rod = rod_create(elements, 1, section);
    for (int i = 0; force && i < 3 * elements; i++) {
        /* A jump at a node belongs to both sides. */
        double s = (i / 3 + (i % 3 == 0 ? 1e-9 : i % 3 == 1 ? 0.5 : 1 - 1e-9)) / elements;
        rod.F[i] = force(s);
    }
    return rod;
}

static void assert_near(double a, double b, double off)
{
    if (!(fabs(a - b) <= off)) fail_msg("%.12g is not within %.1e of %.12g", a, off, b);
}

static void test_table(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    for (int i = 0; i < REFERENCES; i++) {
        const Reference *r = &references[i];
        double critical[2];
        for (int fine = 0; fine < 2; fine++) {
            Rod rod = rod_of(r, fine ? 1600 : 200, BISHOP);
            double start = clock_thread_seconds();
            RodStability q = rod_stability(&rod.at);
            double took = clock_thread_seconds() - start, conjugate = rod.at.length - q.stable_tail;
            critical[fine] = q.critical_factor * r->young / 1e6;
            print_message(
                "%-9s %4d elements: index %d, eigenvalue %11.6f 1/m^2, critical %10.7f MPa, conjugate "
                "point %.7f m, %.1f ms\n",
                r->name, rod.at.elements, q.morse_index, q.lowest_eigenvalue, critical[fine], conjugate,
                1e3 * took);
            assert_int_equal(q.morse_index, r->index);
            assert_int_equal(q.stable, r->index == 0);
            if (fine) {
                assert_near(q.lowest_eigenvalue, r->eigenvalue, r->eigenvalue_off);
                assert_near(critical[1], r->critical, r->critical > 10 ? 5.1e-5 : 5.1e-6);
                assert_near(conjugate, r->conjugate, r->index ? 5.1e-5 : 0);
                assert_int_equal(rod_morse_index(&rod.at), q.morse_index);
                assert_true(rod_lowest_eigenvalue(&rod.at) == q.lowest_eigenvalue &&
                            rod_critical_factor(&rod.at) == q.critical_factor &&
                            rod_stable_tail(&rod.at) == q.stable_tail);
            }
            rod_clear(&rod);
        }
        assert_near(critical[0] / critical[1], 1, r->coarse);
    }
    assert_int_equal(mem_live_count(), blocks);
}

/* Fourth order in the frames that turn least, in Frenet's, and in some that spin at 80 to 220 1/m. */
static void test_framings(void **state)
{
    (void)state;
    const double exact[2] = {25.7800149, 0.395690931};
    for (int framing = BISHOP; framing <= SPUN; framing++) {
        double off[2][2];
        for (int fine = 0; fine < 2; fine++) {
            Rod rod = rod_of(&references[0], fine ? 200 : 100, (Framing)framing);
            RodStability q = rod_stability(&rod.at);
            off[fine][0] = q.lowest_eigenvalue / exact[0] - 1;
            off[fine][1] = q.critical_factor / exact[1] - 1;
            rod_clear(&rod);
        }
        double order = log2(off[0][1] / off[1][1]);
        print_message("framing %d: eigenvalue off by %.1e, factor by %.1e at 200 elements; order %.2f\n",
                      framing, off[1][0], off[1][1], order);
        assert_true(fabs(off[1][0]) < (framing == SPUN ? 3e-5 : 1e-6) && fabs(off[1][1]) < 3e-6 &&
                    order > 3.5);
    }
}

/* m and F stay, K is multiplied: the second direction of the standing helix becomes stable at 19.7364 MPa. */
static void test_second_root(void **state)
{
    (void)state;
    const double young[] = {20.3697, 20.3695, 19.7365, 19.7363};
    const int index[] = {0, 1, 1, 2};
    Rod rod = rod_of(&references[4], 800, BISHOP);
    for (int i = 0; i < 4; i++) {
        double factor = young[i] / (i ? young[i - 1] : 5);
        scale(&rod, vec3(factor, factor, factor));
        assert_int_equal(rod_morse_index(&rod.at), index[i]);
    }
    rod_clear(&rod);
}

static const RodSection unlike = {.twist = 1.5, .bend1 = 3, .bend2 = 2};

static Vec3 own_weight(double s)
{
    return vec3(-(1 - s), 0, 0);
}

static Vec3 thrust(double s)
{
    (void)s;
    return vec3(-1, 0, 0);
}

static Vec3 thrust_at_the_middle(double s)
{
    return vec3(s < 0.5 ? -1 : 0, 0, 0);
}

static Vec3 tension(double s)
{
    (void)s;
    return vec3(50, 0, 0);
}

/* Greenhill's column, whose two directions of bending are lost at once; Euler's, with thrust at its end and
 * at its middle. */
static void test_columns(void **state)
{
    (void)state;
    const double greenhill = 7.837347438943;
    RodSection circle = {.twist = 2.0 / 3, .bend1 = 1, .bend2 = 1};
    Rod column = straight(200, circle, own_weight);
    RodStability q = rod_stability(&column.at);
    print_message("Greenhill's column: w L^3/EI = %.8f\n", 1 / q.critical_factor);
    assert_near(1 / q.critical_factor, greenhill, 2e-7);
    scale(&column, vec3(1, 0.9999 / greenhill, 0.9999 / greenhill));
    assert_int_equal(rod_morse_index(&column.at), 2);
    scale(&column, vec3(1, 1.0001 / 0.9999, 1.0001 / 0.9999));
    assert_int_equal(rod_morse_index(&column.at), 0);
    rod_clear(&column);

    Rod euler = straight(100, unlike, thrust);
    q = rod_stability(&euler.at);
    assert_near(q.critical_factor * unlike.bend2, 4 / (M_PI * M_PI), 2e-8);
    assert_near(q.lowest_eigenvalue, 1.5 / 2 * M_PI * M_PI / 4, 2e-7); /* twist is the softest */
    scale(&euler,
          vec3(1, 1,
               0.01 /
                   unlike.bend2)); /* loses stability at lengths of (n + 1/2) pi/10: three of them, and in the
                                    * other direction none */
    q = rod_stability(&euler.at);
    assert_int_equal(q.morse_index, 3);
    assert_near(q.stable_tail, M_PI / 20, 1e-8);
    assert_near(q.lowest_eigenvalue, M_PI * M_PI / 4 - 100, 1e-5);
    scale(&euler, vec3(1, 0.01 / unlike.bend1, 1));
    assert_int_equal(rod_morse_index(&euler.at), 6);
    rod_clear(&euler);

    Rod middle = straight(100, unlike, thrust_at_the_middle);
    q = rod_stability(&middle.at);
    assert_near(q.critical_factor * unlike.bend2, 1 / (M_PI * M_PI), 1e-8);
    rod_clear(&middle);
}

/* A beam that sags straight under a force P across its end, and tips over sideways at P L^2 = 4.0126 sqrt(EI
 * GJ), twice the first zero of the Bessel function of order -1/4 [Prandtl 1899]; its axes either way round.
 */
static void test_tipping_beam(void **state)
{
    (void)state;
    for (int across = 1; across <= 2; across++) {
        RodSection strip = {.twist = 0.8, .bend1 = across == 1 ? 0.5 : 20, .bend2 = across == 1 ? 20 : 0.5};
        Rod beam = straight(200, strip, NULL);
        for (int j = 0; j <= 400; j++) {
            double moment = 1 - j / 400.0;
            beam.m[j] = across == 1 ? vec3(0, 0, moment) : vec3(0, -moment, 0);
        }
        for (int i = 0; i < 600; i++) beam.F[i] = across == 1 ? vec3(0, 1, 0) : vec3(0, 0, 1);
        RodStability q = rod_stability(&beam.at);
        print_message("tipping beam: P L^2/sqrt(EI GJ) = %.7f\n", 1 / (q.critical_factor * sqrt(0.8 * 0.5)));
        assert_near(1 / (q.critical_factor * sqrt(0.8 * 0.5)), 4.0125993436, 1e-7);
        rod_clear(&beam);
    }
}

/* Nothing to lose stability to, at any resolution. */
static void test_never_unstable(void **state)
{
    (void)state;
    const int counts[] = {1, 2, 7, 200};
    for (int i = 0; i < 4; i++) {
        for (int pulled = 0; pulled < 2; pulled++) {
            Rod rod = straight(counts[i], unlike, pulled ? tension : NULL);
            RodStability q = rod_stability(&rod.at);
            assert_true(q.stable && q.morse_index == 0 && q.critical_factor == 0 && q.stable_tail == 1);
            /* The twist, 1.5/2 pi^2/4; one parabola has 5/2 for pi^2/4. */
            assert_near(q.lowest_eigenvalue, 0.75 * M_PI * M_PI / 4, 0.03 / pow(counts[i], 4) + 1e-7);
            rod_clear(&rod);
        }
    }
}

static Vec3 thrust_at_the_end(double s)
{
    return vec3(s < 0.5 ? 200 : -1, 0, 0);
}

/* The standing helix at a hundredth of its stiffness; a rod that loses stability in the thrust at its end and
 * then is pulled so hard that a field grows by a hundred decades: the index does not depend on the
 * resolution. */
static void test_far_beyond(void **state)
{
    (void)state;
    int index[2][2];
    for (int fine = 0; fine < 2; fine++) {
        Rod soft = rod_of(&references[4], fine ? 1600 : 800, FRENET);
        scale(&soft, vec3(1e-2, 1e-2, 1e-2));
        RodStability q = rod_stability(&soft.at);
        index[fine][0] = q.morse_index;
        assert_near(q.critical_factor * 5e-2, 20.3696, 1e-4);
        rod_clear(&soft);

        Rod pulled = straight(fine ? 800 : 400, (RodSection){.twist = 1, .bend1 = 1e-3, .bend2 = 3e-3},
                              thrust_at_the_end);
        q = rod_stability(&pulled.at);
        index[fine][1] = q.morse_index;
        assert_near(q.stable_tail, M_PI / 2 * sqrt(1e-3), 1e-6);
        rod_clear(&pulled);
    }
    print_message("index of the soft helix %d, of the pulled rod %d\n", index[0][0], index[0][1]);
    for (int i = 0; i < 2; i++) assert_int_equal(index[0][i], index[1][i]);
    assert_int_equal(index[0][1], 8); /* (n + 1/2) pi sqrt(EI) < 1/2: five and three */
}

/* A column of two stiffnesses, 2 and 1, buckles where tan k1/2 tan k2/2 = k2/k1, k^2 = P/EI. */
static void test_stepped_column(void **state)
{
    (void)state;
    RodSection half = {.twist = 1, .bend1 = 1, .bend2 = 1};
    Rod column = straight(100, half, thrust);
    for (int i = 0; i < 150; i++) column.K[i] = vec3(2, 2, 2);
    double low = 0, high = M_PI * M_PI / 2;
    while (high - low > 1e-12) {
        double P = (low + high) / 2, k1 = sqrt(P / 2), k2 = sqrt(P);
        *(tan(k1 / 2) * tan(k2 / 2) < k2 / k1 ? &low : &high) = P;
    }
    double found = 1 / rod_critical_factor(&column.at);
    print_message("a stepped column: P = %.9f, exact %.9f\n", found, low);
    assert_near(found, low, 2e-7);
    rod_clear(&column);
}

/* Elements count in bending lengths sqrt(EI/F) where they bend. */
static void test_bending_lengths(void **state)
{
    (void)state;
    enum { N = 4 };
    RodSection section = rod_circle(1e-3, 1e6, 0.4, 1000);
    Vec3 k[2 * N + 1] = {{0}}, m[2 * N + 1] = {{0}}, K[3 * N], F[3 * N];
    for (int i = 0; i < 3 * N; i++) {
        K[i] = rod_stiffness(&section, 1);
        F[i] = vec3(0.2, 0, -0.1 * (i / 3));
    }
    RodEquilibrium at = {N, 1, k, m, K, F};
    assert_true(rod_bending_lengths(&at) == 0);
    m[3] = vec3(0, section.bend1, 0); /* a quarter of a radian in the second element */
    double expected = 0.25 * sqrt(hypot(0.2, 0.1) / section.bend1);
    assert_true(fabs(rod_bending_lengths(&at) - expected) < 1e-12 * expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stepped_column), cmocka_unit_test(test_bending_lengths),
        cmocka_unit_test(test_table),          cmocka_unit_test(test_framings),
        cmocka_unit_test(test_second_root),    cmocka_unit_test(test_columns),
        cmocka_unit_test(test_tipping_beam),   cmocka_unit_test(test_never_unstable),
        cmocka_unit_test(test_far_beyond)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
