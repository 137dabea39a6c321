/* Which features are near, and how far they may move. */
#include "tests/near_fixture.h"
#include "world/ccd.h"
#include "world/self_pairs.h"
#include "base/memory.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

/* ---- Who is near ---- */

enum { SOUP = 60 };

/* Triangles of random size here and there, some of no area, with their edges; two by two they share an edge. */
typedef struct Soup {
    double rest[4 * SOUP][3];
    int faces[2 * SOUP][3], edges[5 * SOUP][2], part[4 * SOUP];
    bool fixed[12 * SOUP];
    SelfContactDef def;
} Soup;

static void soup_make(Soup *soup, Random *random, double distance)
{
    *soup = (Soup){0};
    for (int k = 0; k < SOUP; k++) {
        double centre[3];
        choose(random, 3, 1, centre);
        for (int v = 4 * k; v < 4 * k + 4; v++) {
            for (int i = 0; i < 3; i++) soup->rest[v][i] = centre[i] + 0.2 * random_signed(random);
            soup->part[v] = k % 7 ? 0 : k;
            for (int i = 0; i < 3; i++) soup->fixed[3 * v + i] = k % 5 == 0;
        }
        if (k % 11 == 3) memcpy(soup->rest[4 * k + 1], soup->rest[4 * k], 3 * sizeof(double));
        const int faces[2][3] = {{0, 1, 2}, {2, 1, 3}},
                  edges[5][2] = {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}};
        for (int i = 0; i < 6; i++) soup->faces[2 * k + i / 3][i % 3] = 4 * k + faces[i / 3][i % 3];
        for (int i = 0; i < 10; i++) soup->edges[5 * k + i / 2][i % 2] = 4 * k + edges[i / 2][i % 2];
    }
    soup->def = (SelfContactDef){.vertex_count = 4 * SOUP,
                                 .face_count = 2 * SOUP,
                                 .edge_count = 5 * SOUP,
                                 .faces = (const int(*)[3])soup->faces,
                                 .edges = (const int(*)[2])soup->edges,
                                 .rest = (const double(*)[3])soup->rest,
                                 .part = soup->part,
                                 .fixed = soup->fixed,
                                 .distance = distance};
}

static bool all_held(const Soup *soup, const int v[4])
{
    bool held = true;
    for (int i = 0; i < 4; i++) held = held && soup->fixed[3 * v[i]];
    return held;
}

static bool belongs(const Soup *soup, const double *x, const int v[4], bool edges, double radius)
{
    double own[12];
    DistanceOf *distance = edges ? distance_edges : distance_point_triangle;
    for (int i = 0; i < (edges ? 2 : 1); i++)
        for (int j = edges ? 2 : 1; j < 4; j++)
            if (v[i] == v[j]) return false;
    if (all_held(soup, v)) return false;
    neighbours_gather(v, (const double *)soup->rest, own);
    if (soup->part[v[0]] == soup->part[v[3]] && sqrt(distance(own).square) < 1.6 * soup->def.distance)
        return false;
    neighbours_gather(v, x, own);
    return distance(own).square < radius * radius;
}

static void expect_pair(const PairList *list, int *k, int a, int b)
{
    assert_true(*k < list->count && list->pairs[*k][0] == a && list->pairs[*k][1] == b);
    (*k)++;
}

static void test_all_pairs(void **unused)
{
    (void)unused;
    static Soup soup;
    Random random = random_seed(9);
    int total[2] = {0};
    for (int run = 0; run < 12; run++) {
        double x[12 * SOUP], radius = 0.02 + 0.2 * random_uniform(&random);
        soup_make(&soup, &random, 0.1 * random_uniform(&random));
        Neighbours *n = neighbours_create(&soup.def);
        PairList list = {0};
        for (int i = 0; i < 12 * SOUP; i++)
            x[i] = ((const double *)soup.rest)[i] * (run % 2 ? 0.5 : 1) + 0.1 * random_signed(&random);
        neighbours_find(n, x, radius, &list);
        int k = 0;
        for (int v = 0; v < 4 * SOUP; v++)
            for (int f = 0; f < 2 * SOUP; f++) {
                const int *c = soup.faces[f];
                if (belongs(&soup, x, (int[]){v, c[0], c[1], c[2]}, false, radius))
                    expect_pair(&list, &k, v, f);
            }
        assert_int_equal(k, list.points);
        for (int a = 0; a < 5 * SOUP; a++)
            for (int b = a + 1; b < 5 * SOUP; b++) {
                const int *i = soup.edges[a], *j = soup.edges[b];
                if (belongs(&soup, x, (int[]){i[0], i[1], j[0], j[1]}, true, radius))
                    expect_pair(&list, &k, a, b);
            }
        assert_int_equal(k, list.count);
        total[0] += list.points, total[1] += list.count - list.points;
        pair_list_clear(&list);
        neighbours_destroy(n);
    }
    print_message("%d and %d pairs\n", total[0], total[1]);
    assert_true(total[0] > 1000 && total[1] > 1000);
}

/* ---- How far ---- */

static void test_reach(void **unused)
{
    (void)unused;
    Random random = random_seed(21);
    int short_of = 0, slid = 0;
    for (int k = 0; k < 3000; k++) {
        double from[12], to[12], x[12], keep = k % 3 ? 0.1 : 0.02, least = INFINITY;
        bool edges = k % 2;
        DistanceOf *distance = edges ? distance_edges : distance_point_triangle;
        choose(&random, 12, 1, from);
        if (k % 5 == 1) make_parallel(&random, k % 10 == 1 ? 0 : 1e-6, from);
        for (int i = 0; i < 12; i++) to[i] = from[i] + (k % 7 == 0 ? 100 : 2) * random_signed(&random);
        double d = sqrt(distance(from).square), reach = ccd_reach(distance, from, to, keep, 1);
        assert_true(reach > 0 && reach <= 1);
        for (int m = 0; m <= 1000; m++) {
            for (int i = 0; i < 12; i++) x[i] = from[i] + reach * m / 1000 * (to[i] - from[i]);
            least = fmin(least, sqrt(distance(x).square));
        }
        assert_true(least >= keep * d * (1 - 1e-9));
        if (reach == 1) continue;
        short_of++;
        slid += sqrt(distance(x).square) > 1.1 * keep * d * (1 + 1e-9);
    }
    print_message("%d of 3000 came near, %d slid\n", short_of, slid);
    assert_true(short_of > 300 && slid < short_of / 20);
}

/* A way's reach is the same from the list at hand as from the boxes of all. */
static void test_same_reach(void **unused)
{
    (void)unused;
    static Soup soup;
    static double from[12 * SOUP], to[12 * SOUP];
    Random random = random_seed(40);
    int stopped = 0;
    soup_make(&soup, &random, 0.2);
    SelfPairs *with = self_pairs_create(&soup.def), *without = self_pairs_create(&soup.def);
    for (int run = 0; run < 200; run++) {
        double size = 0.2 * random_uniform(&random), known[12 * SOUP];
        for (int i = 0; i < 12 * SOUP; i++) {
            from[i] = 0.7 * ((const double *)soup.rest)[i] + 0.05 * random_signed(&random);
            to[i] = from[i] + (i % 3 ? 1 : 7) * 0.01 + size * random_signed(&random);
        }
        for (int i = 0; i < 12 * SOUP; i++) known[i] = from[i] + 0.02 * random_signed(&random);
        self_pairs_update(with, known, known);
        double reach = self_pairs_reach(with, from, to, 0.1);
        assert_true(reach == self_pairs_reach(without, from, to, 0.1));
        stopped += reach < 1;
    }
    print_message("%d of 200 stopped\n", stopped);
    assert_true(stopped > 20 && stopped < 200);
    self_pairs_destroy(with);
    self_pairs_destroy(without);
}

/* Nothing hangs or crashes on what is no number, nor where all is in one place. */
static void test_hostile(void **unused)
{
    (void)unused;
    static Soup soup;
    Random random = random_seed(30);
    soup_make(&soup, &random, 0.05);
    Neighbours *n = neighbours_create(&soup.def);
    PairList list = {0};
    static double x[12 * SOUP], y[12 * SOUP];
    const double *rest = (const double *)soup.rest;
    const double values[] = {NAN, INFINITY, -INFINITY, 1e300, 0, 1e-320};
    for (int k = 0; k < 6; k++) {
        for (int i = 0; i < 12 * SOUP; i++) x[i] = k % 2 && i % 3 ? rest[i] : values[k];
        neighbours_find(n, x, 0.1, &list);
        neighbours_sweep(n, rest, x, 0, &list);
        memcpy(y, x, sizeof y);
        assert_true(isnan(neighbours_moved(n, y, rest)) == !(k >= 4));
        double reach = ccd_reach(distance_edges, rest, x, 0.1, 1);
        assert_true(reach > 0 && reach <= 1);
    }
    pair_list_clear(&list);
    neighbours_destroy(n);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_pairs),
        cmocka_unit_test(test_reach),
        cmocka_unit_test(test_same_reach),
        cmocka_unit_test(test_hostile),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
