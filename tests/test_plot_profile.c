/* Profiles of machines from files: points read back, limits, refills, refusals. */
#include "base/cubic.h"
#include "base/memory.h"
#include "io/plot_file.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "plot_fixture.h"

static int live(void **state)
{
    (void)state;
    return mem_live_count() == 0 ? 0 : -1;
}

static void write_profile(const char *text)
{
    FILE *file = fopen("own.yaml", "w");
    assert_true(file && fputs(text, file) >= 0 && fclose(file) == 0);
}

#define OWN                                                                                                  \
    "slender: 1\n"                                                                                           \
    "travel: \"T{x},{y}\\n\"\ndown: \"D\\n\"\nline: \"L{x},{y}\\n\"\nup: \"U\\n\"\n"

/* The plot in the words of own.yaml; NULL where it is refused. */
static char *written_own(const Plot *what, Error *err)
{
    PlotProfile profile;
    bool ok = plot_profile_read("own.yaml", &profile, err) &&
              plot_write_machine("plot.out", what, &profile, &usual, err);
    plot_profile_clear(&profile);
    return ok ? file_text("plot.out") : NULL;
}

/* A page that stands, turned, in hundredths from a place within it: read back, the curves are where they were. */
static void profiles_of_files(void **state)
{
    (void)state;
    Error err = {""};
    Plot high = plot;
    high.paper[0] = 105, high.paper[1] = 148;
    write_profile(OWN "units: 100\ndecimals: 0\nturn: portrait\norigin: [1 mm, 2 mm]\n");
    char *text = written_own(&high, &err);
    if (!text) fail_msg("%s", err.text);
    Drawn drawn = {0};
    double x = 0, y = 0;
    for (const char *c = text; *c; c = strchr(c, '\n') + 1) {
        if (sscanf(c + 1, "%lf,%lf", &x, &y) == 2) assert_true(*c == 'T' || *c == 'L');
        Vec2 at = {105 - (y / 100 + 2), 148 - (x / 100 + 1)};
        if (*c == 'D') drawn.lines++;
        if (*c == 'D' || *c == 'L') draw_to(&drawn, at);
    }
    assert_true(deviation(&drawn, 0.0071) < 0.05 + 0.0071);
    mem_free(text);
    /* the plot reaches to x = 100 and y = 50 of the paper, from 5 and 0 on; turned: 97 .. 147 mm, 3 .. 98 mm */
    write_profile(OWN "turn: portrait\norigin: [90 mm, 5 mm]\nlimits: [58.1 mm, 95.1 mm]\n");
    text = written_own(&high, &err);
    if (!text) fail_msg("%s", err.text);
    mem_free(text);
    static const char *const narrow[] = {"[58.1 mm, 94.8 mm]", "[57.8 mm, 95.1 mm]"};
    for (int k = 0; k < 2; k++) {
        char words[400];
        snprintf(words, sizeof words, OWN "turn: portrait\norigin: [90 mm, 5 mm]\nlimits: %s\n", narrow[k]);
        write_profile(words);
        assert_null(written_own(&high, &err));
        assert_non_null(strstr(err.text, "and it reaches from (0, 0) to (5"));
    }
}

/* Those that come with the program: their words draw the plot. */
static void shipped_profiles(void **state)
{
    (void)state;
    static const char *const names[] = {"grbl_servo", "brush", "hp7475a"};
    for (int m = 0; m < 3; m++) {
        Error err = {""};
        PlotProfile profile;
        char path[300];
        snprintf(path, sizeof path, SOURCE_DIR "/scenes/plotters/%s.yaml", names[m]);
        if (!plot_profile_read(path, &profile, &err)) fail_msg("%s", err.text);
        if (m == 2) profile.origin[0] = profile.origin[1] = 0; /* as the reader has it */
        if (!plot_write_machine("plot.out", &plot, &profile, &usual, &err)) fail_msg("%s", err.text);
        plot_profile_clear(&profile);
        char *text = file_text("plot.out");
        const char *first = strstr(text, m == 2 ? "SP1;" : "; pen 1"); /* the brush has been to its pot */
        memmove(text, first, strlen(first) + 1);
        Drawn drawn = m == 0   ? read_gcode(text, "M3 S30", "M5")
                      : m == 1 ? read_gcode(text, "G1 Z0", "G0 Z5")
                               : read_hpgl(text);
        assert_true(deviation(&drawn, m == 2 ? 0.018 : 0.001) < 0.07);
        mem_free(text);
    }
}

/* Lines of 30 mm and one of 100 mm, which is not broken; each pen begins anew. */
static void refills(void **state)
{
    (void)state;
    Error err = {""};
    static Vec2 points[24];
    static int start[] = {0, 4, 8, 12, 16, 20, 24};
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < 4; i++) points[4 * k + i] = (Vec2){10 + (k == 3 ? 100 : 30) * i / 3.0, 10.0 + k};
    PlotLayer two[] = {{.name = "a", .pen = 1, .count = 6, .start = start, .points = points},
                       {.name = "b", .pen = 1, .count = 2, .start = start, .points = points}};
    Plot lines = {.paper = {148, 105}, .layer_count = 2, .layers = two};
    write_profile(OWN "layer: \"P{pen}\\n\"\nrefill: \"R\\n\"\nrefill_after: 70 mm\n");
    char *text = written_own(&lines, &err), order[64] = "";
    if (!text) fail_msg("%s", err.text);
    for (const char *c = text; *c; c = strchr(c, '\n') + 1)
        if (strchr("PRD", *c)) strncat(order, c, 1);
    assert_string_equal(order, "PDDRDRDRDDPDD");
    mem_free(text);
}

static void refused_profiles(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
    } rows[] = {
        {OWN "header: \"G0 {speed}\"\n",
         "own.yaml:6:9: header: \"{speed}\" stands for nothing; there are {x}, {y},"},
        {OWN "header: \"G0 {x\"\n", "\"{x\" stands for nothing"},
        {OWN "refill: R\n", "after how much ink? Say `refill_after`"},
        {OWN "refill_after: 1 m\n", "refill_after"},
        {OWN "unit: 40\n", "units"},
        {OWN "limits: [0, 1 m]\n", "limits"},
        {"slender: 1\ntravel: a\nup: b\ndown: c\n", "line"},
        {"slender: 1\ntravel: \"{x},{y}\"\nup: b\ndown: c\nline: \"\"\n",
         "own.yaml:5:7: line: these words do not say where to: {x} and {y} are needed"},
        {"slender: 1\ntravel: \"{x}\"\nup: b\ndown: c\nline: \"{x},{y}\"\n",
         "own.yaml:2:9: travel: these words do not say where to"},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        Error err = {""};
        write_profile(rows[k].text);
        if (written_own(&plot, &err)) fail_msg("taken: %s", rows[k].text);
        if (!strstr(err.text, "own.yaml") || !strstr(err.text, rows[k].says))
            fail_msg("\"%s\" does not say \"%s\"", err.text, rows[k].says);
    }
}

int main(void)
{
    usual = plotter_default();
    const struct CMUnitTest tests[] = {cmocka_unit_test(profiles_of_files),
                                       cmocka_unit_test(shipped_profiles), cmocka_unit_test(refills),
                                       cmocka_unit_test(refused_profiles)};
    return cmocka_run_group_tests(tests, NULL, live);
}
