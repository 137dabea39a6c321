/* Charts over stages and time: of probes, of currents that a trajectory looks for, and the moments that a page shows. */
#include "base/memory.h"
#include "page_fixture.h"
#include "view/show_motion.h"
#include "view/show_probes.h"
#include <math.h>
#include <string.h>

#define NAME "test_show_charts"
#define SHEET                                                                                                \
    "shell:\n  mesh: {shape: sheet, size: [30 mm, 10 mm], cells: [4, 2]}\n  thickness: 1 mm\n"               \
    "  young: 0.1 MPa\n  poisson: 0.3\n  density: 1000\n  magnetization: [5.0e+4, 0, 0]\n"                   \
    "fix: [{group: root, clamp: true}]\n"

enum { CHARTS = 3 };

static ShowData open_data(const ShowDef *def)
{
    ShowData data = {0};
    Error err;
    if (!show_data_open(&data, NAME ".vtkhdf", def, &err)) fail_msg("%s", err.text);
    return data;
}

/* A tip that goes up, a distance that stays, and a mean along y and a force that are rounding. */
static void test_probes(void **state)
{
    (void)state;
    page_run(NAME,
             "slender: 1\njob: equilibrium\n" SHEET
             "sequence: {flux_density: {from: [0, 0, 0], to: [0, 0, 2 mT], count: 3}}\n"
             "probes: {tip: {height: tip}, side: {distance: [\"0\", \"5\"]}, pull: {force: root}, none: "
             "{distance: [\"3\", \"3\"]}, turn: {angle: [\"0\", \"3\"], axis: [0, 0, 1]}}\n");
    ShowDef def = show_default();
    ShowData data = open_data(&def);
    Chart charts[CHARTS];
    int count = show_probes_charts(&data, charts, CHARTS);
    assert_int_equal(count, 2);   /* places and angles: what holds it is rounding */
    for (int k = 0; k < 2; k++) { /* what the stages differ by counts them */
        assert_true(!charts[k].x_counts && !strcmp(charts[k].x_label, "flux density"));
        assert_true(!strcmp(charts[k].x_unit, "T") && fabs(charts[k].series[0].x[1] - 1e-3) < 1e-15);
    }
    assert_true(!strcmp(charts[0].y_unit, "m") && !strcmp(charts[1].y_unit, "rad"));
    bool side = false, none = false, tip = false;
    assert_int_equal(charts[0].series_count, 3);
    for (int k = 0; k < 3; k++) {
        const ChartSeries *series = &charts[0].series[k];
        assert_int_equal(series->count, 3);
        double change = fabs(series->y[2] - series->y[0]);
        if (!strcmp(series->name, "tip")) tip = change > 1e-4;
        if (!strcmp(series->name, "side")) side = fabs(series->y[0] - 0.005) < 1e-9;
        if (!strcmp(series->name, "none")) none = series->y[0] == 0 && change == 0;
    }
    assert_true(tip && side && none);
    show_data_clear(&data);
}

/* A field along two directions is no number, nor is one beside another thing that changes: stages count the rows. */
static void test_stages(void **state)
{
    (void)state;
    static const char *const sequences[] = {
        "sequence: [{flux_density: [0, 0, 1 mT]}, {flux_density: [0, 1 mT, 0]}]\n",
        "sequence: [{flux_density: [0, 0, 1 mT]}, {flux_density: [0, 0, 2 mT], gravity: [0, 0, -1]}]\n",
        "sequence: [{gravity: [0, 0, -1]}, {gravity: [0, 0, -2]}]\n"};
    static const char *const labels[] = {"stage", "stage", "gravity"};
    for (int k = 0; k < 3; k++) {
        char *text = mem_format("slender: 1\njob: equilibrium\n%s%s%s", SHEET, sequences[k],
                                "probes: {tip: {height: tip}}\n");
        page_run(NAME, text);
        ShowDef def = show_default();
        ShowData data = open_data(&def);
        Chart chart;
        assert_int_equal(show_probes_charts(&data, &chart, 1), 1);
        assert_string_equal(chart.x_label, labels[k]);
        assert_true(chart.x_counts == (k < 2) && (k < 2 || chart.series[0].x[1] == -2));
        show_data_clear(&data);
        mem_free(text);
    }
}

/* Two currents over time, by their coils' names; a third one, which stays, has no line. */
static void test_currents(void **state)
{
    (void)state;
    page_run(
        NAME,
        "slender: 1\njob: trajectory\n" SHEET
        "flux_density:\n  - {name: left, coil: {at: [20 mm, 5 mm, -20 mm], radius: 9 mm, current: 30}}\n"
        "  - {name: right, coil: {at: [45 mm, 5 mm, 12 mm], axis: [1, 0, 0], radius: 9 mm, current: 30}}\n"
        "  - {name: far, coil: {at: [0, 0, 90 mm], radius: 9 mm, current: 1}}\n"
        "time: {step: 2 ms, steps: 8}\noutput: {every: 2}\n"
        "design:\n  unknowns: {source_strength: {sources: [left, right], per: frame, bounds: [-9, 9]}}\n"
        "  optimizer: gauss_newton\n  iterations: 2\n"
        "  objectives: [{waypoint: {vertex: tip, at: [28 mm, 5 mm, 3 mm]}}]\n");
    ShowDef def = show_default();
    ShowData data = open_data(&def);
    ShowMotion motion;
    Chart charts[SHOW_MOTION_CHARTS];
    Error err;
    assert_true(show_motion_read(&motion, &data, &err));
    int count = show_motion_charts(&motion, charts);
    const Chart *chart = &charts[count - 1];
    const double *rows = show_dataset(&data, "slender/trajectory/source_strength", ARRAY_FLOAT64, 8 * 2);
    assert_non_null(rows);
    assert_string_equal(chart->y_label, "strength of sources");
    assert_int_equal(chart->series_count, 2);
    assert_string_equal(chart->series[0].name, "left");
    assert_string_equal(chart->series[1].name, "right");
    for (int n = 0; n < 8; n++)
        for (int s = 0; s < 2; s++) {
            assert_true(chart->series[s].y[n] == rows[2 * n + s]);
            assert_float_equal(chart->series[s].x[n], 2e-3 * (n + 1), 1e-12);
        }
    show_data_clear(&data);
}

static int count_of(const char *text, const char *what)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, what)); at++) count++;
    return count;
}

/* A line in the chart of a rod's probes at each of the moments beside it. */
static void test_stills(void **state)
{
    (void)state;
    page_run(NAME,
             "slender: 1\njob: simulate\nrod: {natural_strain: [0, 0, 0], length: 0.1, elements: 8, radius: "
             "1 mm, young: 1 MPa, poisson: 0.4, density: 1000, gravity: [0, 0, -10]}\n"
             "time: {step: 5 ms, steps: 4}\nprobes: {tip: {height: tip}}\n");
    ShowDef def = show_default();
    Error err;
    if (show_result(NAME ".vtkhdf", NAME ".svg", &def, &err) != SHOW_DONE) fail_msg("%s", err.text);
    char *svg = page_text(NAME ".svg");
    assert_int_equal(count_of(svg, "rgb(50%,50%,52%)"), 5);
    mem_free(svg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_probes), cmocka_unit_test(test_stages),
                                       cmocka_unit_test(test_currents), cmocka_unit_test(test_stills)};
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    page_remove_files(NAME);
    unlink(NAME ".svg");
    unlink(NAME "_probes.csv");
    return failed;
}
