/* Strokes on paper: cubic curves and their parts, what is cut off at the edge of the page, the preview. */
#include "base/cubic.h"
#include "io/canvas.h"
#include "png_fixture.h"
#include "spline/plot.h"
#include "spline/preview.h"
#include "spline_fixture.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

static void expect_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.17g is not %.17g", value, expected);
}

static void cubics(void **state)
{
    (void)state;
    const Vec2 c[4] = {{0, 1}, {2, 5}, {4, -3}, {3, 2}};
    Vec2 part[4], p = cubic_at(c, 0.3), x;
    expect_close(p.x, 3 * 0.3 * 0.49 * 2 + 3 * 0.09 * 0.7 * 4 + 0.027 * 3, 1e-14);
    cubic_part(c, 0.2, 0.7, part);
    for (int k = 0; k <= 10; k++) {
        p = cubic_at(part, k / 10.0);
        x = cubic_at(c, 0.2 + 0.5 * k / 10.0);
        expect_close(hypot(p.x - x.x, p.y - x.y), 0, 1e-14);
    }
    cubic_part(c, 1, 0, part);
    for (int k = 0; k < 4; k++) assert_true(part[k].x == c[3 - k].x && part[k].y == c[3 - k].y);

    double roots[3], at[3] = {0.1, 0.45, 0.9}; /* of (s - 0.1)(s - 0.45)(s - 0.9) */
    const double b[4] = {-0.0405, (0.1 * .45 + .1 * .9 + .45 * .9) / 3 - 0.0405,
                         -(0.1 + .45 + .9) / 3 + 2 * (0.1 * .45 + .1 * .9 + .45 * .9) / 3 - 0.0405,
                         0.9 * 0.55 * 0.1};
    assert_int_equal(cubic_roots(b, roots), 3);
    for (int k = 0; k < 3; k++) expect_close(roots[k], at[k], 1e-12);
    assert_int_equal(cubic_roots((const double[]){-1, -1, -1, 1}, roots), 1);
    expect_close(roots[0], cbrt(0.5), 1e-12);
    assert_int_equal(cubic_roots((const double[]){-1, 0, 1, 2}, roots), 1); /* a line */
    expect_close(roots[0], 1.0 / 3, 1e-12);
    assert_int_equal(cubic_roots((const double[]){3, 1, 1, 3}, roots), 0);
    assert_int_equal(cubic_roots((const double[]){1, -1, -1, 1}, roots), 2); /* 6 s^2 - 6 s + 1 */
    expect_close(roots[1], 0.5 + sqrt(1.0 / 12), 1e-12);
    assert_int_equal(cubic_roots((const double[]){0, 0, 0, 0}, roots), 0);

    for (int k = 1; k < 5;
         k++) { /* chords are as near as they should, and not twice as near as they need be */
        double tolerance = pow(10, -k), worst = 0;
        int steps = cubic_steps(c, tolerance);
        for (int i = 0; i < steps; i++) {
            Vec2 from = cubic_at(c, (double)i / steps), to = cubic_at(c, (i + 1.0) / steps);
            double chord = hypot(to.x - from.x, to.y - from.y);
            for (int s = 1; s < 20; s++) {
                Vec2 q = cubic_at(c, (i + s / 20.0) / steps);
                worst = fmax(
                    worst, fabs((q.x - from.x) * (to.y - from.y) - (q.y - from.y) * (to.x - from.x)) / chord);
            }
        }
        assert_true(worst <= tolerance && (k < 2 || worst > 0.2 * tolerance));
    }
    assert_int_equal(cubic_steps((const Vec2[]){{0, 0}, {1, 1}, {2, 2}, {3, 3}}, 1e-9), 1);
}

/* A paper of 60 x 40 mm, margins of 10 mm; the pen is 1 mm wide. */
static SplinePage small_page(void)
{
    return spline_page(0.06, 0.04, 0.01, 0.001);
}

static const Color white = {1, 1, 1, 1};

/* A black pen as wide as the page's, and a red one of that many times its width. */
static Plot plot_of(const Strokes *strokes, const SplinePage *page, int pen_count, double red)
{
    SplinePen pens[] = {{"black", {0, 0, 0, 1}, page->pen, false},
                        {"red", {1, 0, 0, 1}, red * page->pen, false}};
    return spline_plot(strokes, page, pens, pen_count, white);
}

static void expect_point(Vec2 p, double x, double y)
{
    if (!(fabs(p.x - x) < 1e-9 && fabs(p.y - y) < 1e-9))
        fail_msg("(%.12g, %.12g) is not (%g, %g)", p.x, p.y, x, y);
}

static void inside_is_kept(void **state)
{
    (void)state;
    SplinePage page = small_page();
    Strokes strokes = {0};
    double mm = 1e-3 / page.unit;
    strokes_add(&strokes, 2, (const double[2][4]){{0, 0, 5 * mm, 0}, {40 * mm, 20 * mm, 0, 5 * mm}}, 1);
    strokes_add(&strokes, 3,
                (const double[3][4]){
                    {10 * mm, 10 * mm, 2 * mm, mm}, {20 * mm, 10 * mm, 3 * mm, 0}, {30 * mm, 12 * mm, 0, mm}},
                0);
    strokes_add(&strokes, 2, (const double[2][4]){{0, 0, mm, 0}, {mm, mm, mm, 0}}, 2); /* no pen for it */
    Plot plot = plot_of(&strokes, &page, 2, 1.5);
    expect_close(plot.paper[0], 60, 1e-12);
    expect_close(plot.paper[1], 40, 1e-12);
    assert_int_equal(plot.layer_count, 2);
    assert_string_equal(plot.layers[1].name, "red");
    expect_close(plot.layers[0].pen, 1, 1e-12);
    expect_close(plot.layers[1].pen, 1.5, 1e-12);
    assert_int_equal(plot.layers[0].count, 1);
    assert_int_equal(plot.layers[0].start[1], 7);
    assert_int_equal(plot.layers[1].count, 1);
    const Vec2 *red = plot.layers[1].points, *black = plot.layers[0].points;
    expect_point(red[0], 10, 10);
    expect_point(red[1], 15, 10);
    expect_point(red[2], 50, 25);
    expect_point(red[3], 50, 30);
    expect_point(black[2], 27, 20);
    expect_point(black[3], 30, 20);
    expect_point(black[4], 33, 20);
    spline_plot_clear(&plot);
    strokes_clear(&strokes);
}

/* Whether all of the layer is inside the drawable part; its length. */
static double inside_length(const PlotLayer *layer)
{
    double length = 0;
    for (int k = 0; k < layer->count; k++) {
        for (const Vec2 *c = layer->points + layer->start[k]; c < layer->points + layer->start[k + 1] - 1;
             c += 3) {
            Vec2 at = *c;
            for (int s = 0; s <= 200; s++) {
                Vec2 next = cubic_at(c, s / 200.0);
                assert_true(next.x > 10 - 1e-9 && next.x < 50 + 1e-9 && next.y > 10 - 1e-9 &&
                            next.y < 30 + 1e-9);
                length += hypot(next.x - at.x, next.y - at.y);
                at = next;
            }
        }
    }
    return length;
}

static void outside_is_cut(void **state)
{
    (void)state;
    SplinePage page = small_page();
    double mm = 1e-3 / page.unit;
    Strokes strokes = {0};
    strokes_add(&strokes, 2, /* straight through the whole page: 40 mm are left */
                (const double[2][4]){{-20 * mm, 5 * mm, 30 * mm, 0}, {70 * mm, 5 * mm, 30 * mm, 0}}, 0);
    strokes_add(&strokes, 2, /* out at the top and in again within one segment */
                (const double[2][4]){{10 * mm, 5 * mm, 0, -20 * mm}, {30 * mm, 5 * mm, 0, 20 * mm}}, 0);
    strokes_add(&strokes, 4, /* out at the right, along there, and back: a node on either side */
                (const double[4][4]){{35 * mm, 10 * mm, 5 * mm, 0},
                                     {45 * mm, 10 * mm, 2 * mm, 0},
                                     {45 * mm, 15 * mm, -2 * mm, 0},
                                     {35 * mm, 15 * mm, -5 * mm, 0}},
                0);
    strokes_add(&strokes, 2, (const double[2][4]){{-5 * mm, 0, mm, mm}, {-1 * mm, 10 * mm, mm, mm}}, 0);
    Plot plot = plot_of(&strokes, &page, 1, 1);
    const PlotLayer *layer = &plot.layers[0];
    assert_int_equal(layer->count, 5);
    expect_point(layer->points[0], 10, 15);
    expect_point(layer->points[3], 50, 15);
    Vec2 leaves = layer->points[layer->start[2] - 1], enters = layer->points[layer->start[2]];
    expect_close(leaves.y, 10, 0);
    expect_close(enters.y, 10, 0);
    expect_close(leaves.x + enters.x, 60, 1e-9); /* the arch is symmetric */
    expect_close(layer->points[layer->start[4] - 1].x, 50, 0);
    expect_close(layer->points[layer->start[4]].x, 50, 0);

    /* What is inside, by stepping along the strokes. */
    double expected = 0;
    for (int k = 0; k < strokes.count; k++) {
        for (int node = strokes.start[k]; node < strokes.start[k + 1] - 1; node++) {
            Vec2 c[4], at, next;
            strokes_bezier(&strokes, node, c);
            at = c[0];
            for (int s = 1; s <= 100000; s++, at = next) {
                next = cubic_at(c, s / 1e5);
                if (next.x >= 0 && next.x <= page.width && next.y >= 0 && next.y <= page.height)
                    expected += hypot(next.x - at.x, next.y - at.y) / mm;
            }
        }
    }
    expect_close(inside_length(layer), expected, 0.01);
    spline_plot_clear(&plot);
    strokes_clear(&strokes);
}

/* A black and a red line, of which a pixel is 0.1 mm; grey steps beside it. */
static void previews(void **state)
{
    (void)state;
    SplinePage page = small_page();
    double mm = 1e-3 / page.unit, ink[4][3] = {{0, 0.1, 0.2}, {0.25, 0, 1}, {0.5, 0.5, 0.5}, {1, 0, 0.75}};
    Strokes strokes = {0};
    strokes_add(&strokes, 2,
                (const double[2][4]){{5 * mm, 5 * mm, 10 * mm, 0}, {35 * mm, 5 * mm, 10 * mm, 0}}, 0);
    strokes_add(&strokes, 2,
                (const double[2][4]){{20 * mm, 2 * mm, 0, 5 * mm}, {20 * mm, 17 * mm, 0, 5 * mm}}, 1);
    Plot plot = plot_of(&strokes, &page, 2, 1);
    SplineGrid target = {.columns = 4, .rows = 1, .width = 3, .values = ink[0]};
    for (int beside = 0; beside < 2; beside++) {
        Error err = {""};
        unsigned char *rgb;
        int width, height, dark = 0, red = 0, left = beside ? 600 : 0;
        if (!spline_preview("preview.png", &plot, &page, beside ? &target : NULL, 600, &err))
            fail_msg("%s", err.text);
        if (!png_read("preview.png", &rgb, &width, &height, &err)) fail_msg("%s", err.text);
        assert_int_equal(width, 600 + left);
        assert_int_equal(height, 400);
        for (int i = 0; i < height;
             i++) { /* the lines are 10 pixels wide; black shines through the red one that lies on it */
            dark += rgb[3 * (i * width + left + 200)] < 128;
            red += rgb[3 * (i * width + left + 300) + 1] < 128;
            bool crossing = i >= 145 && i < 155;
            assert_true((rgb[3 * (i * width + left + 300)] < 128) == crossing || i < 110 || i > 290);
        }
        assert_int_equal(dark, 10);
        assert_true(red >= 150 && red <= 162); /* with round ends */
        for (int k = 0; beside && k < 12; k++)
            expect_close(rgb[3 * (200 * width + 150 + 100 * (k / 3)) + k % 3], 255 * (1 - ink[k / 3][k % 3]),
                         1);
        if (beside) assert_int_equal(rgb[3 * (5 * width + 5)], 255); /* the margin */
        mem_free(rgb);
    }
    Error err = {""};
    assert_false(spline_preview("preview.gif", &plot, &page, NULL, 600, &err));
    spline_plot_clear(&plot);
    strokes_clear(&strokes);
}

static void expect_rgb(const unsigned char *rgb, int r, int g, int b)
{
    if (abs(rgb[0] - r) > 1 || abs(rgb[1] - g) > 1 || abs(rgb[2] - b) > 1)
        fail_msg("%d %d %d is not %d %d %d", rgb[0], rgb[1], rgb[2], r, g, b);
}

/* On blue paper: of a transparent ink what it shares with the paper; of an opaque one its colour, also where it lies
 * on the other one. */
static void papers(void **state)
{
    (void)state;
    SplinePage page = small_page();
    const Color blue = {0.2, 0.4, 1, 1};
    SplinePen pens[] = {{"clear", {1, 0.5, 0, 1}, page.pen, false},
                        {"paint", {1, 1, 0.6, 1}, page.pen, true}};
    double mm = 1e-3 / page.unit;
    Strokes strokes = {0};
    strokes_add(&strokes, 2,
                (const double[2][4]){{5 * mm, 5 * mm, 10 * mm, 0}, {35 * mm, 5 * mm, 10 * mm, 0}}, 0);
    strokes_add(&strokes, 2,
                (const double[2][4]){{20 * mm, 2 * mm, 0, 5 * mm}, {20 * mm, 17 * mm, 0, 5 * mm}}, 1);
    Plot plot = spline_plot(&strokes, &page, pens, 2, blue);
    Error err = {""};
    unsigned char *rgb;
    int width, height;
    assert_true(spline_preview("papers.png", &plot, &page, NULL, 600, &err));
    assert_true(png_read("papers.png", &rgb, &width, &height, &err));
    expect_rgb(rgb + 3 * (5 * width + 5), 51, 102, 255);
    expect_rgb(rgb + 3 * (150 * width + 200), 51, 51, 0);
    expect_rgb(rgb + 3 * (200 * width + 300), 255, 255, 153);
    expect_rgb(rgb + 3 * (150 * width + 300), 255, 255, 153);
    mem_free(rgb);
    spline_plot_clear(&plot);
    strokes_clear(&strokes);
}

static int live(void **state)
{
    (void)state;
    return mem_live_count() == 0 ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(cubics), cmocka_unit_test(papers),
                                       cmocka_unit_test(inside_is_kept), cmocka_unit_test(outside_is_cut),
                                       cmocka_unit_test(previews)};
    return cmocka_run_group_tests(tests, NULL, live);
}
