/* Directions: along edges, across flat parts, around corners; and as given by angles, formulas and pictures.
 */
#include "base/memory.h"
#include "spline/direction.h"
#include "spline/formula_field.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>

static void expect_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.17g is not %.17g", value, expected);
}

static SplinePage square(void)
{
    return spline_page(0.1, 0.1, 0, 6e-4);
}

/* The density that a function gives at each pixel. */
static SplineField tone_of(double (*density)(double x, double y), const SplinePage *page)
{
    SplineField tone = spline_field_create(page, 0.003, 1);
    for (int i = 0; i < tone.rows; i++)
        for (int j = 0; j < tone.columns; j++) {
            Vec2 at = spline_field_center(&tone, page, i, j);
            *spline_field_pixel(&tone, i, j) = density(at.x, at.y);
        }
    return tone;
}

static SplineField direction_of(double (*density)(double x, double y), const SplinePage *page, double angle)
{
    SplineField tone = tone_of(density, page);
    SplineDirectionDef def = spline_direction_default(page);
    def.angle = angle;
    SplineField direction = spline_direction_from_tone(&tone, page, &def);
    spline_field_clear(&tone);
    return direction;
}

/* sin of the angle between the direction at a place and a vector. */
static double error_at(const SplineField *direction, const SplinePage *page, Vec2 at, Vec2 expected,
                       double *coherence)
{
    SplineGrid grid = spline_grid(direction);
    Vec2 v = spline_direction_at(&grid, page, at, coherence);
    expect_close(hypot(v.x, v.y), 1, 1e-14);
    return fabs(v.x * expected.y - v.y * expected.x) / hypot(expected.x, expected.y);
}

/* M = c (I - v v^T) at every pixel: symmetric, one eigenvalue 0, the other 0 to 1. */
static void expect_tensors(const SplineField *direction)
{
    for (int i = 0; i < direction->columns * direction->rows; i++) {
        const double *m = direction->values + 3 * i;
        expect_close(m[0] * m[2] - m[1] * m[1], 0, 1e-14);
        assert_true(m[0] >= -1e-15 && m[2] >= -1e-15 && m[0] + m[2] <= 1 + 1e-12);
    }
}

static double disc(double x, double y)
{
    return hypot(x - 0.5, y - 0.5) < 0.3 ? 0.7 : 0.1;
}

/* Around a disc everything runs in circles, to the corners of the page. Inside they do down to the two points
 * that a disc cannot do without. */
static void around_disc(void **state)
{
    (void)state;
    SplinePage page = square();
    SplineField direction = direction_of(disc, &page, 0.3);
    expect_tensors(&direction);
    double worst_edge = 0, worst_far = 0, worst_inside = 0, least = 1, least_edge = 1;
    for (int k = 0; k < 360; k++) {
        double angle = M_PI / 180 * k, x = cos(angle), y = sin(angle), c;
        Vec2 around = {-y, x};
        worst_edge =
            fmax(worst_edge, error_at(&direction, &page, (Vec2){0.5 + 0.3 * x, 0.5 + 0.3 * y}, around, &c));
        least_edge = fmin(least_edge, c);
        worst_far =
            fmax(worst_far, error_at(&direction, &page, (Vec2){0.5 + 0.48 * x, 0.5 + 0.48 * y}, around, &c));
        worst_inside = fmax(worst_inside,
                            error_at(&direction, &page, (Vec2){0.5 + 0.22 * x, 0.5 + 0.22 * y}, around, &c));
    }
    for (int i = 0; i < direction.columns * direction.rows; i++)
        least = fmin(least, direction.values[3 * i] + direction.values[3 * i + 2]);
    print_message("disc: sin of the error at the edge %.4f, outside %.4f, inside %.4f; least c %.3f\n",
                  worst_edge, worst_far, worst_inside, least);
    assert_true(worst_edge < 0.02);
    assert_true(worst_far < 0.1);
    assert_true(worst_inside < 0.3);
    assert_true(least_edge > 0.95);
    assert_true(least < 0.35);
    spline_field_clear(&direction);
}

static double half(double x, double y)
{
    return x * cos(0.5) + y * sin(0.5) > 0.7 ? 0.8 : 0;
}

/* One straight edge: its direction holds everywhere, up to the page's edges. */
static void along_edge(void **state)
{
    (void)state;
    SplinePage page = square();
    SplineField direction = direction_of(half, &page, 0.5);
    double worst = 0, least = 1, c;
    for (int i = 0; i <= 20; i++)
        for (int j = 0; j <= 20; j++) {
            worst = fmax(worst, error_at(&direction, &page, (Vec2){j / 20.0, i / 20.0},
                                         (Vec2){-sin(0.5), cos(0.5)}, &c));
            least = fmin(least, c);
        }
    print_message("straight edge: sin of the error %.2g, least c %.4f\n", worst, least);
    assert_true(worst < 0.02);
    assert_true(least > 0.99);
    spline_field_clear(&direction);
}

static double quarter(double x, double y)
{
    return x > 0.4 && y > 0.4 ? 0.8 : 0;
}

/* A dark corner: its strokes turn on the diagonal in a bend, without a seam where no direction is sure. */
static void around_corner(void **state)
{
    (void)state;
    SplinePage page = square();
    SplineField direction = direction_of(quarter, &page, 0);
    SplineGrid grid = spline_grid(&direction);
    double least = 1, sharpest = 0;
    Vec2 before = {0};
    for (int k = 0; k <= 200; k++) { /* across the diagonal */
        double s = 0.001 * (k - 100), c;
        Vec2 v = spline_direction_at(&grid, &page, (Vec2){0.6 + s, 0.6 - s}, &c);
        least = fmin(least, c);
        if (k > 0) sharpest = fmax(sharpest, fabs(v.x * before.y - v.y * before.x) / 0.001 / M_SQRT2);
        before = v;
    }
    print_message("corner: least c across the diagonal %.3f, sharpest turn %.1f rad per unit\n", least,
                  sharpest);
    assert_true(least > 0.8);
    assert_true(sharpest < 30);
    double c;
    assert_true(error_at(&direction, &page, (Vec2){0.4, 0.8}, (Vec2){0, 1}, &c) < 0.05);
    assert_true(error_at(&direction, &page, (Vec2){0.8, 0.4}, (Vec2){1, 0}, &c) < 0.05);
    spline_field_clear(&direction);
}

static double white(double x, double y)
{
    (void)x, (void)y;
    return 0;
}

static void blank_page(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.297, 0.21, 0.01, 3e-4);
    SplineField direction = direction_of(white, &page, 1.1);
    double c;
    expect_close(error_at(&direction, &page, (Vec2){0.4, 0.7}, (Vec2){cos(1.1), sin(1.1)}, &c), 0, 1e-9);
    expect_close(c, 1, 1e-9);
    spline_field_clear(&direction);
}

static void angles(void **state)
{
    (void)state;
    SplinePage page = square();
    for (int k = -7; k <= 7; k++) {
        double angle = 0.45 * k, c;
        SplineField direction = spline_direction_constant(&page, angle);
        expect_tensors(&direction);
        expect_close(error_at(&direction, &page, (Vec2){0.3, 0.8}, (Vec2){cos(angle), sin(angle)}, &c), 0,
                     1e-14);
        expect_close(c, 1, 1e-14);
        spline_direction_turn(&direction, 0.7);
        expect_close(
            error_at(&direction, &page, (Vec2){0.3, 0.8}, (Vec2){cos(angle + 0.7), sin(angle + 0.7)}, &c), 0,
            1e-14);
        expect_close(c, 1, 1e-14);
        spline_field_clear(&direction);
    }
}

static Formula *formula_of(const char *x, const char *y)
{
    Error err = {""};
    Formula *formula = formula_create((const char *[]){x, y}, 2, NULL, 0, spline_formula_variables, &err);
    if (!formula) fail_msg("%s", err.text);
    return formula;
}

static void formulas(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.2, 0.1, 0, 5e-4);
    Error err = {""};
    SplineField direction;
    Formula *formula =
        formula_of("-(v/sqrt(2) - 0.3)*5", "(x/sqrt(0.02) - 0.3)*5"); /* in units of the page */
    assert_true(spline_direction_from_formula(formula, &page, &direction, &err));
    expect_tensors(&direction);
    for (int i = 0; i < direction.rows; i += 7)
        for (int j = 0; j < direction.columns; j += 7) {
            Vec2 at = spline_field_center(&direction, &page, i, j), around = {-(at.y - 0.3), at.x - 0.3};
            double c;
            expect_close(error_at(&direction, &page, at, around, &c), 0, 1e-12);
            expect_close(c, fmin(1, 5 * hypot(around.x, around.y)), 1e-12);
        }
    spline_field_clear(&direction);
    formula_destroy(formula);
    formula = formula_of("sqrt(x - 1)", "u");
    assert_false(spline_direction_from_formula(formula, &page, &direction, &err));
    assert_non_null(strstr(err.text, "sqrt(x - 1)"));
    formula_destroy(formula);
}

/* Grey levels 1/4 and 3/4 are 45 and 135 degrees; 0 and 1 are the same line. */
static void pictures(void **state)
{
    (void)state;
    SplinePage page = square();
    double grey[] = {0.25, 0.75, 0, 1}, red[] = {1, 0.5, 0.5, 0}, green[] = {0.5, 0, 0.5, 1}, c;
    Image image = {2, 2, grey}, rgb[3] = {{2, 2, red}, {2, 2, green}, {2, 2, red}};
    SplineField direction = spline_direction_from_grey(&image, &page);
    expect_tensors(&direction);
    expect_close(error_at(&direction, &page, (Vec2){0.1, 0.1}, (Vec2){1, 1}, &c), 0, 1e-9);
    expect_close(error_at(&direction, &page, (Vec2){0.9, 0.1}, (Vec2){-1, 1}, &c), 0, 1e-9);
    expect_close(error_at(&direction, &page, (Vec2){0.5, 0.9}, (Vec2){1, 0}, &c), 0, 1e-9);
    expect_close(c, 1, 1e-12);
    spline_field_clear(&direction);
    direction = spline_direction_from_rgb(rgb, &page);
    expect_tensors(&direction);
    expect_close(error_at(&direction, &page, (Vec2){0.1, 0.1}, (Vec2){1, 0}, &c), 0, 1e-9);
    expect_close(error_at(&direction, &page, (Vec2){0.9, 0.1}, (Vec2){0, 1}, &c), 0, 1e-9);
    expect_close(error_at(&direction, &page, (Vec2){0.9, 0.9}, (Vec2){-1, 1}, &c), 0, 1e-9);
    expect_close(c, 1, 1e-12);
    error_at(&direction, &page, (Vec2){0.1, 0.9}, (Vec2){1, 0}, &c);
    expect_close(c, 0, 1e-12); /* no vector */
    spline_field_clear(&direction);
}

static int nothing_leaks(void **state)
{
    (void)state;
    assert_int_equal(mem_live_count(), 0);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(around_disc, nothing_leaks),
        cmocka_unit_test_teardown(along_edge, nothing_leaks),
        cmocka_unit_test_teardown(around_corner, nothing_leaks),
        cmocka_unit_test_teardown(blank_page, nothing_leaks),
        cmocka_unit_test_teardown(angles, nothing_leaks),
        cmocka_unit_test_teardown(formulas, nothing_leaks),
        cmocka_unit_test_teardown(pictures, nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
