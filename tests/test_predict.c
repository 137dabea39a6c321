/* What slender check foretells: the factor from its pattern, without the matrix, and beyond that size by a law. */
#include "job/predict.h"
#include "tests/leaks.h"
#include "tests/scene_fixture.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static Built build(const char *bending, int length, int width, const char *lines)
{
    return scene_build(mem_format("slender: 1\njob: equilibrium\nshell:\n"
                                  "  mesh: {shape: sheet, size: [%d mm, %d mm], cells: [%d, %d]}\n"
                                  "  thickness: 1 mm\n  young: 1 MPa\n  poisson: 0.3\n  bending: %s\n"
                                  "fix:\n  - {group: root, clamp: true}\n%s",
                                  length, width, length, width, bending, lines));
}

static void test_small(void **state)
{
    (void)state;
    Built b = build("midedge", 20, 10, "");
    System *sys = b.model->cases[0].sys;
    Prediction r = predict(b.model, &b.scene);
    assert_true(r.exact);
    assert_int_equal(system_info(sys).factor_nonzeros, 0); /* nothing was built for it */
    system_build(sys);
    assert_true(r.numbers == (double)system_info(sys).factor_nonzeros);
    assert_true(r.flops == system_info(sys).factor_flops);
    assert_true(r.factorization > 0 && r.iteration > r.factorization * r.factorizations && r.end > 0);
    assert_true(r.bytes > r.factor_bytes);
    clear(&b);
}

/* A second case is another first solve, a later stage goes on. */
static void test_counts(void **state)
{
    (void)state;
    Built one = build("hinge", 4, 2, "load_steps: 1\n"),
          two =
              build("hinge", 4, 2,
                    "load_steps: 1\ncases:\n  - {flux_density: [0, 0, 1]}\n  - {flux_density: [0, 0, 2]}\n"),
          on = build(
              "hinge", 4, 2,
              "load_steps: 1\nsequence:\n  - {flux_density: [0, 0, 1]}\n  - {flux_density: [0, 0, 2]}\n");
    double first = predict(one.model, &one.scene).iterations;
    assert_true(predict(two.model, &two.scene).iterations == 2 * first);
    double more = predict(on.model, &on.scene).iterations - first;
    assert_true(more > 0 && more < first);
    clear(&one);
    clear(&two);
    clear(&on);
}

/* Load steps that are frames are stored, each of each stage: the result of all of them is in memory. */
static void test_frames(void **state)
{
    (void)state;
    static const char *const steps[] = {"100", "{count: 100, frames: true}", "{count: 10000, frames: true}"};
    Prediction r[3];
    for (int k = 0; k < 3; k++) {
        char *lines = mem_format("sequence: {flux_density: {from: [0, 0, 0], to: [0, 0, 1], count: "
                                 "1000}}\nload_steps: %s\n",
                                 steps[k]);
        Built b = build("hinge", 4, 2, lines);
        mem_free(lines);
        r[k] = predict(b.model, &b.scene);
        clear(&b);
    }
    assert_true(r[0].iterations == r[1].iterations);
    assert_true(r[1].end > 100 && r[1].bytes - r[0].bytes > 0.4e9 && r[0].end < 3);
    assert_true(r[2].bytes > 30e9 && r[2].end > 50 * r[1].end);
}

/* within: factors on numbers and bytes, and on flops. */
static void check_built(Built b, const char *what, const double within[2])
{
    Prediction r = predict(b.model, &b.scene);
    SparseInfo cost = system_cost(b.model->cases[0].sys);
    double numbers = r.numbers / (double)cost.factor_nonzeros, flops = r.flops / cost.factor_flops,
           bytes = r.factor_bytes / fmax((double)cost.factor_bytes, 8 * (double)cost.factor_nonzeros);
    if (r.exact || !(fabs(log(numbers)) <= log(within[0])) || !(fabs(log(bytes)) <= log(within[0])) ||
        !(fabs(log(flops)) <= log(within[1])))
        fail_msg("%s: numbers %.3g, bytes %.3g, flops %.3g of what they are", what, numbers, bytes, flops);
    assert_true(r.iteration > 0 && r.factorization > 0 && r.end > 0);
    clear(&b);
}

static void check_law(const char *bending, int length, int width)
{
    char what[80];
    snprintf(what, sizeof what, "%s, %d x %d", bending, length, width);
    check_built(build(bending, length, width, ""), what, (const double[]){1.25, 1.5});
}

static void test_law(void **state)
{
    (void)state;
    check_law("hinge", 260, 130);
    check_law("hinge", 184, 184);
    check_law("hinge", 1024, 32);
    check_law("midedge", 186, 93);
    check_law("midedge", 720, 24);
}

/* A body of many small parts, or so narrow that it is a row of many small pieces. */
static void test_small_parts(void **state)
{
    (void)state;
    enum { PARTS = 8000 };
    static const char NAME[] = "test_predict.obj";
    FILE *file = fopen(NAME, "w");
    for (int k = 0; k < PARTS; k++)
        fprintf(file, "v %d 0 0\nv %d.5 0 0\nv %d 0.5 0\nf %d %d %d\n", k, k, k, 3 * k + 1, 3 * k + 2,
                3 * k + 3);
    fclose(file);
    check_built(
        scene_build(mem_format("slender: 1\njob: equilibrium\nshell: {mesh: %s, thickness: 1 mm, young: 1 "
                               "MPa, poisson: 0.3}\n",
                               NAME)),
        "triangles", (const double[]){1.5, 3});
    check_built(build("midedge", 9500, 1, ""), "a strip", (const double[]){1.5, 4});
    remove(NAME);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(test_small, nothing_leaks),
                                       cmocka_unit_test_teardown(test_counts, nothing_leaks),
                                       cmocka_unit_test_teardown(test_frames, nothing_leaks),
                                       cmocka_unit_test_teardown(test_law, nothing_leaks),
                                       cmocka_unit_test_teardown(test_small_parts, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
