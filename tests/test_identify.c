/* Young's modulus and Poisson's ratio from poses: of curves that are exact equilibria of one rod, and of
 * what is left of them after noise. */
#include "base/clock.h"
#include "base/memory.h"
#include "base/quat.h"
#include "base/random.h"
#include "rod/identify.h"
#include "rod/section.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

enum { N = 200, STATIONS = 2 * N + 1, POSES = 3, DEGREE = 16 };

/* The rod: made of something like soft rubber, its natural strains a formula. */
typedef struct Rod {
    double radius, density, young, poisson, length;
    Vec3 (*natural)(double s);
    Vec3 tip; /* N, at its end */
} Rod;

static Vec3 curly(double s)
{
    return vec3(8 + 20 * s, 12 * sin(14 * s), 25 - 30 * s);
}

static Vec3 flat(double s)
{
    return vec3(0, 12 * cos(9 * s), 0);
}

static const Rod curly_rod = {1.3e-3, 1180, 6e6, 0.42, 0.2, curly, {0, 0, 0}},
                 flat_rod = {1.3e-3, 1180, 6e6, 0.42, 0.2, flat, {0, 0, 0}};
static const Vec3 gravity = {0, 0, -9.81};

/* As a scene may have them, with four digits; the last one head down. */
static const RodFrame clamps[POSES] = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{0.9397, 0, -0.3420}, {0.3368, -0.1736, 0.9254}, {-0.0594, -0.9848, -0.1632}},
    {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
};

/* A section of the hanging rod: place, frame, moment of what hangs beyond. */
typedef struct Section {
    Vec3 x, M;
    Quat q;
} Section;

static Vec3 strain_at(const Rod *rod, Section at, double s)
{
    RodSection section = rod_circle(rod->radius, rod->young, rod->poisson, rod->density);
    Vec3 m = quat_rotate(quat_conj(at.q), at.M);
    return vec3_add(rod->natural(s), vec3(m.x / section.twist, m.y / section.bend1, m.z / section.bend2));
}

static Section slope_at(const Rod *rod, Section at, double s, Vec3 line)
{
    Vec3 t = quat_rotate(at.q, vec3(1, 0, 0));
    Quat turn = quat_mul(at.q, (Quat){0, vec3_scale(0.5, strain_at(rod, at, s))});
    Vec3 pull = vec3_axpy(rod->length - s, line, rod->tip);
    return (Section){t, vec3_scale(-1, vec3_cross(t, pull)), turn};
}

static Section along(Section a, double h, Section slope)
{
    Quat q = {a.q.w + h * slope.q.w, vec3_axpy(h, slope.q.v, a.q.v)};
    return (Section){vec3_axpy(h, slope.x, a.x), vec3_axpy(h, slope.M, a.M), q};
}

/* From station to station, `parts` Runge-Kutta steps each; curve may be NULL. Returns the moment that is left
 * at the free end. */
static Vec3 hang(const Rod *rod, Section at, Vec3 line, int parts, RodCurve *curve)
{
    double h = rod->length / (2 * N * parts);
    for (int k = 0; k <= 2 * N * parts; k++) {
        double s = k * h;
        if (curve && k % parts == 0) {
            Vec3 strain = strain_at(rod, at, s);
            curve->x[k / parts] = at.x;
            curve->t[k / parts] = quat_rotate(at.q, vec3(1, 0, 0));
            curve->c[k / parts] = quat_rotate(at.q, vec3(0, strain.z, -strain.y));
        }
        if (k == 2 * N * parts) break;
        Section a = slope_at(rod, at, s, line), b = slope_at(rod, along(at, h / 2, a), s + h / 2, line);
        Section c = slope_at(rod, along(at, h / 2, b), s + h / 2, line),
                d = slope_at(rod, along(at, h, c), s + h, line);
        at = along(along(along(along(at, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
        at.q = quat_unit(at.q);
    }
    return at.M;
}

/* Newton on the clamp's moment until none is left at the end. */
static Vec3 clamp_moment(const Rod *rod, Quat clamp, Vec3 line, int parts, Vec3 M)
{
    for (int k = 0; k < 20; k++) {
        Section at = {vec3(0, 0, 0), M, clamp};
        Vec3 left = hang(rod, at, line, parts, NULL), column[3];
        const double step = 1e-8;
        for (int i = 0; i < 3; i++) {
            at.M = vec3_add(M, vec3(i == 0 ? step : 0, i == 1 ? step : 0, i == 2 ? step : 0));
            column[i] = vec3_scale(1 / step, vec3_sub(hang(rod, at, line, parts, NULL), left));
        }
        double volume = vec3_dot(column[0], vec3_cross(column[1], column[2]));
        Vec3 off = vec3(vec3_dot(left, vec3_cross(column[1], column[2])),
                        vec3_dot(left, vec3_cross(column[2], column[0])),
                        vec3_dot(left, vec3_cross(column[0], column[1])));
        M = vec3_axpy(-1 / volume, off, M);
        if (vec3_length(left) < 1e-15) break;
    }
    return M;
}

enum { LOAD_STEPS = 50 };

/* The equilibrium, its weight put on in steps, and the pose it is, held in just that frame. */
static RodPose equilibrium(const Rod *rod, RodFrame clamp, RodCurve *curve)
{
    *curve = (RodCurve){N, rod->length, mem_alloc(STATIONS, sizeof(Vec3)), mem_alloc(STATIONS, sizeof(Vec3)),
                        mem_alloc(STATIONS, sizeof(Vec3))};
    Vec3 weight = vec3_scale(rod->density * M_PI * rod->radius * rod->radius, gravity), M = vec3(0, 0, 0);
    Quat q = quat_from_axes(clamp.n0, clamp.n1, clamp.n2);
    Rod part = *rod;
    for (int k = 1; k <= LOAD_STEPS; k++) {
        part.tip = vec3_scale((double)k / LOAD_STEPS, rod->tip);
        M = clamp_moment(&part, q, vec3_scale((double)k / LOAD_STEPS, weight), 1, M);
    }
    M = clamp_moment(rod, q, weight, 3, M);
    Vec3 left = hang(rod, (Section){vec3(0, 0, 0), M, q}, weight, 3, curve);
    assert_true(vec3_length(left) < 1e-12 * vec3_length(M));
    RodFrame frame = {quat_rotate(q, vec3(1, 0, 0)), quat_rotate(q, vec3(0, 1, 0)),
                      quat_rotate(q, vec3(0, 0, 1))};
    return (RodPose){.curve = curve, .clamp = frame};
}

static RodLoads weight_of(const Rod *rod)
{
    return (RodLoads){.line = vec3_scale(rod->density * M_PI * rod->radius * rod->radius, gravity)};
}

static RodMaterial identify_loaded(const RodPose *poses, int count, RodLoads loads)
{
    RodIdentifyDef def = {poses, count, 1.3e-3, loads};
    Error err;
    assert_true(rod_identify_check(&def, &err));
    return rod_identify(&def);
}

static RodMaterial identify(const RodPose *poses, int count)
{
    return identify_loaded(poses, count, weight_of(&curly_rod));
}

/* A known force at the end, with the rod's weight and by itself, as a point load and as that of a magnetised
 * rod in a field. */
static void test_loads(void **state)
{
    (void)state;
    for (int light = 0; light < 2; light++) {
        Rod rod = curly_rod;
        rod.tip = vec3(2e-3, 1e-3, -6e-3);
        if (light) rod.density = 0;
        RodCurve curves[2];
        RodPose poses[2];
        for (int p = 0; p < 2; p++) poses[p] = equilibrium(&rod, clamps[p], &curves[p]);
        RodPointLoad point = {.s = 1.01 * rod.length, .force = rod.tip};
        for (int magnetic = 0; magnetic < 2; magnetic++) {
            RodLoads loads = weight_of(&rod);
            if (magnetic)
                loads.end = rod.tip;
            else
                loads.point_count = 1, loads.points = &point;
            RodMaterial found = identify_loaded(poses, 2, loads);
            print_message("with a force at the end: E off by %.0e, nu by %.0e\n", found.young / rod.young - 1,
                          found.poisson - rod.poisson);
            assert_true(fabs(found.young / rod.young - 1) < 1e-6 && fabs(found.poisson - rod.poisson) < 1e-6);
        }
        for (int p = 0; p < 2; p++) rod_curve_clear(&curves[p]);
    }
}

/* Equilibria of rods from rubber to steel (whose poses differ by micrometres): both numbers come back, with
 * frames of four digits nearly so. */
static void test_exact(void **state)
{
    (void)state;
    static const double materials[][2] = {{6e6, 0.42}, {1e7, 0.5}, {4e7, 0}, {2e11, -0.3}};
    long blocks = mem_live_count();
    for (size_t k = 0; k < sizeof materials / sizeof *materials; k++) {
        Rod rod = curly_rod;
        rod.young = materials[k][0], rod.poisson = materials[k][1];
        RodCurve curves[POSES];
        RodPose poses[POSES];
        for (int p = 0; p < POSES; p++) poses[p] = equilibrium(&rod, clamps[p], &curves[p]);
        for (int count = 2; count <= POSES; count++) {
            double seconds = clock_thread_seconds();
            RodMaterial found = identify(poses, count);
            seconds = clock_thread_seconds() - seconds;
            print_message(
                "E %.0e, %d poses: E off by %.0e, nu by %.0e; shapes by %.0e m, %d iterations, %.0f ms\n",
                rod.young, count, found.young / rod.young - 1, found.poisson - rod.poisson, found.distance,
                found.iterations, seconds * 1e3);
            assert_true(fabs(found.young / rod.young - 1) < 1e-6 && fabs(found.poisson - rod.poisson) < 1e-6);
            assert_true(found.young_known && found.poisson_known && found.converged && found.distance < 1e-8);
            assert_int_equal(found.poisson_at_limit, k == 1);
        }
        if (k == 0) {
            poses[1].clamp = clamps[1];
            RodMaterial found = identify(poses, 2);
            print_message("frame of four digits: E off by %.1e, nu by %.1e\n", found.young / rod.young - 1,
                          found.poisson - rod.poisson);
            assert_true(fabs(found.young / rod.young - 1) < 1e-3 && fabs(found.poisson - rod.poisson) < 1e-3);
        }
        for (int p = 0; p < POSES; p++) rod_curve_clear(&curves[p]);
    }
    assert_int_equal(mem_live_count(), blocks);
}

/* A polynomial through noisy samples at the nodes, by least squares: x = sum of a_k P_k(2 u/L - 1). */
typedef struct Fit {
    double length;
    Vec3 a[DEGREE + 1];
} Fit;

static void legendre(double z, double *p)
{
    p[0] = 1, p[1] = z;
    for (int k = 1; k < DEGREE; k++) p[k + 1] = ((2 * k + 1) * z * p[k] - k * p[k - 1]) / (k + 1);
}

static bool fit_place(void *self, double u, Vec3 *x)
{
    const Fit *fit = self;
    double p[DEGREE + 1];
    legendre(2 * u / fit->length - 1, p);
    *x = vec3(0, 0, 0);
    for (int k = 0; k <= DEGREE; k++) *x = vec3_axpy(p[k], fit->a[k], *x);
    return true;
}

static Vec3 noise(Random *random, double sigma)
{
    double a = sigma * sqrt(3), x = random_signed(random), y = random_signed(random);
    return vec3(a * x, a * y, a * random_signed(random));
}

/* A x = b for a positive definite A; both are used up. */
static void solve_in_place(double (*A)[DEGREE + 1], Vec3 *b)
{
    for (int i = 0; i <= DEGREE; i++)
        for (int j = i + 1; j <= DEGREE; j++) {
            double f = A[j][i] / A[i][i];
            for (int k = i; k <= DEGREE; k++) A[j][k] -= f * A[i][k];
            b[j] = vec3_axpy(-f, b[i], b[j]);
        }
    for (int i = DEGREE; i >= 0; i--) {
        for (int j = i + 1; j <= DEGREE; j++) b[i] = vec3_axpy(-A[i][j], b[j], b[i]);
        b[i] = vec3_scale(1 / A[i][i], b[i]);
    }
}

/* What is made of noisy samples at the nodes. */
static RodCurve measured(const RodCurve *exact, double sigma, Random *random)
{
    Fit fit = {.length = exact->length};
    double A[DEGREE + 1][DEGREE + 1] = {{0}}, p[DEGREE + 1];
    for (int i = 0; i <= N; i++) {
        legendre(2.0 * i / N - 1, p);
        Vec3 x = vec3_add(exact->x[2 * i], noise(random, sigma));
        for (int j = 0; j <= DEGREE; j++) {
            for (int k = 0; k <= DEGREE; k++) A[j][k] += p[j] * p[k];
            fit.a[j] = vec3_axpy(p[j], x, fit.a[j]);
        }
    }
    solve_in_place(A, fit.a);
    RodCurve curve;
    assert_true(rod_curve_create(fit_place, &fit, 0, fit.length, N, &curve, NULL));
    return curve;
}

/* 0.1 mm on 201 samples: rms over draws of what E and GJ are off by, and of that over the standard errors. */
static void test_noise(void **state)
{
    (void)state;
    enum { DRAWS = 8 };
    RodCurve curves[POSES], noisy[POSES];
    RodPose poses[POSES];
    Random random = random_seed(5);
    for (int p = 0; p < POSES; p++) poses[p] = equilibrium(&curly_rod, clamps[p], &curves[p]);
    for (int count = 2; count <= POSES; count++) {
        double young = 0, twist = 0, young_said = 0, poisson_said = 0;
        for (int k = 0; k < DRAWS; k++) {
            for (int p = 0; p < count; p++) {
                noisy[p] = measured(&curves[p], 1e-4, &random);
                poses[p].curve = &noisy[p];
            }
            RodMaterial found = identify(poses, count);
            assert_true(found.young_known && found.poisson_known);
            double off = found.young / 6e6 - 1, nu_off = found.poisson - 0.42;
            young += off * off / DRAWS;
            twist += pow((1 + off) * 1.42 / (1 + found.poisson) - 1, 2) / DRAWS;
            young_said += pow(off * 6e6 / found.young_error, 2) / DRAWS;
            poisson_said += pow(nu_off / found.poisson_error, 2) / DRAWS;
            for (int p = 0; p < count; p++) rod_curve_clear(&noisy[p]);
        }
        print_message(
            "0.1 mm of noise, %d poses: E off by %.2f %%, GJ by %.2f %% (%.1f standard errors; nu %.1f)\n",
            count, 100 * sqrt(young), 100 * sqrt(twist), sqrt(young_said), sqrt(poisson_said));
        assert_true(sqrt(young) < 0.015 && sqrt(twist) < 0.015);
        assert_true(sqrt(young_said) < 2.5 && sqrt(poisson_said) < 2.5 && sqrt(young_said) > 0.3);
    }
    for (int p = 0; p < POSES; p++) rod_curve_clear(&curves[p]);
}

/* Poses in a plane twist nothing: E alone. The same pose twice, or turned about the vertical, tells nothing,
 * with noise or without; nor does a stiff rod in noise. */
static void test_not_identifiable(void **state)
{
    (void)state;
    RodCurve curves[POSES], noisy[POSES];
    RodPose poses[POSES];
    Random random = random_seed(7);
    static const RodFrame planar[2] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                       {{0.6, 0, 0.8}, {0, 1, 0}, {-0.8, 0, 0.6}}};
    static const RodFrame turned = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
    for (int p = 0; p < 2; p++) poses[p] = equilibrium(&flat_rod, planar[p], &curves[p]);
    RodMaterial found = identify(poses, 2);
    assert_true(found.young_known && found.converged && fabs(found.young / 6e6 - 1) < 1e-6);
    assert_true(!found.poisson_known && isnan(found.poisson) && isinf(found.poisson_error));
    for (int p = 0; p < 2; p++) noisy[p] = measured(&curves[p], 1e-4, &random), poses[p].curve = &noisy[p];
    found = identify(poses, 2);
    print_message("in a plane, with noise: E off by %+.2f %%, nu %g\n", 100 * (found.young / 6e6 - 1),
                  found.poisson);
    assert_true(found.young_known && fabs(found.young / 6e6 - 1) < 0.02 && !found.poisson_known);
    for (int p = 0; p < 2; p++) rod_curve_clear(&curves[p]), rod_curve_clear(&noisy[p]);

    poses[0] = equilibrium(&curly_rod, clamps[0], &curves[0]), poses[1] = poses[0];
    found = identify(poses, 2);
    assert_true(!found.young_known && !found.poisson_known && isnan(found.young));
    poses[1] = equilibrium(&curly_rod, turned, &curves[1]);
    found = identify(poses, 2);
    assert_true(!found.young_known && !found.poisson_known);
    for (int p = 0; p < 2; p++) noisy[p] = measured(&curves[p], 1e-4, &random), poses[p].curve = &noisy[p];
    found = identify(poses, 2);
    assert_true(!found.young_known && !found.poisson_known);
    for (int p = 0; p < 2; p++) rod_curve_clear(&curves[p]), rod_curve_clear(&noisy[p]);

    Rod stiff = curly_rod;
    stiff.young = 2e11;
    for (int p = 0; p < 2; p++) {
        poses[p] = equilibrium(&stiff, clamps[p], &curves[p]);
        noisy[p] = measured(&curves[p], 1e-4, &random), poses[p].curve = &noisy[p];
    }
    found = identify(poses, 2);
    assert_true(!found.young_known && !found.poisson_known);
    for (int p = 0; p < 2; p++) rod_curve_clear(&curves[p]), rod_curve_clear(&noisy[p]);
}

static void test_refusals(void **state)
{
    (void)state;
    RodCurve curves[2];
    RodPose poses[2];
    for (int p = 0; p < 2; p++) poses[p] = equilibrium(&curly_rod, clamps[p], &curves[p]);
    RodIdentifyDef def = {poses, 1, 1.3e-3, weight_of(&curly_rod)};
    Error err;
    assert_false(rod_identify_check(&def, &err));
    assert_string_equal(err.text, "a material needs two poses of the rod or more");
    def.pose_count = 2;
    poses[1].clamp = clamps[0], poses[1].clamp.n2.z = -1;
    assert_false(rod_identify_check(&def, &err));
    assert_string_equal(err.text,
                        "the frame of pose 2 is not three unit vectors at right angles, right-handed");
    poses[1].clamp = clamps[2];
    assert_false(rod_identify_check(&def, &err));
    assert_string_equal(err.text, "the tangent in the frame of pose 2 is 70 degrees off the curve's");
    curves[1].length = 0.21;
    assert_false(rod_identify_check(&def, &err));
    assert_string_equal(err.text, "pose 2 is 0.21 m long and the first one 0.2 m: not the same rod");
    curves[1].elements = 100;
    assert_false(rod_identify_check(&def, &err));
    assert_string_equal(err.text, "pose 2 has 100 elements, the first one 200");
    def.loads.line = vec3(0, 0, 0);
    assert_false(rod_identify_check(&def, &err));
    assert_string_equal(err.text, "a material needs a rod that has weight or loads, and a radius");
    for (int p = 0; p < 2; p++) rod_curve_clear(&curves[p]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact),    cmocka_unit_test(test_loads),
        cmocka_unit_test(test_noise),    cmocka_unit_test(test_not_identifiable),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
