/* slender report: charts, and what frames are called. */
#include "report/report.h"
#include "tests/leaks.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define NAME "test_report_charts"
#include "tests/run_fixture.h"
#include "tests/report_fixture.h"

#define RESULT NAME ".vtkhdf"
#define HTML   NAME ".html"

static Page report(int frames)
{
    return page_of(RESULT, HTML, frames);
}

static const char SHEET[] =
    "slender: 1\njob: simulate\nshell:\n  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [8, 4]}\n"
    "  thickness: 1 mm\n  poisson: 0.3\n  density: 1000\n  magnetization: [1.0e+4, 0, 0]\n"
    "  young: {formula: \"x < 0.02 ? 1e5 : 1e6\"}\n  gravity: [0, 0, -9.81]\nfix: [{group: root, clamp: "
    "true}]\n"
    "time: {step: 5 ms, steps: 6}\n";

/* The y of a line of the chart that has this label. */
static const char *line_of(const char *json, const char *label, const char *name)
{
    char key[80];
    snprintf(key, sizeof key, "\"y\":{\"label\":\"%s\"", label);
    const char *chart = strstr(json, key);
    assert_non_null(chart);
    snprintf(key, sizeof key, "\"name\":\"%s\"", name);
    chart = strstr(chart, key);
    assert_non_null(chart);
    return after(chart, "y") + 1;
}

/* Energies of a motion go to those of its end; what the water takes is the sum of all steps. */
static void test_energies(void **unused)
{
    (void)unused;
    Result *result = run_text(mem_format("%swater: {density: 1000}\n", SHEET));
    Page page = report(0);
    Array bending = read_all(result, "slender/final/energy/bending"),
          work = read_all(result, "slender/history/water_work");
    const char *y = line_of(page.json, "energy", "bending"),
               *taken = line_of(page.json, "energy taken", "water");
    double energy = NAN, sum = 0, first = strtod(y, NULL);
    char *rest;
    for (int k = 0; k < 7; k++, y = rest + 1) energy = strtod(y, &rest);
    assert_int_equal(*rest, ']');
    assert_true(first == 0 && fabs(energy / *(double *)bending.data - 1) < 1e-5);
    for (int k = 0; k < 6; k++, taken = rest + 1) {
        sum += ((double *)work.data)[k];
        assert_true(fabs(strtod(taken, &rest) - sum) <= 1e-6 * fabs(sum));
    }
    assert_true(*rest == ']' && sum != 0);
    array_clear(&bending);
    array_clear(&work);
    page_clear(&page);
    result_close(result);
}

/* Frames of a sequence are called after what it changes; its energies are a chart. */
static void test_stages(void **unused)
{
    (void)unused;
    Result *result = run_text(mem_format(
        "slender: 1\njob: equilibrium\nshell:\n  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [4, 2]}\n"
        "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n  magnetization: [1.0e+4, 0, 0]\n"
        "fix: [{group: root, clamp: true}]\n"
        "probes: {tip: {group: tip}}\n"
        "sequence: {flux_density: {from: [0, 0, 0], to: [0, 0, 1 mT], count: 3}}\n"));
    Page page = report(2);
    assert_non_null(strstr(page.json, "\"stages\":[0,2]"));
    const char *probed = strstr(page.json, "{\"x\":{\"label\":\"flux density\",\"unit\":\"T\"}");
    assert_non_null(probed);
    assert_int_equal(strncmp(after(probed, "of_stages"), "true", 4), 0);
    page_clear(&page);
    page = report(0);
    assert_non_null(strstr(page.json, "\"labels\":[\"stage 0: 0 T\",\"stage 1: 500 µT\",\"stage 2: 1 mT\"]"));
    Array energy = read_all(result, "slender/stages/energy/bending");
    const char *chart = strstr(page.json, "\"y\":{\"label\":\"energy\",\"unit\":\"J\"}");
    assert_non_null(chart);
    const char *y = after(strstr(chart, "\"name\":\"bending\""), "y");
    char *rest;
    for (int k = 0; k < 3; k++, y = rest) {
        double is = ((double *)energy.data)[k], got = strtod(y + 1, &rest);
        assert_true(fabs(got - is) <= 1e-6 * fabs(is));
    }
    array_clear(&energy);
    page_clear(&page);
    result_close(result);
}

/* Each after what changes from the one before: the field and where it points to, the time, gravity, the part of a load. */
static void test_names(void **unused)
{
    (void)unused;
    static const struct {
        const char *scene, *labels;
    } rows[] = {
        {"sequence:\n  - {flux_density: [0, 0, 1 mT]}\n  - {flux_density: [0.6 mT, 0, 0.8 mT], time: 1}\n"
         "  - {time: 3}\n  - {loads: [{force: [0, 0, 1.0e-6], on: {group: tip}}]}\n  - {gravity: [0, 0, "
         "-1]}\n",
         "[\"stage 0: 1 mT along (0, 0, 1), t = 0 s, gravity 0 m/s²\","
         "\"stage 1: 1 mT along (0.6, 0, 0.8), t = 1 s\",\"stage 2: t = 3 s\",\"stage 3\","
         "\"stage 4: gravity 1 m/s²\"]"},
        {"flux_density: [0, 0, 1 mT]\nload_steps: {count: 2, frames: true}\n",
         "[\"stage 0: 500 µT, 0.5 of the loads\",\"stage 1: 1 mT, 1 of the loads\"]"},
        {"sequence: {time: {from: 0, to: 0.5, count: 3}}\nflux_density: [\"0\", \"0\", \"1e-3*(1 - 2*t)\"]\n",
         "[\"stage 0: 1 mT, t = 0 s\",\"stage 1: 500 µT, t = 250 ms\",\"stage 2: 0 T, t = 500 ms\"]"}};
    for (int k = 0; k < 3; k++) {
        Result *result = run_text(mem_format("slender: 1\njob: equilibrium\nshell:\n  mesh: {shape: sheet, "
                                             "size: [40 mm, 20 mm], cells: [4, 2]}\n"
                                             "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n  density: "
                                             "1000\n  magnetization: [1.0e+4, 0, 0]\n"
                                             "fix: [{group: root, clamp: true}]\n%s",
                                             rows[k].scene));
        Page page = report(0);
        const char *labels = after(page.json, "labels");
        if (strncmp(labels, rows[k].labels, strlen(rows[k].labels)) != 0)
            fail_msg("%.300s instead of %s", labels, rows[k].labels);
        page_clear(&page);
        result_close(result);
    }
}

static int remove_page(void **state)
{
    unlink(HTML);
    return remove_run(state);
}

/* Frames of a design know which evaluation they are: every other one that was better than all before, and the best. */
static void test_evaluations(void **unused)
{
    (void)unused;
    static const char *const settings[] = {"design.iterations=12", "shell.mesh.n=2", "output.every=2"};
    SlenderError trouble;
    Result *result = run_to(slender_scene_read(SOURCE_DIR "/tests/scene_small.yaml", settings, 3, &trouble),
                            &trouble, false, SLENDER_NOT_CONVERGED);
    Page page = page_of(RESULT, HTML, 0);
    Array history = read_all(result, "slender/history/objective");
    const double *objective = history.data;
    const char *list = after(page.json, "evaluations");
    int frames = result_step_count(result), better = 0, best = 0, last = 0;
    assert_true(frames > 4);
    for (int k = 0; k < history.dims[0]; k++) {
        if (k > 0 && !(objective[k] < objective[best])) continue;
        best = k;
        if (better++ % 2) continue;
        char *end;
        last = (int)strtol(list + 1, &end, 10);
        assert_int_equal(last, k);
        list = end;
    }
    assert_int_equal((better + 1) / 2, frames - 2); /* two cases */
    for (int c = 0; c < 2; c++) {
        char *end;
        assert_int_equal(strtol(list + 1, &end, 10), best);
        list = end;
    }
    assert_int_equal(*list, ']');
    array_clear(&history);
    page_clear(&page);
    result_close(result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(test_energies, nothing_leaks),
                                       cmocka_unit_test_teardown(test_evaluations, nothing_leaks),
                                       cmocka_unit_test_teardown(test_stages, nothing_leaks),
                                       cmocka_unit_test_teardown(test_names, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, remove_page);
}
