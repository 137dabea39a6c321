/* Densities and directions of pictures, and the strokes that follow them. */
#include "base/memory.h"
#include "spline/direction.h"
#include "spline/streamlines.h"
#include "spline/tone_field.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static const double pen = 0.006; /* of the page */

static SplinePage square_page(void)
{
    return spline_page(0.1, 0.1, 0, pen * 0.1);
}

/* D = density in a disc that fades towards its rim, 0 outside. */
static SplineField disc_tone(const SplinePage *page, double density)
{
    SplineField tone = spline_field_create(page, 0.004, 1);
    for (int j = 0; j < tone.rows; j++)
        for (int i = 0; i < tone.columns; i++) {
            double x = (i + 0.5) / tone.columns - 0.5, y = (j + 0.5) / tone.rows - 0.5, r = hypot(x, y);
            tone.values[j * tone.columns + i] = density * fmax(0, 1 - r / 0.45);
        }
    return tone;
}

static void expect_on_page(const Strokes *strokes, const SplinePage *page)
{
    for (int k = 0; k < strokes_node_count(strokes); k++) {
        const double *q = strokes->q + 4 * k;
        assert_true(q[0] >= 0 && q[0] <= page->width && q[1] >= 0 && q[1] <= page->height);
        assert_true(isfinite(q[2]) && isfinite(q[3]));
    }
}

/* Around the disc's middle strokes run in circles. */
static void test_circles(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    SplinePage page = square_page();
    SplineField tone = disc_tone(&page, 0.6);
    SplineDirectionDef def = spline_direction_default();
    SplineField direction = spline_direction_from_tone(&tone, &page, &def);
    SplineGrid grid = spline_grid(&direction);
    double worst = 0;
    for (int k = 0; k < 12; k++) {
        double angle = 2 * M_PI * k / 12, c = cos(angle), s = sin(angle), coherence;
        Vec2 v = spline_direction_at(&grid, &page, (Vec2){0.5 + 0.25 * c, 0.5 + 0.25 * s}, &coherence);
        worst = fmax(worst, fabs(v.x * c + v.y * s));
        assert_true(coherence > 0.5);
    }
    print_message("directions off the circles by %.3f at most\n", worst);
    assert_true(worst < 0.05);
    spline_field_clear(&direction);
    spline_field_clear(&tone);
    assert_int_equal(mem_live_count(), blocks);
}

/* An even tone and one angle: evenly spaced parallel strokes with the ink that is asked for. */
static void test_even_tone(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    SplinePage page = square_page();
    SplineField tone = spline_field_create(&page, 0.01, 1), direction = spline_direction_constant(&page, 0.4);
    for (int i = 0; i < tone.rows * tone.columns; i++) tone.values[i] = 0.3;
    SplineGrid grid = spline_grid(&tone), along = spline_grid(&direction);
    SplineStartDef def = spline_start_default();
    for (int kind = 0; kind < 2; kind++) {
        Strokes strokes = {0}, again = {0};
        for (int k = 0; k < 2; k++)
            (kind ? spline_random_strokes : spline_streamlines)(&grid, &along, &page, &def, 0,
                                                                k ? &again : &strokes);
        double ink = strokes_length(&strokes) * pen / 0.3;
        print_message("%s: %d strokes, ink %.3f of the budget\n", kind ? "random" : "streamlines",
                      strokes.count, ink);
        assert_true(fabs(ink - 1) < 0.2);
        expect_on_page(&strokes, &page);
        assert_int_equal(strokes_node_count(&strokes), strokes_node_count(&again));
        assert_memory_equal(strokes.q, again.q, 4 * (size_t)strokes_node_count(&strokes) * sizeof(double));
        for (int k = 0; kind == 0 && k < strokes_node_count(&strokes); k++)
            assert_true(fabs(strokes.q[4 * k + 2] * sin(0.4) - strokes.q[4 * k + 3] * cos(0.4)) < 1e-3);
        strokes_clear(&strokes);
        strokes_clear(&again);
    }
    spline_field_clear(&direction);
    spline_field_clear(&tone);
    assert_int_equal(mem_live_count(), blocks);
}

/* White paper stays white. */
static void test_white(void **state)
{
    (void)state;
    SplinePage page = square_page();
    SplineField tone = spline_field_create(&page, 0.01, 1), direction = spline_direction_constant(&page, 0);
    SplineGrid grid = spline_grid(&tone), along = spline_grid(&direction);
    SplineStartDef def = spline_start_default();
    Strokes strokes = {0};
    spline_streamlines(&grid, &along, &page, &def, 0, &strokes);
    spline_random_strokes(&grid, &along, &page, &def, 0, &strokes);
    assert_int_equal(strokes.count, 0);
    strokes_clear(&strokes);
    spline_field_clear(&direction);
    spline_field_clear(&tone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_circles), cmocka_unit_test(test_even_tone),
                                       cmocka_unit_test(test_white)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
