/* Pictures of what bodies meet: where obstacles must be seen, and where the body in or behind them. */
#include "base/memory.h"
#include "leaks.h"
#include "page_fixture.h"
#include <math.h>
#include <stdlib.h>

#define NAME "test_show_obstacles"

static void run(const char *text)
{
    page_run(NAME, text);
}

static Page draw(double x, double y, double z, int frame)
{
    ShowDef def = show_default();
    def.view[0] = x, def.view[1] = y, def.view[2] = z;
    def.frame = frame, def.width = 800;
    return page_draw(NAME, &def);
}

/* Blue over red is 1.17 of obstacles' colour and 1.06 of a shell's without a field, in any light; the shell's edges are
 * darker. */
static bool is_blue(const unsigned char *rgb)
{
    return rgb[2] > 80 && rgb[2] > 1.12 * rgb[0] && rgb[1] > rgb[0];
}

static bool is_shell(const unsigned char *rgb)
{
    return rgb[2] > 80 && rgb[2] > 1.03 * rgb[0] && rgb[2] < 1.1 * rgb[0];
}

typedef bool Is(const unsigned char *rgb);

/* How many pixels are of a kind, and the mean of their columns. */
static int count(const Page *page, Is *is, double *column)
{
    int found = 0;
    double sum = 0;
    for (int i = 0; i < page->width * page->height; i++)
        if (is(page->rgb + 3 * i)) found++, sum += i % page->width;
    if (column) *column = sum / found;
    return found;
}

#define SHEET                                                                                                \
    "slender: 1\njob: evaluate\nshell:\n"                                                                    \
    "  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [8, 4]}\n"                                          \
    "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n"

/* A floor fills the picture around the body; from below one sees the body alone, edge-on a line. */
static void test_floor(void **state)
{
    (void)state;
    run(SHEET "obstacles: [{plane: {point: [0, 0, -1 mm]}}]\n");
    Page above = draw(0.1, -0.5, 1, -1), below = draw(0.1, -0.5, -1, -1), edge = draw(0, -1, 0, -1);
    int blue = count(&above, is_blue, NULL), shell = count(&above, is_shell, NULL),
        line = count(&edge, is_blue, NULL);
    print_message("floor %d, shell %d of %d pixels; edge-on %d\n", blue, shell, above.width * above.height,
                  line);
    assert_true(blue > shell / 4 && shell > 20000);
    assert_int_equal(count(&below, is_blue, NULL), 0);
    assert_true(count(&below, is_shell, NULL) > 20000);
    assert_in_range(line, 600, 3000); /* across 800 pixels but for the margins, two or three high */
    mem_free(above.rgb);
    mem_free(below.rgb);
    mem_free(edge.rgb);
}

/* One looks into a pipe: the shell in it is seen whole; a bar in front of it covers it, and it shines through. */
static void test_pipe(void **state)
{
    (void)state;
    run(SHEET
        "obstacles: [{cylinder: {point: [0, 10 mm, 0], axis: [1, 0, 0], radius: 12 mm, inside: true}}]\n");
    Page pipe = draw(0, -0.4, 1, -1);
    run(SHEET "obstacles: [{cylinder: {point: [0, 10 mm, 14 mm], axis: [1, 0, 0], radius: 6 mm}}]\n");
    Page bar = draw(0, 0, 1, -1);
    run(SHEET "obstacles: [{sphere: {center: [20 mm, 10 mm, 10 m], radius: 1 mm}}]\n");
    Page bare = draw(0, 0, 1, -1), slanted = draw(0, -0.4, 1, -1);
    int all = count(&bare, is_shell, NULL), under = count(&bar, is_shell, NULL);
    print_message("in the pipe %d of %d pixels, under the bar %d of %d\n", count(&pipe, is_shell, NULL),
                  count(&slanted, is_shell, NULL), under, all);
    assert_true(abs(count(&pipe, is_shell, NULL) - count(&slanted, is_shell, NULL)) < 0.02 * all);
    assert_true(fabs((double)under / all - 0.4) < 0.03); /* 20 mm less the bar's 12 */
    /* The line x = 20 mm, on the bar: where the sheet is behind it, it is darker than beside. */
    const unsigned char *inner = bar.rgb + 3 * (bar.height / 2 * bar.width + bar.width / 2), *outer = inner;
    while (outer < inner + 3 * bar.width / 2 && is_blue(outer + 9)) outer += 3;
    assert_true(is_blue(inner) && inner[2] + 5 < outer[-30 + 2]);
    Page *pages[] = {&pipe, &bar, &bare, &slanted};
    for (int k = 0; k < 4; k++) mem_free(pages[k]->rgb);
}

/* A box is where it is at the frame's time, and shown whole. */
static void test_moving(void **state)
{
    (void)state;
    run("slender: 1\njob: simulate\nshell:\n"
        "  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [8, 4]}\n"
        "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n  density: 1000\n"
        "fix: [{boundary: true}]\n"
        "obstacles:\n"
        "  - {box: {center: [10 mm, 10 mm, 6 mm], half: [4 mm, 4 mm, 4 mm]}, move: [\"0.1*t\", \"0\", "
        "\"0\"]}\n"
        "time: {step: 10 ms, steps: 20}\noutput: {every: 10}\n");
    double shell, box[3];
    for (int k = 0; k < 3; k++) {
        Page page = draw(0, 0, 1, k);
        assert_true(count(&page, is_blue, &box[k]) > 2000);
        if (k == 1) count(&page, is_shell, &shell); /* the box is in its middle */
        mem_free(page.rgb);
    }
    print_message("box at columns %.1f, %.1f, %.1f, sheet at %.1f\n", box[0], box[1], box[2], shell);
    assert_true(fabs(box[1] - shell) < 2 && fabs(box[0] + box[2] - 2 * box[1]) < 2);
    assert_true(box[2] - box[0] > 300); /* 20 of the sheet's 40 mm, which are about 650 pixels */
}

/* Rods: a floor is a line in front, and an area from above; a ball beside the rod is shown whole. */
static void test_rod(void **state)
{
    (void)state;
    run("slender: 1\njob: simulate\n"
        "rod: {natural_strain: [0, 0, 0], length: 0.1, elements: 10, radius: 1 mm,\n"
        "      young: 1 MPa, poisson: 0.4, density: 1100, gravity: [0, 0, -9.81]}\n"
        "obstacles:\n"
        "  - {plane: {point: [0, 0, -3 mm]}}\n"
        "time: {step: 2 ms, steps: 10}\n");
    Page front = draw(0, -1, 0, -1), top = draw(0, 0, 1, -1);
    int line = count(&front, is_blue, NULL), area = count(&top, is_blue, NULL);
    print_message("floor: %d pixels from the front, %d from above\n", line, area);
    assert_in_range(line, 600, 6000); /* with the natural curve, which is blue, too */
    assert_true(area > 5 * line);
    mem_free(front.rgb);
    mem_free(top.rgb);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(test_floor, nothing_leaks),
                                       cmocka_unit_test_teardown(test_pipe, nothing_leaks),
                                       cmocka_unit_test_teardown(test_moving, nothing_leaks),
                                       cmocka_unit_test_teardown(test_rod, nothing_leaks)};
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    page_remove_files(NAME);
    return failed;
}
