/* Drawings from scenes: pages, pens, what each part shall cover, directions. */
#include "base/memory.h"
#include "spline/direction.h"
#include "drawing_fixture.h"
#include <math.h>

static void expect_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.15g is not %.15g", value, expected);
}

static double value_at(const SplineField *field, const SplinePage *page, double u, double v)
{
    SplineGrid grid = spline_grid(field);
    double value;
    assert_int_equal(field->width, 1);
    spline_grid_sample(&grid, page, (Vec2){u * page->width, v * page->height}, &value);
    return value;
}

static void pages(void **state)
{
    (void)state;
    Drawing *d = drawing_of("density: 0.5, page: {size: a5 landscape, margin: 10 mm}, pen: 0.4 mm, seed: 7");
    expect_close(d->page.paper[0], 0.210, 1e-12);
    expect_close(d->page.paper[1], 0.148, 1e-12);
    expect_close(d->page.unit * d->page.width, 0.190, 1e-12);
    expect_close(d->page.unit * d->page.pen, 0.4e-3, 1e-15);
    assert_true(d->part_count == 1 && d->pen_count == 1 && d->start.seed == 7 && d->relax.seed == 7);
    assert_string_equal(d->pens[0].name, "black");
    drawing_destroy(d);
    d = drawing_of("density: 0.5, page: {size: 80x40mm, margin: 0}, pen: 1 mm, method: gradient, rest: 0, "
                   "energies: {bend: 3}");
    expect_close(d->page.unit * d->page.height, 0.040, 1e-12);
    assert_true(d->relax.method == RELAX_GRADIENT && d->relax.rest == 0 && d->relax.weights.bend == 3 &&
                d->relax.weights.tone == 1);
    drawing_destroy(d);
}

/* A picture that is shown whole is all that is drawn on, in the middle: what a mask, a formula and strokes see of the
 * page, too. One that covers the page leaves the page as it is. */
static void shapes_of_pictures(void **state)
{
    (void)state;
    write_file("wide.pgm", "P2 4 1 255  0 90 180 255\n");
    static const double size[][2] = {{0.080, 0.020}, {0.060, 0.040}, {0.080, 0.060}, {0.040, 0.010}};
    static const char *const tones[] = {"{}", "{crop: [0, 0, 0.375, 1]}", "{fit: cover}", "{}"};
    for (int k = 0; k < 4; k++) {
        char entry[300];
        snprintf(entry, sizeof entry,
                 "image: wide.pgm, tone: %s, pen: %s, page: {size: [90 mm, %s], margin: 5 mm}", tones[k],
                 k == 3 ? "1 mm" : "0.5 mm",
                 k == 1   ? "50 mm"
                 : k == 3 ? "20 mm"
                          : "70 mm");
        Drawing *d = drawing_of(entry);
        const SplinePage *page = &d->page;
        expect_close(page->unit * page->width, size[k][0], 1e-15);
        expect_close(page->unit * page->height, size[k][1], 1e-15);
        expect_close(2 * page->left + size[k][0], page->paper[0], 1e-15);
        expect_close(2 * page->top + size[k][1], page->paper[1], 1e-15);
        expect_close(page->width * page->height, 1, 1e-14);
        expect_close(d->pens[0].width * page->unit, k == 3 ? 1e-3 : 0.5e-3, 1e-15);
        if (k != 2)
            expect_close(value_at(&d->parts[0].tone, page, 0.01, 0.02), 0.85, 1e-6); /* no blank beside it */
        drawing_destroy(d);
    }
    /* of a strip there is room for some lines */
    Drawing *d = drawing_of("image: wide.pgm, pen: 3 mm, page: {size: [80 mm, 80 mm], margin: 0}");
    expect_close(d->page.unit * d->page.height, 0.030, 1e-15);
    drawing_destroy(d);
}

/* All control points of what a plotter gets, within the picture. */
static void nothing_beside(void **state)
{
    (void)state;
    write_file("grey.pgm", "P2 2 1 255  100 200\n");
    Drawing *d = drawing_of(
        "image: grey.pgm, pen: 1 mm, page: {size: [90 mm, 130 mm], margin: 5 mm}, direction: 80 deg");
    SplineTarget *target;
    Strokes strokes = {0};
    drawing_begin(d, 0, 1, &strokes, &target);
    spline_relax(target, &d->relax, &strokes, NULL);
    Plot plot = spline_plot(&strokes, &d->page, d->pens, d->pen_count, d->paper);
    const PlotLayer *layer = &plot.layers[0];
    assert_true(layer->count > 30);
    for (int i = 0; i < layer->start[layer->count]; i++) {
        Vec2 p = layer->points[i]; /* 80 mm x 40 mm in the middle of the paper */
        assert_true(fabs(p.x - 45) < 40 && fabs(p.y - 65) < 20);
    }
    spline_plot_clear(&plot);
    strokes_clear(&strokes);
    spline_target_destroy(target);
    drawing_destroy(d);
}

/* As many iterations as fit into two seconds, and no rounds; fewer for more segments, ten at least. */
static void drafts(void **state)
{
    (void)state;
    static const struct {
        const char *pen;
        int least, most;
    } rows[] = {{"2 mm", 500, 500}, {"0.5 mm", 12, 60}, {"0.2 mm", 10, 10}};
    int before = 501;
    for (int k = 0; k < 3; k++) {
        char entry[100];
        snprintf(entry, sizeof entry, "density: 0.3, draft: true, rounds: 5, pen: %s", rows[k].pen);
        Drawing *d = drawing_of(entry);
        assert_true(d->draft && d->rounds == 0);
        assert_in_range(d->relax.max_iterations, rows[k].least, rows[k].most);
        assert_true(d->relax.max_iterations < before);
        before = d->relax.max_iterations;
        drawing_destroy(d);
    }
    Drawing *d = drawing_of("density: 0.3, draft: true, iterations: 7");
    assert_int_equal(d->relax.max_iterations, 7);
    drawing_destroy(d);
}

/* What a scene does not say is what the library takes. */
static void defaults(void **state)
{
    (void)state;
    Drawing *d = drawing_of("density: 0.5");
    RelaxDef relax = relax_default();
    SplineStartDef start = spline_start_default();
    assert_memory_equal(&d->relax.weights, &relax.weights, sizeof relax.weights);
    assert_true(d->relax.method == relax.method && d->relax.rest == relax.rest &&
                d->relax.seed == relax.seed && d->relax.max_iterations == relax.max_iterations &&
                d->relax.energy_tol == relax.energy_tol &&
                d->relax.temperature_first == relax.temperature_first &&
                d->relax.temperature_last == relax.temperature_last &&
                d->relax.temperatures == relax.temperatures && d->relax.sweeps == relax.sweeps &&
                d->relax.time_step == relax.time_step && d->relax.time_steps == relax.time_steps &&
                d->relax.damping == relax.damping && d->relax.model.pair_kernel == relax.model.pair_kernel &&
                d->relax.model.pair_radius == relax.model.pair_radius);
    assert_true(d->start.separation == start.separation && d->start.ink == start.ink &&
                d->start.longest == start.longest && d->start.segments == start.segments &&
                d->start.seed == start.seed);
    const Plotter *p = &d->plotter, q = plotter_default();
    assert_true(p->down == q.down && p->up == q.up && p->lift == q.lift && p->pause == q.pause);
    assert_true(p->z_up == q.z_up && p->z_down == q.z_down && p->z_speed == q.z_speed);
    assert_string_equal(p->servo_up, q.servo_up);
    assert_string_equal(p->servo_down, q.servo_down);
    drawing_destroy(d);
}

/* Formulas know metres and parts of the page; densities end at 0 and 1. */
static void formulas(void **state)
{
    (void)state;
    Drawing *d = drawing_of(
        "density: {formula: \"a + 0.2*v\", where: {a: \"4*(x - 0.02)\"}}, page: {size: [120 mm, 70 mm], "
        "margin: 10 mm}, pen: 0.5 mm, direction: {formula: [\"cos(2*u)\", \"sin(2*u)\"], turn: 30 deg}");
    for (double u = 0.05; u < 0.96; u += 0.1)
        for (double v = 0.1; v < 1; v += 0.2) {
            double want = fmin(fmax(4 * (0.1 * u - 0.02) + 0.2 * v, 0), 1);
            if (want > 0.02) expect_close(value_at(&d->tones[0], &d->page, u, v), want, 1e-4);
            SplineGrid along = spline_grid(&d->direction);
            Vec2 t =
                spline_direction_at(&along, &d->page, (Vec2){u * d->page.width, v * d->page.height}, NULL);
            expect_close(fabs(cos(2 * u + M_PI / 6) * t.x + sin(2 * u + M_PI / 6) * t.y), 1, 1e-4);
        }
    expect_close(value_at(&d->tones[0], &d->page, 0.01, 0.01), 0, 0);
    drawing_destroy(d);
}

/* Four pure inks side by side; black is the greatest density. */
static void inks(void **state)
{
    (void)state;
    write_file("inks.ppm", "P3 4 1 255  0 255 255  255 0 255  255 255 0  0 0 0\n");
    Drawing *d = drawing_of("image: inks.ppm, page: {size: [80 mm, 20 mm], margin: 0}, pen: 0.5 mm, "
                            "separation: cmyk, tone: {density: 0.8}");
    assert_true(d->pen_count == 4 && d->part_count == 4 && d->picture.width == 3);
    for (int pen = 0; pen < 4; pen++)
        for (int k = 0; k < 4; k++)
            expect_close(value_at(&d->tones[pen], &d->page, (k + 0.5) / 4, 0.5), pen == k ? 0.8 : 0, 0.02);
    expect_close(d->parts[0].turn, -M_PI / 6, 1e-12);
    expect_close(d->parts[2].turn, M_PI / 2, 1e-12);
    drawing_destroy(d);
    d = drawing_of("image: inks.ppm, page: {size: [80 mm, 20 mm], margin: 0}, separation: cmyk, pens: "
                   "[{name: black, width: 0.7 mm}, {name: cyan, color: \"#0080ff\", turn: 0}]");
    assert_true(d->pen_count == 2);
    expect_close(d->pens[1].color.g, 128 / 255.0, 1e-12);
    expect_close(d->parts[1].turn, 0, 0);
    expect_close(d->page.unit * d->parts[0].page.pen, 0.7e-3, 1e-15);
    expect_close(value_at(&d->tones[0], &d->page, 0.875, 0.5), 0.85, 0.02);
    drawing_destroy(d);
}

static void tones(void **state)
{
    (void)state;
    Drawing *d =
        drawing_of("density: \"u\", page: {size: [80 mm, 20 mm], margin: 0}, pen: 0.5 mm, separation: tones, "
                   "pens: [grey, {name: bold, from: 0.4, width: 1 mm}]");
    for (double u = 0.1; u < 0.96; u += 0.1) {
        if (fabs(u - 0.4) < 0.02) continue;
        expect_close(value_at(&d->tones[0], &d->page, u, 0.5), u < 0.4 ? u : 0, 1e-3);
        expect_close(value_at(&d->tones[1], &d->page, u, 0.5), u < 0.4 ? 0 : u, 1e-3);
    }
    expect_close(d->pens[1].color.r, 0, 0); /* a name that is no colour */
    expect_close(d->page.unit * d->parts[1].page.pen, 1e-3, 1e-15);
    expect_close(d->page.unit * d->page.pen, 0.5e-3, 1e-15);
    drawing_destroy(d);
}

/* Sets that cross cover together what was asked for, the second one only where it is dark. */
static void crossed(void **state)
{
    (void)state;
    Drawing *d = drawing_of(
        "density: \"0.9*u\", page: {size: [80 mm, 20 mm], margin: 0}, pen: 0.5 mm, direction: 20 deg, "
        "cross: {angle: 70 deg, from: [0, 0.3]}");
    assert_int_equal(d->part_count, 2);
    for (double u = 0.05; u < 0.96; u += 0.1) {
        double a = value_at(&d->parts[0].tone, &d->page, u, 0.5),
               b = value_at(&d->parts[1].tone, &d->page, u, 0.5);
        expect_close(1 - (1 - a) * (1 - b), 0.9 * u, 1e-4);
        if (0.9 * u < 0.29) expect_close(b, 0, 0);
    }
    expect_close(d->parts[1].turn - d->parts[0].turn, 70 * M_PI / 180, 1e-12);
    drawing_destroy(d);
}

/* The same bits with any number of threads. */
static void expect_same(const Drawing *d, int part, const Strokes *strokes, const SplineTarget *target)
{
    for (int threads = 2; threads <= 5; threads += 3) {
        Strokes again = {0};
        SplineTarget *other;
        drawing_begin(d, part, threads, &again, &other);
        size_t probes = (size_t)target->probes->size * sizeof(double);
        assert_int_equal(again.count, strokes->count);
        assert_memory_equal(again.q, strokes->q, 4 * (size_t)strokes_node_count(strokes) * sizeof(double));
        assert_int_equal(other->probes->size, target->probes->size);
        assert_memory_equal(other->probes->target, target->probes->target, probes);
        assert_memory_equal(other->probes->inverse, target->probes->inverse, probes);
        strokes_clear(&again);
        spline_target_destroy(other);
    }
}

/* Strokes start and have a target: all on the page, along their part's direction. */
static void starts(void **state)
{
    (void)state;
    static const char *const kinds[] = {"streamlines", "random"};
    for (int kind = 0; kind < 2; kind++) {
        char entry[300];
        snprintf(entry, sizeof entry,
                 "density: 0.4, page: {size: [60 mm, 40 mm]}, pen: 1 mm, direction: 10 deg, cross: {from: "
                 "[0, 0]}, start: %s",
                 kinds[kind]);
        Drawing *d = drawing_of(entry);
        for (int part = 0; part < 2; part++) {
            Strokes strokes = {0};
            SplineTarget *target;
            drawing_begin(d, part, 1, &strokes, &target);
            assert_true(strokes.count > 3);
            expect_close(strokes_length(&strokes) / spline_ink_budget(target), 1, 0.25);
            for (int i = 0; i < strokes_node_count(&strokes); i++) {
                const double *q = strokes.q + 4 * i, angle = (10 + 90 * part) * M_PI / 180;
                assert_true(q[0] >= 0 && q[0] <= d->page.width && q[1] >= 0 && q[1] <= d->page.height);
                expect_close(fabs(q[2] * cos(angle) + q[3] * sin(angle)) / hypot(q[2], q[3]), 1, 1e-6);
            }
            expect_same(d, part, &strokes, target);
            spline_target_destroy(target);
            strokes_clear(&strokes);
        }
        drawing_destroy(d);
    }
}

static void colors(void **state)
{
    (void)state;
    Color color;
    Error err = {""};
    assert_true(color_parse("#1A2b3c", &color, &err));
    expect_close(color.r, 0x1a / 255.0, 1e-12);
    expect_close(color.b, 0x3c / 255.0, 1e-12);
    assert_true(color_parse("black", &color, &err) && color.r == 0 && color.a == 1);
    static const char *const wrong[] = {"", "#12", "#12345g", "#1234567", "Black", "ultraviolet"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
        assert_false(color_parse(wrong[k], &color, &err));
    assert_non_null(strstr(err.text, "'ultraviolet' is no colour"));
}

/* Contours along outlines: half a line within the region, whose tone alone counts them; of crossed sets each a half. */
static void outline_contours(void **state)
{
    (void)state;
    write_file("circle.svg",
               "<svg xmlns='http://www.w3.org/2000/svg' width='70mm' height='70mm' viewBox='0 0 70 70'>"
               "<circle cx='35' cy='35' r='20'/></svg>");
    Drawing *d =
        drawing_of("density: 0.4, page: {size: [70 mm, 70 mm], margin: 5 mm}, pen: 0.6 mm, "
                   "regions: [{svg: circle.svg, fit: paper}], contours: {kind: outlines, width: 0.8 mm}, "
                   "cross: {angle: 90 deg, from: [0, 0]}");
    assert_true(d->contours.count == 1 && d->layer_count == 2 && d->pen_count == 1 && d->part_count == 2);
    for (int k = 0; k < strokes_node_count(&d->contours); k++) {
        const double *q = d->contours.q + 4 * k;
        double radius = d->page.unit * hypot(q[0] - d->page.width / 2, q[1] - d->page.height / 2);
        expect_close(radius, 0.020 - 0.0004, 5e-5);
    }
    for (int k = 0; k < 2; k++) {
        const SplineField *counts = &d->parts[k].counts;
        expect_close(*spline_field_pixel(counts, counts->rows / 2, counts->columns / 2), 0.5, 1e-12);
        expect_close(*spline_field_pixel(counts, 2, 2), 0, 1e-12);
    }
    drawing_destroy(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(pages, nothing_leaks),
                                       cmocka_unit_test_teardown(outline_contours, nothing_leaks),
                                       cmocka_unit_test_teardown(shapes_of_pictures, nothing_leaks),
                                       cmocka_unit_test_teardown(nothing_beside, nothing_leaks),
                                       cmocka_unit_test_teardown(drafts, nothing_leaks),
                                       cmocka_unit_test_teardown(defaults, nothing_leaks),
                                       cmocka_unit_test_teardown(formulas, nothing_leaks),
                                       cmocka_unit_test_teardown(inks, nothing_leaks),
                                       cmocka_unit_test_teardown(tones, nothing_leaks),
                                       cmocka_unit_test_teardown(crossed, nothing_leaks),
                                       cmocka_unit_test_teardown(starts, nothing_leaks),
                                       cmocka_unit_test_teardown(colors, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
