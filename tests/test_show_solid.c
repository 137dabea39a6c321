/* Pictures of solids: colours of tetrahedra on the skin and on a cut, and targets of single nodes. */
#include "leaks.h"
#include "page_fixture.h"
#include <math.h>
#include <stdlib.h>

#define NAME "test_show_solid"

static void run(const char *text)
{
    page_run(NAME, text);
}

static ShowDef from_front(const char *field)
{
    ShowDef def = show_default();
    def.view[1] = -1, def.view[2] = 0.05;
    def.width = 600, def.field = field, def.arrows = false;
    return def;
}

/* Parts of the body's pixels that have the colours of the upper and of the lower end of the scale, in any light; the colour
 * key below the body is left out. */
static void parts_of(Page page, double *high, double *low)
{
    int count = 0, yellow = 0, violet = 0;
    for (int i = 0; i < page.width * (page.height - 120); i++) {
        const unsigned char *c = page.rgb + 3 * i;
        if (abs(c[0] - c[1]) < 12 && abs(c[1] - c[2]) < 12) continue; /* paper and ink */
        count++;
        yellow += c[0] > 1.02 * c[1] && c[1] > 2 * c[2];
        violet += c[0] > 2 * c[1] && c[2] > c[0];
    }
    *high = (double)yellow / count, *low = (double)violet / count;
    mem_free(page.rgb);
}

#define BLOCK                                                                                                \
    "slender: 1\njob: evaluate\nsolid:\n"                                                                    \
    "  mesh: {shape: box, size: [40 mm, 20 mm, 10 mm], cells: [4, 2, 2]}\n  poisson: 0.3\n"

static void check_parts(const ShowDef *def, double yellow, double violet)
{
    double high, low;
    parts_of(page_draw(NAME, def), &high, &low);
    print_message("yellow %.3f, violet %.3f\n", high, low);
    assert_true(fabs(high - yellow) < 0.12 && fabs(low - violet) < 0.12);
}

/* A face has the colour of the tetrahedron behind it, the cut that of those that it goes through: of four blocks the upper one
 * at the back is stiff, and the two at x > 20 mm are magnetised. */
static void test_colours(void **state)
{
    (void)state;
    run(BLOCK "  young: {formula: \"z > 0.005 && y > 0.01 ? 10e6 : 1e5\"}\n"
              "  magnetization: {formula: [\"x > 0.02 ? 1e5 : 0\", \"0\", \"0\"]}\n");
    ShowDef def = from_front("young");
    check_parts(&def, 0, 1);
    def.clip = (ClipPlane){{0, 0.015, 0}, {0, -1, 0}};
    check_parts(&def, 0.5, 0.5);
    def.clip =
        (ClipPlane){{0, 0.013, 0}, {0, 1, 0}}; /* the eye's side is left out, whichever way it is given */
    check_parts(&def, 0.5, 0.5);
    def = from_front("magnetization");
    check_parts(&def, 0.5, 0.5);
    def.clip = (ClipPlane){{0, 0.004, 0}, {0, 1, 0}};
    check_parts(&def, 0.5, 0.5);
}

/* What the skin has is shown on it, and what the volume has on the cut. */
static void test_skin(void **state)
{
    (void)state;
    run(BLOCK "  young: 1 MPa\n  skin: {thickness: 1 mm, magnetization: [1.0e+5, 0, 0]}\n"
              "  magnetization: [1, 0, 0]\n");
    ShowDef def = from_front(NULL);
    def.clip = (ClipPlane){{0, 0.001, 0}, {0, 1, 0}};
    check_parts(&def, 0, 1);
    def.field = "volume_magnetization", def.clip = (ClipPlane){{0}, {0}};
    Error err;
    assert_int_equal(page_show(NAME, &def, &err), SHOW_DONE);
    def.field = "least_jacobian";
    assert_int_equal(page_show(NAME, &def, &err), SHOW_DONE);
    /* A stiff film, on the lower half of the side that is seen. */
    run(BLOCK "  young: 1 MPa\n  skin: {thickness: 1 mm, poisson: 0.3, "
              "young: {formula: \"z < 0.005 ? 5e6 : 1e6\"}}\n");
    def = from_front("young");
    check_parts(&def, 0.5, 0.5);
}

static int dots_of(Page page)
{
    int count = 0;
    for (int i = 0; i < page.width * (page.height - 120); i++) {
        const unsigned char *c = page.rgb + 3 * i;
        count += c[0] > 90 && c[0] > 1.8 * c[1] && c[1] > 3 * c[2];
    }
    mem_free(page.rgb);
    return count;
}

/* The target of one node, which no face has, is a dot over the body, wherever targets were to be. */
static void test_dots(void **state)
{
    (void)state;
    run(BLOCK
        "  young: 1 MPa\n"
        "cases:\n  - name: one\n    target:\n      on: {box: [[9 mm, -1 mm, 4 mm], [11 mm, 1 mm, 6 mm]]}\n"
        "      formula: [\"x - 0.005\", \"y - 0.005\", \"z\"]\n");
    ShowDef def = from_front("none");
    Page page = page_draw(NAME, &def);
    int height = page.height, dots = dots_of(page);
    print_message("%d pixels of a dot\n", dots);
    assert_true(dots > 8 && dots < 60);
    def.target = PICTURE_TARGET_OVER;
    page = page_draw(NAME, &def);
    assert_int_equal(page.height, height);
    assert_int_equal(dots_of(page), dots);
}

static void test_sentences(void **state)
{
    (void)state;
    Error err;
    run(BLOCK "  young: 1 MPa\n");
    ShowDef def = from_front(NULL);
    def.clip = (ClipPlane){{0, 0, 1}, {0, 0, 1}};
    assert_int_equal(page_show(NAME, &def, &err), SHOW_HAS_NOT);
    assert_string_equal(err.text, "the plane does not cut the body, which at rest reaches from (0, 0, 0) to "
                                  "(0.04, 0.02, 0.01) m");
    run("slender: 1\njob: equilibrium\nrod: {natural_strain: [0, 0, 0], length: 0.1, elements: 10, radius: 1 "
        "mm,\n"
        "  young: 1 MPa, poisson: 0.4, density: 1100}\n");
    assert_int_equal(page_show(NAME, &def, &err), SHOW_HAS_NOT);
    assert_string_equal(err.text, "a plane cuts shells and solids open; rods are lines");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_colours), cmocka_unit_test(test_skin),
                                       cmocka_unit_test(test_dots), cmocka_unit_test(test_sentences)};
    int failed = cmocka_run_group_tests(tests, NULL, nothing_leaks);
    page_remove_files(NAME);
    return failed;
}
