/* Pages of curves: which views, where they go, and that what is drawn lies where its scales say. */
#include "base/memory.h"
#include "leaks.h"
#include "png_fixture.h"
#include "view/curves_layout.h"
#include "view/page.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <cmocka.h>

enum { POINTS = 201 };

static const Color red = {1, 0, 0, 1}, blue = {0, 0, 1, 1};

/* A helix of one curve about an axis (0: x, ..), of this length and radius. */
static CurvesSet helix(double (*points)[3], int axis, double length, double radius)
{
    static const int offsets[2] = {0, POINTS};
    for (int i = 0; i < POINTS; i++) {
        double t = (double)i / (POINTS - 1);
        points[i][axis] = -length * t;
        points[i][(axis + 1) % 3] = radius * cos(20 * t);
        points[i][(axis + 2) % 3] = radius * sin(20 * t);
    }
    return (CurvesSet){"helix", 1, offsets, (const double(*)[3])points, red, 1.6, 0, false, {0}, {0}, 0, {0}};
}

/* A curve of two points. */
static CurvesSet segment(double (*points)[3], Vec3 from, Vec3 to)
{
    static const int offsets[2] = {0, 2};
    vec3_store(points[0], from);
    vec3_store(points[1], to);
    return (CurvesSet){"segment", 1, offsets, (const double(*)[3])points, red, 2, 0, false, {0}, {0}, 0, {0}};
}

static CurvesScene scene_of(const CurvesSet *sets, int count)
{
    CurvesScene scene = curves_default();
    scene.sets = sets, scene.set_count = count;
    return scene;
}

static CurvesLayout lay_out(const CurvesScene *scene)
{
    CurvesLayout layout;
    assert_true(curves_layout(scene, 60, &layout));
    return layout;
}

static bool apart(Box a, Box b)
{
    return a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;
}

/* Nothing leaves the page or covers something else, all views have one scale and show all points. */
static void check_layout(const CurvesScene *scene, const CurvesLayout *layout)
{
    Box boxes[CURVES_VIEWS_MAX + CURVES_CHARTS_MAX];
    int count = 0;
    for (int v = 0; v < layout->view_count; v++) boxes[count++] = layout->views[v].box;
    for (int k = 0; k < scene->chart_count; k++) boxes[count++] = layout->charts[k];
    for (int i = 0; i < count; i++) {
        assert_true(boxes[i].width > 30 && boxes[i].height > 30);
        assert_true(boxes[i].x >= PAGE_MARGIN - 1e-9 && boxes[i].y >= 60);
        assert_true(boxes[i].x + boxes[i].width <= PAGE_WIDTH - PAGE_MARGIN + 1e-9);
        assert_true(boxes[i].y + boxes[i].height <= layout->end + 1e-9);
        for (int j = 0; j < i; j++) assert_true(apart(boxes[i], boxes[j]));
    }
    for (int v = 0; v < layout->view_count; v++) {
        const CurvesView *view = &layout->views[v];
        assert_true(view->scale == layout->views[0].scale);
        assert_true(fabs(view->box.width - view->scale * (view->high[0] - view->low[0])) < 1e-9);
        assert_true(fabs(view->box.height - view->scale * (view->high[1] - view->low[1])) < 1e-9);
        for (int i = 0; i < scene->sets[0].offsets[1]; i++) {
            Vec3 p = vec3_load(scene->sets[0].points[i]);
            double x = vec3_dot(p, view->camera.right), y = vec3_dot(p, view->camera.up);
            assert_true(x > view->low[0] && x < view->high[0] && y > view->low[1] && y < view->high[1]);
        }
    }
}

/* Tall, flat along x, flat along y; with up to three charts. */
static void arrangements(void **state)
{
    (void)state;
    double points[POINTS][3], y[3] = {0, 1, 2};
    const ChartSeries series = {.count = 3, .y = y};
    const Chart chart = {.series_count = 1, .series = &series};
    const Chart charts[CURVES_CHARTS_MAX] = {chart, chart, chart};
    for (int axis = 0; axis < 3; axis++)
        for (int count = 0; count <= CURVES_CHARTS_MAX; count++) {
            CurvesSet set = helix(points, axis, 0.3, 0.03);
            CurvesScene scene = scene_of(&set, 1);
            scene.charts = charts, scene.chart_count = count;
            CurvesLayout layout = lay_out(&scene);
            assert_int_equal(layout.view_count, 3);
            check_layout(&scene, &layout);
            print_message("axis %d, %d charts: %.0f pt per metre, page %.0f pt high\n", axis, count,
                          layout.views[0].scale, layout.end + PAGE_MARGIN);
            assert_true(layout.views[0].scale * 0.3 > 240); /* a good part of the page */
        }
}

static void expect_view(Vec3 from, Vec3 to, const char *name)
{
    double points[2][3];
    CurvesSet set = segment(points, from, to);
    CurvesScene scene = scene_of(&set, 1);
    CurvesLayout layout = lay_out(&scene);
    assert_int_equal(layout.view_count, 1);
    assert_string_equal(layout.views[0].name, name);
    check_layout(&scene, &layout);
}

/* Of plane curves and straight ones only one view shows something. */
static void planes(void **state)
{
    (void)state;
    expect_view(vec3(0, 0, 0), vec3(1, 0, -2), "front");
    expect_view(vec3(0, 1, 0), vec3(0, 2, -1), "side");
    expect_view(vec3(0, 1, 5), vec3(1, 2, 5), "top");
    expect_view(vec3(0, 0, 0), vec3(1, 1e-9, 1e-9), "front");
    expect_view(vec3(0, 0, 0), vec3(0, 1, 0), "side");
    expect_view(vec3(0, 0, 0), vec3(0, 0, 1), "front");
    expect_view(vec3(3, 4, 5), vec3(3, 4, 5), "front");
    double points[2][3];
    CurvesSet set = segment(points, vec3(0, 0, 0), vec3(1, 1, 1));
    CurvesScene scene = scene_of(&set, 1);
    scene.view[1] = -1, scene.view[2] = 1;
    CurvesLayout layout = lay_out(&scene);
    assert_int_equal(layout.view_count, 1);
    assert_null(layout.views[0].name);
    check_layout(&scene, &layout);
}

/* ---- Pixels ---- */

typedef struct Page {
    int width, height;
    unsigned char *rgb;
} Page;

static Page page_write(const CurvesScene *scene)
{
    Page page = {0};
    Error err = {""};
    if (!curves_write("curves.png", scene, &err) ||
        !png_read("curves.png", &page.rgb, &page.width, &page.height, &err))
        fail_msg("%s", err.text);
    return page;
}

static bool is_color(const unsigned char *rgb, Color color)
{
    return fabs(rgb[0] - 255 * color.r) < 1 && fabs(rgb[1] - 255 * color.g) < 1 &&
           fabs(rgb[2] - 255 * color.b) < 1;
}

static int count_pixels(const Page *page, Color color)
{
    int count = 0;
    for (int i = 0; i < page->width * page->height; i++) count += is_color(page->rgb + 3 * i, color);
    return count;
}

/* Where a point of a view is on the page, pixels. */
static const unsigned char *pixel_at(const Page *page, const CurvesView *view, double right, double up)
{
    double zoom = page->width / PAGE_WIDTH;
    int x = (int)(zoom * (view->box.x + view->scale * (right - view->low[0]))),
        y = (int)(zoom * (view->box.y + view->scale * (view->high[1] - up)));
    return page->rgb + 3 * (y * page->width + x);
}

/* A slanted line is seen at its place, and nowhere else; one that is interrupted has a gap. */
static void places(void **state)
{
    (void)state;
    double points[2][3], broken[5][3] = {{0, 0, -1}, {0.2, 0, -1}, {NAN, 0, 0}, {0.8, 0, -1}, {1, 0, -1}};
    const int offsets[2] = {0, 5};
    CurvesSet sets[2] = {segment(points, vec3(0, 0, 0), vec3(1, 0, -1))};
    sets[1] = (CurvesSet){NULL, 1, offsets, (const double(*)[3])broken, blue, 2, 0, false, {0}, {0}, 0, {0}};
    sets[0].name = NULL;
    CurvesScene scene = scene_of(sets, 2);
    CurvesLayout layout;
    assert_true(curves_layout(&scene, page_head_end((PageHead){0}), &layout)); /* there is no legend */
    Page page = page_write(&scene);
    assert_int_equal(page.width, 1600);
    for (int k = 1; k < 10; k++) {
        assert_true(is_color(pixel_at(&page, &layout.views[0], 0.1 * k, -0.1 * k), red));
        assert_false(is_color(pixel_at(&page, &layout.views[0], 0.1 * k + 0.02, -0.1 * k), red));
    }
    assert_true(is_color(pixel_at(&page, &layout.views[0], 0.1, -1), blue));
    assert_false(is_color(pixel_at(&page, &layout.views[0], 0.5, -1), blue));
    mem_free(page.rgb);
}

/* A gravity that points down is an arrow in two views and a circle in the third; clamps are squares. */
static void marks(void **state)
{
    (void)state;
    double points[POINTS][3];
    CurvesSet set = helix(points, 2, 0.3, 0.03);
    CurvesScene scene = scene_of(&set, 1);
    Page page = page_write(&scene);
    int bare = count_pixels(&page, page_ink);
    mem_free(page.rgb);
    scene.gravity[2] = -9.8;
    page = page_write(&scene);
    int with_gravity = count_pixels(&page, page_ink);
    mem_free(page.rgb);
    scene.clamps = (const double(*)[3])points, scene.clamp_count = 1;
    page = page_write(&scene);
    int with_clamp = count_pixels(&page, page_ink);
    mem_free(page.rgb);
    assert_true(with_gravity > bare + 100);
    assert_true(with_clamp > with_gravity + 4 * 150); /* three views and the legend, 14 x 14 pixels each */
}

/* A frame that is held has its axes, and the outline of the section where these put it; one that turns freely a square only. */
static void holds(void **state)
{
    (void)state;
    const Color n1 = {0.48, 0.20, 0.58, 1}, n2 = {0.80, 0.28, 0.55, 1};
    const double outline[4][2] = {{2, 0}, {0, 1}, {-2, 0}, {0, -1}};
    double points[2][3];
    CurvesSet set = segment(points, vec3(0, 0, 0), vec3(1, 0, -1));
    set.name = NULL;
    Hold items[2] = {{.at = {0.25, 0, -0.75}, .n1 = {0, 0, 1}, .n2 = {-1, 0, 0}},
                     {.at = {0.75, 0, -0.25}, .n1 = {NAN, NAN, NAN}, .n2 = {NAN, NAN, NAN}}};
    set.holds = (Holds){2, items, 4, outline};
    CurvesScene scene = scene_of(&set, 1);
    CurvesLayout layout;
    assert_true(
        curves_layout(&scene, page_head_end((PageHead){0}) + 1.5 * 15, &layout)); /* with its legend */
    Page page = page_write(&scene);
    const CurvesView *view = &layout.views[0];
    double point = 1 / view->scale;
    assert_true(is_color(pixel_at(&page, view, 0.25, -0.75 + 13 * point), n1));
    assert_true(is_color(pixel_at(&page, view, 0.25 - 13 * point, -0.75), n2));
    assert_true(is_color(pixel_at(&page, view, 0.25, -0.75 - 7.6 * point), page_ink)); /* long along n1 */
    assert_true(
        is_color(pixel_at(&page, view, 0.25 + 3.8 * point, -0.75), page_ink)); /* and short along n2 */
    assert_false(is_color(pixel_at(&page, view, 0.25 + 7.6 * point, -0.75), page_ink));
    assert_true(is_color(pixel_at(&page, view, 0.75 + point, -0.25 + point), page_ink));
    assert_false(is_color(pixel_at(&page, view, 0.75, -0.25 + 13 * point), n1));
    mem_free(page.rgb);
}

/* ---- Many curves, formats, motion ---- */

static size_t file_size(const char *path)
{
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return (size_t)status.st_size;
}

/* A straight line of 20 000 points needs no more than one of two; many strands take their time, but not much.
 */
static void many(void **state)
{
    (void)state;
    enum { STRANDS = 1900, EACH = 50 };
    Error err = {""};
    int offsets[STRANDS + 1] = {0};
    double(*points)[3] = mem_alloc(STRANDS * EACH, sizeof *points);
    for (int i = 0; i < STRANDS * EACH; i++) points[i][0] = points[i][2] = i / 1e5;
    offsets[1] = STRANDS * EACH;
    CurvesSet set = {"line", 1, offsets, (const double(*)[3])points, red, 1, 0, false, {0}, {0}, 0, {0}};
    CurvesScene scene = scene_of(&set, 1);
    assert_true(curves_write("curves.svg", &scene, &err));
    assert_true(file_size("curves.svg") < 40000);

    for (int k = 0; k < STRANDS; k++) {
        offsets[k + 1] = (k + 1) * EACH;
        for (int i = 0; i < EACH; i++)
            vec3_store(points[k * EACH + i],
                       vec3(0.1 * cos(k), 0.1 * sin(k) + 0.01 * sin(0.4 * i + k), -0.004 * i));
    }
    set.curve_count = STRANDS;
    Pen pen = curves_pen(&set);
    assert_true(pen.width >= 0.1 && pen.width < 0.3 && pen.color.a > 0.1 && pen.color.a < 0.5);
    clock_t start = clock();
    assert_true(curves_write("curves.png", &scene, &err));
    print_message("%d strands of %d points: %.2f s\n", STRANDS, EACH,
                  (double)(clock() - start) / CLOCKS_PER_SEC);
    mem_free(points);
}

static void formats(void **state)
{
    (void)state;
    double points[POINTS][3];
    Error err = {""};
    CurvesSet set = helix(points, 2, 0.3, 0.03);
    CurvesScene scene = scene_of(&set, 1);
    const char *const paths[] = {"curves.pdf", "curves.svg"}, *const heads[] = {"%PDF-", "<?xml"};
    for (int k = 0; k < 2; k++) {
        char head[6] = "";
        assert_true(curves_write(paths[k], &scene, &err));
        FILE *file = fopen(paths[k], "rb");
        assert_int_equal(fread(head, 1, 5, file), 5);
        fclose(file);
        assert_string_equal(head, heads[k]);
    }
    assert_false(curves_write("curves.jpg", &scene, &err));
    assert_non_null(strstr(err.text, "written as .png, .svg or .pdf"));
    scene.width = 100;
    assert_false(curves_write("curves.png", &scene, &err));
    assert_string_equal(err.text, "curves.png: a width of 100 pixels; 400 to 4000 are allowed");
    scene.width = 800, scene.set_count = 0;
    assert_false(curves_write("curves.png", &scene, &err));
    assert_string_equal(err.text, "curves.png: there is nothing to draw: the curves have no points");
}

/* Parts of a file with this name of four letters. */
static int count_chunks(const char *path, const char *name)
{
    size_t size = file_size(path);
    char *bytes = mem_alloc(size + 1, 1);
    FILE *file = fopen(path, "rb");
    assert_int_equal(fread(bytes, 1, size, file), size);
    fclose(file);
    int count = 0;
    for (size_t i = 0; i + 4 <= size; i++) count += !memcmp(bytes + i, name, 4);
    mem_free(bytes);
    return count;
}

/* A page for each moment, which shows that moment and no other; on a still all are seen. */
static void moments(void **state)
{
    (void)state;
    double points[3][POINTS][3];
    Error err = {""};
    CurvesSet sets[3];
    for (int k = 0; k < 3; k++) {
        sets[k] = helix(points[k], 2, 0.3, 0.02 + 0.01 * k);
        sets[k].moment = k > 0;
    }
    sets[1].color = blue, sets[2].color = curves_fade(blue, 0);
    CurvesScene scene = scene_of(sets, 3);
    Page page = page_write(&scene);
    assert_true(count_pixels(&page, red) > 100 && count_pixels(&page, blue) > 100 &&
                count_pixels(&page, sets[2].color) > 100);
    mem_free(page.rgb);
    scene.width = 400;
    assert_true(curves_animate("curves.webp", &scene, 0.04, &err));
    assert_int_equal(count_chunks("curves.webp", "WEBP"), 1);
    assert_int_equal(count_chunks("curves.webp", "ANMF"), 2);
    assert_false(curves_animate("curves.png", &scene, 0.04, &err));
    assert_non_null(strstr(err.text, ".webp"));
}

static void fades(void **state)
{
    (void)state;
    Color last = curves_fade(blue, 1), first = curves_fade(blue, 0), middle = curves_fade(blue, 0.5);
    assert_memory_equal(&last, &blue, sizeof blue);
    assert_true(first.r < 0.95 && first.r > middle.r && middle.r > 0 && first.b == 1 && first.a == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(arrangements, nothing_leaks),
        cmocka_unit_test_teardown(planes, nothing_leaks),
        cmocka_unit_test_teardown(places, nothing_leaks),
        cmocka_unit_test_teardown(marks, nothing_leaks),
        cmocka_unit_test_teardown(holds, nothing_leaks),
        cmocka_unit_test_teardown(many, nothing_leaks),
        cmocka_unit_test_teardown(formats, nothing_leaks),
        cmocka_unit_test_teardown(moments, nothing_leaks),
        cmocka_unit_test_teardown(fades, nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
