#include "base/memory.h"
#include "io/canvas.h"
#include "leaks.h"
#include "png_fixture.h"
#include <glob.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
#include <cmocka.h>

static const Color red = {1, 0, 0, 1}, blue = {0, 0, 1, 1}, black = {0, 0, 0, 1};

static void expect_close(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) fail_msg("%.17g is not %.17g", value, expected);
}

static Canvas *create(const char *path, double width, double height, double resolution)
{
    Error err = {""};
    Canvas *canvas = canvas_create(path, width, height, resolution, &err);
    if (!canvas) fail_msg("%s", err.text);
    return canvas;
}

static void finish(Canvas *canvas)
{
    Error err = {""};
    if (!canvas_save(canvas, &err)) fail_msg("%s", err.text);
    canvas_destroy(canvas);
}

/* A saved page's pixels. */
typedef struct Page {
    int width, height;
    unsigned char *rgb;
} Page;

static Page page_read(const char *path)
{
    Page page;
    Error err = {""};
    if (!png_read(path, &page.rgb, &page.width, &page.height, &err)) fail_msg("%s", err.text);
    return page;
}

static void expect_pixel(const Page *page, int row, int column, int r, int g, int b)
{
    const unsigned char *rgb = page->rgb + 3 * (row * page->width + column);
    if (rgb[0] != r || rgb[1] != g || rgb[2] != b)
        fail_msg("pixel %d,%d is %d %d %d, not %d %d %d", row, column, rgb[0], rgb[1], rgb[2], r, g, b);
}

static char *file_text(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    char *text = mem_alloc(1 << 20, 1);
    *length = fread(text, 1, (1 << 20) - 1, file);
    fclose(file);
    return text;
}

static void png_shapes(void **state)
{
    (void)state;
    Canvas *canvas = create("canvas.PNG", 20, 10, 2);
    expect_close(canvas_resolution(canvas), 2, 0);
    canvas_fill(canvas, (Box){1, 1, 4, 3}, red);
    canvas_line(canvas, (Vec2){0, 8}, (Vec2){20, 8}, (Pen){blue, 1, 0});
    canvas_polygon(canvas, (const Vec2[]){{10, 0}, {14, 0}, {14, 4}}, 3, black);
    canvas_circle(canvas, (Vec2){17, 3}, 2, blue);
    canvas_fill(canvas, (Box){0, 5, 2, 1}, (Color){0, 0, 0, 0.5});
    finish(canvas);

    Page page = page_read("canvas.PNG");
    assert_int_equal(page.width, 40);
    assert_int_equal(page.height, 20);
    expect_pixel(&page, 1, 2, 255, 255, 255);
    expect_pixel(&page, 2, 1, 255, 255, 255);
    expect_pixel(&page, 2, 2, 255, 0, 0);
    expect_pixel(&page, 7, 9, 255, 0, 0);
    expect_pixel(&page, 8, 9, 255, 255, 255);
    expect_pixel(&page, 15, 20, 0, 0, 255); /* the line covers y = 7.5 .. 8.5 */
    expect_pixel(&page, 16, 20, 0, 0, 255);
    expect_pixel(&page, 14, 20, 255, 255, 255);
    expect_pixel(&page, 17, 20, 255, 255, 255);
    expect_pixel(&page, 1, 26, 0, 0, 0);
    expect_pixel(&page, 6, 21, 255, 255, 255);
    expect_pixel(&page, 6, 34, 0, 0, 255);
    expect_pixel(&page, 10, 0, 127, 127, 127);
    mem_free(page.rgb);
}

static void clip_and_image(void **state)
{
    (void)state;
    Canvas *canvas = create("canvas_clip.png", 8, 4, 1);
    canvas_clip(canvas, (Box){0, 0, 4, 4});
    canvas_clip(canvas, (Box){2, 0, 6, 4});
    canvas_fill(canvas, (Box){0, 0, 8, 1}, red);
    canvas_unclip(canvas);
    canvas_unclip(canvas);
    canvas_fill(canvas, (Box){7, 0, 1, 1}, red);
    const unsigned char rgba[] = {10, 20, 30, 255, 0, 0, 0, 0, 0, 0, 0, 51, 255, 255, 255, 255};
    canvas_image(canvas, rgba, 2, 2, (Box){3, 2, 2, 2});
    finish(canvas);
    Page page = page_read("canvas_clip.png");
    expect_pixel(&page, 0, 1, 255, 255, 255);
    expect_pixel(&page, 0, 2, 255, 0, 0);
    expect_pixel(&page, 0, 3, 255, 0, 0);
    expect_pixel(&page, 0, 4, 255, 255, 255);
    expect_pixel(&page, 0, 7, 255, 0, 0);
    expect_pixel(&page, 2, 3, 10, 20, 30);
    expect_pixel(&page, 2, 4, 255, 255, 255);
    expect_pixel(&page, 3, 3, 204, 204, 204);
    mem_free(page.rgb);
}

static int dark_pixels(const Page *page, int left, int right)
{
    int count = 0;
    for (int i = 0; i < page->height; i++)
        for (int j = left; j < right; j++) count += page->rgb[3 * (i * page->width + j)] < 128;
    return count;
}

static void texts(void **state)
{
    (void)state;
    Canvas *canvas = create("canvas_text.png", 120, 20, 2);
    const TextStyle style = {.color = black, .size = 10};
    double width = canvas_text_width(canvas, "magnetization", style);
    assert_true(width > 40 && width < 100);
    expect_close(canvas_text_width(canvas, "magnetization", (TextStyle){.size = 20}), 2 * width,
                 0.02 * width);
    assert_true(canvas_text_width(canvas, "magnetization", (TextStyle){.size = 10, .bold = true}) > width);
    expect_close(canvas_text_width(canvas, "", style), 0, 0);
    canvas_text(canvas, (Vec2){60, 15}, "HHHH", (TextStyle){.color = black, .size = 10, .align = TEXT_RIGHT});
    finish(canvas);
    Page page = page_read("canvas_text.png");
    assert_true(dark_pixels(&page, 0, 120) > 100); /* left of x = 60 pt only */
    assert_int_equal(dark_pixels(&page, 121, 240), 0);
    mem_free(page.rgb);
}

static void vector_formats(void **state)
{
    (void)state;
    const char *const paths[] = {"canvas.svg", "canvas.pdf"};
    for (int i = 0; i < 2; i++) {
        Canvas *canvas = create(paths[i], 200, 100, 3);
        canvas_arrow(canvas, (Vec2){10, 10}, (Vec2){100, 10}, (Pen){red, 1, 0});
        canvas_text(canvas, (Vec2){10, 50}, "µT", (TextStyle){.color = black, .size = 10, .upwards = true});
        canvas_frame(canvas, (Box){1, 1, 198, 98}, (Pen){black, 1, 4});
        finish(canvas);
    }
    size_t length;
    char *svg = file_text("canvas.svg", &length);
    assert_int_equal(strncmp(svg, "<?xml", 5), 0);
    assert_non_null(strstr(svg, "width=\"200"));
    assert_non_null(strstr(svg, "stroke-dasharray"));
    assert_non_null(strstr(svg, "glyph"));
    assert_string_equal(svg + length - 7, "</svg>\n");
    mem_free(svg);
    char *pdf = file_text("canvas.pdf", &length);
    assert_int_equal(strncmp(pdf, "%PDF-1.", 7), 0);
    assert_string_equal(pdf + length - 6, "%%EOF\n");
    mem_free(pdf);
}

static void refused(void **state)
{
    (void)state;
    Error err = {""};
    assert_null(canvas_create("page.jpg", 100, 100, 1, &err));
    assert_string_equal(
        err.text, "page.jpg: pictures are written as .png, .svg or .pdf; give the file one of these endings");
    assert_null(canvas_create("page", 100, 100, 1, &err));
    assert_null(canvas_create("page.png", 10000, 100, 4, &err));
    assert_string_equal(
        err.text,
        "page.png: a page of 10000 x 100 points; 1 to 10000 points are allowed, and 32000 pixels in a PNG");
    assert_null(canvas_create("page.svg", 0, 100, 1, &err));
    assert_null(canvas_create("page.svg", 0.0 / 0.0, 100, 1, &err));

    Canvas *canvas = create("no/such/folder/page.png", 10, 10, 1);
    assert_false(canvas_save(canvas, &err));
    assert_string_equal(err.text, "no/such/folder/page.png: cannot be written: No such file or directory");
    canvas_destroy(canvas);
    canvas_destroy(NULL);
}

/* What was there stays when the new page cannot be written whole. */
static void old_file_survives(void **state)
{
    (void)state;
    finish(create("canvas_old.png", 10, 10, 1));
    struct rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &(struct rlimit){64, limit.rlim_max});
    Canvas *canvas = create("canvas_old.png", 20, 20, 1);
    Error err = {""};
    assert_false(canvas_save(canvas, &err));
    setrlimit(RLIMIT_FSIZE, &limit);
    assert_string_equal(err.text, "canvas_old.png: cannot be written: File too large");
    canvas_destroy(canvas);
    glob_t found;
    assert_int_equal(glob("canvas_old.png?*", 0, NULL, &found), GLOB_NOMATCH);
    Page page = page_read("canvas_old.png");
    assert_int_equal(page.width, 10);
    mem_free(page.rgb);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(png_shapes, nothing_leaks),
        cmocka_unit_test_teardown(clip_and_image, nothing_leaks),
        cmocka_unit_test_teardown(texts, nothing_leaks),
        cmocka_unit_test_teardown(vector_formats, nothing_leaks),
        cmocka_unit_test_teardown(refused, nothing_leaks),
        cmocka_unit_test_teardown(old_file_survives, nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
