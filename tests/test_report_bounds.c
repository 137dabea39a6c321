/* slender report at its bounds: what is empty, far away, of many names. */
#include "report/report.h"
#include "tests/leaks.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define NAME "test_report_bounds"
#include "tests/run_fixture.h"
#include "tests/report_fixture.h"

#define RESULT NAME ".vtkhdf"
#define HTML   NAME ".html"

static const char EMPTY[] =
    "slender: 1\njob: draw\nspline:\n  density: {formula: \"0\"}\n  direction: {formula: [\"1\", \"0\"]}\n"
    "  page: {size: [90 mm, 60 mm], margin: 5 mm}\n  pen: 0.6 mm\n  rounds: 0\n  iterations: 4\noutput: "
    "{film: "
    "1}\n";

/* Of a drawing without strokes the page has its paper, and layers and a film without curves. */
static void test_empty_drawing(void **unused)
{
    (void)unused;
    result_close(run_text(mem_text(EMPTY)));
    Page page = page_of(RESULT, HTML, 0);
    Unpacked offsets = unpack(&page, after(page.json, "layers"), "offsets"),
             points = unpack(&page, after(page.json, "layers"), "points");
    assert_true(offsets.width == 1 && offsets.values[0] == 0 && points.width == 0);
    mem_free(offsets.values), mem_free(points.values);
    page_clear(&page);
}

static int count_of(const char *text, const char *word)
{
    int count = 0;
    for (; (text = strstr(text, word)); text++) count++;
    return count;
}

/* Of a film as many frames as are asked for. */
static void test_film_frames(void **unused)
{
    (void)unused;
    static const char *const settings[] = {"spline.rounds=0", "spline.iterations=6", "output.film=1"};
    SlenderError trouble;
    Result *result = run_to(slender_scene_read(SOURCE_DIR "/tests/scene_draw.yaml", settings, 3, &trouble),
                            &trouble, false, SLENDER_NOT_CONVERGED);
    Array iterations = read_all(result, "slender/spline/film/iteration");
    assert_true(iterations.dims[0] > 5);
    for (int frames = 0; frames < 4; frames++) {
        Page page = page_of(RESULT, HTML, frames);
        assert_int_equal(count_of(page.json, "\"iteration\":"), frames ? frames : iterations.dims[0]);
        page_clear(&page);
    }
    array_clear(&iterations);
    result_close(result);
}

/* Far away from the origin a body is as exact as near it. */
static void test_far(void **unused)
{
    (void)unused;
    FILE *file = fopen(NAME ".obj", "w");
    assert_non_null(file);
    for (int k = 0; k < 10; k++) fprintf(file, "v %.9g %.9g 0\n", 1e4 + 0.01 * (k / 2), 1e4 + 0.01 * (k % 2));
    for (int k = 0; k < 4; k++)
        fprintf(file, "f %d %d %d\nf %d %d %d\n", 2 * k + 1, 2 * k + 3, 2 * k + 2, 2 * k + 3, 2 * k + 4,
                2 * k + 2);
    assert_int_equal(fclose(file), 0);
    Result *result = run_text(mem_text(
        "slender: 1\njob: equilibrium\nshell: {mesh: {file: " NAME ".obj}, thickness: 0.1 mm, young: 1 "
        "MPa, poisson: 0.4, magnetization: [1000, 0, 0]}\nfix: [{vertices: [0, 1], clamp: true}]\n"
        "flux_density: [0, 0, 1 mT]\n"));
    Page page = page_of(RESULT, HTML, 0);
    Unpacked points = unpack(&page, after(page.json, "body"), "points");
    Array x;
    Error err;
    assert_true(result_read_step(result, "Points", 0, &x, &err));
    const double *own = x.data;
    assert_true(points.width == 30 && points.low >= -0.021 && points.high <= 0.021);
    for (int v = 0; v < 10; v++)
        for (int i = 0; i < 3; i++)
            assert_true(fabs(points.values[3 * v + i] - points.values[i] - (own[3 * v + i] - own[i])) < 2e-6);
    array_clear(&x);
    mem_free(points.values);
    page_clear(&page);
    result_close(result);
    unlink(NAME ".obj");
}

/* Results of one name are called after the folders in which they differ. */
static void test_names(void **unused)
{
    (void)unused;
    Error err;
    result_close(run_text(mem_text(EMPTY)));
    mkdir(NAME "_a", 0777), mkdir(NAME "_b", 0777);
    unlink(NAME "_a/1.vtkhdf"), unlink(NAME "_b/1.vtkhdf");
    assert_int_equal(link(RESULT, NAME "_a/1.vtkhdf") | link(RESULT, NAME "_b/1.vtkhdf"), 0);
    const char *const results[] = {NAME "_a/1.vtkhdf", "./" NAME "_b/1.vtkhdf", "./" RESULT};
    if (report_write(results, 3, HTML, &(ReportDef){0}, &err) != SHOW_DONE) fail_msg("%s", err.text);
    Page page = page_read(HTML);
    assert_non_null(strstr(page.json, "\"name\":\"" NAME "_a/1.vtkhdf\""));
    assert_non_null(strstr(page.json, "\"name\":\"" NAME "_b/1.vtkhdf\""));
    assert_non_null(strstr(page.json, "\"name\":\"" RESULT "\""));
    page_clear(&page);
    for (int k = 0; k < 2; k++) unlink(results[k]);
    rmdir(NAME "_a"), rmdir(NAME "_b"), unlink(HTML);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(test_empty_drawing, nothing_leaks),
                                       cmocka_unit_test_teardown(test_film_frames, nothing_leaks),
                                       cmocka_unit_test_teardown(test_far, nothing_leaks),
                                       cmocka_unit_test_teardown(test_names, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
