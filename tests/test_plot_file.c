/* Plots as files: SVG word for word, XML that can be read, machines' points read back; times; sizes of paper.
 */
#include "base/cubic.h"
#include "base/memory.h"
#include "io/paper.h"
#include "io/plot_file.h"
#include <ctype.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "plot_fixture.h"

static char *written_svg(const Plot *what)
{
    Error err = {""};
    unlink("plot.svg");
    if (!plot_write_svg("plot.svg", what, &err)) fail_msg("%s", err.text);
    return file_text("plot.svg");
}

static void svg_words(void **state)
{
    (void)state;
    char *text = written_svg(&plot), *again = written_svg(&plot);
    assert_string_equal(
        text,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" width=\"148mm\" height=\"105mm\" "
        "viewBox=\"0 0 148 105\">\n"
        "<g id=\"layer1\" inkscape:groupmode=\"layer\" inkscape:label=\"1-black\" fill=\"none\" "
        "stroke=\"#000000\" stroke-width=\"0.5\" stroke-linecap=\"round\" stroke-linejoin=\"round\" "
        "style=\"mix-blend-mode:multiply\">\n"
        "<path d=\"M10 20C12.5 20 15 21 15 25\"/>\n"
        "<path d=\"M40 30C50 10 60 50 70 30 75 20 90 0 100 47.5\"/>\n"
        "</g>\n"
        "<g id=\"layer3\" inkscape:groupmode=\"layer\" inkscape:label=\"3-a &#34;red&#34; "
        "&#60;&#38;\xc3\xa9>\\x0a\" "
        "fill=\"none\" stroke=\"#ff8000\" stroke-width=\"0.25\" stroke-linecap=\"round\" "
        "stroke-linejoin=\"round\" style=\"mix-blend-mode:multiply\">\n"
        "<path d=\"M5 5C5 15 5 25 5 35\"/>\n"
        "</g>\n"
        "<metadata>made by slender " SLENDER_VERSION "</metadata>\n"
        "</svg>\n");
    assert_string_equal(text, again);
    mem_free(text);
    mem_free(again);
}

/* Paper of a colour is a style of the whole; opaque ink hides what is below it. White paper says nothing. */
static void svg_paper(void **state)
{
    (void)state;
    PlotLayer paint = layers[2];
    paint.opaque = true;
    Plot dark = {.paper = {148, 105}, .color = {0.2, 0, 1, 1}, .layer_count = 1, .layers = &paint};
    char *text = written_svg(&dark);
    assert_non_null(strstr(text, "viewBox=\"0 0 148 105\" style=\"background:#3300ff\">\n<g "));
    assert_non_null(strstr(text, "stroke-linejoin=\"round\">\n<path"));
    assert_null(strstr(text, "multiply"));
    mem_free(text);
    dark.color = (Color){1, 1, 1, 1};
    text = written_svg(&dark);
    assert_null(strstr(text, "background"));
    mem_free(text);
}

/* One tag that begins at <: its name and whether it ends or begins an element; what follows it. Attributes
 * must be name="value" with nothing in the value that XML forbids there. */
static const char *read_tag(const char *c, char name[32], int *depth)
{
    bool ends = c[1] == '/';
    int length = 0;
    for (c += ends ? 2 : 1; isalnum((unsigned char)*c) && length < 31; c++) name[length++] = *c;
    name[length] = 0;
    assert_true(length > 0);
    for (;;) {
        while (isspace((unsigned char)*c)) c++;
        if (*c == '>' || !strncmp(c, "/>", 2)) break;
        assert_true(!ends && isalpha((unsigned char)*c));
        while (isalnum((unsigned char)*c) || *c == '-' || *c == ':') c++;
        assert_true(c[0] == '=' && c[1] == '"');
        for (c += 2; *c && *c != '"'; c++) {
            assert_true(*c != '<' && (unsigned char)*c >= 0x20);
            if (*c == '&') assert_true(strcspn(c, ";") < 6 && c[1] == '#');
        }
        assert_int_equal(*c++, '"');
    }
    *depth = *c == '/' ? 0 : ends ? -1 : 1;
    return strchr(c, '>') + 1;
}

static void svg_is_xml(void **state)
{
    (void)state;
    char *text = written_svg(&plot), open[8][32], name[32];
    int depth = 0, paths = 0, change;
    const char *c = strchr(text, '\n');
    assert_true(!strncmp(text, "<?xml version=\"1.0\"", 19));
    while ((c = strchr(c, '<'))) {
        c = read_tag(c, name, &change);
        if (change > 0) strcpy(open[depth++], name);
        if (change < 0) assert_string_equal(open[--depth], name);
        paths += !strcmp(name, "path");
        if (!strcmp(name, "g")) assert_int_equal(depth, change > 0 ? 2 : 1); /* layers are not wrapped */
        assert_true(depth < 8 && (depth > 0 || !strchr(c, '<')));
    }
    assert_int_equal(depth, 0);
    assert_int_equal(paths, 3);
    mem_free(text);
}

static void refused_plots(void **state)
{
    (void)state;
    Error err = {""};
    Vec2 points[] = {{1, 1}, {2, 2}, {NAN, 3}, {4, 4}};
    PlotLayer bad = {.name = "bad", .pen = 1, .count = 1, .start = red_start, .points = points};
    Plot wrong = {.paper = {100, 100}, .layer_count = 1, .layers = &bad};
    PlotProfile profile;
    assert_true(plot_profile("hpgl", &profile, &err));
    char *before = written_svg(&plot);
    assert_false(plot_write_svg("plot.svg", &wrong, &err));
    assert_non_null(strstr(err.text, "layer 1 has a point at (nan, 3) mm"));
    assert_false(plot_write_machine("plot.svg", &wrong, &profile, &usual, &err));
    points[2].x = 201;
    assert_false(plot_write_svg("plot.svg", &wrong, &err));
    char *after = file_text("plot.svg");
    assert_string_equal(before, after);
    assert_false(plot_write_svg("no/such/folder.svg", &plot, &err));
    assert_non_null(strstr(err.text, "no/such/folder.svg: cannot be written"));
    assert_false(plot_profile("gerber", &profile, &err));
    assert_non_null(strstr(err.text, "gcode, gcode_servo or hpgl"));
    mem_free(before);
    mem_free(after);
}

static void machines(void **state)
{
    (void)state;
    static const char *const names[] = {"hpgl", "gcode", "gcode_servo"};
    for (int m = 0; m < 3; m++) {
        Error err = {""};
        PlotProfile profile;
        assert_true(plot_profile(names[m], &profile, &err));
        if (!plot_write_machine("plot.out", &plot, &profile, &usual, &err)) fail_msg("%s", err.text);
        char *text = file_text("plot.out");
        Drawn drawn = m == 0   ? read_hpgl(text)
                      : m == 1 ? read_gcode(text, "G1 Z0", "G0 Z5")
                               : read_gcode(text, "M3 S30", "M5");
        double rounding = m ? 0.001 : 0.018, worst = deviation(&drawn, rounding);
        print_message("%s: %d points, at most %.4f mm from the curves\n", names[m], drawn.points, worst);
        assert_true(worst < 0.05 + rounding);
        assert_true(drawn.pens >= 2 && drawn.pen[0] == 1 && drawn.pen[1] == 3);
        if (m)
            assert_true(strstr(text, "M0") && !strstr(strstr(text, "M0") + 1, "M0")); /* one change of pens */
        mem_free(text);
    }
}

/* No byte of a name is one that a machine obeys in comments; the SVG has the name as it is. */
static void names_for_machines(void **state)
{
    (void)state;
    static const char *const languages[] = {"gcode", "gcode_servo", "hpgl"};
    char name[512] = "Pen 0.5!?~ \xc4\x8c\xc4\x84 (x);%$*\r\n";
    memset(name + strlen(name), 'n', 400);
    PlotLayer layer = layers[0];
    layer.name = name;
    Plot one = {.paper = {148, 105}, .layer_count = 1, .layers = &layer};
    for (int m = 0; m < 3; m++) {
        Error err = {""};
        PlotProfile profile;
        assert_true(plot_profile(languages[m], &profile, &err));
        if (!plot_write_machine("plot.out", &one, &profile, &usual, &err)) fail_msg("%s", err.text);
        char *text = file_text("plot.out");
        if (m < 2) assert_non_null(strstr(text, "; layer 1-Pen 0.5___ __ _x_______nnn"));
        int column = 0;
        for (const char *c = text; *c; c++) {
            assert_true(*c == '\n' || (*c >= 0x20 && *c < 0x7f && !strchr("!?~()%$*", *c)));
            column = *c == '\n' ? 0 : column + 1;
            assert_true(column < 80);
        }
        mem_free(text);
    }
    char *text = written_svg(&one);
    assert_non_null(strstr(text, "1-Pen 0.5!?~ \xc4\x8c\xc4\x84 (x);%$*\\x0d\\x0annn"));
    mem_free(text);
}

static int count_of(const char *text, const char *word)
{
    int count = 0;
    for (const char *at = text; (at = strstr(at, word)); at += strlen(word)) count++;
    return count;
}

/* The words that lift and lower the pen of three strokes, and how fast HPGL draws. */
static void lifts(void **state)
{
    (void)state;
    static const struct {
        const char *language, *up, *down;
        Plotter plotter;
    } rows[] = {
        {"gcode", "G0 Z3 F210\n", "G1 Z-0.5 F210\n", {.lift = 2, .z_up = 3, .z_down = -0.5, .z_speed = 10}},
        {"gcode", "G0 Z3 F60\n", "G1 Z-0.5 F60\n", {.lift = 2, .z_up = 3, .z_down = -0.5, .z_speed = 1}},
        {"gcode", "G0 Z5 F600\n", "G1 Z0 F600\n", {.lift = 0, .z_up = 5, .z_speed = 10}},
        {"gcode_servo",
         "M3 S90\nG4 P0.5\n",
         "M3 S10\nG4 P0.5\n",
         {.lift = 1, .pause = 1, .z_speed = 1, .servo_up = "M3 S90", .servo_down = "M3 S10"}},
        {"gcode_servo",
         "M280 P0 S90\nG4 P125\n",
         "M280 P0 S9\nG4 P125\n",
         {.lift = 0.25, .pause = 1e-3, .z_speed = 1, .servo_up = "M280 P0 S90", .servo_down = "M280 P0 S9"}},
        {"hpgl", "IN;VS4;\n", "PD;\n", {.z_speed = 1}},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        Error err = {""};
        PlotProfile profile;
        Plotter plotter = rows[k].plotter;
        plotter.down = 40, plotter.up = 100;
        assert_true(plot_profile(rows[k].language, &profile, &err));
        if (!plot_write_machine("plot.out", &plot, &profile, &plotter, &err)) fail_msg("%s", err.text);
        char *text = file_text("plot.out");
        assert_int_equal(count_of(text, rows[k].down), 3);
        assert_int_equal(count_of(text, rows[k].up), !strcmp(rows[k].language, "gcode") ? 4 : k == 5 ? 1 : 3);
        mem_free(text);
    }
}

static void own_profile(void **state)
{
    (void)state;
    PlotProfile profile = {.header = "{ {y\n",
                           .footer = "end",
                           .change = "wait {pen}\n",
                           .layer = "[{name}]\n",
                           .travel = "({x};{y})",
                           .down = "{nothing}",
                           .line = ">{x},{y}@{feed}",
                           .up = "^{travel_feed}\n",
                           .units = 0.1,
                           .decimals = 2,
                           .tolerance = 1000};
    Error err = {""};
    Plotter slow = {.down = 0.5, .up = 1};
    if (!plot_write_machine("plot.out", &plot, &profile, &slow, &err)) fail_msg("%s", err.text);
    char *text = file_text("plot.out");
    assert_string_equal(text, "{ {y\n[black]\n"
                              "(1;2){nothing}>1.5,2.5@30^60\n"
                              "(4;3){nothing}>7,3@30>10,4.75@30^60\n"
                              "wait 3\n[a _red_ _____]\n"
                              "(0.5;0.5){nothing}>0.5,3.5@30^60\n"
                              "end");
    mem_free(text);
}

static void times(void **state)
{
    (void)state;
    Vec2 points[] = {{30, 40}, {30, 50}, {30, 60}, {30, 70}, {60, 70}, {70, 70}, {80, 70}, {90, 70}};
    int start[] = {0, 4, 8};
    PlotLayer layer = {.name = "x", .pen = 1, .count = 2, .start = start, .points = points};
    Plotter plotter = {.down = 10, .up = 20, .lift = 0.25};
    PlotEstimate estimate = plot_estimate(&layer, &plotter);
    assert_true(fabs(estimate.ink - 60) < 1e-9);
    assert_true(fabs(estimate.travel - (50 + 30 + hypot(90, 70))) < 1e-9);
    assert_true(fabs(estimate.seconds - (6 + estimate.travel / 20 + 0.5)) < 1e-9);
    PlotEstimate empty = plot_estimate(&layers[1], &usual);
    assert_true(empty.ink == 0 && empty.travel == 0 && empty.seconds == 0);

    /* A quarter of a circle of 10 mm as a cubic: its length is known to 1e-6. */
    Vec2 arc[] = {{10, 0}, {10, 5.5228475}, {5.5228475, 10}, {0, 10}};
    PlotLayer quarter = {.name = "x", .pen = 1, .count = 1, .start = red_start, .points = arc};
    assert_true(fabs(plot_estimate(&quarter, &usual).ink - 15.7091) < 2e-3);
}

static void papers(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double width, height;
    } rows[] = {{"a4", 0.21, 0.297},
                {"A3", 0.297, 0.42},
                {"a5 landscape", 0.21, 0.148},
                {"Letter", 0.2159, 0.2794},
                {"210x297mm", 0.21, 0.297},
                {"210x297mm landscape", 0.297, 0.21},
                {"30x20cm portrait", 0.2, 0.3},
                {"8.5x11in", 0.2159, 0.2794},
                {" 1.5x2m ", 1.5, 2}};
    static const char *const wrong[] = {"",         "a7",           "a4 sideways", "210x297",       "210mm",
                                        "0x10mm",   "11x1m",        "nanx10mm",    "10x10mm x y z", "a4 a4",
                                        "10x10mmm", "10 x 10 mm ft"};
    Error err = {""};
    double size[2];
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        if (!paper_size(rows[k].text, size, &err)) fail_msg("%s", err.text);
        assert_true(fabs(size[0] - rows[k].width) < 1e-12 && fabs(size[1] - rows[k].height) < 1e-12);
    }
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
        if (paper_size(wrong[k], size, &err)) fail_msg("\"%s\" is a paper", wrong[k]);
    assert_non_null(strstr(err.text, "210x297mm"));
}

static int live(void **state)
{
    (void)state;
    return mem_live_count() == 0 ? 0 : -1;
}

int main(void)
{
    usual = plotter_default();
    const struct CMUnitTest tests[] = {cmocka_unit_test(svg_words),   cmocka_unit_test(svg_paper),
                                       cmocka_unit_test(svg_is_xml),  cmocka_unit_test(refused_plots),
                                       cmocka_unit_test(machines),    cmocka_unit_test(names_for_machines),
                                       cmocka_unit_test(own_profile), cmocka_unit_test(times),
                                       cmocka_unit_test(papers),      cmocka_unit_test(lifts)};
    return cmocka_run_group_tests(tests, NULL, live);
}
