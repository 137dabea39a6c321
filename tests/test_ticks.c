/* Numbers and their units, as pictures and reports write them. */
#include "tests/leaks.h"
#include "view/ticks.h"
#include <float.h>
#include <string.h>

static void numbers(void **state)
{
    (void)state;
    static const struct {
        double number;
        const char *unit, *text;
    } rows[] = {{0.05, "T", "50 mT"},
                {1250, "A/m", "1.25 kA/m"},
                {-4.5e-5, "J", "−45 µJ"},
                {3.1e-6, "m^2", "3.1·10⁻⁶ m²"},
                {0, "J", "0 J"},
                {1.05e12, "Pa", "1050 GPa"},
                {5e-13, "J", "0.5 pJ"},
                {-5.68071983692565e41, "N/m", "−5.68·10⁴¹ N/m"}, /* beyond the prefixes */
                {2e13, "Pa", "2·10¹³ Pa"},
                {4e-15, "J", "4·10⁻¹⁵ J"},
                {1e-300, "m", "1·10⁻³⁰⁰ m"},
                {DBL_MAX, "s", "1.8·10³⁰⁸ s"},
                {20000, "", "2·10⁴"},
                {1e-9, "T", "1 nT"}, /* the prefix is that of what is shown */
                {0.000001 * 1e-3, "T", "1 nT"},
                {9.9999999e-10, "T", "1 nT"},
                {0.9999999e-3, "T", "1 mT"},
                {-0.9996e-3, "T", "−1 mT"},
                {0.9994e-3, "T", "999 µT"},
                {999.4, "N", "999 N"},
                {999.6, "N", "1 kN"},
                {0.9999999e-12, "J", "1 pJ"},
                {0.0099999, "", "0.01"},
                {0.01, "", "0.01"},
                {9996, "", "9996"},
                {9999.7, "", "1·10⁴"},
                {99999, "", "1·10⁵"},
                {9.999e12, "Pa", "9999 GPa"},
                {9.99999e12, "Pa", "1·10¹³ Pa"}};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char text[TICKS_TEXT];
        unit_format(rows[k].number, rows[k].unit, text, sizeof text);
        assert_string_equal(text, rows[k].text);
    }
}

/* What an axis shows is its numbers times the factor, in the unit, whatever their size. */
static void scales(void **state)
{
    (void)state;
    for (int e = -300; e <= 300; e += 7) {
        double size = 2.5;
        for (int k = 0; k < (e < 0 ? -e : e); k++) size = e < 0 ? size / 10 : size * 10;
        UnitScale scale = unit_scale("N", size);
        assert_true(size * scale.factor >= 0.01 && size * scale.factor < 10000);
        assert_string_equal(scale.unit + strlen(scale.unit) - 1, "N");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(numbers, nothing_leaks),
                                       cmocka_unit_test_teardown(scales, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
