/* Plots in parts: every curve once, in its order, with its pen; as much ink as fits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>
#include "io/plot_split.h"
#include "plot_fixture.h"

static double ink_of(const Plot *part)
{
    double ink = 0;
    for (int k = 0; k < part->layer_count; k++) ink += plot_estimate(&part->layers[k], &usual).ink;
    return ink;
}

static int curves_of(const Plot *part)
{
    int count = 0;
    for (int k = 0; k < part->layer_count; k++) count += part->layers[k].count;
    return count;
}

/* The curves of all parts are those of the whole: the same points, by the same pens, in the same order. */
static void expect_whole(const PlotParts *parts, const Plot *whole)
{
    int seen[8] = {0}, last = 0;
    for (int p = 0; p < parts->count; p++) {
        const Plot *part = &parts->plots[p];
        assert_true(part->layer_count == whole->layer_count && part->paper[0] == whole->paper[0]);
        assert_true(curves_of(part) > 0);
        for (int k = 0; k < part->layer_count; k++) {
            const PlotLayer *own = &part->layers[k], *all = &whole->layers[k];
            assert_ptr_equal(own->name, all->name);
            assert_true(own->count == 0 || k >= last);
            for (int i = 0; i < own->count; i++, seen[k]++)
                assert_true(own->points + own->start[i] == all->points + all->start[seen[k]] &&
                            own->start[i + 1] == all->start[seen[k] + 1]);
            if (own->count) last = k;
        }
    }
    for (int k = 0; k < whole->layer_count; k++) assert_int_equal(seen[k], whole->layers[k].count);
}

static void by_pens(void **state)
{
    (void)state;
    PlotParts parts = plot_split_pens(&plot);
    assert_int_equal(parts.count, 2);
    expect_whole(&parts, &plot);
    assert_true(parts.plots[0].layers[0].count == 2 && parts.plots[1].layers[2].count == 1);
    PlotProfile profile;
    Error err = {""};
    assert_true(plot_profile("hpgl", &profile, &err));
    assert_true(plot_write_machine("part.hpgl", &parts.plots[1], &profile, &usual, &err));
    char *text = file_text("part.hpgl");
    assert_non_null(strstr(text, "SP3;")); /* the third pen stays the third */
    assert_null(strstr(text, "SP1;"));
    mem_free(text);
    plot_parts_clear(&parts);
}

/* 40 lines of 1 to 40 mm by two pens. No part has more than it may, but for a single longer line; the next part's first
 * line would not have fitted. */
static void by_ink(void **state)
{
    (void)state;
    enum { LINES = 40 };
    static Vec2 points[4 * LINES];
    static int start[LINES + 1];
    for (int k = 0; k < LINES; k++) {
        for (int i = 0; i < 4; i++) points[4 * k + i] = (Vec2){10 + (k * 17 % LINES + 1) * i / 3.0, 10 + k};
        start[k + 1] = 4 * (k + 1);
    }
    PlotLayer two[] = {{.name = "a", .pen = 1, .count = 25, .start = start, .points = points},
                       {.name = "b", .pen = 1, .count = 15, .start = start + 25, .points = points}};
    const Plot lines = {.paper = {148, 105}, .layer_count = 2, .layers = two};
    static const double mosts[] = {0.5, 30, 100, 817, 1e6};
    for (int m = 0; m < 5; m++) {
        PlotParts parts = plot_split_ink(&lines, mosts[m]);
        expect_whole(&parts, &lines);
        assert_int_equal(m == 0 ? parts.count : 40, 40);
        assert_int_equal(m == 4 ? parts.count : 1, 1);
        for (int p = 0; p < parts.count; p++) {
            const Plot *part = &parts.plots[p];
            assert_true(ink_of(part) <= mosts[m] + 1e-9 || curves_of(part) == 1);
            if (p + 1 == parts.count) continue;
            Plot next = parts.plots[p + 1];
            PlotLayer first = next.layers[next.layers[0].count ? 0 : 1];
            first.count = 1;
            assert_true(ink_of(part) + plot_estimate(&first, &usual).ink > mosts[m] - 1e-9);
        }
        plot_parts_clear(&parts);
    }
    PlotParts none = plot_split_ink(&(Plot){.paper = {10, 10}}, 5);
    assert_int_equal(none.count, 0);
    plot_parts_clear(&none);
}

static int live(void **state)
{
    (void)state;
    return mem_live_count() == 0 ? 0 : -1;
}

int main(void)
{
    usual = plotter_default();
    const struct CMUnitTest tests[] = {cmocka_unit_test(by_pens), cmocka_unit_test(by_ink)};
    return cmocka_run_group_tests(tests, NULL, live);
}
