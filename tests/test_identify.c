/* Young's modulus and Poisson's ratio from poses: of curves that are exact equilibria of one rod, and of
 * what is left of them after noise. */
#include "base/clock.h"
#include "base/random.h"
#include "rod/samples.h"
#include "tests/pose_fixture.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

enum { DEGREE = 16 };

static RodLoads weight_of(const Rod *rod)
{
    return (RodLoads){.line = vec3_scale(rod->density * M_PI * rod->radius * rod->radius, gravity)};
}

static RodMaterial identify_loaded(const RodPose *poses, int count, RodLoads loads)
{
    RodIdentifyDef def = {
        .poses = poses, .pose_count = count, .radius = 1.3e-3, .poisson = NAN, .loads = loads};
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
            print_message("with a force at the end: E off by %.0e, nu by %.0e\n", found.value / rod.young - 1,
                          found.poisson - rod.poisson);
            assert_true(fabs(found.value / rod.young - 1) < 1e-6 && fabs(found.poisson - rod.poisson) < 1e-6);
        }
        for (int p = 0; p < 2; p++) rod_curve_clear(&curves[p]);
    }
}

/* The rod's radius or its density, Young's modulus being known; with and without a force at the end, in a field, and with
 * Poisson's ratio given. */
static void test_sought(void **state)
{
    (void)state;
    static const char *const names[] = {"E", "radius", "density"};
    for (int loaded = 0; loaded < 2; loaded++) {
        Rod rod = curly_rod;
        RodCurve curves[2];
        RodPose poses[2];
        if (loaded) rod.tip = vec3(2e-3, 1e-3, -6e-3);
        for (int p = 0; p < 2; p++) poses[p] = equilibrium(&rod, clamps[p], &curves[p]);
        const double truth[] = {rod.young, rod.radius, rod.density};
        /* Half of the force is that of a field on the rod, whose magnetisation is so many A/m. */
        double half = loaded ? 0.5 : 0;
        for (int k = 0; k < 6; k++) {
            RodIdentifyDef def = {
                .poses = poses,
                .pose_count = 2,
                .sought = (RodSought)(k % 3),
                .young = rod.young,
                .radius = rod.radius,
                .density = rod.density,
                .poisson = k < 3 ? NAN : rod.poisson,
                .gravity = gravity,
                .loads = {.end = vec3_scale(1 - half, rod.tip)},
                .magnetization = half / (M_PI * rod.radius * rod.radius),
                .flux_density = rod.tip,
            };
            *(k % 3 == 0 ? &def.young : k % 3 == 1 ? &def.radius : &def.density) = NAN; /* is not read */
            RodMaterial found = rod_identify(&def);
            print_message("%s off by %.0e, nu by %.0e; condition %.1f\n", names[k % 3],
                          found.value / truth[k % 3] - 1, found.poisson - rod.poisson, found.condition);
            assert_true(found.converged && found.known && found.poisson_known &&
                        found.error < 1e-5 * found.value);
            assert_true(fabs(found.value / truth[k % 3] - 1) < 1e-6);
            if (k < 3)
                assert_true(fabs(found.poisson - rod.poisson) < 1e-6 && found.condition > 1);
            else
                assert_true(found.poisson == rod.poisson && found.poisson_error == 0 && found.condition == 1);
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
                rod.young, count, found.value / rod.young - 1, found.poisson - rod.poisson, found.distance,
                found.iterations, seconds * 1e3);
            assert_true(fabs(found.value / rod.young - 1) < 1e-6 && fabs(found.poisson - rod.poisson) < 1e-6);
            assert_true(found.known && found.poisson_known && found.converged && found.distance < 1e-8);
            assert_int_equal(found.poisson_at_limit, k == 1);
        }
        if (k == 0) {
            poses[1].clamp = clamps[1];
            RodMaterial found = identify(poses, 2);
            print_message("frame of four digits: E off by %.1e, nu by %.1e\n", found.value / rod.young - 1,
                          found.poisson - rod.poisson);
            assert_true(fabs(found.value / rod.young - 1) < 1e-3 && fabs(found.poisson - rod.poisson) < 1e-3);
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
            assert_true(found.known && found.poisson_known);
            double off = found.value / 6e6 - 1, nu_off = found.poisson - 0.42;
            young += off * off / DRAWS;
            twist += pow((1 + off) * 1.42 / (1 + found.poisson) - 1, 2) / DRAWS;
            young_said += pow(off * 6e6 / found.error, 2) / DRAWS;
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

/* 0.1 mm on 201 samples, as the program takes them: over 20 draws E, radius and nu scatter as the standard errors say. */
static void test_scatter(void **state)
{
    (void)state;
    enum { DRAWS = 20, OTHERS = 12 };
    RodCurve curves[POSES], noisy[POSES];
    RodDraws others[POSES];
    RodPose poses[POSES], measured[POSES];
    Random random = random_seed(11);
    RodSamplesDef samples = rod_samples_default();
    double off[2][3] = {{0}}, said[2][3] = {{0}};
    for (int p = 0; p < POSES; p++) poses[p] = equilibrium(&curly_rod, clamps[p], &curves[p]);
    for (int k = 0; k < DRAWS; k++) {
        for (int p = 0; p < POSES; p++) {
            Vec3 x[N + 1];
            for (int i = 0; i <= N; i++) x[i] = vec3_add(curves[p].x[2 * i], noise(&random, 1e-4));
            assert_true(rod_samples_curve(x, N + 1, &samples, N, &noisy[p], NULL, NULL));
            others[p] = (RodDraws){.wanted = OTHERS, .random = random};
            assert_true(rod_samples_draw(x, N + 1, &samples, N, &others[p], NULL));
            random = others[p].random;
            measured[p] = (RodPose){.curve = &noisy[p], .clamp = poses[p].clamp, .draws = others[p].curves};
        }
        for (int count = 2; count <= POSES; count++)
            for (int sought = 0; sought < 2; sought++) {
                RodIdentifyDef def = {.poses = measured,
                                      .pose_count = count,
                                      .draw_count = OTHERS,
                                      .sought = sought ? ROD_SOUGHT_RADIUS : ROD_SOUGHT_YOUNG,
                                      .young = 6e6,
                                      .radius = 1.3e-3,
                                      .density = 1180,
                                      .poisson = NAN,
                                      .gravity = gravity};
                RodMaterial found = rod_identify(&def);
                double *o = off[count - 2], *e = said[count - 2], truth = sought ? 1.3e-3 : 6e6;
                assert_true(found.known && found.poisson_known);
                o[sought] += pow(found.value / truth - 1, 2) / DRAWS,
                    e[sought] += pow(found.error / truth, 2) / DRAWS;
                if (sought) continue;
                o[2] += pow(found.poisson - 0.42, 2) / DRAWS, e[2] += pow(found.poisson_error, 2) / DRAWS;
            }
        for (int p = 0; p < POSES; p++) {
            rod_curve_clear(&noisy[p]);
            rod_draws_clear(&others[p]);
        }
    }
    for (int count = 2; count <= POSES; count++)
        for (int i = 0; i < 3; i++) {
            static const char *const names[] = {"E", "radius", "nu"};
            double scatter = sqrt(off[count - 2][i]), error = sqrt(said[count - 2][i]);
            print_message("%d poses: %s scatters by %.2g, standard errors say %.2g\n", count, names[i],
                          scatter, error);
            assert_true(scatter < 1.5 * error && error < 1.5 * scatter);
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
    assert_true(found.known && found.converged && fabs(found.value / 6e6 - 1) < 1e-6);
    assert_true(!found.poisson_known && isnan(found.poisson) && isinf(found.poisson_error));
    for (int p = 0; p < 2; p++) noisy[p] = measured(&curves[p], 1e-4, &random), poses[p].curve = &noisy[p];
    found = identify(poses, 2);
    print_message("in a plane, with noise: E off by %+.2f %%, nu %g\n", 100 * (found.value / 6e6 - 1),
                  found.poisson);
    assert_true(found.known && fabs(found.value / 6e6 - 1) < 0.02 && !found.poisson_known);
    for (int p = 0; p < 2; p++) rod_curve_clear(&curves[p]), rod_curve_clear(&noisy[p]);

    poses[0] = equilibrium(&curly_rod, clamps[0], &curves[0]), poses[1] = poses[0];
    found = identify(poses, 2);
    assert_true(!found.known && !found.poisson_known && isnan(found.value));
    poses[1] = equilibrium(&curly_rod, turned, &curves[1]);
    found = identify(poses, 2);
    assert_true(!found.known && !found.poisson_known);
    for (int p = 0; p < 2; p++) noisy[p] = measured(&curves[p], 1e-4, &random), poses[p].curve = &noisy[p];
    found = identify(poses, 2);
    assert_true(!found.known && !found.poisson_known);
    for (int p = 0; p < 2; p++) rod_curve_clear(&curves[p]), rod_curve_clear(&noisy[p]);

    Rod stiff = curly_rod;
    stiff.young = 2e11;
    for (int p = 0; p < 2; p++) {
        poses[p] = equilibrium(&stiff, clamps[p], &curves[p]);
        noisy[p] = measured(&curves[p], 1e-4, &random), poses[p].curve = &noisy[p];
    }
    found = identify(poses, 2);
    assert_true(!found.known && !found.poisson_known);
    for (int p = 0; p < 2; p++) rod_curve_clear(&curves[p]), rod_curve_clear(&noisy[p]);
}

static void test_refusals(void **state)
{
    (void)state;
    RodCurve curves[2];
    RodPose poses[2];
    for (int p = 0; p < 2; p++) poses[p] = equilibrium(&curly_rod, clamps[p], &curves[p]);
    RodIdentifyDef def = {
        .poses = poses, .pose_count = 1, .radius = 1.3e-3, .poisson = NAN, .loads = weight_of(&curly_rod)};
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
    assert_string_equal(err.text, "a material needs a rod that has weight or loads");
    for (int p = 0; p < 2; p++) rod_curve_clear(&curves[p]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact),    cmocka_unit_test(test_loads),
        cmocka_unit_test(test_sought),   cmocka_unit_test(test_noise),
        cmocka_unit_test(test_scatter),  cmocka_unit_test(test_not_identifiable),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
