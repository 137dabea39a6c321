/* The legend of a picture of rods names a target once: its line, or where it has none its dots. */
#include "tests/leaks.h"
#include "view/show.h"
#include <stdio.h>
#include <string.h>

#define NAME "test_show_rod_target"
#include "tests/run_fixture.h"

static const char ROD[] =
    "slender: 1\njob: design\nrod:\n  natural_strain: [0, 0, 0]\n  length: 60 mm\n  elements: 20\n"
    "  radius: 1 mm\n  young: 1 MPa\n  poisson: 0.4\n  density: 1000\n  gravity: [0, 0, -1]\n"
    "  magnetization: [1.0e+4, 0, 0]\nflux_density: [0, 0, 5 mT]\n"
    "design: {unknowns: {magnetization: {bounds: [-8.0e+4, 8.0e+4]}}, objectives: [{target: 1}], "
    "optimizer: gauss_newton, iterations: 1}\ntarget: ";

/* How many strokes are as wide as a target's, and how many paths there are. */
static void count_strokes(const char *target, int *wide, int *paths)
{
    Error err;
    SlenderError trouble;
    char *text = mem_format("%s%s\n", ROD, target);
    char line[8192];
    result_close(
        run_to(slender_scene_parse(text, NULL, 0, &trouble), &trouble, false, SLENDER_NOT_CONVERGED));
    mem_free(text);
    ShowDef def = show_default();
    if (show_result(NAME ".vtkhdf", NAME ".svg", &def, &err) != SHOW_DONE) fail_msg("%s", err.text);
    FILE *file = fopen(NAME ".svg", "r");
    assert_non_null(file);
    for (*wide = *paths = 0; fgets(line, sizeof line, file);)
        *wide += strstr(line, "stroke-width:3.4;") != NULL, *paths += strstr(line, "<path") != NULL;
    fclose(file);
    unlink(NAME ".svg");
}

static void test_names(void **unused)
{
    (void)unused;
    int line, dot, paths;
    count_strokes("{formula: [\"s\", \"0\", \"2*s*s\"]}", &line, &paths);
    count_strokes("{formula: [\"0.05\", \"0\", \"0.01\"], on: {group: tip}}", &dot, &paths);
    assert_true(line >= 2); /* in the legend and in the view */
    assert_int_equal(dot, 0);
    assert_true(paths > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(test_names, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
