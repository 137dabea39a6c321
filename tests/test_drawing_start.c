/* Drawings that start from the lines of an SVG file: where they lie, their nodes and tangents, and whose they are. */
#include "drawing_fixture.h"
#include <math.h>

static const char *const svg =
    "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 80 60' width='80mm' height='60mm'>"
    "<path d='M10 10L30 25'/><circle cx='55' cy='30' r='15'/><path d='M5 5h0'/></svg>";

/* A point of the page on the paper, mm. */
static Vec2 on_paper(const SplinePage *page, const double *p)
{
    return (Vec2){1e3 * (page->left + page->unit * p[0]), 1e3 * (page->top + page->unit * p[1])};
}

#define PAGE                                                                                                 \
    "density: 0.35, page: {size: [80 mm, 60 mm], margin: 4 mm}, pen: 0.5 mm, start: {file: lines.svg}"

static void lines(void **state)
{
    (void)state;
    write_file("lines.svg", svg);
    Drawing *d = drawing_of(PAGE);
    const Strokes *given = &d->parts[0].given;
    assert_true(d->start_given && given->count == 2); /* a dot is no stroke */
    for (int k = 0; k < 2; k++) {
        int segments = given->start[k + 1] - given->start[k] - 1;
        double length = k ? 2 * M_PI * 15 : 25, rest = 1.2 * 0.5 / 0.35;
        assert_int_equal(segments, lround(length / rest));
        for (int i = 0; i <= segments; i++) {
            const double *q = given->q + 4 * (given->start[k] + i);
            Vec2 p = on_paper(&d->page, q), v = {1e3 * d->page.unit * q[2], 1e3 * d->page.unit * q[3]};
            double r = hypot(p.x - 55, p.y - 30);
            if (k == 0) {
                assert_true(fabs(p.x - 10 - 20.0 * i / segments) < 1e-9 &&
                            fabs(p.y - 10 - 15.0 * i / segments) < 1e-9);
                assert_true(fabs(v.x - 20.0 / 3 / segments) < 1e-9 && fabs(v.y - 5.0 / segments) < 1e-9);
            } else {
                assert_true(fabs(r - 15) < 1e-3 && fabs(hypot(v.x, v.y) - length / segments / 3) < 0.01);
                bool end = i == 0 || i == segments; /* one-sided there */
                assert_true(fabs(v.x * (p.x - 55) + v.y * (p.y - 30)) < (end ? 0.6 : 1e-2));
            }
        }
    }
    Strokes strokes = {0};
    SplineTarget *target;
    drawing_begin(d, 0, 1, &strokes, &target);
    assert_true(strokes.count == 2 &&
                !memcmp(strokes.q, given->q, 4 * sizeof(double) * (size_t)strokes.start[2]));
    spline_target_destroy(target);
    strokes_clear(&strokes);
    drawing_destroy(d);
}

/* Each stroke is of the region that its middle is in. */
static void regions(void **state)
{
    (void)state;
    write_file("lines.svg", svg);
    write_file("left.pgm", "P2 4 3 255  255 255 0 0  255 255 0 0  255 255 0 0\n");
    Drawing *d = drawing_of(PAGE ", regions: [{mask: left.pgm, invert: true}, {mask: left.pgm}]");
    assert_true(d->part_count == 2 && d->parts[0].given.count == 1 && d->parts[1].given.count == 1);
    assert_true(d->parts[0].given.start[1] > 30 && d->parts[1].given.start[1] < 20);
    drawing_destroy(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(lines, nothing_leaks),
                                       cmocka_unit_test_teardown(regions, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
