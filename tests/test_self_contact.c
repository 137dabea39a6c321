/* Where polylines and natural shapes touch themselves. */
#include "base/clock.h"
#include "base/memory.h"
#include "base/random.h"
#include "rod/inverse.h"
#include "rod/self_contact.h"
#include <math.h>
#include "tests/rod_reference.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

static double down = -0.00318, up = 0.00318, omega_20pi = 62.83185307179586, omega_63 = 63;

/* Natural nodes under the rod's own weight; the caller frees. */
static Vec3 *natural_of(RodCurvePoint *point, void *self, double range, double young, int elements)
{
    RodCurve curve;
    Error err;
    assert_true(rod_curve_create(point, self, 0, range, elements, &curve, &err));
    RodSection section = rod_circle(1.5e-3, young, 0.5, 1200);
    Vec3 *moment = mem_alloc(2 * (size_t)elements + 1, sizeof *moment),
         *natural = mem_alloc((size_t)elements + 1, sizeof *natural);
    rod_moments(&curve, (RodLoads){.line = vec3(0, 0, -9.8 * section.mass)}, moment);
    rod_invert(&curve, rod_alike(&section), moment, NULL, natural);
    mem_free(moment);
    rod_curve_clear(&curve);
    return natural;
}

static void test_natural_shapes(void **state)
{
    (void)state;
    const struct {
        const char *name;
        RodCurvePoint *point;
        void *self;
        double range, young;
        bool touches;
    } shapes[] = {{"helix", reference_helix, &down, 19.565163762857, 5e6, true},
                  {"conical", reference_conical, NULL, 7.88691715750555, 3.5e6, false},
                  {"wave_20pi", reference_wave, &omega_20pi, .302598403658, 23e6, true},
                  {"wave_63", reference_wave, &omega_63, .301915337162638, 23e6, true},
                  {"standing", reference_helix, &up, 19.565163762857, 5e6, false}};
    long blocks = mem_live_count();
    double nearest[5];
    for (int i = 0; i < 5; i++)
        for (int elements = 200; elements <= 10000; elements *= 50) {
            Vec3 *x = natural_of(shapes[i].point, shapes[i].self, shapes[i].range, shapes[i].young, elements);
            double start = clock_thread_seconds();
            RodContacts c = rod_self_contacts(x, elements + 1, 3e-3);
            print_message("%-9s %5d elements: %5d contacts, nearest %.4f mm (%d, %d), %.2f ms\n",
                          shapes[i].name, elements, c.count, 1e3 * c.nearest.distance, c.nearest.e1,
                          c.nearest.e2, 1e3 * (clock_thread_seconds() - start));
            assert_int_equal(c.count > 0, shapes[i].touches);
            nearest[i] = c.nearest.distance;
            rod_contacts_clear(&c);
            mem_free(x);
        }
    assert_true(fabs(nearest[0] - 0.19e-3) < 5e-6 && nearest[2] < 1e-7 &&
                nearest[3] < 1e-7); /* plane waves cross */
    assert_true(isinf(nearest[1]) && isinf(nearest[4]));
    /* The conical one passes itself at 9.66 mm. */
    Vec3 *x = natural_of(reference_conical, NULL, 7.88691715750555, 3.5e6, 2000);
    RodContacts wide = rod_self_contacts(x, 2001, 12e-3);
    assert_true(fabs(wide.nearest.distance - 9.6635e-3) < 1e-6);
    rod_contacts_clear(&wide);
    mem_free(x);
    assert_int_equal(mem_live_count(), blocks);
}

static Vec3 random_place(Random *random, double size)
{
    double x = random_signed(random), y = random_signed(random);
    return vec3(size * x, size * y, size * random_signed(random));
}

static double place_distance(Vec3 p, Vec3 b0, Vec3 b1)
{
    Vec3 v = vec3_sub(b1, b0), r = vec3_sub(p, b0);
    double t = fmin(fmax(vec3_dot(r, v) / vec3_dot(v, v), 0), 1);
    return vec3_length(vec3_axpy(-t, v, r));
}

/* The distance to b from a place on a is a convex function of the place. */
static double distance_by_thirds(Vec3 a0, Vec3 a1, Vec3 b0, Vec3 b1)
{
    double low = 0, high = 1, d[2] = {0};
    while (high - low > 1e-9) {
        for (int i = 0; i < 2; i++) {
            double s = low + (high - low) * (1 + i) / 3;
            d[i] = place_distance(vec3_axpy(s, vec3_sub(a1, a0), a0), b0, b1);
        }
        *(d[0] < d[1] ? &high : &low) = low + (high - low) * (d[0] < d[1] ? 2 : 1) / 3;
    }
    return fmin(d[0], d[1]);
}

static void test_segment_distance(void **state)
{
    (void)state;
    const struct {
        Vec3 a0, a1, b0, b1;
        double distance;
    } cases[] = {
        {{0, 0, 0}, {2, 0, 0}, {1, -1, 3}, {1, 1, 3}, 3},       /* across */
        {{0, 0, 0}, {2, 0, 0}, {1, 3, 0}, {5, 3, 0}, 3},        /* parallel, beside each other */
        {{0, 0, 0}, {2, 0, 0}, {9, 3, 0}, {1, 3, 0}, 3},        /* the other way */
        {{0, 0, 0}, {2, 0, 0}, {5, 4, 0}, {9, 4, 0}, 5},        /* parallel, one after the other */
        {{0, 0, 0}, {2, 0, 0}, {9, 4, 0}, {5, 4, 0}, 5},        /* the other way */
        {{5, 4, 0}, {9, 4, 0}, {0, 0, 0}, {2, 0, 0}, 5},        /* and exchanged */
        {{0, 0, 0}, {2, 0, 0}, {3, 0, 0}, {7, 0, 0}, 1},        /* on one line */
        {{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {7, 0, 0}, 0},        /* one upon the other */
        {{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, 2, 0}, 2},        /* a point */
        {{1, 2, 0}, {1, 2, 0}, {0, 0, 0}, {2, 0, 0}, 2},        /* exchanged */
        {{1, 2, 0}, {1, 2, 0}, {1, 2, 7}, {1, 2, 7}, 7},        /* two points */
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1 + 1e-9, 0}, 1}, /* almost parallel */
        {{0, 0, 0}, {1, 0, 0}, {0, -1e-7, 0}, {1, 1e-7, 0}, 0}, /* almost parallel, crossing */
        {{0, 0, 0}, {1, 1, 0}, {3, 0, 0}, {3, 4, 0}, 2},        /* end to inside */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double d = rod_segment_distance(cases[i].a0, cases[i].a1, cases[i].b0, cases[i].b1);
        if (!(fabs(d - cases[i].distance) < 1e-12)) fail_msg("case %zu: %.15g", i, d);
    }
    Random random = random_seed(5);
    for (int i = 0; i < 3000; i++) {
        Vec3 a0 = random_place(&random, 1), a1 = random_place(&random, 1), b0 = random_place(&random, 1);
        /* Every other pair is parallel but for 1e-2 to 1e-12. */
        Vec3 b1 = random_place(&random, 1);
        if (i % 2)
            b1 = vec3_axpy(pow(10, -2 - i % 11), b1, vec3_axpy(random_signed(&random), vec3_sub(a1, a0), b0));
        assert_true(fabs(rod_segment_distance(a0, a1, b0, b1) - distance_by_thirds(a0, a1, b0, b1)) < 2e-8);
    }
}

/* Every pair; of each pass the nearest. */
static int contacts_by_all_pairs(const Vec3 *x, int count, double distance, RodContact *list)
{
    double s[600] = {0};
    int found = 0;
    for (int e = 0; e < count - 1; e++) s[e + 1] = s[e] + vec3_length(vec3_sub(x[e + 1], x[e]));
    for (int e1 = 0; e1 < count - 1; e1++)
        for (int e2 = e1 + 1, last = -1; e2 < count - 1; e2++) {
            double d = rod_segment_distance(x[e1], x[e1 + 1], x[e2], x[e2 + 1]);
            if (s[e2] - s[e1 + 1] < M_PI / 2 * distance || !(d < distance)) continue;
            if (last < 0 || e2 > last + 1)
                list[found++] = (RodContact){e1, e2, d};
            else if (d < list[found - 1].distance)
                list[found - 1] = (RodContact){e1, e2, d};
            last = e2;
        }
    return found;
}

/* Balls of wool with even and uneven segments, some of no length, at distances below and above a segment's.
 */
static void test_all_pairs(void **state)
{
    (void)state;
    enum { MOST = 500 };
    static RodContact list[MOST * MOST];
    Random random = random_seed(11);
    int total = 0, none = 0;
    for (int run = 0; run < 60; run++) {
        int count = 2 + (int)(random_uniform(&random) * (MOST - 2));
        double stiffness = run % 3, distance = 0.02 * pow(50, random_uniform(&random));
        Vec3 x[MOST], way = {1, 0, 0};
        x[0] = random_place(&random, 100);
        for (int v = 1; v < count; v++) {
            Vec3 back = vec3_scale(0.5, vec3_sub(x[0], x[v - 1]));
            way = vec3_unit(vec3_add(back, vec3_axpy(3 * stiffness, way, random_place(&random, 1))));
            double step = run % 2 ? 0.2 : v % 7 == 0 ? 0 : 0.3 * random_uniform(&random);
            x[v] = vec3_axpy(step, way, x[v - 1]);
        }
        RodContacts c = rod_self_contacts(x, count, distance);
        int expected = contacts_by_all_pairs(x, count, distance, list);
        double nearest = INFINITY;
        assert_int_equal(c.count, expected);
        for (int i = 0; i < expected; i++) {
            assert_true(c.list[i].e1 == list[i].e1 && c.list[i].e2 == list[i].e2 &&
                        c.list[i].distance == list[i].distance);
            nearest = fmin(nearest, list[i].distance);
        }
        assert_true(c.nearest.distance == nearest && (c.nearest.e1 >= 0) == (expected > 0));
        total += expected;
        none += expected == 0;
        rod_contacts_clear(&c);
    }
    print_message("%d contacts in 60 random polylines, %d of them without\n", total, none);
    assert_true(total > 10000 && none > 2 && none < 40);
}

/* Contacts of a rod of diameter 1 along 0.55 turns of a circle. */
static int contacts_around(double diameter, int segments)
{
    Vec3 x[501];
    for (int v = 0; v <= segments; v++) {
        double angle = 1.1 * M_PI * v / segments;
        x[v] = vec3(diameter / 2 * cos(angle), diameter / 2 * sin(angle), 0);
    }
    RodContacts c = rod_self_contacts(x, segments + 1, 1);
    int count = c.count;
    rod_contacts_clear(&c);
    return count;
}

/* Neighbours are no contacts as long as the curve bends no sharper than the rod can. */
static void test_neighbours(void **state)
{
    (void)state;
    Vec3 line[400];
    for (int v = 0; v < 400; v++) line[v] = vec3(0.01 * v, 0, 0);
    const int counts[] = {0, 1, 2, 3, 400};
    for (int i = 0; i < 5; i++)
        for (double distance = 0; distance < 100; distance = 10 * distance + 0.001) {
            RodContacts c = rod_self_contacts(line, counts[i], distance);
            assert_true(c.count == 0 && c.list == NULL && c.nearest.e1 == -1 && isinf(c.nearest.distance));
            rod_contacts_clear(&c);
        }
    for (int segments = 50; segments <= 500; segments *= 10) {
        assert_int_equal(contacts_around(1.04, segments), 0);
        assert_true(contacts_around(0.96, segments) > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_natural_shapes),
                                       cmocka_unit_test(test_segment_distance),
                                       cmocka_unit_test(test_all_pairs), cmocka_unit_test(test_neighbours)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
