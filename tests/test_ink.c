/* Colours that inks make on paper: what meets by chance, in closed form; distances against published ones; and how much
 * of each ink makes a colour, against closed forms, itself and a search. */
#include "base/memory.h"
#include "drawing_fixture.h"
#include "spline/ink.h"
#include "spline/ink_seen.h"
#include "spline/ink_table.h"
#include <math.h>

static void expect_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.15g is not %.15g", value, expected);
}

static void expect_color(Vec3 value, Vec3 expected, double tolerance)
{
    expect_close(value.x, expected.x, tolerance);
    expect_close(value.y, expected.y, tolerance);
    expect_close(value.z, expected.z, tolerance);
}

static const Vec3 white = {1, 1, 1}, black = {0, 0, 0};

/* Four inks that are no pure ones, the third of them opaque. */
static const Ink four[] = {
    {{0.05, 0.4, 0.8}, false}, {{0.8, 0.1, 0.3}, false}, {{0.9, 0.85, 0.2}, true}, {{0.1, 0.1, 0.12}, false}};

/* The mean over all the ways in which inks meet, by Demichel's probabilities. */
static Vec3 by_meetings(const InkSet *set, const double *cover)
{
    Vec3 sum = black;
    for (int meet = 0; meet < 1 << set->count; meet++) {
        Vec3 color = set->paper;
        double part = 1;
        for (int k = 0; k < set->count; k++) {
            const Vec3 c = set->inks[k].color;
            bool there = meet >> k & 1;
            part *= there ? cover[k] : 1 - cover[k];
            if (there) color = set->inks[k].opaque ? c : vec3(color.x * c.x, color.y * c.y, color.z * c.z);
        }
        sum = vec3_axpy(part, color, sum);
    }
    return sum;
}

static void meetings(void **state)
{
    (void)state;
    InkSet set = {vec3(0.9, 0.8, 0.7), 4, four, 1};
    for (int n = 0; n < 50; n++) {
        double cover[4];
        for (int k = 0; k < 4; k++) cover[k] = (7919 * (4 * n + k + 1) % 1000) / 999.0;
        expect_color(ink_mix(&set, cover), by_meetings(&set, cover), 1e-15);
    }
}

/* sRGB's red, green and blue in CIELAB are (53.24, 80.09, 67.20), (87.73, -86.18, 83.18) and (32.30, 79.19, -107.86), grey
 * of half its levels has L* 53.39. */
static void distances(void **state)
{
    (void)state;
    double half = color_linear(0.5);
    expect_close(half, 0.21404114, 1e-8);
    expect_close(color_linear(0.04), 0.04 / 12.92, 1e-15);
    expect_close(ink_difference(white, black), 100, 1e-4);
    expect_close(ink_difference(black, vec3(half, half, half)), 53.39, 0.005);
    expect_close(ink_difference(vec3(1, 0, 0), vec3(0, 1, 0)),
                 sqrt(pow(53.24 - 87.73, 2) + pow(80.09 + 86.18, 2) + pow(67.20 - 83.18, 2)), 0.02);
    expect_close(ink_difference(vec3(0, 0, 1), black), sqrt(pow(32.30, 2) + pow(79.19, 2) + pow(107.86, 2)),
                 0.02);
    expect_close(ink_difference(vec3(1e-3, 1e-3, 1e-3), black), 0.9033, 1e-3); /* 903.3 Y, near black */
}

/* One ink makes what lies between it and the paper: R = (1 - a) paper + a coat; what is beyond takes as much as is
 * allowed, or none. Black on white, white paint on black, a transparent ink on cream. */
static void single(void **state)
{
    (void)state;
    const Vec3 cream = {0.9, 0.8, 0.6};
    const struct {
        Vec3 paper, coat;
        Ink ink;
    } rows[] = {{white, black, {black, false}},
                {black, white, {white, true}},
                {cream, {0.45, 0.08, 0.3}, {{0.5, 0.1, 0.5}, false}},
                {{0.02, 0.02, 0.05}, {0.8, 0.7, 0.1}, {{0.8, 0.7, 0.1}, true}}};
    for (int k = 0; k < 4; k++) {
        InkSet set = {rows[k].paper, 1, &rows[k].ink, 0.85};
        double cover;
        for (double part = 0; part <= 1; part += 0.0625) {
            Vec3 way = vec3_sub(rows[k].coat, rows[k].paper);
            ink_match(&set, vec3_axpy(part, way, rows[k].paper), &cover);
            expect_close(cover, fmin(part, 0.85), 1e-3); /* less ink counts a little */
        }
    }
}

/* Inks that each take away one of red, green and blue: a = (1 - R)/(1 - T) of each, whatever the others do. A black one
 * that does the same as all three takes their place: squares of 0.5 - a spread over four. */
static void separable(void **state)
{
    (void)state;
    const Ink inks[] = {{{0.1, 1, 1}, false}, {{1, 0.2, 1}, false}, {{1, 1, 0.05}, false}, {black, false}};
    InkSet set = {white, 3, inks, 0.9};
    double cover[4];
    for (int n = 0; n < 60; n++) {
        double want[3];
        for (int k = 0; k < 3; k++) want[k] = 0.9 * (6151 * (3 * n + k + 1) % 1000) / 999.0;
        ink_match(&set, vec3(1 - 0.9 * want[0], 1 - 0.8 * want[1], 1 - 0.95 * want[2]), cover);
        for (int k = 0; k < 3; k++) expect_close(cover[k], want[k], 2e-3);
    }
    set.count = 4;
    ink_match(&set, vec3(0.4, 0.4, 0.4), cover);
    assert_true(cover[3] > 0.4 && cover[3] < 0.6);
    expect_color(ink_mix(&set, cover), vec3(0.4, 0.4, 0.4), 1e-3);
}

/* No mixture of a fine grid is nearer; what inks have made is made again, with no more ink. */
static void nearest(void **state)
{
    (void)state;
    enum { GRID = 12 };
    InkSet set = {vec3(0.95, 0.95, 0.9), 4, four, 0.85};
    for (int n = 0; n < 40; n++) {
        double want[3], cover[4], ink = 0, given = 0, grid[4], least = INFINITY;
        for (int k = 0; k < 3; k++) want[k] = (4241 * (3 * n + k + 1) % 1000) / 999.0;
        Vec3 color = vec3(want[0], want[1], want[2]);
        ink_match(&set, color, cover);
        for (int k = 0; k < 4; k++) assert_true(cover[k] >= 0 && cover[k] <= 0.85);
        for (int i = 0; i < GRID * GRID * GRID * GRID; i++) {
            for (int k = 0, rest = i; k < 4; k++, rest /= GRID) grid[k] = 0.85 * (rest % GRID) / (GRID - 1);
            least = fmin(least, ink_difference(ink_mix(&set, grid), color));
        }
        assert_true(ink_difference(ink_mix(&set, cover), color) < least + 0.1);
        for (int k = 0; k < 4; k++) grid[k] = 0.85 * (2503 * (4 * n + k + 1) % 1000) / 999.0;
        color = ink_mix(&set, grid);
        ink_match(&set, color, cover);
        assert_true(ink_difference(ink_mix(&set, cover), color) < 1);
        for (int k = 0; k < 4; k++) ink += cover[k] * cover[k], given += grid[k] * grid[k];
        assert_true(ink <= given * 1.001);
    }
}

/* Between its nodes a table is as good as nobody sees; white and black go where the inks can, and greys between them
 * by their light. */
static void tables(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 5e-4);
    InkSet set = {vec3(0.95, 0.95, 0.9), 4, four, 0.85};
    SplineField dark = spline_field_create(&page, 0.05, 3), cover[4], grey[1];
    size_t pixels = (size_t)dark.columns * (size_t)dark.rows;
    double worst = 0, mean = 0;
    for (size_t i = 0; i < 3 * pixels; i++) dark.values[i] = (i * 7919 % 1000) / 999.0;
    ink_table_cover(&set, INK_ABSOLUTE, &dark, cover);
    for (size_t i = 0; i < pixels; i++) {
        const double *d = dark.values + 3 * i;
        double got[4], best[4];
        Vec3 color = ink_linear((Color){1 - d[0], 1 - d[1], 1 - d[2], 1});
        ink_match(&set, color, best);
        for (int k = 0; k < 4; k++) got[k] = cover[k].values[i];
        double more = ink_difference(ink_mix(&set, got), color) - ink_difference(ink_mix(&set, best), color);
        worst = fmax(worst, more), mean += more / (double)pixels;
    }
    print_message("more than the nearest colour's: %.3f on the mean, %.3f at most\n", mean, worst);
    assert_true(worst < 1.5 && mean < 0.3);
    for (int k = 0; k < 4; k++) spline_field_clear(&cover[k]);

    InkSet paint = {vec3(0.01, 0.01, 0.01), 1, &(Ink){{0.8, 0.8, 0.8}, true}, 0.7};
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < 3; c++) dark.values[3 * i + (size_t)c] = 1 - (double)(i % 33) / 32;
    ink_table_cover(&paint, INK_RELATIVE, &dark, grey);
    for (size_t i = 0; i < pixels; i++)
        expect_close(grey->values[i], 0.7 * color_linear((double)(i % 33) / 32), 2e-3);
    spline_field_clear(grey);
    spline_field_clear(&dark);
}

/* Lines of two pens across each other, from edge to edge, have the colour that covered parts of 1/2 and 1/3 make, by
 * both kinds of ink; from another colour they are as far as that is. */
static void seen(void **state)
{
    (void)state;
    enum { ACROSS = 25, DOWN = 50 };
    SplinePage page = spline_page(0.1, 0.1, 0, 1e-3);
    const double widths[] = {page.pen, 4.0 / 3 * page.pen}, cover[] = {0.5, 1.0 / 3};
    Strokes strokes = {0};
    for (int k = 0; k < DOWN; k++) {
        double y = (k + 0.5) / DOWN;
        strokes_add(&strokes, 2, (const double[2][4]){{0, y, 1.0 / 3, 0}, {1, y, 1.0 / 3, 0}}, 0);
    }
    for (int k = 0; k < ACROSS; k++) {
        double x = (k + 0.5) / ACROSS;
        strokes_add(&strokes, 2, (const double[2][4]){{x, 0, 0, 1.0 / 3}, {x, 1, 0, 1.0 / 3}}, 1);
    }
    for (int first = 0; first < 3; first++) { /* none is opaque, or the second, or the first */
        InkSet set = {vec3(0.9, 0.8, 0.7), 2, four + first, 1};
        SplineField light = spline_field_create(&page, 0.02, 3);
        Vec3 mixed = ink_mix(&set, cover);
        expect_close(ink_seen_error(&set, &page, widths, &strokes, &light), ink_difference(mixed, set.paper),
                     1);
        for (int i = 0; i < light.columns * light.rows; i++)
            vec3_store(light.values + 3 * i, vec3_sub(mixed, set.paper));
        assert_true(ink_seen_error(&set, &page, widths, &strokes, &light) < 0.5);
        spline_field_clear(&light);
    }
    strokes_clear(&strokes);
}

/* A picture of pure colours by pens in these colours on black paper; beside a strip the paper stays as it is. */
static void scenes(void **state)
{
    (void)state;
    write_file("lights.ppm", "P3 4 1 255  255 0 0  0 255 0  255 255 255  0 0 0\n");
    Drawing *d = drawing_of("image: lights.ppm, page: {size: [80 mm, 20 mm], margin: 0}, pen: 0.5 mm, "
                            "separation: {kind: match, intent: "
                            "absolute}, paper: black, tone: {density: 0.8}, pens: [{name: r, color: "
                            "\"#ff0000\", opaque: true}, {name: g, "
                            "color: \"#00ff00\", opaque: true}, {name: white, opaque: true}]");
    assert_true(d->pen_count == 3 && d->part_count == 3 && d->picture.width == 3 && d->paper.r == 0);
    for (int pen = 0; pen < 3; pen++) {
        expect_close(d->parts[pen].turn, pen * M_PI / 3, 1e-15);
        for (int k = 0; k < 4; k++) {
            SplineGrid grid = spline_grid(&d->tones[pen]);
            double value;
            spline_grid_sample(&grid, &d->page, (Vec2){(k + 0.5) / 4 * d->page.width, 0.5 * d->page.height},
                               &value);
            if (k == 3 || (pen == 2 && k < 2) || (k < 2 && pen != k)) expect_close(value, 0, 0.02);
            if (pen == k) expect_close(value, 0.8, 0.02);
        }
    }
    drawing_destroy(d);
    d = drawing_of("image: lights.ppm, page: {size: [80 mm, 20 mm], margin: 0}, separation: match, pens: "
                   "[red, blue], contours: edges");
    assert_true(d->layer_count == 3 && !d->pens[2].opaque); /* black, as no colour is said */
    assert_true(d->pens[2].color.r == 0 && d->pens[2].color.g == 0 && d->pens[2].color.b == 0);
    drawing_destroy(d);
    write_file("strip.ppm", "P3 40 1 255 " /* of ten pens there is room: blank above and below */);
    FILE *file = fopen("strip.ppm", "a");
    for (int k = 0; k < 40; k++) fputs(" 255 255 255", file);
    fclose(file);
    d = drawing_of("image: strip.ppm, page: {size: [80 mm, 80 mm], margin: 0}, pen: 1 mm, separation: match, "
                   "paper: black, pens: [{name: white, opaque: true}]");
    SplineGrid grid = spline_grid(&d->tones[0]);
    expect_close(spline_grid_mean(&grid, 0), 0.85 * 2 / 10, 0.02);
    drawing_destroy(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(meetings, nothing_leaks),
                                       cmocka_unit_test_teardown(distances, nothing_leaks),
                                       cmocka_unit_test_teardown(single, nothing_leaks),
                                       cmocka_unit_test_teardown(separable, nothing_leaks),
                                       cmocka_unit_test_teardown(nearest, nothing_leaks),
                                       cmocka_unit_test_teardown(tables, nothing_leaks),
                                       cmocka_unit_test_teardown(seen, nothing_leaks),
                                       cmocka_unit_test_teardown(scenes, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
