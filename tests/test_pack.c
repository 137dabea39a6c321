/* pack_atan2 against the C library: random directions, all sizes, axes and diagonals. */
#include "base/pack.h"
#include "base/random.h"
#include <float.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static double error_of(double y, double x)
{
    double exact = atan2(y, x), got = pack_atan2(pack_set(y), pack_set(x))[PACK_LANES - 1];
    return fabs(got - exact) / fmax(fabs(exact), DBL_MIN);
}

static void test_atan2(void **state)
{
    (void)state;
    Random random = random_seed(12);
    double worst = 0;
    for (int k = 0; k < 1000000; k++) {
        double size = exp(20 * random_signed(&random)), y = random_signed(&random),
               x = size * random_signed(&random);
        worst = fmax(worst, error_of(y, x));
    }
    print_message("pack_atan2: relative error at most %.1f epsilon\n", worst / DBL_EPSILON);
    assert_true(worst < 4 * DBL_EPSILON);
    static const double axes[][2] = {{0, 1},  {1, 0},  {0, -1},  {-1, 0}, {1, 1},
                                     {-1, 1}, {1, -1}, {-1, -1}, {0, 0},  {1e-300, -1}};
    for (size_t k = 0; k < sizeof axes / sizeof *axes; k++)
        assert_true(error_of(axes[k][0], axes[k][1]) < 2 * DBL_EPSILON);
    assert_true(isnan(error_of(NAN, 1)) && isnan(error_of(1, NAN)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_atan2)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
