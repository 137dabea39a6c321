/* From pictures to densities: curves, places on the page, inks, layers, crossed sets. */
#include "base/memory.h"
#include "spline/tone_field.h"
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

static double tone_at(const SplineField *tone, const SplinePage *page, double x, double y)
{
    SplineGrid grid = spline_grid(tone);
    double value;
    spline_grid_sample(&grid, page, (Vec2){x * page->width, y * page->height}, &value);
    return value;
}

/* The density of a picture of that one grey. */
static double density_of(const SplineToneDef *def, double grey)
{
    SplinePage page = spline_page(0.2, 0.1, 0.01, 5e-4);
    Image image = {1, 1, &grey};
    SplineField tone = spline_tone(&image, &page, def, 0.02);
    double first = tone.values[0];
    SplineToneDef whole = *def;
    whole.extend = true;
    SplineField filled = spline_tone(&image, &page, &whole, 0.02);
    double value = filled.values[0];
    expect_close(first, 0, 0); /* beside the picture, which is a square in the middle */
    expect_close(tone_at(&tone, &page, 0.5, 0.5), value, 1e-15);
    spline_field_clear(&tone);
    spline_field_clear(&filled);
    return value;
}

static void curves(void **state)
{
    (void)state;
    SplineToneDef def = spline_tone_default();
    expect_close(density_of(&def, 0), 0.85, 1e-15);
    expect_close(density_of(&def, 0.25), 0.85 * 0.75, 1e-15);
    expect_close(density_of(&def, 1), 0, 0);
    def.density = 0.8;
    def.gamma = 2;
    expect_close(density_of(&def, 0.25), 0.8 * 0.5, 1e-15);
    def.invert = true;
    expect_close(density_of(&def, 0.75), 0.8 * 0.5, 1e-15);
    def = (SplineToneDef){.crop = {0, 0, 1, 1}, .black = 0.2, .white = 0.7, .gamma = 1, .density = 1};
    expect_close(density_of(&def, 0.1), 1, 0);
    expect_close(density_of(&def, 0.3), 0.8, 1e-15);
    expect_close(density_of(&def, 0.8), 0, 0);
    const double points[][2] = {{0.1, 0.2}, {0.5, 0.2}, {0.9, 1}};
    def.curve = points;
    def.curve_points = 3;
    expect_close(density_of(&def, 0), 0.8, 1e-15);
    expect_close(density_of(&def, 0.3), 0.8, 1e-15);
    expect_close(density_of(&def, 0.7), 0.4, 1e-15);
    expect_close(density_of(&def, 1), 0, 0);
}

static void expect_refused(const SplineToneDef *def, const char *sentence)
{
    Error err = {""};
    assert_false(spline_tone_check(def, &err));
    assert_string_equal(err.text, sentence);
}

static void refused(void **state)
{
    (void)state;
    SplineToneDef def = spline_tone_default();
    Error err;
    assert_true(spline_tone_check(&def, &err));
    def.crop[2] = 0;
    expect_refused(&def,
                   "the crop 0, 0, 0, 1 must be left, top, right and bottom as fractions of the picture");
    def = spline_tone_default();
    def.black = 1;
    expect_refused(&def, "the black point 1 and the white point 1 must be grey levels 0 to 1 that grow");
    def = spline_tone_default();
    def.gamma = NAN;
    expect_refused(&def, "the gamma is nan; 0.05 to 20 is allowed");
    def = spline_tone_default();
    def.density = 1.5;
    expect_refused(&def, "the density of black is 1.5; it must be above 0 and at most 1");
    def = spline_tone_default();
    const double points[][2] = {{0, 0}, {0.5, 2}}, back[][2] = {{0.5, 0}, {0.5, 1}};
    def.curve_points = 2;
    def.curve = points;
    expect_refused(&def, "point 2 of the tone curve is (0.5, 2); grey levels and brightnesses are 0 to 1");
    def.curve = back;
    expect_refused(&def, "the grey levels of the tone curve must grow; 0.5 follows 0.5");
}

/* A picture of 4 x 2 black and white pixels on a square page: shown whole it fills the middle half of the
 * page's height; covering, the middle half of its width fills the page. */
static void placed(void **state)
{
    (void)state;
    double grey[] = {0, 1, 0, 1, 1, 0, 1, 1};
    Image image = {4, 2, grey};
    SplinePage page = spline_page(0.1, 0.1, 0, 5e-4);
    SplineToneDef def = spline_tone_default();
    def.density = 1;
    SplineField whole = spline_tone(&image, &page, &def, 0.005);
    expect_close(tone_at(&whole, &page, 0.125, 0.375), 1, 0.02);
    expect_close(tone_at(&whole, &page, 0.375, 0.375), 0, 0.02);
    expect_close(tone_at(&whole, &page, 0.375, 0.625), 1, 0.02);
    expect_close(tone_at(&whole, &page, 0.125, 0.2), 0, 0);
    expect_close(tone_at(&whole, &page, 0.375, 0.8), 0, 0);
    def.extend = true;
    SplineField extended = spline_tone(&image, &page, &def, 0.005);
    expect_close(tone_at(&extended, &page, 0.125, 0.1), 1, 0.02);
    expect_close(tone_at(&extended, &page, 0.375, 0.9), 1, 0.02);
    def.extend = false;
    def.cover = true;
    SplineField covering = spline_tone(&image, &page, &def, 0.005);
    expect_close(tone_at(&covering, &page, 0.25, 0.25), 0, 0.02);
    expect_close(tone_at(&covering, &page, 0.75, 0.25), 1, 0.02);
    expect_close(tone_at(&covering, &page, 0.25, 0.75), 1, 0.02);
    expect_close(tone_at(&covering, &page, 0.75, 0.75), 0, 0.02);
    def.crop[2] = def.crop[3] = 0.5; /* the upper left 2 x 1 pixels */
    def.cover = false;
    SplineField cropped = spline_tone(&image, &page, &def, 0.005);
    expect_close(tone_at(&cropped, &page, 0.25, 0.5), 1, 0.02);
    expect_close(tone_at(&cropped, &page, 0.75, 0.5), 0, 0.02);
    expect_close(tone_at(&cropped, &page, 0.25, 0.2), 0, 0);
    spline_field_clear(&whole);
    spline_field_clear(&extended);
    spline_field_clear(&covering);
    spline_field_clear(&cropped);
}

/* A picture finer than the page's pixels keeps its mean. */
static void averaged(void **state)
{
    (void)state;
    enum { SIDE = 240 };
    double *grey = mem_alloc(SIDE * SIDE, sizeof *grey), sum = 0;
    for (int i = 0; i < SIDE * SIDE; i++) sum += grey[i] = (i * 7919 % 1000) / 1000.0;
    Image image = {SIDE, SIDE, grey};
    SplinePage page = spline_page(0.1, 0.1, 0, 5e-4);
    SplineToneDef def = spline_tone_default();
    SplineField tone = spline_tone(&image, &page, &def, 1.0 / 24);
    SplineGrid grid = spline_grid(&tone);
    assert_int_equal(tone.columns, 24);
    expect_close(spline_grid_mean(&grid, 0), 0.85 * (1 - sum / (SIDE * SIDE)), 1e-12);
    spline_field_clear(&tone);
    mem_free(grey);
}

/* What the inks leave of red is (1 - C)(1 - K). */
static void inks(void **state)
{
    (void)state;
    double red[] = {1, 1, 0, 0.2, 0.9}, green[] = {1, 0, 0, 0.5, 0.6}, blue[] = {1, 0, 0, 0.9, 0.3};
    Image rgb[3] = {{5, 1, red}, {5, 1, green}, {5, 1, blue}}, ink[4];
    const double shares[] = {0, 0.6, 1};
    for (int k = 0; k < 3; k++) {
        spline_separate(rgb, shares[k], ink);
        for (int i = 0; i < 5; i++) {
            double common = 1 - fmax(red[i], fmax(green[i], blue[i]));
            expect_close(1 - ink[3].grey[i], shares[k] * common, 1e-15);
            for (int c = 0; c < 3; c++) expect_close(ink[c].grey[i] * ink[3].grey[i], rgb[c].grey[i], 1e-15);
        }
        if (shares[k] == 1) expect_close(ink[0].grey[2], 1, 0); /* black is nothing but black ink */
        expect_close(1 - ink[1].grey[1], 1, 1e-15);             /* red is magenta and yellow      */
        for (int c = 0; c < 4; c++) image_clear(&ink[c]);
    }
}

static SplineField ramp(const SplinePage *page)
{
    SplineField tone = spline_field_create(page, 0.01, 1);
    for (int i = 0; i < tone.rows; i++)
        for (int j = 0; j < tone.columns; j++) *spline_field_pixel(&tone, i, j) = (j + 0.5) / tone.columns;
    return tone;
}

static void layers(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 5e-4);
    SplineField tone = ramp(&page), layer[3];
    spline_tone_layers(&tone, 3, (const double[]){0.3, 0.6}, layer);
    for (int i = 0; i < tone.columns * tone.rows; i++) {
        double d = tone.values[i];
        for (int k = 0; k < 3; k++)
            expect_close(layer[k].values[i],
                         (k == 0   ? d < 0.3
                          : k == 1 ? d >= 0.3 && d < 0.6
                                   : d >= 0.6) *
                             d,
                         0);
    }
    for (int k = 0; k < 3; k++) spline_field_clear(&layer[k]);
    spline_field_clear(&tone);
}

/* The sets together cover what was asked for; each draws more where it is darker, and only from its beginning
 * on; those that begin together draw the same. */
static void crossed(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 5e-4);
    const double from[] = {0, 0.3, 0.3, 0.7};
    SplineField tone = ramp(&page), set[4];
    spline_tone_cross(&tone, 4, from, set);
    for (int j = 0; j < tone.columns; j++) {
        double paper = 1;
        for (int k = 0; k < 4; k++) {
            double d = set[k].values[j];
            paper *= 1 - d;
            assert_true(j == 0 || d >= set[k].values[j - 1]);
            assert_true(tone.values[j] <= from[k] ? d < 1e-15 : d > 0);
        }
        expect_close(1 - paper, tone.values[j], 1e-14);
        expect_close(set[1].values[j], set[2].values[j], 1e-15);
    }
    expect_close(set[0].values[20], tone.values[20], 1e-15);
    for (int k = 0; k < 4; k++) spline_field_clear(&set[k]);
    spline_field_clear(&tone);
}

static void grids(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.2, 0.1, 0, 5e-4);
    SplineField field = spline_field_create(&page, 0.02, 2);
    for (int i = 0; i < field.rows; i++)
        for (int j = 0; j < field.columns; j++) {
            Vec2 at = spline_field_center(&field, &page, i, j);
            double *value = spline_field_pixel(&field, i, j);
            value[0] = 2 * at.x - 3 * at.y;
            value[1] = 7;
        }
    SplineGrid grid = spline_grid(&field);
    double value[2];
    spline_grid_sample(&grid, &page, (Vec2){0.5, 0.4}, value);
    expect_close(value[0], 2 * 0.5 - 3 * 0.4, 1e-14); /* bilinear is exact for what is linear */
    expect_close(value[1], 7, 0);
    SplineField coarse = spline_field_resize(&field, &page, 0.11),
                fine = spline_field_resize(&field, &page, 0.007);
    grid = spline_grid(&fine);
    spline_grid_sample(&grid, &page, (Vec2){0.5, 0.4}, value);
    expect_close(value[0], 2 * 0.5 - 3 * 0.4, 1e-14);
    double mean = spline_grid_mean(&grid, 0);
    grid = spline_grid(&coarse);
    expect_close(spline_grid_mean(&grid, 0), mean, 1e-12);
    spline_field_blur(&field, &page, 0.1);
    grid = spline_grid(&field);
    expect_close(spline_grid_mean(&grid, 0), mean, 1e-12); /* the edges mirror: nothing is lost */
    spline_grid_sample(&grid, &page, (Vec2){page.width / 2, page.height / 2}, value);
    expect_close(value[0], page.width - 1.5 * page.height, 1e-12);
    expect_close(value[1], 7, 1e-14);
    spline_field_clear(&field);
    spline_field_clear(&coarse);
    spline_field_clear(&fine);
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
        cmocka_unit_test_teardown(curves, nothing_leaks),  cmocka_unit_test_teardown(refused, nothing_leaks),
        cmocka_unit_test_teardown(placed, nothing_leaks),  cmocka_unit_test_teardown(averaged, nothing_leaks),
        cmocka_unit_test_teardown(inks, nothing_leaks),    cmocka_unit_test_teardown(layers, nothing_leaks),
        cmocka_unit_test_teardown(crossed, nothing_leaks), cmocka_unit_test_teardown(grids, nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
