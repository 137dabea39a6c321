/* The spline through samples against its definition, and curves in pieces. */
#include "base/memory.h"
#include "base/random.h"
#include "rod/curve.h"
#include "rod/spline.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static const double helix_end = 19.565163762857;

enum { ELEMENTS = 200 };

static bool helix(void *self, double u, Vec3 *x)
{
    (void)self;
    *x = vec3(0.015 * cos(u), 0.015 * sin(u), -0.00318 * u);
    return true;
}

/* The helix in three pieces, the second of which is half as long as the others: the speed jumps. */
static void helix_pieces(void *self, double at, Vec3 jet[3])
{
    (void)self;
    static const double starts[] = {0, 0.4, 0.6, 1};
    int piece = at < 3 ? (int)at : 2;
    double rate = helix_end * (starts[piece + 1] - starts[piece]);
    double u = helix_end * starts[piece] + rate * (at - piece);
    helix(NULL, u, &jet[0]);
    jet[1] = vec3_scale(rate, vec3(-0.015 * sin(u), 0.015 * cos(u), -0.00318));
    jet[2] = vec3_scale(rate * rate, vec3(-0.015 * cos(u), -0.015 * sin(u), 0));
}

static void test_pieces(void **state)
{
    (void)state;
    RodCurve whole, pieces;
    assert_true(rod_curve_create(helix, NULL, 0, helix_end, ELEMENTS, &whole, NULL));
    assert_true(rod_curve_create_pieces(helix_pieces, NULL, 3, ELEMENTS, &pieces, NULL));
    double off = fabs(pieces.length - whole.length), bend = 0;
    for (int j = 0; j <= 2 * ELEMENTS; j++) {
        off = fmax(off, vec3_length(vec3_sub(pieces.x[j], whole.x[j])));
        off = fmax(off, vec3_length(vec3_sub(pieces.t[j], whole.t[j])));
        bend = fmax(bend, vec3_length(vec3_sub(pieces.c[j], whole.c[j])));
    }
    print_message("a curve in pieces: places and tangents off by %.1e, curvatures by %.1e 1/m\n", off, bend);
    assert_true(off < 1e-11 && bend < 1e-7);
    rod_curve_clear(&whole);
    rod_curve_clear(&pieces);
}

/* Turns back on itself near the middle, where Newton's first step is a giant's: refused, and only what lies in the range
 * may be asked for. */
static void cusp(void *self, double at, Vec3 jet[3])
{
    bool *beyond = self;
    double off = at - (1.5 + 1e-13);
    *beyond |= !(at >= 0 && at <= 3);
    jet[0] = vec3(pow(off, 4), 0, 0);
    jet[1] = vec3(4 * pow(off, 3), 0, 0);
    jet[2] = vec3(12 * pow(off, 2), 0, 0);
}

static void test_cusp(void **state)
{
    (void)state;
    bool beyond = false;
    RodCurve curve;
    Error err;
    assert_false(rod_curve_create_pieces(cusp, &beyond, 3, 8, &curve, &err));
    assert_string_equal(err.text, "the curve turns back on itself at (0, 0, 0) m: no rod does");
    assert_false(beyond);
}

/* The parameter that counts knots, at u. */
static double count_knots(const RodSpline *spline, double u)
{
    const double *knot = spline->knots + ROD_SPLINE_ORDER - 1;
    int k = 0;
    while (k + 1 < spline->intervals && knot[k + 1] <= u) k++;
    return k + (u - knot[k]) / (knot[k + 1] - knot[k]);
}

static double squares_of(RodSpline *spline)
{
    double sum = 0;
    Vec3 jet[3];
    for (int i = 0; i < spline->points; i++) {
        rod_spline_jet(spline, count_knots(spline, spline->u[i]), jet);
        Vec3 off = vec3_sub(spline->x[i], jet[0]);
        sum += vec3_dot(off, off);
    }
    return sum;
}

/* sum |x - f|^2 + weight int |f'''|^2, the third derivative by differences. */
static double objective(RodSpline *spline)
{
    enum { PARTS = 40 };
    const double h = 0.1 / PARTS;
    double penalty = 0;
    Vec3 low[3], high[3];
    for (int k = 0; k < spline->intervals * PARTS; k++) {
        const double *knot = spline->knots + k / PARTS + ROD_SPLINE_ORDER - 1;
        double width = knot[1] - knot[0], at = (k + 0.5) / PARTS;
        rod_spline_jet(spline, at - h, low);
        rod_spline_jet(spline, at + h, high);
        Vec3 third = vec3_scale(1 / (2 * h * pow(width, 3)), vec3_sub(high[2], low[2]));
        penalty += vec3_dot(third, third) * width / PARTS;
    }
    return squares_of(spline) + spline->weight * penalty;
}

static void check_derivatives(RodSpline *spline)
{
    const double h = 1e-4;
    Vec3 jet[3], low[3], high[3];
    for (double at = 0.05; at < spline->intervals; at += 0.1) {
        rod_spline_jet(spline, at, jet);
        rod_spline_jet(spline, at - h, low);
        rod_spline_jet(spline, at + h, high);
        for (int k = 0; k < 2; k++) {
            Vec3 slope = vec3_scale(1 / (2 * h), vec3_sub(high[k], low[k]));
            assert_true(vec3_length(vec3_sub(slope, jet[k + 1])) < 1e-5);
        }
    }
}

/* Its objective is the least among its neighbours', its derivatives are its slopes, and the trace is what
 * moving each point gives. */
static void test_spline(void **state)
{
    (void)state;
    enum { POINTS = 24, INTERVALS = 9 };
    const double weight = 0.03, step = 1e-2;
    Random random = random_seed(5);
    Vec3 x[POINTS], low[3], high[3];
    double u[POINTS] = {0}, freedom = 0;
    for (int i = 0; i < POINTS; i++) {
        if (i > 0) u[i] = u[i - 1] + 0.3 + 0.7 * random_uniform(&random);
        x[i] = vec3(random_signed(&random), random_signed(&random), random_signed(&random));
    }
    RodSpline spline = rod_spline_create(u, x, POINTS, INTERVALS);
    rod_spline_fit(&spline, weight);
    double least = objective(&spline);
    assert_true(fabs(spline.squares / squares_of(&spline) - 1) < 1e-12);
    check_derivatives(&spline);
    for (int k = 0; k < 3 * spline.coefficients; k++)
        for (int sign = -1; sign <= 1; sign += 2) {
            double *c = &spline.c[k / 3].x + k % 3, old = *c;
            *c = old + sign * step;
            assert_true(objective(&spline) > least);
            *c = old;
        }
    for (int i = 1; i < POINTS; i++) {
        double at = count_knots(&spline, spline.u[i]);
        rod_spline_jet(&spline, at, low);
        x[i].y += 1;
        RodSpline moved = rod_spline_create(u, x, POINTS, INTERVALS);
        rod_spline_fit(&moved, weight);
        rod_spline_jet(&moved, at, high);
        freedom += high[0].y - low[0].y;
        rod_spline_clear(&moved);
        x[i].y -= 1;
    }
    /* The first point moves the origin: what all points together move less what the others do. */
    rod_spline_jet(&spline, 0, low);
    double others = 0;
    for (int i = 1; i < POINTS; i++) {
        x[i].y += 1;
        RodSpline moved = rod_spline_create(u, x, POINTS, INTERVALS);
        rod_spline_fit(&moved, weight);
        rod_spline_jet(&moved, 0, high);
        others += high[0].y - low[0].y;
        rod_spline_clear(&moved);
        x[i].y -= 1;
    }
    freedom += 1 - others;
    print_message("effective unknowns %.12f, by moving each point %.12f\n", spline.freedom, freedom);
    assert_true(fabs(spline.freedom - freedom) < 1e-10);
    rod_spline_clear(&spline);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_pieces), cmocka_unit_test(test_cusp),
                                       cmocka_unit_test(test_spline)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
