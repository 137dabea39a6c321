/* From pictures to densities: placement, tone curves, inks, layers and crossing sets, all exact. */
#include "base/memory.h"
#include "spline/tone_field.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* Twice as wide as high: the left half has grey level 0.2, the right half 0.6. */
static double two_greys[2 * 4] = {0.2, 0.2, 0.6, 0.6, 0.2, 0.2, 0.6, 0.6};
static const Image picture = {.width = 4, .height = 2, .grey = two_greys};

static double density_at(const SplineToneDef *def, double x, double y)
{
    SplinePage page = spline_page(0.1, 0.1, 0, 0.001);
    SplineField tone = spline_tone(&picture, &page, def, 1.0 / 8);
    SplineGrid grid = spline_grid(&tone);
    double density;
    spline_grid_sample(&grid, &page, (Vec2){x * page.width, y * page.height}, &density);
    spline_field_clear(&tone);
    return density;
}

/* On a square page the picture fills the middle half of the height; `cover` and `extend` fill the rest. The
 * places asked are centres of pixels of the field. */
static void test_placement(void **state)
{
    (void)state;
    SplineToneDef def = spline_tone_default();
    assert_float_equal(density_at(&def, 1.0 / 16, 7.0 / 16), 0.85 * 0.8, 1e-14);
    assert_float_equal(density_at(&def, 15.0 / 16, 9.0 / 16), 0.85 * 0.4, 1e-14);
    assert_float_equal(density_at(&def, 1.0 / 16, 1.0 / 16), 0, 1e-14);
    def.extend = true;
    assert_float_equal(density_at(&def, 1.0 / 16, 1.0 / 16), 0.85 * 0.8, 1e-14);
    def.extend = false;
    def.cover = true;
    assert_float_equal(density_at(&def, 1.0 / 16, 1.0 / 16), 0.85 * 0.8, 1e-14);
    assert_float_equal(density_at(&def, 15.0 / 16, 15.0 / 16), 0.85 * 0.4, 1e-14);
    def.crop[2] = 0.5; /* the left half is square; its last half pixel blends into the right one */
    assert_float_equal(density_at(&def, 9.0 / 16, 15.0 / 16), 0.85 * 0.8, 1e-14);
}

static void test_tones(void **state)
{
    (void)state;
    SplineToneDef def = spline_tone_default();
    def.cover = true;
    def.density = 1;
    def.invert = true;
    assert_float_equal(density_at(&def, 1.0 / 16, 0.4375), 0.2, 1e-14);
    def.invert = false;
    def.black = 0.1;
    def.white = 0.5;
    def.gamma = 2;
    assert_float_equal(density_at(&def, 1.0 / 16, 0.4375), 1 - sqrt(0.1 / 0.4), 1e-14);
    assert_float_equal(density_at(&def, 15.0 / 16, 0.4375), 0, 1e-14);
    const double curve[3][2] = {{0.1, 0}, {0.5, 0.4}, {0.7, 1}};
    def.curve = curve;
    def.curve_points = 3;
    assert_float_equal(density_at(&def, 1.0 / 16, 0.4375), 0.9, 1e-14);
    assert_float_equal(density_at(&def, 15.0 / 16, 0.4375), 0.3, 1e-14);
}

static void test_refused(void **state)
{
    (void)state;
    Error err = {0};
    SplineToneDef def = spline_tone_default();
    assert_true(spline_tone_check(&def, &err));
    def.white = 0;
    assert_false(spline_tone_check(&def, &err));
    def = spline_tone_default();
    def.crop[0] = 1;
    assert_false(spline_tone_check(&def, &err));
    def = spline_tone_default();
    def.gamma = (double)NAN;
    assert_false(spline_tone_check(&def, &err));
    def = spline_tone_default();
    const double curve[2][2] = {{0.5, 0}, {0.5, 1}};
    def.curve = curve;
    def.curve_points = 2;
    assert_false(spline_tone_check(&def, &err));
}

/* Inks on each other give the colour back: R = (1 - C)(1 - K); an ink's picture is 1 - ink. */
static void test_separate(void **state)
{
    (void)state;
    double red[3] = {0.9, 0, 1}, green[3] = {0.3, 0, 1}, blue[3] = {0.5, 0, 1};
    const double *levels[3] = {red, green, blue};
    const Image rgb[3] = {{3, 1, red}, {3, 1, green}, {3, 1, blue}};
    const double blacks[3] = {0, 0.5, 1};
    for (int b = 0; b < 3; b++) {
        Image ink[4];
        spline_separate(rgb, blacks[b], ink);
        for (int i = 0; i < 3; i++)
            for (int c = 0; c < 3; c++)
                assert_float_equal(ink[c].grey[i] * ink[3].grey[i], levels[c][i], 1e-14);
        assert_float_equal(ink[3].grey[0], 1 - blacks[b] * 0.1, 1e-14);
        for (int c = 0; c < 4; c++) image_clear(&ink[c]);
    }
}

/* Layers add up to the density; crossing sets cover 1 - prod(1 - D_k) of the paper, alike where all draw. */
static void test_shares(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    SplinePage page = spline_page(0.1, 0.1, 0, 0.001);
    SplineField tone = spline_field_create(&page, 0.1, 1), part[3];
    int count = tone.columns * tone.rows;
    for (int i = 0; i < count; i++) tone.values[i] = 0.95 * i / count;
    const double limits[2] = {0.3, 0.6}, from[3] = {0, 0.3, 0.6};
    spline_tone_layers(&tone, 3, limits, part);
    for (int i = 0; i < count; i++) {
        int k = tone.values[i] < 0.3 ? 0 : tone.values[i] < 0.6 ? 1 : 2;
        for (int l = 0; l < 3; l++) assert_true(part[l].values[i] == (l == k ? tone.values[i] : 0));
    }
    for (int k = 0; k < 3; k++) spline_field_clear(&part[k]);
    spline_tone_cross(&tone, 3, from, part);
    for (int i = 0; i < count; i++) {
        double bare = 1;
        for (int k = 0; k < 3; k++) {
            bare *= 1 - part[k].values[i];
            assert_true(k == 0 || part[k].values[i] <= part[k - 1].values[i]);
            assert_true((part[k].values[i] > 0) == (tone.values[i] > from[k]));
        }
        assert_float_equal(1 - bare, tone.values[i], 1e-14);
    }
    for (int k = 0; k < 3; k++) spline_field_clear(&part[k]);
    spline_field_clear(&tone);
    assert_int_equal(mem_live_count(), blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_placement), cmocka_unit_test(test_tones),
                                       cmocka_unit_test(test_refused), cmocka_unit_test(test_separate),
                                       cmocka_unit_test(test_shares)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
