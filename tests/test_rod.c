/* Curves by arclength, frames, and the natural shape of hanging rods: reference end points, boxes and
 * strains. */
#include "base/memory.h"
#include "base/quat.h"
#include "rod/inverse.h"
#include <math.h>
#include "tests/rod_reference.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

static const double omega_20pi = 62.83185307179586, omega_63 = 63;

typedef struct Reference {
    const char *name;
    RodCurvePoint *point;
    const double *omega;
    double range, length, young;
    double end[3], middle[3], low[3], high[3];
} Reference;

static const Reference references[] = {
    {"helix",
     reference_helix,
     NULL,
     19.565163762857,
     0.3,
     5e6,
     {.011892357209, .010567181870, -.003405014154},
     {-.011014064320, -.001405880674, .018765670659},
     {-.01426136320, -.00942009031, -.00340501415},
     {.01798017285, .01991371092, .02287705541}},
    {"conical",
     reference_conical,
     NULL,
     7.88691715750555,
     0.23,
     3.5e6,
     {-.035372611385, -.006441328786, -.061033604576},
     {-0.01279269031455, .026624904273, -.088809232130},
     {-.03537261138, -.00644132879, -.08913418816},
     {.00339294820, .04127335461, 0}},
    {"wave_20pi",
     reference_wave,
     &omega_20pi,
     .302598403658,
     0.7,
     23e6,
     {-.085699964467, 0, .024204359773},
     {.014666091248, 0, .014769637846},
     {-.08569996447, 0, -.04019703502},
     {.03874835735, 0, .06905477374}},
    {"wave_63",
     reference_wave,
     &omega_63,
     .301915337162638,
     0.7,
     23e6,
     {-.085366588041, 0, .023514813217},
     {.014864498647, 0, .015050683422},
     {-.08536658804, 0, -.04023536166},
     {.03877137465, 0, .06891239728}},
};

enum { REFERENCES = sizeof references / sizeof *references };

static RodLoads weight(double mass)
{
    return (RodLoads){.line = vec3(0, 0, -9.8 * mass)};
}

static double distance(Vec3 a, const double *b)
{
    return vec3_length(vec3_sub(a, vec3_load(b)));
}

/* Natural nodes of a reference rod; the caller frees. */
static Vec3 *invert(const Reference *r, int elements, RodCurve *curve)
{
    Error err;
    assert_true(rod_curve_create(r->point, (void *)r->omega, 0, r->range, elements, curve, &err));
    RodSection section = rod_circle(1.5e-3, r->young, 0.5, 1200);
    Vec3 *moment = mem_alloc(2 * (size_t)elements + 1, sizeof *moment),
         *natural = mem_alloc((size_t)elements + 1, sizeof *natural);
    rod_moments(curve, weight(section.mass), moment);
    rod_invert(curve, rod_alike(&section), moment, NULL, natural);
    mem_free(moment);
    return natural;
}

/* Of the natural shape's nodes: a box may be missed by what lies between two of them. */
static double off_the_box(const Vec3 *x, int count, const double *low, const double *high)
{
    double a[3] = {INFINITY, INFINITY, INFINITY}, b[3] = {-INFINITY, -INFINITY, -INFINITY}, off = 0;
    for (int k = 0; k < count; k++) {
        double v[3];
        vec3_store(v, x[k]);
        for (int i = 0; i < 3; i++) a[i] = fmin(a[i], v[i]), b[i] = fmax(b[i], v[i]);
    }
    for (int i = 0; i < 3; i++) off = fmax(off, fmax(fabs(a[i] - low[i]), fabs(b[i] - high[i])));
    return off;
}

static void test_natural_shapes(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    for (int k = 0; k < REFERENCES; k++) {
        const Reference *r = &references[k];
        RodCurve curve;
        double off[4];
        for (int i = 0, n = 50; i < 4; i++, n *= 2) {
            Vec3 *natural = invert(r, n, &curve);
            off[i] = distance(natural[n], r->end);
            if (n == 200)
                assert_true(fabs(curve.length - r->length) < 1e-11 && off[i] < 1e-7 &&
                            distance(natural[n / 2], r->middle) < 1e-7);
            rod_curve_clear(&curve);
            mem_free(natural);
        }
        Vec3 *natural = invert(r, 20000, &curve);
        assert_true(distance(natural[20000], r->end) < 1e-11 + 2e-11 * (r->omega != NULL));
        assert_true(off_the_box(natural, 20001, r->low, r->high) < 1e-7);
        rod_curve_clear(&curve);
        mem_free(natural);
        print_message("%-9s end off by %.1e m at 200 elements; orders %.2f, %.2f\n", r->name, off[2],
                      log2(off[1] / off[2]), log2(off[2] / off[3]));
        assert_true(log2(off[1] / off[2]) > 3.9);
    }
    assert_int_equal(mem_live_count(), blocks);
}

/* The rows of a reference file. */
static int read_rows(const char *name, double (*rows)[13])
{
    char path[512], line[1024];
    snprintf(path, sizeof path, "%s/tests/rod/%s.csv", SOURCE_DIR, name);
    FILE *file = fopen(path, "r");
    int count = 0;
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        char *at = line;
        if (*line == '#' || *line == 's') continue;
        for (int i = 0; i < 13; i++) rows[count][i] = strtod(at, &at), at++;
        count++;
    }
    fclose(file);
    return count;
}

/* Natural strains in the Bishop frame of the references, places and moments, at 31 stations. */
static void test_natural_strains(void **state)
{
    (void)state;
    enum { N = 480 };
    static const Vec3 normals[REFERENCES] = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 1, 0}};
    for (int k = 0; k < REFERENCES; k++) {
        const Reference *r = &references[k];
        double rows[40][13], worst = 0, scale = 0, moment_off = 0;
        RodCurve curve;
        Vec3 *natural = invert(r, N, &curve);
        RodSection section = rod_circle(1.5e-3, r->young, 0.5, 1200);
        static RodFrame frames[2 * N + 1];
        static Vec3 moment[2 * N + 1], strains[2 * N + 1];
        assert_int_equal(read_rows(r->name, rows), 31);
        rod_moments(&curve, weight(section.mass), moment);
        /* The conical one's file starts with the Frenet normal. */
        if (k == 1) rod_frenet(&curve, frames);
        rod_bishop(&curve, k == 1 ? frames[0].n1 : normals[k], frames);
        rod_natural_strains(&curve, rod_alike(&section), moment, frames, strains);
        for (int i = 0; i < 31; i++) {
            int j = i * 2 * N / 30;
            scale = fmax(scale, vec3_length(vec3_load(rows[i] + 7)));
            worst = fmax(worst, distance(strains[j], rows[i] + 7));
            assert_true(distance(curve.x[j], rows[i] + 1) < 1e-10 &&
                        distance(natural[j / 2], rows[i] + 4) < 1e-7);
            moment_off = fmax(moment_off, distance(moment[j], rows[i] + 10));
        }
        print_message("%-9s natural strains off by %.1e of their largest, moments by %.1e N m\n", r->name,
                      worst / scale, moment_off);
        assert_true(worst < 1e-6 * scale && moment_off < 1e-11);
        rod_curve_clear(&curve);
        mem_free(natural);
    }
}

/* Frenet, Bishop, and Frenet turned by a straight and by an exponential angle: kbar of the paper's
 * section 5.2, and the strain route from the free end, seen from the world, is in all of them what the
 * moments say. */
static void test_framings(void **state)
{
    (void)state;
    enum { N = 3000 };
    const Reference *r = &references[0];
    const double start[3][3] = {{13.159058565, -.235912494, 67.570682114},
                                {26.684504266, -.235912494, 67.570682114},
                                {-49.672794507, -.235912494, 67.570682114}};
    RodCurve curve;
    mem_free(invert(r, N, &curve));
    RodSection section = rod_circle(1.5e-3, r->young, 0.5, 1200);
    static RodFrame frames[2 * N + 1];
    static Vec3 moment[2 * N + 1], strains[2 * N + 1], route[2 * N + 1], untwisted[2 * N + 1];
    rod_moments(&curve, weight(section.mass), moment);
    for (int k = 0; k < 4; k++) {
        double worst = 0, largest = 0;
        rod_frenet(&curve, frames);
        if (k == 1) rod_bishop(&curve, frames[0].n1, frames);
        for (int j = 0; k > 1 && j <= 2 * N; j++) {
            double part = j / (2.0 * N);
            frames[j] =
                rod_turned(frames[j], k == 2 ? -6 * M_PI * part : -6 * M_PI * (exp(part) - 1) / (exp(1) - 1));
        }
        rod_natural_strains(&curve, rod_alike(&section), moment, frames, strains);
        rod_strain_route(&curve, rod_alike(&section), weight(section.mass), frames, route);
        for (int j = 0; j <= 2 * N; j++) {
            Vec3 M = rod_to_frame(frames[j], moment[j]);
            Vec3 direct = vec3(-M.x / section.twist, -M.y / section.bend1, -M.z / section.bend2);
            worst = fmax(worst, vec3_length(vec3_sub(route[j], direct)));
            largest = fmax(largest, vec3_length(direct));
        }
        print_message(
            "framing %d: the strain route is off by %.1e of the largest strain; kbar(0) %.6f %.6f %.6f\n", k,
            worst / largest, strains[0].x, strains[0].y, strains[0].z);
        assert_true(worst < 1e-9 * largest);
        if (k < 3) assert_true(distance(strains[0], start[k]) < 1e-6 * 80);
        /* What does not twist in the natural shape is the same for all of them. */
        double apart = 0;
        rod_untwist(&curve, strains);
        for (int j = 0; j <= 2 * N; j++) {
            if (k == 0) untwisted[j] = strains[j];
            apart = fmax(apart, vec3_length(vec3_sub(strains[j], untwisted[j])));
            assert_true(strains[j].x == 0);
        }
        assert_true(apart < 1e-8 * vec3_length(untwisted[0]));
    }
    rod_curve_clear(&curve);
}

static bool straight(void *self, double u, Vec3 *x)
{
    (void)self;
    *x = vec3(0.3 * u, 0, 0);
    return true;
}

static bool inflected(void *self, double u, Vec3 *x)
{
    (void)self;
    *x = vec3(u, u * u * u, 0);
    return true;
}

/* No curvature anywhere, or none in one point: every frame and strain is finite; what lies in a plane with
 * the weight stays there, and has no twist. */
static void test_straight_and_inflected(void **state)
{
    (void)state;
    enum { N = 100 };
    RodCurvePoint *points[] = {straight, inflected};
    for (int k = 0; k < 2; k++) {
        RodCurve curve;
        Error err;
        assert_true(rod_curve_create(points[k], NULL, k ? -1 : 0, 1, N, &curve, &err));
        RodSection section = reference_section(1e7);
        RodLoads loads = {.line = vec3(0, -1e-2, 0)};
        Vec3 moment[2 * N + 1], natural[N + 1], strains[2 * N + 1];
        RodFrame frames[2 * N + 1];
        rod_moments(&curve, loads, moment);
        rod_invert(&curve, rod_alike(&section), moment, NULL, natural);
        for (int f = 0; f < 2; f++) {
            rod_frenet(&curve, frames);
            if (f) rod_bishop(&curve, frames[0].n1, frames);
            rod_natural_strains(&curve, rod_alike(&section), moment, frames, strains);
            for (int j = 0; j <= 2 * N; j++) assert_true(isfinite(vec3_length(strains[j])));
            for (int j = 0; f && j <= 2 * N; j++) assert_true(fabs(strains[j].x) < 1e-12);
        }
        for (int i = 0; i <= N; i++) assert_true(isfinite(natural[i].x) && fabs(natural[i].z) < 1e-15);
        rod_curve_clear(&curve);
    }
}

/* A helix about an axis to which its tangent has the angle 0.7, and turns about it by 0.3 rad per mm. */
static const double helix_angle = 0.7, helix_rate = 300, helix_length = 0.05;

static bool helix(void *self, double s, Vec3 *x)
{
    (void)self;
    double r = sin(helix_angle) / helix_rate, turn = helix_rate * s;
    *x = vec3(r * sin(turn), r * (1 - cos(turn)), cos(helix_angle) * s);
    return true;
}

/* A straight rod with a couple at its end is a helix about the couple, whatever GJ is: its tangent turns about C at the rate
 * C/EI. So what the couple bent into a helix is straight without it, and twisted by nothing. */
static void test_end_couple(void **state)
{
    (void)state;
    enum { N = 400 };
    RodCurve curve;
    Error err;
    assert_true(rod_curve_create(helix, NULL, 0, helix_length, N, &curve, &err));
    static Vec3 moment[2 * N + 1], natural[N + 1], route[2 * N + 1];
    static RodFrame frames[2 * N + 1];
    rod_frenet(&curve, frames);
    for (int k = 0; k < 2; k++) {
        RodSection section = rod_circle(1.5e-3, 1e6, k ? 0.3 : 0, 1200); /* GJ = EI/(1 + nu) */
        double off = 0, routes = 0, C = section.bend1 * helix_rate;
        RodPointLoad point = {.s = curve.length, .couple = {0, 0, C}};
        RodLoads loads = {.points = &point, .point_count = 1};
        rod_moments(&curve, loads, moment);
        rod_invert(&curve, rod_alike(&section), moment, NULL, natural);
        rod_strain_route(&curve, rod_alike(&section), loads, frames, route);
        for (int i = 0; i <= N; i++) {
            Vec3 straight_on = vec3_scale(curve.length * i / N, curve.t[0]);
            off = fmax(off, vec3_length(vec3_sub(vec3_sub(natural[i], natural[0]), straight_on)));
        }
        for (int j = 0; j <= 2 * N; j++) {
            Vec3 m = rod_to_frame(frames[j], moment[j]);
            Vec3 direct = vec3(-m.x / section.twist, -m.y / section.bend1, -m.z / section.bend2);
            routes = fmax(routes, vec3_length(vec3_sub(route[j], direct)));
        }
        print_message("GJ/EI = %.2f: %.1e of the length off a straight rod; strain route %.1e off\n",
                      section.twist / section.bend1, off / curve.length, routes / helix_rate);
        assert_true(off < 1e-8 * curve.length && routes < 1e-9 * helix_rate);
    }
    rod_curve_clear(&curve);
}

/* How far the natural shape of a straight rod with a couple across it at s is off the circle, and the straight line beyond
 * it, of which it consists. */
static double off_the_arc(double s, int elements)
{
    RodCurve curve;
    Error err;
    assert_true(rod_curve_create(straight, NULL, 0, 1, elements, &curve, &err));
    RodSection section = rod_circle(1.5e-3, 1e6, 0.3, 1200);
    double k = 4, off = 0;
    RodPointLoad point = {.s = s, .couple = {0, 0, -k * section.bend1}};
    Vec3 *moment = mem_alloc(3 * (size_t)elements + 2, sizeof *moment), *natural = moment + 2 * elements + 1;
    rod_moments(&curve, (RodLoads){.points = &point, .point_count = 1}, moment);
    rod_invert(&curve, rod_alike(&section), moment, NULL, natural);
    for (int i = 0; i <= elements; i++) {
        double at = curve.length * i / elements, bent = fmin(at, s), on = at - bent;
        Vec3 x = vec3(sin(k * bent) / k + on * cos(k * s), (1 - cos(k * bent)) / k + on * sin(k * s), 0);
        off = fmax(off, vec3_length(vec3_sub(natural[i], x)));
    }
    mem_free(moment);
    rod_curve_clear(&curve);
    return off;
}

/* At a node to rounding but for the quadrature; within an element second order. */
static void test_couple_within(void **state)
{
    (void)state;
    double end = off_the_arc(0.3, 64), within = off_the_arc(0.1234, 64), fine = off_the_arc(0.1234, 640);
    print_message("couple at the end %.1e m off; within an element %.1e m, ten times as many %.1e m\n", end,
                  within, fine);
    assert_true(end < 1e-9 && within < 3e-6 && fine < within / 50);
}

/* A load that varies along the rod: the moment of a cubic one is that of the integral, to rounding; the strain route is of
 * fourth order. */
static void test_load_along(void **state)
{
    (void)state;
    enum { N = 50 };
    RodCurve curve;
    Error err;
    Vec3 moment[2 * N + 1], along[2 * N + 1], pull[3 * N], d[2 * N + 1];
    RodFrame frames[2 * N + 1];
    assert_true(rod_curve_create(straight, NULL, 0, 1, N, &curve, &err));
    RodSection section = rod_circle(1.5e-3, 1e6, 0.3, 1200);
    double L = curve.length, q = 0.4, off = 0, F = 0, routes = 0;
    for (int j = 0; j <= 2 * N; j++) along[j] = vec3(0, 0, -q * (1 - j / (2.0 * N)));
    RodLoads loads = {.along = along};
    rod_moments(&curve, loads, moment);
    rod_pulls(&curve, loads, pull);
    rod_bishop(&curve, vec3(0, 1, 0), frames);
    rod_strain_route(&curve, rod_alike(&section), loads, frames, d);
    for (int j = 0; j <= 2 * N; j++) { /* what is left of the triangle, and its centre */
        double left = L - L * j / (2.0 * N), M = q * left * left * left / (6 * L);
        off = fmax(off, vec3_length(vec3_sub(moment[j], vec3(0, M, 0))));
        Vec3 m = rod_to_frame(frames[j], moment[j]);
        routes = fmax(routes, vec3_length(vec3_add(d[j], vec3_scale(1 / section.bend1, m))));
    }
    for (int i = 0; i < 3 * N; i++) {
        double left = L - L / N * (i / 3 + i % 3 / 2.0);
        F = fmax(F, fabs(pull[i].z + q * left * left / (2 * L)));
    }
    print_message("triangular load: moments %.1e, pulls %.1e of the largest off; strain route %.1e\n",
                  off / (q * L * L / 6), F / (q * L / 2), routes * section.bend1 / (q * L * L / 6));
    assert_true(off < 1e-14 * q * L * L && F < 1e-14 * q * L && routes * section.bend1 < 1e-8 * q * L * L);
    rod_curve_clear(&curve);
}

/* x = (u, u^2, u^3): tau = 3/(1 + 9 u^2 + 9 u^4), against its middle; no torsion where there is no curvature. */
static bool twisted_cubic(void *self, double u, Vec3 *x)
{
    (void)self;
    *x = vec3(u, u * u, u * u * u);
    return true;
}

static void test_torsion(void **state)
{
    (void)state;
    enum { N = 160 };
    double off[2], torsion[2 * N + 1];
    RodCurve curve;
    Error err;
    for (int k = 0; k < 2; k++) {
        int elements = k ? N : N / 2;
        assert_true(rod_curve_create(twisted_cubic, NULL, -1, 1, elements, &curve, &err));
        rod_torsion(&curve, torsion);
        off[k] = 0;
        for (int j = 0; j <= 2 * elements; j++) {
            double u2 = curve.x[j].x * curve.x[j].x;
            off[k] = fmax(off[k], fabs(torsion[j] - 3 / (1 + 9 * u2 + 9 * u2 * u2)));
        }
        rod_curve_clear(&curve);
    }
    print_message("torsion off by %.1e 1/m of 3, with half as many elements by %.1e\n", off[1], off[0]);
    assert_true(off[1] < 2e-5 && off[1] < off[0] / 10);
    assert_true(rod_curve_create(straight, NULL, 0, 1, N, &curve, &err));
    rod_torsion(&curve, torsion);
    for (int j = 0; j <= 2 * N; j++) assert_true(isnan(torsion[j]));
    rod_curve_clear(&curve);
    assert_true(rod_curve_create(inflected, NULL, -1, 1, N, &curve, &err));
    rod_torsion(&curve, torsion);
    for (int j = 0; j <= 2 * N; j++) assert_true(j == N ? isnan(torsion[j]) : fabs(torsion[j]) < 1e-12);
    rod_curve_clear(&curve);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_natural_shapes), cmocka_unit_test(test_natural_strains),
        cmocka_unit_test(test_framings),       cmocka_unit_test(test_straight_and_inflected),
        cmocka_unit_test(test_end_couple),     cmocka_unit_test(test_couple_within),
        cmocka_unit_test(test_load_along),     cmocka_unit_test(test_torsion)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
