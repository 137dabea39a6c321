/* Metrics of drawings: exact coverage of simple strokes; the figures of the benchmark's script. */
#include "base/clock.h"
#include "spline/coverage.h"
#include "spline/metrics.h"
#include "spline/tone.h"
#include "spline_fixture.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <cmocka.h>

static void expect_near(const char *name, double value, double expected, double relative)
{
    print_message("  %-16s %.5f (%.5f)\n", name, value, expected);
    if (!(fabs(value - expected) <= relative * fabs(expected)))
        fail_msg("%s is %.6g, not %.6g", name, value, expected);
}

static double covered(const SplinePage *page, const Strokes *strokes)
{
    Coverage coverage = coverage_create(page, 40, 30);
    double sum = 0;
    coverage_draw(&coverage, strokes, page->pen);
    for (int k = 0; k < 40 * 30; k++) sum += coverage.mean[k] / (40 * 30);
    coverage_clear(&coverage);
    return sum;
}

/* A straight line of any direction covers its length times the pen, and a disc. */
static void lines_cover(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.14, 0.09, 0.005, 0.0006);
    double worst = 0;
    for (int k = 0; k < 24; k++) {
        double angle = 0.3 * k, c = 0.3 * cos(angle), s = 0.3 * sin(angle), x = 0.6 + 0.001 * k, y = 0.4;
        Strokes strokes = {0};
        strokes_add(&strokes, 2,
                    (const double[2][4]){{x - c, y - s, c / 2, s / 2}, {x + c, y + s, c / 2, s / 2}}, 0);
        double exact = 0.6 * page.pen + acos(-1) / 4 * page.pen * page.pen;
        worst = fmax(worst, fabs(covered(&page, &strokes) / exact - 1));
        strokes_add(&strokes, 2, /* on itself: counted once */
                    (const double[2][4]){{x - c, y - s, c / 2, s / 2}, {x + c, y + s, c / 2, s / 2}}, 0);
        worst = fmax(worst, fabs(covered(&page, &strokes) / exact - 1));
        strokes_clear(&strokes);
    }
    print_message("lines of 24 directions: ink within %.2g\n", worst);
    assert_true(worst < 1e-2);

    /* Half of it beyond the edge. */
    Strokes strokes = {0};
    double x = page.width / 2;
    strokes_add(&strokes, 2, (const double[2][4]){{x, -0.3, 0, 0.2}, {x, 0.3, 0, 0.2}}, 0);
    double half = covered(&page, &strokes) / (0.3 * page.pen + acos(-1) / 8 * page.pen * page.pen);
    print_message("half of a line: %.4f of it\n", half);
    assert_true(fabs(half - 1) < 1.5e-2);
    strokes_clear(&strokes);
    assert_true(covered(&page, &strokes) == 0);
}

/* The ink that probes of the same radius see, over the whole page: W's integral is 1. */
static double seen(const SplinePage *page, const Strokes *strokes)
{
    double density = 0.3, rest[2] = {1, 1}, sum = 0;
    ProbesDef probes_def = probes_default();
    SplineModelDef model_def = spline_model_default();
    SplineTarget *target =
        spline_target_create(page, &(SplineFields){.density = {1, 1, 1, &density}}, &probes_def);
    SplineModel *model = spline_model_create(target, strokes, rest, &model_def);
    SplinePoints points = spline_points_create(&model->rule, model->segment_count, spline_pen_cap(page));
    spline_points_update(&points, model, strokes->q);
    Tone tone = tone_create(target, NULL);
    tone_update(&tone, &points);
    for (int l = 0; l < target->probes->level_count; l++) {
        const ProbeLevel *level = &target->probes->levels[l];
        for (long k = level->first; k < level->first + (long)level->stride * level->rows; k++)
            sum += target->probes->inverse[k] > 0 ? level->dx * level->dy * tone.ink[k] : 0;
    }
    tone_clear(&tone);
    spline_points_clear(&points);
    spline_model_destroy(model);
    spline_target_destroy(target);
    return sum;
}

/* What the energy counts as ink is what the pen covers, round ends and all; of a dot too. */
static void ink_is_what_covers(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.14, 0.09, 0.005, 0.0006);
    for (int k = 0; k < 2; k++) {
        double c = k ? 0.1 * page.pen : 0.1, x = 0.6, y = 0.4;
        Strokes strokes = {0};
        strokes_add(&strokes, 3,
                    (const double[3][4]){
                        {x - c, y, c / 3, 0}, {x, y, c / 3, c / 9}, {x + c, y + c / 2, c / 3, c / 3}},
                    0);
        double area = page.pen * (strokes_length(&strokes) + 2 * spline_pen_cap(&page));
        expect_near("seen", seen(&page, &strokes), area, 5e-3);
        expect_near("covered", covered(&page, &strokes), area, k ? 0.05 : 0.01);
        strokes_clear(&strokes);
    }
}

/* Even hatching is a tone without error, away from where it is cut off. */
static void even_hatching(void **state)
{
    (void)state;
    enum { LINES = 40 };
    SplinePage page = spline_page(0.1, 0.1, 0, 0.001);
    double density = 0.4;
    SplineGrid target = {.columns = 1, .rows = 1, .width = 1, .values = &density};
    FixtureStrokes made = fixture_begin(LINES, 2 * LINES);
    for (int k = 0; k < LINES; k++) {
        double y = (k + 0.5) / LINES;
        fixture_node(&made, 0, y, 0.3, 0);
        fixture_node(&made, 1, y, 0.3, 0);
        fixture_end(&made, 0);
    }
    SplineJudge *judge = spline_judge_create(&page, &target);
    SplineMetrics m = spline_judge_measure(judge, &made.strokes);
    expect_near("ink", m.ink, 0.4, 1e-3);
    expect_near("ink length", m.ink_length, 40, 1e-9);
    expect_near("ink budget", m.ink_budget, 40, 1e-9);
    expect_near("spacing mean", m.spacing_mean, 1, 1e-3);
    expect_near("ssim", m.ssim, 1, 1e-3);
    expect_near("travel", m.travel_over_ink, 39 * hypot(1, 1.0 / LINES) / 40, 1e-9);
    print_message("  tone %.2g, spacing cv %.2g, crowded %g\n", m.tone_rmse, m.spacing_cv, m.crowded);
    assert_true(m.tone_rmse < 1e-3 && m.tone_scaled <= m.tone_rmse && m.spacing_cv < 1e-3 && m.crowded == 0);

    /* Every second line only: half of the ink; a factor puts it right. */
    for (int k = 0; k < LINES / 2; k++)
        for (int i = 0; i < 8; i++) made.strokes.q[8 * k + i] = made.strokes.q[16 * k + i];
    made.strokes.count = LINES / 2;
    m = spline_judge_measure(judge, &made.strokes);
    expect_near("half the ink", m.tone_rmse, 0.2, 0.02);
    assert_true(m.tone_scaled < m.tone_rmse);
    expect_near("spacing mean", m.spacing_mean, 2, 1e-3);

    Strokes none = {0};
    m = spline_judge_measure(judge, &none);
    expect_near("no ink", m.tone_rmse, 0.4, 1e-6);
    assert_true(m.ink_length == 0 && m.travel_over_ink == 0 && m.spacing_mean == 0 && m.spacing_cv == 0);
    spline_judge_destroy(judge);

    density = 0; /* a white target */
    judge = spline_judge_create(&page, &target);
    m = spline_judge_measure(judge, &none);
    assert_true(m.tone_rmse == 0 && m.ink_budget == 0);
    spline_judge_destroy(judge);
    strokes_clear(&made.strokes);
}

/* What the script says of a drawing. Its raster loses up to 5 % of the ink, more in some directions than in
 * others: strokes were drawn for it by librsvg, 72 (18) pixels per pen; everything else is as it was. */
typedef struct Script {
    const char *name;
    double pen;
    bool rings;
    SplineMetrics figures;
} Script;

static const Script scripts[] = {
    {"rings, wide pen",
     0.02,
     true,
     {9.68963, 10.74104, 0.21370, 0.21482, 0.00478, 0.00473, 0.99776, 0.54146, 0.54563, 0.36078, 0.45106}},
    {"walks, wide pen",
     0.02,
     false,
     {8.75601, 10.74104, 0.16601, 0.21482, 0.06283, 0.03944, 0.87745, 0.34971, 0.88622, 0.64000, 3.62990}},
    {"rings",
     0.005,
     true,
     {41.70125, 42.96414, 0.21356, 0.21482, 0.00534, 0.00529, 0.98900, 0.82994, 0.29937, 0.09386, 0.25864}},
    {"walks",
     0.005,
     false,
     {35.01738, 42.96414, 0.15733, 0.21482, 0.12506, 0.12149, 0.46946, 0.46073, 1.04554, 0.55069, 3.73577}},
};

static void as_the_script(void **state)
{
    (void)state;
    double *image = fixture_image();
    SplineGrid target = fixture_grid(image);
    for (size_t k = 0; k < sizeof scripts / sizeof *scripts; k++) {
        const Script *script = &scripts[k];
        SplinePage page = spline_page(0.1, 0.1, 0, 0.1 * script->pen);
        Strokes strokes = script->rings ? fixture_rings(page.pen, 0.6 * page.pen, 1)
                                        : fixture_walks(&page, (int)(1.5 / script->pen), 8, 0.015, 2);
        double start = clock_seconds();
        SplineJudge *judge = spline_judge_create(&page, &target);
        double created = clock_seconds(), tone = spline_judge_tone(judge, &strokes), toned = clock_seconds();
        SplineMetrics m = spline_judge_measure(judge, &strokes), s = script->figures;
        print_message("%s, pen %g, %d strokes: ready in %.1f ms, tone in %.1f ms, all in %.1f ms\n",
                      script->name, script->pen, strokes.count, 1e3 * (created - start),
                      1e3 * (toned - created), 1e3 * (clock_seconds() - toned));
        assert_true(tone == m.tone_rmse);
        expect_near("ink length", m.ink_length, s.ink_length, 1e-3);
        expect_near("ink budget", m.ink_budget, s.ink_budget, 1e-5);
        expect_near("ink", m.ink, s.ink, 0.01);
        expect_near("target", m.target, s.target, 1e-4);
        expect_near("tone rmse", m.tone_rmse, s.tone_rmse, 0.02);
        expect_near("best scale", m.tone_scaled, s.tone_scaled, 0.02);
        expect_near("ssim", m.ssim, s.ssim, 0.005);
        expect_near("spacing mean", m.spacing_mean, s.spacing_mean, 0.01);
        expect_near("spacing cv", m.spacing_cv, s.spacing_cv, 0.01);
        expect_near("crowded", m.crowded, s.crowded, 0.02);
        expect_near("travel", m.travel_over_ink, s.travel_over_ink, 1e-3);
        spline_judge_destroy(judge);
        strokes_clear(&strokes);
    }
    mem_free(image);
}

static int live(void **state)
{
    (void)state;
    return mem_live_count() == 0 ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(lines_cover), cmocka_unit_test(ink_is_what_covers),
                                       cmocka_unit_test(even_hatching), cmocka_unit_test(as_the_script)};
    return cmocka_run_group_tests(tests, NULL, live);
}
