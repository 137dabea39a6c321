/* Curves by their arclength: fine ones, and ones far away. */
#include "rod/curve.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static bool coil(void *self, double u, Vec3 *x)
{
    (void)self;
    *x = vec3(0.005 * cos(u), 0.005 * sin(u), -0.002 * u / (2 * M_PI));
    return true;
}

/* A wave of 1024 and 3072 periods: of equal places on any grid of 1024 or 2048 steps. */
static bool hidden_wave(void *self, double u, Vec3 *x)
{
    *x = vec3(u, 1e-4 * sin(2 * M_PI * *(const double *)self * u), 0);
    return true;
}

static bool corner(void *self, double u, Vec3 *x)
{
    *x = vec3(u, *(const double *)self * fabs(u - 0.3), 0);
    return true;
}

/* However many waves there are: followed, or refused. */
static void test_fine_curves(void **state)
{
    (void)state;
    RodCurve curve;
    Error err;
    for (int turns = 10; turns <= 1000; turns *= 10) {
        const int elements = 20 * turns;
        assert_true(rod_curve_create(coil, NULL, 0, 2 * M_PI * turns, elements, &curve, &err));
        double c = 0.002 / (2 * M_PI), bend = 0.005 / (0.005 * 0.005 + c * c), worst = 0;
        for (int j = 0; j <= 2 * elements; j++) worst = fmax(worst, fabs(vec3_length(curve.c[j]) / bend - 1));
        double off = curve.length / (turns * 2 * M_PI * hypot(0.005, c)) - 1;
        print_message("a coil of %d turns: length off by %.1e, curvature by %.1e\n", turns, off, worst);
        assert_true(fabs(off) < 1e-9 && worst < 2e-6);
        rod_curve_clear(&curve);
    }
    for (double periods = 1024; periods <= 3072; periods += 2048) {
        assert_true(rod_curve_create(hidden_wave, &periods, 0, 1, 200, &curve, &err));
        double rise = 2 * M_PI * periods * 1e-4, sum = 0; /* the mean of hypot(1, rise cos) over a period */
        for (int k = 0; k < 1000; k++) sum += hypot(1, rise * cos(2 * M_PI * (k + 0.5) / 1000)) / 1000;
        print_message("%.0f waves: length off by %.1e\n", periods, curve.length / sum - 1);
        assert_true(fabs(curve.length / sum - 1) < 1e-5);
        rod_curve_clear(&curve);
    }
    double kink = 0.1, many = 1e5;
    assert_false(rod_curve_create(corner, &kink, 0, 1, 200, &curve, &err));
    assert_non_null(strstr(err.text, "the curve has a kink near 0."));
    assert_false(rod_curve_create(hidden_wave, &many, 0, 1, 200, &curve, &err));
    assert_null(curve.x);
}

/* A coil ten thousand times its size away, and how often it is asked for a place. */
typedef struct FarCoil {
    double far;
    int asked;
} FarCoil;

static bool far_coil(void *self, double u, Vec3 *x)
{
    FarCoil *coil = self;
    coil->asked++;
    *x = vec3(coil->far + cos(6 * u), coil->far + sin(6 * u), coil->far + 2 * u);
    return true;
}

/* The rounding of places is no wave: it makes no finer grid, on which its differences would be curvature. */
static void test_far_curves(void **state)
{
    (void)state;
    double curvature = 36.0 / 40; /* radius 1, rise 1/3 for each radian */
    for (double far = 0; far <= 1e6; far = far ? 1e2 * far : 1e2) {
        FarCoil coil = {.far = far};
        RodCurve curve;
        Error err;
        double off = 0;
        assert_true(rod_curve_create(far_coil, &coil, 0, 1, 60, &curve, &err));
        for (int j = 0; j <= 120; j++) off = fmax(off, fabs(vec3_length(curve.c[j]) / curvature - 1));
        print_message("%g away: asked %d times, curvature off by %.1e\n", far, coil.asked, off);
        assert_true(coil.asked < 3000 && off < 1e-8 + 1e-8 * far);
        rod_curve_clear(&curve);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_fine_curves), cmocka_unit_test(test_far_curves)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
