/* Distances of points, edges and triangles, and what repels them. */
#include "tests/near_fixture.h"
#include "world/touch.h"
#include "base/memory.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

/* ---- Distances ---- */

/* |sum of a few differences| with weights (1, -b) of a triangle, or (1 - s, s, t - 1, -t). */
static double square_at(const double *x, const double w[4])
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        double c = 0;
        for (int v = 0; v < 4; v++) c += w[v] * x[3 * v + i];
        sum += c * c;
    }
    return sum;
}

/* The least over the second unknown, in closed form. */
static double least_beside(const double *x, bool edges, double u)
{
    double w[2][4], way[3] = {0}, from[3] = {0}, most = edges ? 1 : 1 - u, along = 0, square = 0;
    for (int i = 0; i < 2; i++)
        for (int v = 0; v < 4; v++)
            w[i][v] = edges ? (double[]){1 - u, u, i - 1, -i}[v] : (double[]){1, u + i - 1, -u, -i}[v];
    for (int i = 0; i < 12; i++) {
        from[i % 3] += w[0][i / 3] * x[i];
        way[i % 3] += (w[1][i / 3] - w[0][i / 3]) * x[i];
    }
    for (int i = 0; i < 3; i++) along -= from[i] * way[i], square += way[i] * way[i];
    double t = square > 0 ? fmin(fmax(along / square, 0), most) : 0;
    for (int v = 0; v < 4; v++) w[0][v] += t * (w[1][v] - w[0][v]);
    return square_at(x, w[0]);
}

/* The square is convex: thirds of the first unknown. */
static double by_search(const double *x, bool edges)
{
    double low = 0, high = 1;
    for (int k = 0; k < 80; k++) {
        double a = low + (high - low) / 3, b = high - (high - low) / 3;
        if (least_beside(x, edges, a) < least_beside(x, edges, b))
            high = b;
        else
            low = a;
    }
    return sqrt(least_beside(x, edges, low));
}

static void test_distances(void **unused)
{
    (void)unused;
    Random random = random_seed(1);
    int classes[2][3] = {{0}};
    for (int k = 0; k < 4000; k++) {
        double x[DISTANCE_DOFS];
        bool edges = k % 2;
        choose(&random, DISTANCE_DOFS, 1, x);
        if (k % 8 == 3) make_parallel(&random, k % 16 == 3 ? 0 : pow(10, -1 - k % 10), x);
        if (k % 32 == 4) memcpy(x + 9, x + 6, 3 * sizeof *x); /* a triangle that is an edge */
        if (k % 32 == 5) memcpy(x + 3, x, 3 * sizeof *x);     /* an edge that is a point    */
        Distance d = edges ? distance_edges(x) : distance_point_triangle(x);
        classes[edges][d.slides]++;
        assert_true(fabs(sqrt(d.square) - by_search(x, edges)) < 1e-7);
        assert_true(fabs(sqrt(square_at(x, d.w)) - sqrt(d.square)) < 1e-7);
    }
    for (int i = 0; i < 6; i++) assert_true(classes[i / 3][i % 3] > 20);
}

static void test_known_distances(void **unused)
{
    (void)unused;
    const double face[DISTANCE_DOFS] = {0.2, 0.3, 0.7, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    const double across[DISTANCE_DOFS] = {-1, 0, 0, 1, 0, 0, 0, -1, 3, 0, 1, 3};
    const double beside[DISTANCE_DOFS] = {0, 0, 0, 2, 0, 0, 1, 4, 0, 5, 4, 0};
    assert_true(distance_point_triangle(face).square == 0.7 * 0.7);
    assert_true(distance_edges(across).square == 9 && distance_edges(beside).square == 16);
    double bad[DISTANCE_DOFS];
    for (int i = 0; i < DISTANCE_DOFS; i++) bad[i] = NAN;
    assert_true(isnan(distance_edges(bad).square) && isnan(distance_point_triangle(bad).square));
}

/* ---- What repels ---- */

/* A lone face and a lone vertex, or two edges of rods: one pair of each kind. */
typedef struct Pairing {
    double rest[4][3];
    int faces[1][3], edges[2][2], part[4];
    SelfContactDef def;
    Neighbours *n;
    PairList list;
} Pairing;

static void pairing_make(Pairing *p, bool edges)
{
    *p = (Pairing){.rest = {{5, 5, 5}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                   .faces = {{1, 2, 3}},
                   .edges = {{0, 1}, {2, 3}},
                   .part = {0, 1, 1, 1}};
    static int pair[1][2];
    p->def = (SelfContactDef){.vertex_count = 4,
                              .face_count = !edges,
                              .edge_count = edges ? 2 : 0,
                              .faces = (const int(*)[3])p->faces,
                              .edges = (const int(*)[2])p->edges,
                              .rest = (const double(*)[3])p->rest,
                              .part = p->part,
                              .distance = 1};
    p->n = neighbours_create(&p->def);
    p->n->vertex_weight[0] = 1.3;
    if (edges) p->n->edge_square[0] = p->n->edge_square[1] = 1;
    pair[0][0] = 0, pair[0][1] = edges;
    p->list = (PairList){.count = 1, .points = !edges, .pairs = pair};
}

/* Do the nearest points lie on the same features all around? */
static bool stays_in_class(const Pairing *p, const double x[12], double size)
{
    Random random = random_seed(8);
    Touch at = touch_at(p->n, &p->list, 0, 3, x);
    bool same = true;
    for (int k = 0; k < 40; k++) {
        double y[12];
        choose(&random, 12, size, y);
        for (int i = 0; i < 12; i++) y[i] += x[i];
        Touch touch = touch_at(p->n, &p->list, 0, 3, y);
        same = same && touch.acts && touch.at.slides == at.at.slides && (touch.m < 1) == (at.m < 1);
        for (int v = 0; v < 4; v++) same = same && (touch.at.w[v] != 0) == (at.at.w[v] != 0);
    }
    return same;
}

static void change(const Pairing *p, const double *x, const double *d, double h, double *E, double g[12])
{
    const double at[4] = {-2, -1, 1, 2};
    double value[4], slope[4][12];
    for (int k = 0; k < 4; k++) {
        double y[12];
        for (int i = 0; i < 12; i++) y[i] = x[i] + at[k] * h * d[i];
        Touch touch = touch_at(p->n, &p->list, 0, 3, y);
        value[k] = touch_energy(&touch);
        touch_slopes(&touch, y, slope[k], NULL);
    }
    *E = (8 * (value[2] - value[1]) - (value[3] - value[0])) / (12 * h);
    for (int i = 0; i < 12; i++)
        g[i] = (8 * (slope[2][i] - slope[1][i]) - (slope[3][i] - slope[0][i])) / (12 * h);
}

/* Gradient and Hessian along a random way against differences, relative to the largest entries. */
static double slope_error(const Pairing *p, Random *random, const double x[12], double h)
{
    double d[12], E, dg[12], g[12], H[78], size = 1e-300, error = 0, row_size = 1e-300, row_error = 0,
                                           along = 0;
    choose(random, 12, 1, d);
    Touch touch = touch_at(p->n, &p->list, 0, 3, x);
    touch_slopes(&touch, x, g, H);
    change(p, x, d, h, &E, dg);
    for (int i = 0; i < 12; i++) {
        double row = 0;
        for (int j = 0; j < 12; j++) {
            double entry = i > j ? H[i * (i + 1) / 2 + j] : H[j * (j + 1) / 2 + i];
            row += entry * d[j];
            row_size = fmax(row_size, fabs(entry));
        }
        along += g[i] * d[i];
        size = fmax(size, fabs(g[i]));
        row_error = fmax(row_error, fabs(row - dg[i]));
    }
    error = fmax(fabs(along - E) / size, row_error / row_size);
    return error;
}

static double curvature(const double H[78], const double d[12])
{
    double sum = 0;
    for (int i = 0; i < 12; i++)
        for (int j = 0; j < 12; j++)
            sum += d[i] * d[j] * H[i > j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i];
    return sum;
}

/* The convex part is never negative, and all of the Hessian where a vertex comes straight nearer. */
static void test_convex(void **unused)
{
    (void)unused;
    Random random = random_seed(5);
    int indefinite = 0, straight = 0;
    for (int k = 0; k < 4000; k++) {
        Pairing p;
        double x[12], d[12], nearer[12] = {0}, g[12], H[78], convex[78];
        pairing_make(&p, k % 2);
        choose(&random, 12, 0.8, x);
        choose(&random, 12, 1, d);
        Touch touch = touch_at(p.n, &p.list, 0, 3, x);
        touch_slopes(&touch, x, g, H);
        touch_convex(&touch, x, convex);
        assert_true(curvature(convex, d) >= 0);
        indefinite += curvature(H, d) < 0;
        for (int i = 0; i < 3; i++) nearer[i] = touch.at.c[i];
        double whole = curvature(H, nearer);
        if (touch.acts && !touch.edges) {
            assert_true(fabs(curvature(convex, nearer) - whole) <= 1e-9 * whole);
            straight++;
        }
        neighbours_destroy(p.n);
    }
    assert_true(indefinite > 100 && straight > 100);
}

/* Of every class, and of edges that are taken out the more the more parallel they are. */
static void test_slopes(void **unused)
{
    (void)unused;
    Random random = random_seed(3);
    int classes[2][3] = {{0}}, weak = 0, near = 0;
    double worst = 0;
    for (int k = 0; k < 20000; k++) {
        Pairing p;
        double x[12];
        bool edges = k % 2;
        pairing_make(&p, edges);
        choose(&random, 12, 0.8, x);
        if (k % 4 == 3) make_parallel(&random, 0.05 * random_uniform(&random), x);
        Touch touch = touch_at(p.n, &p.list, 0, 3, x);
        if (touch.acts && touch.d > 0.05 && touch.m > 1e-3 && stays_in_class(&p, x, 1e-4)) {
            double error = fmin(slope_error(&p, &random, x, 3e-5), slope_error(&p, &random, x, 1e-5));
            classes[edges][touch.at.slides]++;
            weak += touch.m < 1;
            near += touch.d < 0.2;
            worst = fmax(worst, error);
        }
        neighbours_destroy(p.n);
    }
    print_message("worst %.1e, %d nearly parallel, %d very near\n", worst, weak, near);
    assert_true(worst < 1e-6 && weak > 200 && near > 200);
    for (int i = 0; i < 6; i++) assert_true(classes[i / 3][i % 3] > 100);
}

static bool same_class(const Touch *a, const Touch *b)
{
    bool same = a->at.slides == b->at.slides;
    for (int v = 0; v < 4; v++) same = same && (a->at.w[v] != 0) == (b->at.w[v] != 0);
    return same;
}

/* Where the class changes, the gradient does not jump: closed in on along random lines, through parallel edges too. */
static void test_continuity(void **unused)
{
    (void)unused;
    Random random = random_seed(6);
    int changes = 0;
    double worst = 0;
    for (int k = 0; k < 6000; k++) {
        Pairing p;
        double x[12], d[12], low = 0, high = 0.3, g[2][12], y[12], size = 0, jump = 0;
        Touch ends[2], middle;
        pairing_make(&p, k % 2);
        choose(&random, 12, 0.6, x);
        if (k % 4 == 3) make_parallel(&random, 0.02 * random_uniform(&random), x);
        choose(&random, 12, 1, d);
        for (int m = 0; m < 45; m++) {
            double a = (low + high) / 2;
            for (int i = 0; i < 12; i++) y[i] = x[i] + low * d[i];
            ends[0] = touch_at(p.n, &p.list, 0, 3, y);
            for (int i = 0; i < 12; i++) y[i] = x[i] + a * d[i];
            middle = touch_at(p.n, &p.list, 0, 3, y);
            *(same_class(&ends[0], &middle) ? &low : &high) = a;
        }
        for (int m = 0; m < 2; m++) {
            for (int i = 0; i < 12; i++) y[i] = x[i] + (m ? high : low) * d[i];
            ends[m] = touch_at(p.n, &p.list, 0, 3, y);
            touch_slopes(&ends[m], y, g[m], NULL);
        }
        for (int i = 0; i < 12; i++) {
            size = fmax(size, fabs(g[0][i]));
            jump = fmax(jump, fabs(g[0][i] - g[1][i]));
        }
        if (ends[0].acts && ends[0].d > 0.05 && !same_class(&ends[0], &ends[1])) {
            changes++;
            worst = fmax(worst, jump / fmax(size, 1));
        }
        neighbours_destroy(p.n);
    }
    print_message("%d changes of class, largest jump %.1e\n", changes, worst);
    assert_true(changes > 500 && worst < 1e-6);
}

/* The grip's changes against differences, and against their way back. */
static void test_grips(void **unused)
{
    (void)unused;
    Random random = random_seed(4);
    double worst = 0, back = 0;
    for (int k = 0; k < 4000; k++) {
        Pairing p;
        double x[12], d[12], y[12], to[12], h = 1e-5, sum = 0, other = 0, size = 0;
        pairing_make(&p, k % 2);
        choose(&random, 12, 0.8, x);
        choose(&random, 12, 1, d);
        if (k % 4 == 3) make_parallel(&random, 0.05 * random_uniform(&random), x);
        Touch touch = touch_at(p.n, &p.list, 0, 3, x);
        if (touch.acts && touch.d > 0.1 && touch.m > 1e-2 && stays_in_class(&p, x, 1e-4)) {
            Grip exact = touch_grip_change(&touch, x, d), w, moved[4];
            double *grip[4] = {(double *)&moved[0], (double *)&moved[1], (double *)&moved[2],
                               (double *)&moved[3]};
            for (int m = 0; m < 4; m++) {
                for (int i = 0; i < 12; i++) y[i] = x[i] + (double[]){-2, -1, 1, 2}[m] * h * d[i];
                Touch other_touch = touch_at(p.n, &p.list, 0, 3, y);
                moved[m] = touch_grip(&other_touch);
            }
            choose(&random, 8, 1, (double *)&w);
            touch_grip_back(&touch, x, &w, to);
            for (int i = 0; i < 8; i++) {
                double e = ((const double *)&exact)[i];
                double rate = (8 * (grip[2][i] - grip[1][i]) - (grip[3][i] - grip[0][i])) / (12 * h);
                size = fmax(size, fabs(e));
                worst = fmax(worst, fabs(e - rate) / fmax(size, 1));
                sum += ((const double *)&w)[i] * e;
            }
            for (int i = 0; i < 12; i++) other += to[i] * d[i];
            back = fmax(back, fabs(sum - other) / fmax(size, 1));
        }
        neighbours_destroy(p.n);
    }
    print_message("grips %.1e, back %.1e\n", worst, back);
    assert_true(worst < 1e-5 && back < 1e-11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_distances),  cmocka_unit_test(test_known_distances),
        cmocka_unit_test(test_slopes),     cmocka_unit_test(test_convex),
        cmocka_unit_test(test_continuity), cmocka_unit_test(test_grips),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
