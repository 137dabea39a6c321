/* What slender check foretells: the factor from its pattern, without the matrix, and beyond that size by a law. */
#include "job/predict.h"
#include "tests/leaks.h"
#include "tests/scene_fixture.h"
#include <math.h>
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

static void check_law(const char *bending, int length, int width)
{
    Built b = build(bending, length, width, "");
    Prediction r = predict(b.model, &b.scene);
    SparseInfo cost = system_cost(b.model->cases[0].sys);
    double numbers = r.numbers / (double)cost.factor_nonzeros, flops = r.flops / cost.factor_flops,
           bytes = r.factor_bytes / (double)cost.factor_bytes;
    if (r.exact || fabs(log(numbers)) > log(1.25) || fabs(log(bytes)) > log(1.25) ||
        fabs(log(flops)) > log(1.5))
        fail_msg("%s, %d x %d: numbers %.3g, bytes %.3g, flops %.3g of what they are", bending, length, width,
                 numbers, bytes, flops);
    clear(&b);
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(test_small, nothing_leaks),
                                       cmocka_unit_test_teardown(test_counts, nothing_leaks),
                                       cmocka_unit_test_teardown(test_law, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
