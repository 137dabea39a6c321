/* Pictures of a rod's load cases, with what each was to be; and charts whose legend is wider than they are. */
#include "io/canvas.h"
#include "leaks.h"
#include "page_fixture.h"
#include "view/chart.h"
#include <string.h>

#define NAME  "test_show_cases"
#define CLOUD NAME ".csv"

#define SCENE(up, side)                                                                                      \
    "slender: 1\njob: design\n"                                                                              \
    "rod: {length: 100 mm, radius: 1 mm, young: 1 MPa, poisson: 0.5, density: 1100, elements: 10, "          \
    "natural_strain: [0, 0, 0]}\n"                                                                           \
    "cases:\n- {name: up, flux_density: [0, 0, 10 mT], target: " up "}\n"                                    \
    "- {name: side, flux_density: [0, 10 mT, 0], target: " side "}\n"                                        \
    "design: {unknowns: {magnetization: {noise: 100}}, objectives: [{target: 1}], iterations: 2}\n"

#define CURVE     "{formula: [\"0.9*s\", \"2*s*s\", \"-s*s\"]}"
#define END       "{formula: [\"0.09\", \"0.01\", \"0.02\"], on: {group: tip}}"
#define CLOUD_KEY "{cloud: " CLOUD ", axes: xz}"

static const int first_ink[] = {213, 94, 0}, second_ink[] = {0, 158, 115}, given_ink[] = {158, 158, 163};

static int count_ink(const Page *page, const int ink[3])
{
    int count = 0;
    for (int k = 0; k < page->width * page->height; k++) {
        const unsigned char *c = page->rgb + 3 * k;
        count += c[0] == ink[0] && c[1] == ink[1] && c[2] == ink[2];
    }
    return count;
}

/* Pixels of the curves of both cases and of what they were to be: of all cases (NULL), or of one. */
static void draw(const char *only, int found[3])
{
    ShowDef def = show_default();
    def.only = only;
    def.history = false;
    Page page = page_draw(NAME, &def);
    const int *const inks[] = {first_ink, second_ink, given_ink};
    for (int k = 0; k < 3; k++) found[k] = count_ink(&page, inks[k]);
    mem_free(page.rgb);
}

static void test_cases(void **state)
{
    (void)state;
    int all[3], up[3], side[3];
    page_run(NAME, SCENE(END, CURVE));
    draw(NULL, all);
    draw("up", up);
    draw("side", side);
    assert_true(all[0] > 100 && all[1] > 100);
    assert_true(up[0] > 100 && up[1] == 0);     /* one case alone has the first colour */
    assert_true(side[0] > 100 && side[1] == 0); /* .. and its own target, a line       */
    assert_true(up[2] > 50 && side[2] > 3 * up[2] && all[2] > 3 * up[2]);
    ShowDef def = show_default();
    def.only = "down";
    Error err;
    assert_int_not_equal(page_show(NAME, &def, &err), SHOW_DONE);
    assert_string_equal(err.text, "the result has no load case 'down'");
    page_remove_files(NAME);
}

static void test_cloud(void **state)
{
    (void)state;
    int up[3];
    FILE *file = fopen(CLOUD, "w");
    for (int k = 0; k < 20; k++) fprintf(file, "%g, %g\n", 0.005 * k, 0.02 + 0.001 * k);
    fclose(file);
    page_run(NAME, SCENE(CLOUD_KEY, CURVE));
    draw("up", up);
    assert_true(up[2] > 100); /* nothing else is grey */
    page_remove_files(NAME);
    unlink(CLOUD);
}

/* ---- Legends ---- */

enum { WIDTH = 400, HEIGHT = 150, LEFT = 200, BOX = 160, SERIES = 4 };

/* Of a chart in a box of the page; series with that name. */
static Page draw_chart(const char *name)
{
    static const double y[] = {1, 2, 3};
    ChartSeries series[SERIES];
    Error err;
    Page page;
    for (int s = 0; s < SERIES; s++) series[s] = (ChartSeries){.name = name, .count = 3, .y = y};
    Chart chart = {.x_label = "t",
                   .x_unit = "s",
                   .y_label = "place",
                   .y_unit = "m",
                   .series_count = SERIES,
                   .series = series};
    Canvas *canvas = canvas_create(NAME ".png", WIDTH, HEIGHT, 1, &err);
    assert_non_null(canvas);
    chart_draw(canvas, &chart, (Box){LEFT, 0, BOX, HEIGHT});
    assert_true(canvas_save(canvas, &err));
    canvas_destroy(canvas);
    assert_true(png_read(NAME ".png", &page.rgb, &page.width, &page.height, &err));
    unlink(NAME ".png");
    return page;
}

static bool is_blank(const Page *page, int column, int row)
{
    const unsigned char *c = page->rgb + 3 * (row * page->width + column);
    return c[0] + c[1] + c[2] > 3 * 250;
}

/* Rows with ink right of the axis and above the plot, whose own ink is below the legend's. */
static int ink_outside(const Page *page)
{
    int count = 0;
    for (int row = 0; row < page->height; row++)
        for (int column = 0; column < page->width; column++)
            count += (column < LEFT - 1 || column > LEFT + BOX + 10) && !is_blank(page, column, row);
    return count;
}

static void test_legends(void **state)
{
    (void)state;
    static const char *const names[] = {"a", "a name of some length",
                                        "a name of such a length that it fits nowhere at all, "
                                        "and still has no end, so that it is cut off"};
    for (int k = 0; k < 3; k++) {
        Page page = draw_chart(names[k]);
        int out = ink_outside(&page);
        mem_free(page.rgb);
        if (out) fail_msg("'%s': %d pixels beside the chart", names[k], out);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(test_cases, nothing_leaks),
                                       cmocka_unit_test_teardown(test_cloud, nothing_leaks),
                                       cmocka_unit_test_teardown(test_legends, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
