/* Contours: edges and lines of equal tone where they are known, the ink that the tone counts of them, and whole runs. */
#include "base/cubic.h"
#include "base/memory.h"
#include "leaks.h"
#include "page_fixture.h"
#include "spline/along.h"
#include "spline/direction.h"
#include "spline/drawn.h"
#include "spline/edges.h"
#include "spline/streamlines.h"
#include "spline/tone.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAME "test_edges"

enum { SAMPLES = 8, PIXELS = 400, SUB = 4 };

static const SplinePage page = {.width = 1, .height = 1, .unit = 0.1, .paper = {0.1, 0.1}, .pen = 0.005};

static void expect_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.15g is not %.15g", value, expected);
}

static SplineEdgeDef usual(void)
{
    return (SplineEdgeDef){
        .detail = 0.01, .contrast = 0.1, .shortest = 0.05, .segment = 0.02, .margin = 0.0025};
}

/* Means over pixels of what is given at places. */
static SplineField field_of(double (*density)(double x, double y))
{
    SplineField field = spline_field_create(&page, 1.0 / PIXELS, 1);
    for (int i = 0; i < field.rows; i++)
        for (int j = 0; j < field.columns; j++)
            for (int k = 0; k < SUB * SUB; k++) {
                double x = (j + (k % SUB + 0.5) / SUB) / field.columns,
                       y = (i + (k / SUB + 0.5) / SUB) / field.rows;
                *spline_field_pixel(&field, i, j) += density(x, y) / (SUB * SUB);
            }
    return field;
}

static double step(double x, double y)
{
    (void)y;
    return x < 0.4075 ? 0.2 : 0.5;
}

static double slanted(double x, double y)
{
    return 0.8 * x + 0.6 * y < 0.7 ? 0.2 : 0.5;
}

static double disc(double x, double y)
{
    return hypot(x - 0.45, y - 0.5) < 0.25 ? 0.6 : 0.1;
}

static double ramp(double x, double y)
{
    return 0.1 + 0.5 * x + 0.2 * y;
}

/* A step of 0.3 in its upper part that fades to 0.08 downwards. */
static double fading(double x, double y)
{
    return x < 0.5 ? 0.2 : 0.5 - 0.22 * y;
}

typedef double Distance(double x, double y);

static double from_step(double x, double y)
{
    (void)y;
    return x - 0.4075;
}

static double from_slanted(double x, double y)
{
    return 0.8 * x + 0.6 * y - 0.7;
}

static double from_disc(double x, double y)
{
    return hypot(x - 0.45, y - 0.5) - 0.25;
}

static double from_level(double x, double y)
{
    return (ramp(x, y) - 0.4) / hypot(0.5, 0.2);
}

/* The farthest that strokes are from where they should be; not at the page's edges, where the blur mirrors. */
static double farthest(const Strokes *strokes, Distance *distance)
{
    double most = 0;
    for (int k = 0; k < strokes->count; k++)
        for (int node = strokes->start[k]; node < strokes->start[k + 1] - 1; node++)
            for (int i = 0; i <= SAMPLES; i++) {
                Vec2 c[4];
                strokes_bezier(strokes, node, c);
                Vec2 p = cubic_at(c, (double)i / SAMPLES);
                bool inside = fmax(fabs(p.x - 0.5), fabs(p.y - 0.5)) < 0.45;
                if (inside) most = fmax(most, fabs(distance(p.x, p.y)));
            }
    return most;
}

static Strokes edges_of(double (*density)(double x, double y), const SplineEdgeDef *def)
{
    SplineField tone = field_of(density);
    Strokes strokes = {0};
    spline_edge_strokes(&tone, &page, def, 3, &strokes);
    spline_field_clear(&tone);
    return strokes;
}

/* One line each, where the step is, from edge to edge of the page. */
static void steps_are_found(void **state)
{
    (void)state;
    const struct {
        double (*density)(double, double);
        Distance *distance;
        double length;
    } rows[] = {{step, from_step, 1}, {slanted, from_slanted, 1.25}};
    for (int k = 0; k < 2; k++) {
        SplineEdgeDef def = usual();
        Strokes strokes = edges_of(rows[k].density, &def);
        assert_int_equal(strokes.count, 1);
        assert_int_equal(strokes.layer[0], 3);
        assert_true(farthest(&strokes, rows[k].distance) < 0.03 * def.detail);
        expect_close(strokes_length(&strokes), rows[k].length, 0.04);
        strokes_clear(&strokes);
    }
}

/* A step of 0.3 is one of 0.3: less contrast finds it, more does not. Of one that fades, half the contrast is kept. */
static void contrast_is_the_height_of_steps(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        SplineEdgeDef def = usual();
        def.contrast = k % 2 ? 0.306 : 0.292;
        Strokes strokes = edges_of(k < 2 ? step : slanted, &def);
        assert_int_equal(strokes.count, k % 2 ? 0 : 1);
        strokes_clear(&strokes);
    }
    SplineEdgeDef def = usual();
    def.contrast = 0.25; /* half of it is where 0.3 - 0.22 y = 0.125 */
    Strokes strokes = edges_of(fading, &def);
    assert_int_equal(strokes.count, 1);
    expect_close(strokes_length(&strokes), (0.3 - 0.125) / 0.22, 0.03);
    strokes_clear(&strokes);
}

/* A ring that closes on itself without a bend; the blur moves it by detail^2/(2 radius) and no more. */
static void rings_close(void **state)
{
    (void)state;
    SplineEdgeDef def = usual();
    Strokes strokes = edges_of(disc, &def);
    assert_int_equal(strokes.count, 1);
    assert_true(farthest(&strokes, from_disc) < def.detail * def.detail / (2 * 0.25) + 1e-4);
    const double *first = strokes.q, *last = strokes.q + 4 * (strokes_node_count(&strokes) - 1);
    for (int k = 0; k < 4; k++) expect_close(first[k], last[k], 1e-15);
    expect_close(hypot(first[2], first[3]), def.segment / 3, 0.02 * def.segment);
    strokes_clear(&strokes);
}

static void levels_are_found(void **state)
{
    (void)state;
    SplineEdgeDef def = usual();
    SplineField tone = field_of(ramp);
    Strokes strokes = {0};
    spline_level_strokes(&tone, &page, &def, 0.4, 0, &strokes);
    assert_int_equal(strokes.count, 1);
    assert_true(farthest(&strokes, from_level) < 1e-5);
    strokes_clear(&strokes);
    spline_level_strokes(&tone, &page, &def, 0.9, 0, &strokes);
    assert_int_equal(strokes.count, 0);
    strokes_clear(&strokes);
    spline_field_clear(&tone);
}

/* Nothing outside of a region, nothing that is too short. */
static void margins_and_lengths(void **state)
{
    (void)state;
    SplineEdgeDef def = usual();
    SplineField outline = spline_field_create(&page, 1.0 / PIXELS, 1);
    for (int i = 0; i < outline.rows; i++)
        for (int j = 0; j < outline.columns; j++)
            *spline_field_pixel(&outline, i, j) = 0.6 - (i + 0.5) / outline.rows; /* above 0.6 */
    def.outline = spline_grid(&outline);
    Strokes strokes = edges_of(step, &def);
    assert_int_equal(strokes.count, 1);
    expect_close(strokes_length(&strokes), 0.6 - 2 * def.margin, 0.01);
    for (int k = 0; k < strokes_node_count(&strokes); k++)
        assert_true(strokes.q[4 * k + 1] < 0.6 - def.margin + 1e-9);
    strokes_clear(&strokes);
    def.shortest = 0.61;
    strokes = edges_of(step, &def);
    assert_int_equal(strokes.count, 0);
    spline_field_clear(&outline);
}

/* ---- The tone counts them ---- */

static SplineTarget *target_of(SplineField *tone, SplineField *direction)
{
    ProbesDef probes = probes_default();
    return spline_target_create(
        &page, &(SplineFields){.density = spline_grid(tone), .align = spline_grid(direction)}, &probes);
}

static Strokes line(double x0, double y0, double x1, double y1)
{
    Strokes strokes = {0};
    strokes_along((Vec2[]){{x0, y0}, {x1, y1}}, 2, 0.01, 0, &strokes);
    return strokes;
}

/* What is missing beside fixed strokes is what is missing with them among the others. */
static void ink_is_counted(void **state)
{
    (void)state;
    SplineField tone = field_of(ramp), direction = spline_direction_constant(&page, 0);
    SplineTarget *whole = target_of(&tone, &direction), *left = target_of(&tone, &direction);
    Strokes fixed = line(0.1, 0.3, 0.8, 0.6), others = line(0.2, 0.8, 0.9, 0.2), all = strokes_copy(&fixed);
    strokes_append(&all, &others, 0);
    SplineFixed counted = {.strokes = &fixed, .pen = page.pen};
    spline_fixed_take_ink(&counted, left);
    Tone together = tone_of_strokes(whole, &all, page.pen), beside = tone_of_strokes(left, &others, page.pen);
    for (long k = 0; k < whole->probes->size; k++) {
        if (whole->probes->inverse[k] == 0) continue; /* no probe */
        expect_close(together.ink[k] - whole->probes->target[k], beside.ink[k] - left->probes->target[k],
                     1e-12);
    }
    double length = strokes_length(&fixed) + 2 * spline_pen_cap(&page);
    expect_close(spline_ink_budget(whole) - spline_ink_budget(left), length, 1e-12);
    expect_close(spline_fixed_length(&counted, &page), length, 1e-12);
    SplineField half = spline_field_create(&page, 0.1, 1);
    for (int k = 0; k < half.columns * half.rows; k++) half.values[k] = k % half.columns < half.columns / 2;
    counted.counts = spline_grid(&half); /* to the left of 0.5 */
    expect_close(spline_fixed_length(&counted, &page), strokes_length(&fixed) * 4 / 7, 0.02);
    spline_field_clear(&half);
    tone_clear(&together);
    tone_clear(&beside);
    strokes_clear(&fixed);
    strokes_clear(&others);
    strokes_clear(&all);
    spline_target_destroy(whole);
    spline_target_destroy(left);
    spline_field_clear(&tone);
    spline_field_clear(&direction);
}

static double grey(double x, double y)
{
    (void)x, (void)y;
    return 0.2;
}

/* Streamlines across a fixed line end before it, and beside one along them they keep their distance. */
static void streamlines_keep_away(void **state)
{
    (void)state;
    SplineField tone = field_of(grey), direction = spline_direction_constant(&page, 0);
    SplineGrid density = spline_grid(&tone), along = spline_grid(&direction);
    double spacing = page.pen / 0.2;
    for (int k = 0; k < 2; k++) {
        Strokes fixed = k ? line(0.503, 0.1, 0.503, 0.9) : line(0.1, 0.503, 0.9, 0.503), strokes = {0};
        SplineStartDef def = spline_start_default();
        def.fixed = (SplineFixed){.strokes = &fixed, .pen = page.pen};
        spline_streamlines(&density, &along, &page, &def, 0, &strokes);
        assert_true(strokes.count > 10);
        for (int node = 0; node < strokes_node_count(&strokes); node++) {
            const double *p = strokes.q + 4 * node;
            double beyond = k ? fmax(fmax(0.1 - p[1], p[1] - 0.9), 0) : fmax(fmax(0.1 - p[0], p[0] - 0.9), 0);
            assert_true(hypot(k ? p[0] - 0.503 : p[1] - 0.503, beyond) > 0.6 * spacing);
        }
        double ink = strokes_length(&strokes) + 2 * strokes.count * spline_pen_cap(&page);
        expect_close(ink + spline_fixed_length(&def.fixed, &page), 0.2 / page.pen, 2);
        strokes_clear(&strokes);
        strokes_clear(&fixed);
    }
    spline_field_clear(&tone);
    spline_field_clear(&direction);
}

/* ---- Whole runs ---- */

#define SCENE                                                                                                \
    "slender: 1\njob: draw\nspline:\n  density: {formula: \"d < 0.3 ? 0.5 : 0.15\", where: {d: "             \
    "\"sqrt((u-0.5)^2 + (v-0.5)^2)\"}}\n"                                                                    \
    "  direction: 30 deg\n  page: {size: [70 mm, 70 mm], margin: 5 mm}\n  pen: 0.6 mm\n  rounds: 1\n"        \
    "  contours: {kind: edges, width: 0.9 mm, color: red, opaque: true}\n"

static double number_of(Result *result, const char *path)
{
    Array array;
    Error err;
    if (!result_read(result, path, &array, &err)) fail_msg("%s", err.text);
    double value = *(const double *)array.data;
    array_clear(&array);
    return value;
}

/* A ring of its own layer and pen, where it was found, and with it the tone of the picture. */
static void runs(void **state)
{
    (void)state;
    Drawn drawn;
    Error err;
    page_run(NAME, SCENE);
    Result *result = result_open(NAME ".vtkhdf", &err);
    assert_true(result && drawn_read(result, &drawn, &err));
    assert_int_equal(drawn.pen_count, 2);
    assert_string_equal(drawn.pens[1].name, "contours");
    assert_true(drawn.pens[1].opaque && !drawn.pens[0].opaque);
    expect_close(drawn.pens[1].width * drawn.page.unit, 0.9e-3, 1e-9);
    const Strokes *strokes = &drawn.strokes;
    assert_true(strokes->layer[strokes->count - 1] == 1 && strokes->layer[strokes->count - 2] == 0);
    double radius = 0.3 * drawn.page.width, length = strokes_stroke_length(strokes, strokes->count - 1);
    for (int node = strokes->start[strokes->count - 1]; node < strokes_node_count(strokes); node++) {
        const double *p = strokes->q + 4 * node;
        expect_close(hypot(p[0] - drawn.page.width / 2, p[1] - drawn.page.height / 2), radius, 2e-3);
    }
    expect_close(number_of(result, "slender/metrics/contour_length"), drawn.page.unit * length, 1e-6);
    expect_close(length, 2 * M_PI * radius, 0.01);
    assert_true(number_of(result, "slender/metrics/tone_rmse") < 0.02);
    drawn_clear(&drawn);
    result_close(result);
    page_remove_files(NAME);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(steps_are_found, nothing_leaks),
        cmocka_unit_test_teardown(contrast_is_the_height_of_steps, nothing_leaks),
        cmocka_unit_test_teardown(rings_close, nothing_leaks),
        cmocka_unit_test_teardown(levels_are_found, nothing_leaks),
        cmocka_unit_test_teardown(margins_and_lengths, nothing_leaks),
        cmocka_unit_test_teardown(ink_is_counted, nothing_leaks),
        cmocka_unit_test_teardown(streamlines_keep_away, nothing_leaks),
        cmocka_unit_test_teardown(runs, nothing_leaks),
    };
    return cmocka_run_group_tests_name("edges", tests, NULL, NULL);
}
