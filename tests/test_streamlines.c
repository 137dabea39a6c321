/* Strokes to start from: their spacing, ink, nodes and places on fields whose right answer is known. */
#include "base/clock.h"
#include "base/memory.h"
#include "spline/direction.h"
#include "spline/formula_field.h"
#include "spline/streamlines.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

enum { SAMPLES = 8 }; /* of a segment */

typedef void Start(const SplineGrid *tone, const SplineGrid *direction, const SplinePage *page,
                   const SplineStartDef *def, int layer, Strokes *strokes);

static void expect_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.17g is not %.17g", value, expected);
}

static double even(double x, double y)
{
    (void)x, (void)y;
    return 0.4;
}

static double ramp(double x, double y)
{
    (void)y;
    return 0.05 + 0.75 * x;
}

/* A lit ball before a light ground. */
static double ball(double x, double y)
{
    double r = hypot(x - 0.5, y - 0.5) / 0.34;
    return r < 1 ? 0.15 + 0.6 * (x + y - 0.5) * sqrt(1 - 0.8 * r * r) : 0.05 + 0.08 * y;
}

static double spot(double x, double y)
{
    return hypot(x - 0.3, y - 0.6) < 0.1 ? 0.7 : 0;
}

static double tiles(double x, double y)
{
    double u = 4 * x - floor(4 * x) - 0.5, v = 4 * y - floor(4 * y) - 0.5;
    return fmax(fabs(u), fabs(v)) < 0.3 ? 0.6 - 0.4 * v : 0;
}

static SplineField tone_of(double (*density)(double x, double y), const SplinePage *page, double pixel)
{
    SplineField tone = spline_field_create(page, pixel, 1);
    for (int i = 0; i < tone.rows; i++)
        for (int j = 0; j < tone.columns; j++) {
            Vec2 at = spline_field_center(&tone, page, i, j);
            *spline_field_pixel(&tone, i, j) = density(at.x, at.y);
        }
    return tone;
}

/* Strokes of a tone along a direction; NULL: along its edges. */
static Strokes start(Start *from, double (*density)(double x, double y), const SplineField *direction,
                     const SplinePage *page, const SplineStartDef *def)
{
    SplineField tone = tone_of(density, page, 0.003), own = {0};
    if (!direction) {
        SplineDirectionDef edges = spline_direction_default(page);
        own = spline_direction_from_tone(&tone, page, &edges);
        direction = &own;
    }
    SplineGrid tones = spline_grid(&tone), directions = spline_grid(direction);
    Strokes strokes = {0};
    from(&tones, &directions, page, def, 3, &strokes);
    spline_field_clear(&tone);
    spline_field_clear(&own);
    return strokes;
}

static Vec2 stroke_point(const Strokes *strokes, int node, double s)
{
    Vec2 c[4];
    strokes_bezier(strokes, node, c);
    double u = 1 - s, a = u * u * u, b = 3 * u * u * s, d = 3 * u * s * s, e = s * s * s;
    return (Vec2){a * c[0].x + b * c[1].x + d * c[2].x + e * c[3].x,
                  a * c[0].y + b * c[1].y + d * c[2].y + e * c[3].y};
}

/* What must hold of any start: all on the page, nodes equally far apart, v a third of that, nothing too long.
 */
static void expect_sound(const Strokes *strokes, const SplinePage *page, double longest)
{
    assert_true(strokes->count > 0);
    assert_int_equal(strokes->start[0], 0);
    for (int k = 0; k < strokes->count; k++) {
        int first = strokes->start[k], last = strokes->start[k + 1] - 1;
        assert_true(last > first);
        assert_int_equal(strokes->layer[k], 3);
        assert_true(strokes_stroke_length(strokes, k) <= longest);
        for (int n = first; n < last; n++) {
            const double *q = strokes->q + 4 * n;
            expect_close(strokes_segment_length(strokes, n) / (3 * hypot(q[2], q[3])), 1, 0.12);
            expect_close(hypot(q[6], q[7]), hypot(q[2], q[3]), 1e-12);
            for (int s = 0; s <= SAMPLES; s++) {
                Vec2 p = stroke_point(strokes, n, s / (double)SAMPLES);
                assert_true(p.x >= page->pen / 2 && p.x <= page->width - page->pen / 2);
                assert_true(p.y >= page->pen / 2 && p.y <= page->height - page->pen / 2);
            }
        }
    }
}

/* Of the distances to the nearest other stroke, away from the page's edges: their mean and deviation/mean. */
static void spacing_of(const Strokes *strokes, const SplinePage *page, double *mean, double *variation)
{
    int count = SAMPLES * strokes_segment_count(strokes), taken = 0, next = 0;
    Vec2 *at = mem_alloc((size_t)count, sizeof *at);
    int *owner = mem_alloc((size_t)count, sizeof *owner);
    double sum = 0, squares = 0;
    for (int k = 0; k < strokes->count; k++)
        for (int n = strokes->start[k]; n < strokes->start[k + 1] - 1; n++)
            for (int s = 0; s < SAMPLES; s++, next++) {
                at[next] = stroke_point(strokes, n, (s + 0.5) / SAMPLES);
                owner[next] = k;
            }
    for (int i = 0; i < count; i += 11) {
        if (fmin(fmin(at[i].x, page->width - at[i].x), fmin(at[i].y, page->height - at[i].y)) < 0.05)
            continue;
        double nearest = 1;
        for (int j = 0; j < count; j++)
            if (owner[j] != owner[i]) nearest = fmin(nearest, hypot(at[j].x - at[i].x, at[j].y - at[i].y));
        sum += nearest;
        squares += nearest * nearest;
        taken++;
    }
    *mean = sum / taken;
    *variation = sqrt(fmax(squares / taken - *mean * *mean, 0)) / *mean;
    mem_free(at);
    mem_free(owner);
}

static double ink_of(const Strokes *strokes, double (*density)(double x, double y), const SplinePage *page)
{
    SplineField tone = tone_of(density, page, 0.003);
    SplineGrid grid = spline_grid(&tone);
    double budget = spline_grid_mean(&grid, 0) / page->pen;
    spline_field_clear(&tone);
    return (strokes_length(strokes) + 2 * strokes->count * spline_pen_cap(page)) / budget;
}

/* One tone, one direction: parallel lines, their distance near w/D. */
static void parallel(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.3, 0.2, 0.01, 1.2e-3);
    SplineStartDef def = spline_start_default();
    SplineField direction = spline_direction_constant(&page, 0.4);
    Strokes strokes = start(spline_streamlines, even, &direction, &page, &def);
    double mean, variation, target = page.pen / 0.4;
    spacing_of(&strokes, &page, &mean, &variation);
    double ink = ink_of(&strokes, even, &page);
    print_message("even tone, parallel: %d strokes, spacing/(w/D) %.3f, CV %.3f, ink/budget %.3f\n",
                  strokes.count, mean / target, variation, ink);
    expect_sound(&strokes, &page, def.longest * 1.001);
    expect_close(ink, 1, 0.05);
    expect_close(mean / target, 0.9, 0.1);
    assert_true(variation < 0.15);
    for (int n = 0; n < strokes_node_count(&strokes); n++) {
        const double *q = strokes.q + 4 * n;
        expect_close(fabs(q[2] * cos(0.4) + q[3] * sin(0.4)) / hypot(q[2], q[3]), 1, 1e-12);
    }
    strokes_clear(&strokes);
    spline_field_clear(&direction);
}

/* One tone, circles: no stroke winds into itself, and their neighbours keep their distance. */
static void circles(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 8e-4);
    Error err = {""};
    SplineField direction;
    Formula *formula = formula_create((const char *[]){"-(v - 0.5)*100", "(u - 0.5)*100"}, 2, NULL, 0,
                                      spline_formula_variables, &err);
    assert_true(spline_direction_from_formula(formula, &page, &direction, &err));
    formula_destroy(formula);
    SplineStartDef def = spline_start_default();
    def.longest = 3; /* whole circles */
    Strokes strokes = start(spline_streamlines, even, &direction, &page, &def);
    double mean, variation, worst = 0, longest_turns = 0;
    spacing_of(&strokes, &page, &mean, &variation);
    for (int k = 0; k < strokes.count; k++) {
        const double *p = strokes.q + 4 * strokes.start[k];
        double radius = hypot(p[0] - 0.5, p[1] - 0.5);
        for (int n = strokes.start[k]; n < strokes.start[k + 1]; n++)
            worst = fmax(worst, fabs(hypot(strokes.q[4 * n] - 0.5, strokes.q[4 * n + 1] - 0.5) - radius));
        longest_turns = fmax(longest_turns, strokes_stroke_length(&strokes, k) / (2 * M_PI * radius));
    }
    print_message("circles: %d strokes, CV %.3f, drift off a circle %.5f, longest %.3f turns\n",
                  strokes.count, variation, worst, longest_turns);
    expect_sound(&strokes, &page, 3);
    assert_true(variation < 0.25);
    assert_true(worst < 1e-3);
    assert_true(longest_turns < 1 && longest_turns > 0.8);
    strokes_clear(&strokes);
    spline_field_clear(&direction);
}

/* What would wind inwards becomes rings: a pen's width between their ends, which go on as each other. */
static void spirals(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 8e-4);
    Error err = {""};
    SplineField direction;
    Formula *formula =
        formula_create((const char *[]){"-(v - 0.5)*100 + 0.6*(u - 0.5)", "(u - 0.5)*100 + 0.6*(v - 0.5)"}, 2,
                       NULL, 0, spline_formula_variables, &err);
    assert_true(spline_direction_from_formula(formula, &page, &direction, &err));
    formula_destroy(formula);
    SplineStartDef def = spline_start_default();
    Strokes strokes = start(spline_streamlines, even, &direction, &page, &def);
    int rings = 0;
    for (int k = 0; k < strokes.count; k++) {
        const double *p = strokes.q + 4 * strokes.start[k], *q = strokes.q + 4 * strokes.start[k + 1] - 4;
        double radius = (hypot(p[0] - 0.5, p[1] - 0.5) + hypot(q[0] - 0.5, q[1] - 0.5)) / 2;
        double turns = strokes_stroke_length(&strokes, k) / (2 * M_PI * radius);
        assert_true(turns < 1);
        double gap = hypot(p[0] - q[0], p[1] - q[1]) / page.pen;
        if (turns < 0.9 || gap > 3) continue; /* it met another one */
        expect_close(gap, 1.25, 0.3);
        rings++;
    }
    print_message("spiral: %d rings\n", rings);
    assert_true(rings >= 15);
    strokes_clear(&strokes);
    spline_field_clear(&direction);
}

/* Small curves that turn sharply, of many kinds: whatever comes back or nearly so, all that is drawn is
 * sound. */
static void tight_rings(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 6e-4);
    SplineStartDef def = spline_start_default();
    for (int k = 0; k < 40; k++) {
        def.seed = (uint64_t)k, def.separation = 0.7 + 0.01 * k;
        Strokes strokes = start(spline_streamlines, tiles, NULL, &page, &def);
        assert_true(strokes.count > 16);
        for (int i = 0; i < strokes.count; i++) {
            double length = strokes_stroke_length(&strokes, i);
            assert_true(length > 0.01 && length < 1);
        }
        strokes_clear(&strokes);
    }
}

/* Lit ball: the ink, and no mere dashes; where it is twice as dark lines are twice as dense. */
static void shaded(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 6e-4);
    SplineStartDef def = spline_start_default();
    double begin = clock_thread_seconds(), mean, variation;
    Strokes strokes = start(spline_streamlines, ball, NULL, &page, &def);
    double seconds = clock_thread_seconds() - begin, ink = ink_of(&strokes, ball, &page), shortest = 1;
    spacing_of(&strokes, &page, &mean, &variation);
    for (int k = 0; k < strokes.count; k++) shortest = fmin(shortest, strokes_stroke_length(&strokes, k));
    print_message(
        "lit ball: %d strokes, %d segments, ink/budget %.3f, shortest %.4f, %.3f s with its direction\n",
        strokes.count, strokes_segment_count(&strokes), ink, shortest, seconds);
    expect_sound(&strokes, &page, def.longest * 1.001);
    expect_close(ink, 1, 0.2);
    assert_true(shortest > 0.02);
    strokes_clear(&strokes);

    SplineField direction = spline_direction_constant(&page, 0);
    strokes = start(spline_streamlines, ramp, &direction, &page, &def);
    double length[5] = {0};
    for (int n = 0, k = 0; k < strokes.count; k++)
        for (n = strokes.start[k]; n < strokes.start[k + 1] - 1; n++)
            for (int s = 0; s < SAMPLES; s++)
                length[(int)(5 * stroke_point(&strokes, n, (s + 0.5) / SAMPLES).x)] +=
                    strokes_segment_length(&strokes, n) / SAMPLES;
    for (int k = 0; k < 5; k++) {
        double share = length[k] * 5 * page.pen / ramp((k + 0.5) / 5, 0);
        print_message("ramp, fifth %d: ink %.3f of what is asked for\n", k + 1, share);
        expect_close(share, 1, 0.25);
    }
    strokes_clear(&strokes);
    spline_field_clear(&direction);
}

static void same_seed(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 1e-3);
    Start *const starts[] = {spline_streamlines, spline_random_strokes};
    for (int k = 0; k < 2; k++) {
        SplineStartDef def = spline_start_default();
        Strokes a = start(starts[k], ball, NULL, &page, &def), b = start(starts[k], ball, NULL, &page, &def);
        def.seed = 2;
        Strokes c = start(starts[k], ball, NULL, &page, &def);
        size_t bytes = 4 * (size_t)strokes_node_count(&a) * sizeof *a.q;
        assert_int_equal(a.count, b.count);
        assert_memory_equal(a.q, b.q, bytes);
        assert_true(strokes_node_count(&a) != strokes_node_count(&c) || memcmp(a.q, c.q, bytes) != 0);
        strokes_clear(&a);
        strokes_clear(&b);
        strokes_clear(&c);
    }
}

/* Random strokes use up the ink, are as long as they should be, and more are where it is dark. */
static void random_strokes(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 5e-4);
    SplineStartDef def = spline_start_default();
    def.segment = 0.02;
    def.segments = 5;
    SplineField direction = spline_direction_constant(&page, 1);
    Strokes strokes = start(spline_random_strokes, ramp, &direction, &page, &def);
    double ink = ink_of(&strokes, ramp, &page), right = 0;
    int whole = 0;
    expect_sound(&strokes, &page, 0.1001);
    for (int k = 0; k < strokes.count; k++) {
        double length = strokes_stroke_length(&strokes, k);
        whole += fabs(length - 0.1) < 1e-3;
        right += strokes.q[4 * ((strokes.start[k] + strokes.start[k + 1]) / 2)] > 0.5 ? length : 0;
    }
    double share = right / strokes_length(&strokes),
           expected = 0.5 * (0.05 + 0.75 * 0.75) / (0.05 + 0.75 * 0.5);
    print_message("random: %d strokes, ink/budget %.3f, on the dark half %.3f of %.3f\n", strokes.count, ink,
                  share, expected);
    expect_close(ink, 1, 0.02);
    expect_close(share, expected, 0.04);
    assert_true(whole > 0.8 * strokes.count);
    strokes_clear(&strokes);
    spline_field_clear(&direction);
}

/* Nothing on white or nearly white paper; a spot on it is filled and nothing else. */
static void blank(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 6e-4);
    SplineStartDef def = spline_start_default();
    SplineField direction = spline_direction_constant(&page, 0.2), white = spline_field_create(&page, 1, 1);
    SplineGrid tone = spline_grid(&white), directions = spline_grid(&direction);
    Strokes strokes = {0};
    for (int pass = 0; pass < 2; pass++) {
        spline_streamlines(&tone, &directions, &page, &def, 0, &strokes);
        spline_random_strokes(&tone, &directions, &page, &def, 0, &strokes);
        assert_int_equal(strokes.count, 0);
        for (int i = 0; i < white.columns * white.rows; i++) white.values[i] = 0.019;
    }
    spline_field_clear(&white);
    strokes = start(spline_streamlines, spot, &direction, &page, &def);
    expect_sound(&strokes, &page, def.longest);
    expect_close(ink_of(&strokes, spot, &page), 1, 0.2);
    for (int n = 0; n < strokes_node_count(&strokes); n++)
        assert_true(hypot(strokes.q[4 * n] - 0.3, strokes.q[4 * n + 1] - 0.6) < 0.105);
    strokes_clear(&strokes);
    spline_field_clear(&direction);
}

/* Strokes of several tones are appended to each other. */
static void appended(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 1e-3);
    SplineStartDef def = spline_start_default();
    SplineField tone = tone_of(even, &page, 0.01), direction = spline_direction_constant(&page, 0.2);
    SplineGrid tones = spline_grid(&tone), directions = spline_grid(&direction);
    Strokes strokes = {0};
    spline_streamlines(&tones, &directions, &page, &def, 0, &strokes);
    int first = strokes.count, nodes = strokes_node_count(&strokes);
    Strokes alone = strokes_copy(&strokes);
    spline_streamlines(&tones, &directions, &page, &def, 7, &strokes);
    assert_int_equal(strokes.count, 2 * first);
    assert_int_equal(strokes_node_count(&strokes), 2 * nodes);
    assert_memory_equal(strokes.q, alone.q, 4 * (size_t)nodes * sizeof *alone.q);
    assert_memory_equal(strokes.q + 4 * nodes, alone.q, 4 * (size_t)nodes * sizeof *alone.q);
    assert_int_equal(strokes.start[first + 1] - nodes, alone.start[1]);
    assert_int_equal(strokes.layer[first - 1], 0);
    assert_int_equal(strokes.layer[first], 7);
    strokes_clear(&strokes);
    strokes_clear(&alone);
    spline_field_clear(&tone);
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
        cmocka_unit_test_teardown(parallel, nothing_leaks),
        cmocka_unit_test_teardown(circles, nothing_leaks),
        cmocka_unit_test_teardown(spirals, nothing_leaks),
        cmocka_unit_test_teardown(tight_rings, nothing_leaks),
        cmocka_unit_test_teardown(shaded, nothing_leaks),
        cmocka_unit_test_teardown(same_seed, nothing_leaks),
        cmocka_unit_test_teardown(random_strokes, nothing_leaks),
        cmocka_unit_test_teardown(blank, nothing_leaks),
        cmocka_unit_test_teardown(appended, nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
