/* Pictures of results of rods, from results as a job leaves them: curves, small print, motion, bundles. */
#include "base/memory.h"
#include "io/result.h"
#include "io/table.h"
#include "leaks.h"
#include "png_fixture.h"
#include "view/curves_picture.h"
#include "view/page.h"
#include "view/show.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

enum { NODES = 31, FRAMES = 5, COLUMNS = 13 };

static const char RESULT[] = "test_show_rod.vtkhdf";

/* What a test puts into its result. */
typedef struct Rods {
    int strands;                  /* each the helix, moved aside */
    bool simulated, motion, held; /* at the other end, too */
    bool designed;                /* the motion, by a field over time */
    bool poses;                   /* how its clamp stands, and            */
    double leads;                 /* m, how far it moves between frames   */
} Rods;

/* Columns of tests/rod/helix.csv for every strand; strands lie 4 cm apart. */
static double *columns(const Table *table, int first, int strands, double aside)
{
    double *values = mem_alloc((size_t)(3 * NODES * strands), sizeof *values), *next = values;
    for (int k = 0; k < strands; k++)
        for (int i = 0; i < NODES; i++)
            for (int c = 0; c < 3; c++)
                *next++ = table->values[i * COLUMNS + first + c] + (c == 1 ? aside * k : 0);
    return values;
}

static void put(Journal *journal, const char *kind, int index, Array array)
{
    Error err;
    if (!journal_put(journal, kind, index, &array, 1, &err)) fail_msg("%s", err.text);
}

/* From the natural shape to the input; the frames hold simulated, input and natural curves. */
static void put_frames(Journal *journal, const double *input, const double *natural, int points)
{
    int numbers = 3 * points;
    double *x = mem_alloc(3 * (size_t)numbers, sizeof *x);
    for (int k = 0; k < FRAMES; k++) {
        double time = 0.1 * k, w = (double)k / (FRAMES - 1);
        for (int i = 0; i < numbers; i++) {
            x[i] = natural[i] + w * (input[i] - natural[i]);
            x[numbers + i] = input[i], x[2 * numbers + i] = natural[i];
        }
        put(journal, "frame", k, array_float("x", "m", x, 2, 3 * points, 3));
        put(journal, "frame", k, array_float("time", "s", &time, 0, 0, 0));
        if (k > 0) put(journal, "evaluation", k - 1, array_float("time", "s", &time, 0, 0, 0));
    }
    mem_free(x);
}

/* A rod that is held at its other end, too. */
static void put_supports(Journal *journal)
{
    static const double end[] = {0.01132041885583, 0.009841144086364, -0.06221722076589};
    put(journal, "static", 0, array_float("rod/held", "m", end, 1, 3, 0));
    put(journal, "static", 0, array_text("rod/supports", "clamped"));
}

/* The clamp at the origin, which goes along x. */
static void put_poses(Journal *journal, double leads)
{
    double pose[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    put(journal, "static", 0, array_float("rod/support_pose", "1, m", pose, 2, 1, 12));
    for (int k = 0; k < FRAMES; k++, pose[3] += leads)
        put(journal, "frame", k, array_float("support_pose", "1, m", pose, 2, 1, 12));
}

/* A field over time, and the end of the last rod, which goes past a place. */
static void put_design(Journal *journal, const double (*input)[3], const double (*natural)[3], int points)
{
    static const int frames[] = {FRAMES - 1, FRAMES - 1}, follows[] = {0}, offsets[] = {0, 1};
    double way[1][FRAMES][3], distance[FRAMES] = {0}, field[FRAMES - 1][3];
    for (int k = 0; k < FRAMES; k++)
        for (int i = 0; i < 3; i++) {
            double from = natural[points - 1][i], w = (double)k / (FRAMES - 1);
            way[0][k][i] = from + w * (input[points - 1][i] - from);
        }
    Array followed = array_float("trajectory/followed", "m", way[0][0], 3, 1, FRAMES);
    followed.dims[2] = 3;
    put(journal, "final", 0, followed);
    put(journal, "final", 0, array_text("trajectory/reference/names", "waypoint\n"));
    put(journal, "final", 0, array_int("trajectory/reference/frames", frames, 2, 1, 2));
    put(journal, "final", 0, array_int("trajectory/reference/follows", follows, 1, 1, 0));
    put(journal, "final", 0, array_int("trajectory/reference/offsets", offsets, 1, 2, 0));
    put(journal, "final", 0, array_float("trajectory/reference/points", "m", way[0][FRAMES - 1], 2, 1, 3));
    put(journal, "final", 0, array_float("trajectory/reference/distance", "m", distance, 2, 1, FRAMES));
    for (int k = 0; k < FRAMES - 1; k++)
        for (int i = 0; i < 3; i++) field[k][i] = 1e-3 * (i + k);
    put(journal, "final", 0, array_float("trajectory/flux_density", "T", field[0], 2, FRAMES - 1, 3));
}

static void put_rods(Journal *journal, Rods rods, const Table *table)
{
    int count = NODES * rods.strands, offsets[64], lines[3 * 64][2], stable = 1;
    double gravity[3] = {0, 0, -9.8}, eigenvalue = 25.78, critical = 1.97845e6, round_trip = 7.1e-5;
    double *input = columns(table, 1, rods.strands, 0.04), *natural = columns(table, 4, rods.strands, 0.04),
           *strain = columns(table, 7, rods.strands, 0), *s = mem_alloc((size_t)count, sizeof *s);
    for (int i = 0; i < count; i++) s[i] = table->values[i % NODES * COLUMNS];
    for (int k = 0; k <= rods.strands; k++) offsets[k] = k * NODES;
    for (int k = 0; k < 3 * rods.strands; k++) lines[k][0] = k * NODES, lines[k][1] = NODES;
    put(journal, "static", 0, array_int("lines", lines[0], 2, 3 * rods.strands, 2));
    if (rods.strands > 1)
        put(journal, "static", 0, array_int("rod/strands", offsets, 1, rods.strands + 1, 0));
    put(journal, "static", 0, array_float("rod/gravity", "m/s^2", gravity, 1, 3, 0));
    put(journal, "final", 0, array_float("rod/input", "m", input, 2, count, 3));
    put(journal, "final", 0, array_float("rod/natural", "m", natural, 2, count, 3));
    put(journal, "final", 0, array_float("rod/natural_strain", "1/m", strain, 2, count, 3));
    put(journal, "final", 0, array_float("rod/s", "m", s, 1, count, 0));
    if (rods.simulated) put(journal, "final", 0, array_float("rod/x", "m", input, 2, count, 3));
    put(journal, "final", 0, array_int("rod/stable", &stable, 0, 0, 0));
    put(journal, "final", 0, array_float("rod/lowest_eigenvalue", "1/m^2", &eigenvalue, 0, 0, 0));
    put(journal, "final", 0, array_float("rod/critical_young", "Pa", &critical, 0, 0, 0));
    put(journal, "final", 0, array_float("metrics/round_trip", "m", &round_trip, 0, 0, 0));
    put(journal, "final", 0, array_text("status", "converged"));
    if (rods.held) put_supports(journal);
    if (rods.designed) put_design(journal, (const double(*)[3])input, (const double(*)[3])natural, count);
    if (rods.poses) put_poses(journal, rods.leads);
    if (rods.motion) put_frames(journal, input, natural, count);
    mem_free(input);
    mem_free(natural);
    mem_free(strain);
    mem_free(s);
}

static void write_result(Rods rods)
{
    Error err;
    Table table;
    if (!table_read(SOURCE_DIR "/tests/rod/helix.csv", NULL, &table, &err)) fail_msg("%s", err.text);
    assert_int_equal(table.rows, NODES);
    unlink("test_show_rod.run");
    Journal *journal = journal_open("test_show_rod.run", JOURNAL_NEW, &err);
    if (!journal) fail_msg("%s", err.text);
    put_rods(journal, rods, &table);
    if (!result_write(journal, RESULT, (ResultDef){0}, NULL, &err)) fail_msg("%s", err.text);
    journal_close(journal, &err);
    table_clear(&table);
}

/* ---- What is on the page ---- */

static const Color grey = {0.62, 0.62, 0.64, 1}, white = {1, 1, 1, 1};

typedef struct Page {
    int width, height;
    unsigned char *rgb;
} Page;

static Page draw(const ShowDef *def)
{
    Page page = {0};
    Error err = {""};
    if (show_result(RESULT, "test_show_rod.png", def, &err) != SHOW_DONE ||
        !png_read("test_show_rod.png", &page.rgb, &page.width, &page.height, &err))
        fail_msg("%s", err.text);
    return page;
}

static int count_pixels(const Page *page, Color color)
{
    const double wanted[3] = {255 * color.r, 255 * color.g, 255 * color.b};
    int count = 0;
    for (int i = 0; i < page->width * page->height; i++) {
        bool same = true;
        for (int c = 0; c < 3; c++) same = same && fabs(page->rgb[3 * i + c] - wanted[c]) < 1;
        count += same;
    }
    return count;
}

/* The input is grey, the natural shape blue, the simulated curve vermilion. */
static void curves(void **state)
{
    (void)state;
    ShowDef def = show_default();
    write_result((Rods){.strands = 1, .simulated = true});
    Page page = draw(&def);
    int simulated = count_pixels(&page, colormap_series(1));
    print_message("%d x %d pixels: %d grey, %d blue, %d vermilion, %d green\n", page.width, page.height,
                  count_pixels(&page, grey), count_pixels(&page, colormap_series(0)), simulated,
                  count_pixels(&page, colormap_series(2)));
    assert_true(count_pixels(&page, grey) > 3000 && count_pixels(&page, colormap_series(0)) > 3000);
    assert_true(simulated > 1000);
    assert_true(count_pixels(&page, colormap_series(2)) > 500); /* the chart's twist */
    mem_free(page.rgb);

    write_result((Rods){.strands = 1});
    page = draw(&def);
    assert_int_equal(count_pixels(&page, colormap_series(1)), 0);
    assert_true(count_pixels(&page, grey) > 3000);
    mem_free(page.rgb);
}

/* Both ends of a rod that is held there are marked, in three views. */
static void held(void **state)
{
    (void)state;
    ShowDef def = show_default();
    int ink[2];
    for (int k = 0; k < 2; k++) {
        write_result((Rods){.strands = 1, .simulated = true, .held = k > 0});
        Page page = draw(&def);
        ink[k] = count_pixels(&page, page_ink);
        mem_free(page.rgb);
    }
    print_message("pixels of ink: %d, with another clamp %d\n", ink[0], ink[1]);
    assert_true(ink[1] > ink[0] + 200);
}

/* Frames, moments over each other, and an animation. */
static void motion(void **state)
{
    (void)state;
    Error err = {""};
    ShowDef def = show_default();
    write_result((Rods){.strands = 1, .simulated = true, .motion = true});
    Page page = draw(&def);
    for (int k = 0; k < FRAMES; k++) /* as many as there are, the last in the full colour */
        assert_true(count_pixels(&page, curves_fade(colormap_series(1), (double)k / (FRAMES - 1))) > 200);
    mem_free(page.rgb);
    def.stills = 2;
    page = draw(&def);
    assert_true(count_pixels(&page, curves_fade(colormap_series(1), 0)) > 200);
    assert_true(count_pixels(&page, curves_fade(colormap_series(1), 0.5)) < 10);
    mem_free(page.rgb);
    def.stills = 0, def.frame = 2;
    page = draw(&def);
    assert_true(count_pixels(&page, colormap_series(1)) > 1000);
    mem_free(page.rgb);
    def.frame = FRAMES;
    assert_int_equal(show_result(RESULT, "test_show_rod.png", &def, &err), SHOW_HAS_NOT);
    assert_string_equal(err.text, "the result has 5 frames, from 0");
    def = show_default();
    def.seconds = 0.12, def.width = 400;
    assert_int_equal(show_result(RESULT, "test_show_rod.webp", &def, &err), SHOW_DONE);
    assert_int_equal(access("test_show_rod.webp", R_OK), 0);
}

static int count_words(const char *path, const char *word)
{
    char line[65536];
    int count = 0;
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file))
        for (const char *at = line; (at = strstr(at, word)); at++) count++;
    fclose(file);
    return count;
}

/* A designed motion: the path of what it leads, and the field over time. */
static void designed(void **state)
{
    (void)state;
    ShowDef def = show_default();
    int paths[2], field[2];
    for (int k = 0; k < 2; k++) {
        Error err = {""};
        write_result((Rods){.strands = 1, .simulated = true, .motion = true, .designed = k > 0});
        assert_int_equal(show_result(RESULT, "test_show_rod.svg", &def, &err), SHOW_DONE);
        paths[k] = count_words("test_show_rod.svg", "stroke:rgb(0%,62%,45.1%)");
        field[k] = count_words("test_show_rod.svg", "stroke:rgb(33.7%,70.6%,91.4%)");
    }
    unlink("test_show_rod.svg");
    assert_int_equal(paths[1] - paths[0], 4); /* in three views and the legend */
    assert_int_equal(field[1] - field[0], 2); /* of Bz, and in the legend */
}

/* The way of a clamp that has moved, dashed, in three views of all moments but the first one, and in the legend. */
static void ways(void **state)
{
    (void)state;
    ShowDef def = show_default();
    int dashes[2];
    for (int k = 0; k < 2; k++) {
        Error err = {""};
        write_result(
            (Rods){.strands = 1, .simulated = true, .motion = true, .poses = true, .leads = k * 0.01});
        assert_int_equal(show_result(RESULT, "test_show_rod.svg", &def, &err), SHOW_DONE);
        dashes[k] = count_words("test_show_rod.svg", "stroke-dasharray:2");
    }
    unlink("test_show_rod.svg");
    print_message("dashed ways: %d, of a clamp that moves %d\n", dashes[0], dashes[1]);
    assert_int_equal(dashes[0], 0);
    assert_int_equal(dashes[1], 3 * (FRAMES - 1) + 1);
}

/* Strands side by side fill the page that one leaves white; many are not shown in moments unless that is
 * asked for. */
static void bundles(void **state)
{
    (void)state;
    ShowDef def = show_default();
    write_result((Rods){.strands = 12, .simulated = true, .motion = true});
    Page page = draw(&def);
    assert_true(count_pixels(&page, curves_fade(colormap_series(1), 0)) > 200);
    assert_true(count_pixels(&page, colormap_series(2)) > 500);
    mem_free(page.rgb);
    write_result((Rods){.strands = 30, .simulated = true, .motion = true});
    page = draw(&def);
    double ink = 1 - (double)count_pixels(&page, white) / (page.width * page.height);
    print_message("30 strands: %.1f %% of the page is drawn on\n", 100 * ink);
    assert_true(ink > 0.025);
    assert_true(count_pixels(&page, curves_fade(colormap_series(1), 0)) < 50); /* some edge is as pale */
    mem_free(page.rgb);
}

static void expect_refusal(ShowDef def, const char *sentence)
{
    Error err = {""};
    assert_int_equal(show_result(RESULT, "test_show_rod.png", &def, &err), SHOW_HAS_NOT);
    assert_string_equal(err.text, sentence);
}

static void refused(void **state)
{
    (void)state;
    write_result((Rods){.strands = 1});
    ShowDef def = show_default();
    def.only = "up";
    expect_refusal(def, "--case up: the result has no load cases");
    def = show_default(), def.field = "young";
    expect_refusal(def, "--field young: curves have no faces to colour");
    def = show_default(), def.target = PICTURE_TARGET_BOTH;
    expect_refusal(def, "--target: the input of a rod is always drawn under the simulated curve");
    def = show_default(), def.arrows = false;
    expect_refusal(def, "--no-arrows: curves carry no arrows of magnetization");
    def = show_default(), def.stills = 3;
    expect_refusal(def, "the result has no frames");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(curves, nothing_leaks),  cmocka_unit_test_teardown(held, nothing_leaks),
        cmocka_unit_test_teardown(motion, nothing_leaks),  cmocka_unit_test_teardown(bundles, nothing_leaks),
        cmocka_unit_test_teardown(refused, nothing_leaks), cmocka_unit_test_teardown(designed, nothing_leaks),
        cmocka_unit_test_teardown(ways, nothing_leaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
