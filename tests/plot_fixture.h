/* plot_fixture.h - a plot of three layers, and what a machine would draw of it; after cmocka.h. */
#pragma once
#include "base/cubic.h"
#include "base/memory.h"
#include "io/plot_file.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Two curves of the first pen (the second of two segments), none of the second, a straight one of the third.
 */
static Vec2 black[] = {{10, 20}, {12.5, 20.0004}, {14.99996, 21}, {15, 25},      {40, 30},   {50, 10},
                       {60, 50}, {70, 30},        {75, 20},       {90, -0.0001}, {100, 47.5}};
static int black_start[] = {0, 4, 11};
static Vec2 red[] = {{5, 5}, {5, 15}, {5, 25}, {5, 35}};
static int red_start[] = {0, 4};
static PlotLayer layers[] = {
    {.name = "black", .color = {0, 0, 0, 1}, .pen = 0.5, .count = 2, .start = black_start, .points = black},
    {.name = "none", .color = {0, 1, 0, 1}, .pen = 0.3},
    {.name = "a \"red\" <&\xc3\xa9>\n",
     .color = {1, 0.5, 0, 1},
     .pen = 0.25,
     .count = 1,
     .start = red_start,
     .points = red}};
static const Plot plot = {.paper = {148, 105}, .layer_count = 3, .layers = layers};

static Plotter usual;

static inline char *file_text(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    char *text = mem_alloc(1 << 20, 1);
    assert_true(fread(text, 1, (1 << 20) - 1, file) > 0);
    fclose(file);
    return text;
}

/* What a machine would do: polylines drawn with the pen down, mm, y down. */
typedef struct Drawn {
    int lines, points, line[400], pens, pen[8];
    Vec2 at[400];
} Drawn;

static inline void draw_to(Drawn *drawn, Vec2 p)
{
    drawn->line[drawn->points] = drawn->lines - 1;
    drawn->at[drawn->points++] = p;
    assert_true(drawn->points < 400);
}

static inline Drawn read_hpgl(const char *c)
{
    Drawn drawn = {0};
    Vec2 at = {0, 0};
    bool down = false;
    for (; *c; c = strchr(c, ';') + 1 + (strchr(c, ';')[1] == '\n')) {
        int x, y, pen, given = sscanf(c + 2, "%d,%d;", &x, &y);
        if (sscanf(c, "SP%d;", &pen) == 1) drawn.pen[drawn.pens++] = pen;
        bool lowers = !strncmp(c, "PD", 2), lifts = !strncmp(c, "PU", 2);
        assert_true(lowers || lifts || !strncmp(c, "SP", 2) || !strncmp(c, "IN;", 3) || !strncmp(c, "VS", 2));
        if (lowers && !down) drawn.lines++, draw_to(&drawn, at);
        down = lowers || (down && !lifts);
        if (given == 2 && (lowers || lifts)) at = (Vec2){x / 40.0, 105 - y / 40.0};
        if (given == 2 && lowers) draw_to(&drawn, at);
    }
    return drawn;
}

static inline Drawn read_gcode(const char *c, const char *down_words, const char *up_words)
{
    Drawn drawn = {0};
    bool down = false;
    Vec2 at = {NAN, NAN};
    for (; *c; c = strchr(c, '\n') + 1) {
        double x, y, feed;
        int g;
        if (!strncmp(c, down_words, strlen(down_words))) {
            drawn.lines++;
            down = true;
            draw_to(&drawn, at);
        }
        if (!strncmp(c, up_words, strlen(up_words))) down = false;
        if (sscanf(c, "G%d X%lf Y%lf F%lf", &g, &x, &y, &feed) == 4) {
            at = (Vec2){x, 105 - y};
            assert_int_equal(g, down ? 1 : 0);
            assert_true(feed == (down ? 2400 : 6000));
            if (down) draw_to(&drawn, at);
        }
        if (sscanf(c, "; layer %d-", &g) == 1) drawn.pen[drawn.pens++] = g;
    }
    return drawn;
}

static inline double to_chord(Vec2 p, Vec2 a, Vec2 b)
{
    double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    double t = square > 0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / square : 0;
    t = fmin(fmax(t, 0), 1);
    return hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

/* The farthest that a point of the curves is from what was drawn for them; ends must be ends. */
static inline double deviation(const Drawn *drawn, double rounding)
{
    double worst = 0;
    int line = 0, first = 0;
    for (int l = 0; l < 3; l++) {
        for (int k = 0; k < layers[l].count; k++, line++) {
            const Vec2 *c = layers[l].points + layers[l].start[k],
                       *end = layers[l].points + layers[l].start[k + 1] - 1;
            int last = first;
            while (last + 1 < drawn->points && drawn->line[last + 1] == line) last++;
            assert_true(drawn->line[first] == line);
            assert_true(hypot(drawn->at[first].x - c->x, drawn->at[first].y - c->y) < rounding);
            assert_true(hypot(drawn->at[last].x - end->x, drawn->at[last].y - end->y) < rounding);
            for (; c < end; c += 3) {
                for (int s = 0; s <= 100; s++) {
                    double nearest = INFINITY;
                    for (int i = first; i < last; i++)
                        nearest =
                            fmin(nearest, to_chord(cubic_at(c, s / 100.0), drawn->at[i], drawn->at[i + 1]));
                    worst = fmax(worst, nearest);
                }
            }
            first = last + 1;
        }
    }
    assert_int_equal(line, drawn->lines);
    return worst;
}
