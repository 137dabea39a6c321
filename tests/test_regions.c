/* Drawings within outlines: distances from them, what of a stroke may stay and move, and that no stroke of a whole
 * drawing leaves them. */
#include "base/cubic.h"
#include "base/memory.h"
#include "base/random.h"
#include "drawing_fixture.h"
#include "spline/contour.h"
#include "spline/order.h"
#include "spline/outline.h"
#include "spline/revise.h"
#include "spline/terms.h"
#include <math.h>

static const double pixel = 0.01;

/* How much of a pixel is in a disc, by 16 x 16 samples. */
static SplineField disc(const SplinePage *page, Vec2 center, double radius)
{
    SplineField cover = spline_field_create(page, pixel, 1);
    for (int i = 0; i < cover.rows; i++)
        for (int j = 0; j < cover.columns; j++)
            for (int k = 0; k < 256; k++) {
                double x = (j + (k % 16 + 0.5) / 16) / cover.columns * page->width,
                       y = (i + (k / 16 + 0.5) / 16) / cover.rows * page->height;
                *spline_field_pixel(&cover, i, j) += (hypot(x - center.x, y - center.y) < radius) / 256.0;
            }
    return cover;
}

/* Of a disc, which the page cuts: to a tenth of a pixel, but where what is nearest is beyond the page. */
static void distances(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.125, 0.08, 0, 1e-3);
    Vec2 center = {0.3, 0.5};
    SplineField cover = disc(&page, center, 0.35), d = spline_contour_distance(&cover, &page);
    double worst = 0;
    for (int i = 0; i < d.rows; i++)
        for (int j = 0; j < d.columns; j++) {
            Vec2 p = spline_field_center(&d, &page, i, j);
            double r = hypot(p.x - center.x, p.y - center.y), scale = 0.35 / fmax(r, 1e-9);
            Vec2 foot = {center.x + scale * (p.x - center.x), center.y + scale * (p.y - center.y)};
            if (foot.x < pixel || foot.y > page.height - pixel) continue;
            worst = fmax(worst, fabs(*spline_field_pixel(&d, i, j) - (0.35 - r)));
        }
    print_message("a disc's distances: off by %.3g pixels\n", worst / pixel);
    assert_true(worst < 0.1 * pixel);
    spline_field_clear(&d);
    for (int k = 0; k < 2; k++) { /* nothing, and all */
        for (int i = 0; i < cover.columns * cover.rows; i++) cover.values[i] = k;
        d = spline_contour_distance(&cover, &page);
        assert_true(d.values[0] == 2 * k - 1 && d.values[77] == 2 * k - 1);
        spline_field_clear(&d);
    }
    spline_field_clear(&cover);
}

/* A star with a square hole, in mm, y down. */
static const double star[][2] = {{50, 2},  {60, 36}, {97, 36}, {67, 57}, {79, 92},
                                 {50, 70}, {21, 92}, {33, 57}, {3, 36},  {40, 36}};
static const double hole[][2] = {{44, 44}, {57, 44}, {57, 57}, {44, 57}};

enum { STAR = sizeof star / sizeof *star, HOLE = sizeof hole / sizeof *hole };

static const char *const svg =
    "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 94' width='100mm' "
    "height='94mm'><polygon points='50,2 60,36 97,36 67,57 79,92 50,70 21,92 33,57 3,36 "
    "40,36'/><path d='M44 44H57V57H44Z'/></svg>";

static void meet_ring(const double (*ring)[2], int count, Vec2 p, double *distance, bool *inside)
{
    for (int k = 0; k < count; k++) {
        const double *a = ring[k], *b = ring[(k + 1) % count];
        double dx = b[0] - a[0], dy = b[1] - a[1];
        double s = fmin(fmax(((p.x - a[0]) * dx + (p.y - a[1]) * dy) / (dx * dx + dy * dy), 0), 1);
        *distance = fmin(*distance, hypot(p.x - a[0] - s * dx, p.y - a[1] - s * dy));
        if ((a[1] > p.y) != (b[1] > p.y) && p.x < a[0] + (p.y - a[1]) / dy * dx) *inside = !*inside;
    }
}

/* mm, positive inside, exact. */
static double star_distance(Vec2 p)
{
    double distance = INFINITY;
    bool inside = false;
    meet_ring(star, STAR, p, &distance, &inside);
    meet_ring(hole, HOLE, p, &distance, &inside);
    return inside ? distance : -distance;
}

/* The largest distance of strokes outside of the star, mm, by samples. */
static double leave_star(const SplinePage *page, const Strokes *strokes)
{
    double most = -INFINITY;
    for (int k = 0; k < strokes->count; k++)
        for (int node = strokes->start[k]; node < strokes->start[k + 1] - 1; node++)
            for (int i = 0; i <= 200; i++) {
                Vec2 c[4];
                strokes_bezier(strokes, node, c);
                Vec2 p = cubic_at(c, i / 200.0);
                Vec2 at = {1e3 * (page->left + page->unit * p.x), 1e3 * (page->top + page->unit * p.y)};
                most = fmax(most, -star_distance(at));
            }
    return most;
}

#define STAR_SCENE                                                                                           \
    "density: {formula: 0.3 + 0.3*u}, direction: {formula: [1, sin(5*v)]}, page: {size: [100 mm, 94 mm], "   \
    "margin: 1 mm}, pen: 1 mm, "

/* What a plotter would get; from the first strokes of another drawing, or its own. */
static Strokes draw(const Drawing *d, const RelaxDef *relax, const Drawing *start)
{
    SplineTarget *target;
    Strokes strokes = {0};
    if (start) drawing_begin(start, 0, 1, &strokes, &target), spline_target_destroy(target);
    SplineGrid outline = spline_grid(&d->outline);
    OrderDef order = order_default();
    order.outline = &outline;
    drawing_begin(d, 0, 1, start ? NULL : &strokes, &target);
    spline_refine(target, relax, 1, 8, &strokes, NULL);
    order_strokes(&strokes, &d->page, order);
    spline_target_destroy(target);
    return strokes;
}

/* With every method, from both starts. */
static void drawings(void **state)
{
    (void)state;
    static const struct {
        const char *method, *more;
    } ways[] = {{"auto", "start: streamlines, iterations: 80"},
                {"auto", "start: random, iterations: 80"},
                {"gradient", "start: random, iterations: 40"},
                {"newton", "start: random, iterations: 8"},
                {"monte_carlo", "start: random, monte_carlo: {temperatures: 3, sweeps: 4}"},
                {"dynamics", "start: random, dynamics: {steps: 4}"},
                {"auto", "start: random, iterations: 40, energies: {boundary: 0.1}"}};
    write_file("star.svg", svg);
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
        char entry[800];
        snprintf(entry, sizeof entry, "regions: [{svg: star.svg, fit: paper}], " STAR_SCENE "method: %s, %s",
                 ways[k].method, ways[k].more);
        Drawing *d = drawing_of(entry);
        double pen = 1, outside;
        Strokes strokes = draw(d, &d->relax, NULL);
        outside = leave_star(&d->page, &strokes);
        print_message("%-11s %-40s %4d strokes, %.3f mm outside\n", ways[k].method, ways[k].more,
                      strokes.count, outside);
        assert_true(strokes.count > 20 && outside <= pen / 2);
        SplineGrid outline = spline_grid(&d->outline);
        /* the pixels' outline cuts corners by a sixth of a pen */
        assert_true(fabs(1e3 * d->page.unit * spline_outline_excess(&outline, &d->page, &strokes) -
                         fmax(outside, 0)) < 0.2 * pen);
        strokes_clear(&strokes);
        drawing_destroy(d);
    }
}

/* From strokes all over the page; without the energy they do leave the star, or this would say nothing. */
static void strays(void **state)
{
    (void)state;
    write_file("star.svg", svg);
    Drawing *d = drawing_of("regions: [{svg: star.svg, fit: paper}], " STAR_SCENE "start: random"),
            *page = drawing_of(STAR_SCENE "start: random");
    for (int bound = 0; bound < 2; bound++) {
        RelaxDef relax = d->relax;
        relax.max_iterations = 40;
        if (!bound) relax.weights.outline = 0;
        Strokes strokes = draw(d, &relax, page);
        double outside = leave_star(&d->page, &strokes);
        print_message("from all over the page: %.3f mm outside\n", outside);
        assert_true((outside <= 0.5) == bound);
        strokes_clear(&strokes);
    }
    drawing_destroy(page);
    drawing_destroy(d);
}

/* The drawing's one stroke, a segment from a to b, mm. */
static Strokes line(const SplinePage *page, Vec2 a, Vec2 b)
{
    double scale = 1e-3 / page->unit, q[2][4];
    for (int k = 0; k < 2; k++) {
        Vec2 p = k ? b : a;
        q[k][0] = scale * (p.x - 1), q[k][1] = scale * (p.y - 1);
        q[k][2] = scale * (b.x - a.x) / 3, q[k][3] = scale * (b.y - a.y) / 3;
    }
    Strokes strokes = {0};
    strokes_add(&strokes, 2, (const double(*)[4])q, 0);
    return strokes;
}

/* Of moves across the hole strokes make what is free, and nine tenths of the distance at most; of those that stay
 * in the star all. */
static void moves(void **state)
{
    (void)state;
    write_file("star.svg", svg);
    Drawing *d = drawing_of("regions: [{svg: star.svg, fit: paper}], " STAR_SCENE "rounds: 0");
    SplineTarget *target;
    drawing_begin(d, 0, 1, NULL, &target);
    static const struct {
        Vec2 from[2], to[2];
        double least, most;
    } ways[] = {{{{38, 42}, {38, 60}}, {{64, 42}, {64, 60}}, 0.15, 6.0 / 26},
                {{{38, 42}, {38, 60}}, {{41, 42}, {41, 60}}, 1, 1},
                {{{50, 30}, {50, 20}}, {{50, 28}, {50, 18}}, 1, 1},
                {{{50, 30}, {50, 20}}, {{70, 30}, {70, 20}}, 0.05, 0.3}};
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
        Strokes from = line(&d->page, ways[k].from[0], ways[k].from[1]),
                to = line(&d->page, ways[k].to[0], ways[k].to[1]);
        double rest[] = {20e-3 / d->page.unit}, before = to.q[0];
        SplineModelDef def = spline_model_default();
        SplineModel *model = spline_model_create(target, &from, rest, &def);
        Term term = spline_outline_term(model, SPLINE_EXACT);
        term.ops->project(term.self, from.q, to.q);
        double way = hypot(before - from.q[0], 0),
               gone = way > 1e-9 ? (to.q[0] - from.q[0]) / (before - from.q[0]) : 1;
        print_message("a move: %.3f of it\n", gone);
        assert_true(gone >= ways[k].least - 1e-12 && gone <= ways[k].most);
        term.ops->destroy(term.self);
        spline_model_destroy(model);
        strokes_clear(&from);
        strokes_clear(&to);
    }
    spline_target_destroy(target);
    drawing_destroy(d);
}

/* A stroke across the hole becomes two, without the segments that are over it. */
static void cuts(void **state)
{
    (void)state;
    write_file("star.svg", svg);
    Drawing *d = drawing_of("regions: [{svg: star.svg, fit: paper}], " STAR_SCENE "rounds: 0");
    SplineTarget *target;
    drawing_begin(d, 0, 1, NULL, &target);
    double scale = 1e-3 / d->page.unit, q[15][4];
    for (int k = 0; k < 15; k++) /* nodes at x = 15, 20, .. 85 mm; the tips are short of that */
        q[k][0] = scale * (14 + 5 * k), q[k][1] = scale * 49, q[k][2] = scale * 5 / 3, q[k][3] = 0;
    Strokes strokes = {0};
    strokes_add(&strokes, 15, (const double(*)[4])q, 3);
    spline_outline_cut(target, 0, &strokes);
    assert_true(strokes.count == 2 && strokes.layer[1] == 3);
    assert_true(leave_star(&d->page, &strokes) < 0);
    for (int k = 0; k < 2; k++) {
        const double *first = strokes.q + 4 * strokes.start[k],
                     *last = strokes.q + 4 * strokes.start[k + 1] - 4;
        assert_true(fabs(first[0] / scale + 1 - (k ? 60 : 25)) < 1e-9 &&
                    fabs(last[0] / scale + 1 - (k ? 75 : 40)) < 1e-9);
    }
    strokes_clear(&strokes);
    spline_target_destroy(target);
    drawing_destroy(d);
}

static double at(const Drawing *d, const SplineField *field, double u, double v)
{
    SplineGrid grid = spline_grid(field);
    double value;
    spline_grid_sample(&grid, &d->page, (Vec2){u * d->page.width, v * d->page.height}, &value);
    return value;
}

/* Masks lie as the picture does; regions do not overlap, have directions and pens of their own; tones end at them. */
static void scenes(void **state)
{
    (void)state;
    write_file("half.pgm", "P2 4 2 255  255 255 0 0  255 255 0 0\n");
    write_file("low.pgm", "P2 2 2 255  0 0 255 255\n");
    write_file("grey.pgm", "P2 2 1 255  100 100\n");
    Drawing *d = drawing_of(
        "image: grey.pgm, tone: {density: 0.8}, page: {size: [80 mm, 60 mm], margin: 0}, pen: 0.5 mm, "
        "direction: 0, regions: [{mask: half.pgm, pen: red}, {mask: low.pgm, pen: blue, "
        "direction: 40 deg}], pens: [red, blue]");
    assert_true(d->region_count == 2 && d->part_count == 2 && d->pen_count == 2);
    /* grey.pgm and half.pgm: 80 mm x 40 mm, all that is drawn on; low.pgm is as high, and 40 mm wide */
    double grey = 0.8 * (1 - 100 / 255.0);
    static const double places[][2] = {{0.25, 0.5}, {0.25, 0.05}, {0.3, 0.8}, {0.02, 0.95},
                                       {0.7, 0.8},  {0.7, 0.3},   {0.8, 0.8}};
    static const int owner[] = {0, 0, 0, 0, 1, -1, -1};
    for (int k = 0; k < 7; k++) {
        double u = places[k][0], v = places[k][1];
        for (int part = 0; part < 2; part++) {
            bool own = owner[k] == part;
            assert_true(fabs(at(d, &d->parts[part].tone, u, v) - (own ? grey : 0)) < 1e-6);
            assert_true((at(d, d->parts[part].outline, u, v) > 0) == own);
        }
        assert_true((at(d, &d->outline, u, v) > 0) == (owner[k] >= 0));
    }
    assert_true(d->parts[0].direction == &d->direction && d->parts[1].direction == &d->regions[1].direction);
    assert_true(d->parts[0].pen == 0 && d->parts[1].pen == 1);
    drawing_destroy(d);
    /* shapes as large as there is room, and what is outside of them */
    write_file("box.svg",
               "<svg xmlns='http://www.w3.org/2000/svg'><rect x='-7' y='20' width='100' height='50'/></svg>");
    for (int invert = 0; invert < 2; invert++) {
        char entry[400];
        snprintf(entry, sizeof entry,
                 "density: 0.3, page: {size: [80 mm, 60 mm], margin: 5 mm}, pen: 0.5 mm, regions: [{svg: "
                 "box.svg, invert: %s}]",
                 invert ? "true" : "false");
        d = drawing_of(entry); /* the drawable part is 70 mm x 50 mm, the box 70 mm x 35 mm in it */
        for (double v = 0.03; v < 1; v += 0.06) {
            double depth = 1e-3 / d->page.unit * (invert ? -1 : 1) * (17.5 - fabs(50 * v - 25));
            assert_true(fabs(at(d, &d->outline, 0.5, v) - depth) < 0.05e-3 / d->page.unit);
        }
        drawing_destroy(d);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(distances, nothing_leaks),
                                       cmocka_unit_test_teardown(scenes, nothing_leaks),
                                       cmocka_unit_test_teardown(cuts, nothing_leaks),
                                       cmocka_unit_test_teardown(moves, nothing_leaks),
                                       cmocka_unit_test_teardown(strays, nothing_leaks),
                                       cmocka_unit_test_teardown(drawings, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
