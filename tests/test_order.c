/* The order of strokes: against all orders of a few, never longer, strokes kept; joints; nearest points. */
#include "base/clock.h"
#include "spline/join.h"
#include "spline/near.h"
#include "spline/order.h"
#include "spline/tour.h"
#include "spline_fixture.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>

static const double PI = 3.14159265358979323846;

static SplinePage page_with_pen(double pen)
{
    return spline_page(0.12, 0.12, 0.01, 0.1 * pen);
}

/* A straight stroke of one segment. */
static void add_line(Strokes *strokes, double x0, double y0, double x1, double y1, int layer)
{
    double vx = (x1 - x0) / 3, vy = (y1 - y0) / 3;
    strokes_add(strokes, 2, (const double[2][4]){{x0, y0, vx, vy}, {x1, y1, vx, vy}}, layer);
}

static Strokes random_lines(int count, uint64_t seed)
{
    Random random = random_seed(seed);
    Strokes strokes = {0};
    for (int k = 0; k < count; k++) {
        double x = random_uniform(&random), y = random_uniform(&random);
        add_line(&strokes, x, y, x + 0.3 * random_signed(&random), y + 0.3 * random_signed(&random), 0);
    }
    return strokes;
}

static void near_is_nearest(void **state)
{
    (void)state;
    enum { POINTS = 500, MOST = 7 };
    Random random = random_seed(3);
    Vec2 points[POINTS];
    int group[POINTS], found[MOST];
    bool gone[POINTS] = {false};
    for (int k = 0; k < POINTS; k++) { /* half of them in a corner, some twice */
        double size = k % 2 ? 1 : 0.05;
        points[k] = k % 50 == 49 ? points[k - 1]
                                 : (Vec2){size * random_uniform(&random), size * random_uniform(&random)};
        group[k] = k / 3;
    }
    for (int round = 0; round < 3; round++) {
        if (round == 1) /* on a line */
            for (int k = 0; k < POINTS; k++) points[k].y = 0.3;
        if (round == 2) /* all at one place */
            for (int k = 0; k < POINTS; k++) points[k].x = 0.3;
        Near *near = near_create(points, group, POINTS);
        for (int k = 0; k < POINTS; k += 3) near_remove(near, k), gone[k] = true;
        for (int k = 0; k < POINTS; k++) {
            Vec2 at = {3 * random_uniform(&random) - 1, 3 * random_uniform(&random) - 1};
            double reach = k % 2 ? 0.3 : INFINITY, last = -1;
            int count = near_find(near, at, group[k], reach, MOST, found), better = 0, all = 0;
            for (int f = 0; f < count; f++) {
                double d = hypot(points[found[f]].x - at.x, points[found[f]].y - at.y);
                assert_true(d >= last - 1e-12 && d <= reach && !gone[found[f]] &&
                            group[found[f]] != group[k]);
                last = d;
            }
            for (int p = 0; p < POINTS; p++) {
                double d = hypot(points[p].x - at.x, points[p].y - at.y);
                bool wanted = !gone[p] && group[p] != group[k] && d <= reach;
                all += wanted;
                better += wanted && d < last - 1e-12;
            }
            assert_int_equal(count, all < MOST ? all : MOST);
            assert_true(better < MOST);
        }
        near_destroy(near);
    }
}

/* The shortest way through what is left of all lines, by trying everything. */
static double shortest(const Vec2 *ends, int count, unsigned left, Vec2 at, Vec2 home)
{
    double best = left ? INFINITY : hypot(at.x - home.x, at.y - home.y);
    for (int e = 0; e < 2 * count; e++) {
        if (!(left & 1u << e / 2)) continue;
        double rest = hypot(ends[e].x - at.x, ends[e].y - at.y);
        rest += shortest(ends, count, left & ~(1u << e / 2), ends[e ^ 1], home);
        best = fmin(best, rest);
    }
    return best;
}

static void few_strokes(void **state)
{
    (void)state;
    enum { LINES = 6, SETS = 60 };
    double sum = 0, worst = 0;
    int exact = 0;
    for (int set = 0; set < SETS; set++) {
        Strokes strokes = random_lines(LINES, (uint64_t)set);
        Vec2 ends[2 * LINES];
        int tour[LINES];
        for (int e = 0; e < 2 * LINES; e++) ends[e] = join_end(&strokes, e);
        for (int k = 0; k < LINES; k++) tour[k] = 2 * k;
        assert_true(tour_shorten(ends, LINES, (Vec2){0, 0}, 1000000, tour));
        double best = shortest(ends, LINES, (1u << LINES) - 1, (Vec2){0, 0}, (Vec2){0, 0});
        double ratio = tour_travel(ends, LINES, (Vec2){0, 0}, tour) / best;
        assert_true(ratio > 1 - 1e-12);
        exact += ratio < 1 + 1e-12;
        worst = fmax(worst, ratio);
        sum += ratio;
        strokes_clear(&strokes);
    }
    print_message("6 lines: %d of %d ways are the shortest, on the average %.3f of it, at worst %.3f\n",
                  exact, SETS, sum / SETS, worst);
    assert_true(exact >= SETS / 2 && sum / SETS < 1.03 && worst < 1.25);
}

/* Each is there once, as it was or turned round. */
static void expect_same_strokes(const Strokes *before, const Strokes *after)
{
    assert_int_equal(before->count, after->count);
    bool *seen = mem_alloc((size_t)before->count, sizeof *seen);
    for (int k = 0; k < after->count; k++) {
        int nodes = after->start[k + 1] - after->start[k], found = -1;
        for (int b = 0; b < before->count && found < 0; b++) {
            if (seen[b] || before->start[b + 1] - before->start[b] != nodes) continue;
            for (int turned = 0; turned < 2; turned++) {
                bool same = before->layer[b] == after->layer[k];
                for (int i = 0; i < nodes && same; i++) {
                    const double *p = after->q + 4 * (after->start[k] + i);
                    const double *q = before->q + 4 * (before->start[b] + (turned ? nodes - 1 - i : i));
                    int sign = turned ? -1 : 1;
                    same = p[0] == q[0] && p[1] == q[1] && p[2] == sign * q[2] && p[3] == sign * q[3];
                }
                if (same) found = b;
            }
        }
        assert_true(found >= 0);
        seen[found] = true;
    }
    mem_free(seen);
}

static void strokes_stay(void **state)
{
    (void)state;
    SplinePage page = page_with_pen(0.01);
    Strokes before = fixture_walks(&page, 301, 5, 0.02, 1), after = strokes_copy(&before);
    OrderDef def = order_default();
    def.join_gap = 0;
    OrderInfo info = order_strokes(&after, &page, def);
    expect_same_strokes(&before, &after);
    for (int k = 1; k < after.count; k++) assert_true(after.layer[k] >= after.layer[k - 1]);
    assert_true(info.whole && info.joints == 0);
    assert_true(fabs(info.before - order_travel(&before, &page)) < 1e-12);
    assert_true(fabs(info.after - order_travel(&after, &page)) < 1e-12);
    print_message("301 strokes of two layers: travel %.2f -> %.2f\n", info.before, info.after);
    assert_true(info.after < 0.2 * info.before);

    Strokes again = strokes_copy(&before);
    order_strokes(&again, &page, def);
    assert_memory_equal(again.q, after.q, 4 * (size_t)strokes_node_count(&after) * sizeof *after.q);
    strokes_clear(&again);

    /* What is in order stays so, and with no work at all the way is not longer either. */
    Strokes once_more = strokes_copy(&after);
    def.work = 0;
    OrderInfo second = order_strokes(&once_more, &page, def);
    assert_true(!second.whole && second.after <= info.after + 1e-12);
    strokes_clear(&once_more);
    strokes_clear(&before);
    strokes_clear(&after);
}

/* Greedy is led astray here: the input is better and must be what comes out. */
static void never_longer(void **state)
{
    (void)state;
    for (int set = 0; set < 300; set++) {
        SplinePage page = page_with_pen(0.3); /* so wide that most ends are joined */
        Strokes strokes = random_lines(2 + set % 12, (uint64_t)(1000 + set));
        OrderDef def = {.join_gap = set % 2, .join_angle = PI, .work = set % 3 ? 1000000 : 0};
        order_strokes(&strokes, &page, (OrderDef){.work = 1000000});
        double before = order_travel(&strokes, &page), ink = strokes_length(&strokes);
        OrderInfo info = order_strokes(&strokes, &page, def);
        assert_true(info.after <= before && info.before == before);
        if (!info.joints) assert_true(fabs(strokes_length(&strokes) - ink) < 1e-12);
        strokes_clear(&strokes);
    }
    Strokes none = {0};
    SplinePage page = page_with_pen(0.01);
    OrderInfo info = order_strokes(&none, &page, order_default());
    assert_true(none.count == 0 && info.before == 0 && info.after == 0 && info.whole);
    strokes_clear(&none);
}

static void time_of_many(void **state)
{
    (void)state;
    for (int count = 1000; count <= 10000; count *= 10) {
        SplinePage page = page_with_pen(0.2 / sqrt(count));
        Strokes strokes = fixture_walks(&page, count, 6, 0.5 / sqrt(count), 3);
        OrderDef def = order_default();
        def.join_gap = 0;
        double ink = strokes_length(&strokes), seconds = clock_seconds();
        OrderInfo info = order_strokes(&strokes, &page, def);
        print_message("%d strokes: travel %.1f -> %.2f (%.2f of the ink) in %.3f s\n", count, info.before,
                      info.after, info.after / ink, clock_seconds() - seconds);
        assert_true(info.whole && info.after < 0.3 * ink);
        strokes_clear(&strokes);
    }
}

/* Two straight strokes, the second turned by `turn` about the middle of the gap between them. */
static Strokes two_lines(double gap, double turn, int layer)
{
    Strokes strokes = {0};
    double c = cos(turn), s = sin(turn);
    add_line(&strokes, 0.2, 0.5, 0.5 - gap / 2, 0.5, 0);
    add_line(&strokes, 0.5 + gap / 2 * c + 0.2 * c, 0.5 + gap / 2 * s + 0.2 * s, 0.5 + gap / 2 * c,
             0.5 + gap / 2 * s, layer); /* drawn towards the joint */
    return strokes;
}

static int count_joints(double gap, double turn, int layer)
{
    SplinePage page = page_with_pen(0.01);
    Strokes strokes = two_lines(gap, turn, layer);
    OrderInfo info = order_strokes(&strokes, &page, order_default());
    int joints = info.joints;
    assert_int_equal(strokes.count, 2 - joints);
    strokes_clear(&strokes);
    return joints;
}

static void joints(void **state)
{
    (void)state;
    assert_int_equal(count_joints(0.0174, 0, 0), 1);
    assert_int_equal(count_joints(0.0176, 0, 0), 0);
    assert_int_equal(count_joints(0.005, 44.5 * PI / 180, 0), 1);
    assert_int_equal(count_joints(0.005, -44.5 * PI / 180, 0), 1);
    assert_int_equal(count_joints(0.005, 45.5 * PI / 180, 0), 0);
    assert_int_equal(count_joints(0.005, PI, 0), 0);
    assert_int_equal(count_joints(0, 0, 0), 1);
    assert_int_equal(count_joints(0.005, 0, 1), 0); /* of another pen */

    SplinePage page = page_with_pen(0.01);
    Strokes strokes = two_lines(0.006, 0.4, 0);
    order_strokes(&strokes, &page, order_default());
    assert_int_equal(strokes_node_count(&strokes), 3);
    const double *q = strokes.q + 4; /* the middle between both ends, the mean of their directions */
    double x = 0.5 + 0.003 * (cos(0.4) - 1) / 2, y = 0.5 + 0.003 * sin(0.4) / 2;
    double sign = strokes.q[0] < 0.4 ? 1 : -1, speed = (0.3 - 0.003) / 3, other = 0.2 / 3;
    assert_true(fabs(q[0] - x) < 1e-12 && fabs(q[1] - y) < 1e-12);
    assert_true(fabs(q[2] - sign * fmin(speed, other) * cos(0.2)) < 1e-12);
    assert_true(fabs(q[3] - sign * fmin(speed, other) * sin(0.2)) < 1e-12);
    strokes_clear(&strokes);
}

static int count_rings(const Strokes *strokes)
{
    int rings = 0;
    for (int k = 0; k < strokes->count; k++) {
        const double *first = strokes->q + 4 * strokes->start[k],
                     *last = strokes->q + 4 * strokes->start[k + 1] - 4;
        rings += !memcmp(first, last, 4 * sizeof *first);
    }
    return rings;
}

/* Rings in pieces come together again and close; what is drawn hardly moves. */
static void joined_rings(void **state)
{
    (void)state;
    SplinePage page = spline_page(0.1, 0.1, 0, 0.1 * 0.006);
    Strokes strokes = fixture_rings(page.pen, 0.6 * page.pen, 1), before = strokes_copy(&strokes);
    double ink = strokes_length(&strokes);
    OrderInfo info = order_strokes(&strokes, &page, order_default());
    print_message("rings: %d strokes, %d joints, ink %.3f -> %.3f, travel %.2f -> %.2f\n", before.count,
                  info.joints, ink, strokes_length(&strokes), info.before, info.after);
    int rings = count_rings(&strokes);
    assert_true(rings > 5);
    assert_int_equal(strokes.count, before.count - info.joints + rings);
    assert_true(info.joints > before.count / 2 && info.after < info.before);
    assert_true(fabs(strokes_length(&strokes) - ink - info.joints * 0.6 * page.pen) < 1e-3 * ink);
    assert_int_equal(strokes_node_count(&strokes), strokes_node_count(&before) - info.joints + rings);
    strokes_clear(&strokes);
    strokes_clear(&before);

    /* A ring of four pieces; of one; a short line is none. */
    FixtureStrokes ring = fixture_begin(4, 40);
    Random random = random_seed(1);
    for (int k = 0; k < 4; k++) fixture_arc(&ring, &random, 0.02, k * PI / 2, (k + 1) * PI / 2, 0);
    assert_int_equal(ring.strokes.count, 4);
    info = order_strokes(&ring.strokes, &page, order_default());
    assert_int_equal(info.joints, 4);
    assert_int_equal(ring.strokes.count, 1);
    assert_int_equal(count_rings(&ring.strokes), 1);
    info = order_strokes(&ring.strokes, &page, order_default());
    assert_int_equal(info.joints, 1);
    strokes_clear(&ring.strokes);
    for (int nodes = 2; nodes < 5; nodes++) {
        Strokes line = {0};
        double step = 0.9 * page.pen / (nodes - 1), q[4][4];
        for (int k = 0; k < nodes; k++)
            q[k][0] = 0.5 + k * step, q[k][1] = 0.5, q[k][2] = step / 3, q[k][3] = 0;
        strokes_add(&line, nodes, (const double(*)[4])q, 0);
        assert_int_equal(order_strokes(&line, &page, order_default()).joints, 0);
        strokes_clear(&line);
    }
}

static int live(void **state)
{
    (void)state;
    return mem_live_count() == 0 ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(near_is_nearest), cmocka_unit_test(few_strokes),
                                       cmocka_unit_test(strokes_stay),    cmocka_unit_test(never_longer),
                                       cmocka_unit_test(time_of_many),    cmocka_unit_test(joints),
                                       cmocka_unit_test(joined_rings)};
    return cmocka_run_group_tests(tests, NULL, live);
}
