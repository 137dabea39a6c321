#include "base/memory.h"
#include "io/formula.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

static const char *const variables[] = {"x", "y", "t", NULL};

static void test_values(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    Error err;
    const char *const expressions[] = {"rint(atan2(y, x)/(pi/3))", "a + b^2", "0"};
    /* a mapping has no order: one that sorts its keys gives the second */
    const FormulaHelper helpers[2][3] = {{{"a", "2*x"}, {"b", "a + y"}, {"a2", "1"}},
                                         {{"a2", "1"}, {"b", "a + y"}, {"a", "2*x"}}};
    for (int k = 0; k < 2; k++) {
        Formula *formula = formula_create(expressions, 3, helpers[k], 3, variables, &err);
        assert_non_null(formula);
        double r[3];
        assert_true(formula_eval(formula, (double[]){1, 2, 0}, r, &err));
        assert_true(r[0] == rint(atan2(2, 1) / (M_PI / 3)) && r[1] == 2 + 16 && r[2] == 0);
        assert_true(formula_uses(formula, "x") && formula_uses(formula, "y") && !formula_uses(formula, "t"));
        formula_destroy(formula);
    }
    assert_int_equal(mem_live_count(), blocks);
}

static void check_refused(const char *expression, const char *sentence)
{
    Error err = {""};
    long blocks = mem_live_count();
    assert_null(formula_create(&expression, 1, NULL, 0, variables, &err));
    assert_string_equal(err.text, sentence);
    assert_int_equal(mem_live_count(), blocks);
}

static void test_refused(void **state)
{
    (void)state;
    check_refused("x + q", "unknown name 'q' in \"x + q\"; known are x, y, t, pi, e");
    check_refused("", "an expression is empty");
    check_refused("x=5", "\"x=5\": the = at position 1 is no part of an expression; == compares");
    check_refused("x + (y = 3)",
                  "\"x + (y = 3)\": the = at position 7 is no part of an expression; == compares");
    check_refused("x ? y=1 : 2",
                  "\"x ? y=1 : 2\": the = at position 5 is no part of an expression; == compares");
    check_refused("x, y", "\"x, y\": a list of 2; a formula is one expression");
    check_refused("sin(x), 2, 3", "\"sin(x), 2, 3\": a list of 3; a formula is one expression");
    check_refused("1,5", "\"1,5\": numbers have a decimal point: 1.5, not 1,5");
    check_refused("0,25*sin(t)", "\"0,25*sin(t)\": numbers have a decimal point: 0.25, not 0,25");
    check_refused("(x + 0,5)*t", "\"(x + 0,5)*t\": numbers have a decimal point: 0.5, not 0,5");
    check_refused("sin(0,5*t)", "\"sin(0,5*t)\": numbers have a decimal point: 0.5, not 0,5");
    check_refused("clamp(x, 0,5, 1)", "\"clamp(x, 0,5, 1)\": numbers have a decimal point: 0.5, not 0,5");
    check_refused("3 mm * x",
                  "\"3 mm * x\": '3 mm' has a unit, and numbers in expressions are plain, in SI: 0.003");
    check_refused(
        "sin(2*x) + 20mT",
        "\"sin(2*x) + 20mT\": '20mT' has a unit, and numbers in expressions are plain, in SI: 0.02");
    check_refused(
        "x + 1.5e-3 m",
        "\"x + 1.5e-3 m\": '1.5e-3 m' has a unit, and numbers in expressions are plain, in SI: 0.0015");
    check_refused("3 x", "\"3 x\": Unexpected variable \"x\" found at position 2");
    check_refused(
        "30 deg + q",
        "\"30 deg + q\": '30 deg' has a unit, and numbers in expressions are plain, in SI: 0.523599");
    check_refused("\"abc\"", "\"\"abc\"\": Strings must only be used as function arguments!");
}

/* Names of helpers are names, and their own. */
static void test_helper_names(void **state)
{
    (void)state;
    static const char *const bad[] = {"", "a b", "1a", "a=1", "+", "x", "pi", "e"};
    const char *expression = "x + y";
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        Error err = {""};
        assert_null(formula_create(&expression, 1, &(FormulaHelper){bad[k], "7"}, 1, variables, &err));
        if (k == 1)
            assert_string_equal(
                err.text, "'a b' is no name for a part of a formula: letters, digits and _, a letter first");
        if (k >= 5 && !strstr(err.text, "has a meaning in this formula already"))
            fail_msg("%s: %s", bad[k], err.text);
    }
}

/* Comparisons are no assignments. */
static void test_comparisons(void **state)
{
    (void)state;
    static const char *const expressions[] = {"x==2",           "x!=3",       "x<=2",          "x>=2",
                                              "x == 2 ? 1 : 0", "-x^2 == -4", "min(x, y) == 2"};
    for (size_t k = 0; k < sizeof expressions / sizeof *expressions; k++) {
        Error err = {""};
        double r = 0;
        Formula *formula = formula_create(&expressions[k], 1, NULL, 0, variables, &err);
        if (!formula) fail_msg("%s: %s", expressions[k], err.text);
        assert_true(formula_eval(formula, (double[]){2, 3, 5}, &r, &err) && r == 1);
        formula_destroy(formula);
    }
}

/* Helpers may be given in any order, and not in a circle. */
static void test_circle(void **state)
{
    (void)state;
    Error err;
    const char *expression = "a";
    const FormulaHelper circle[] = {{"c", "1"}, {"a", "b + c"}, {"b", "2*a"}};
    assert_null(formula_create(&expression, 1, circle, 3, variables, &err));
    assert_string_equal(err.text, "the name 'a' beside the formula depends on itself, through others");
}

static void test_not_finite(void **state)
{
    (void)state;
    Error err;
    const char *expression = "1/x";
    Formula *formula = formula_create(&expression, 1, NULL, 0, variables, &err);
    double r;
    assert_non_null(formula);
    assert_false(formula_eval(formula, (double[]){0, 1, 2}, &r, &err));
    assert_string_equal(err.text, "\"1/x\" is not a finite number at x = 0, y = 1, t = 2");
    formula_destroy(formula);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),       cmocka_unit_test(test_refused),
        cmocka_unit_test(test_helper_names), cmocka_unit_test(test_comparisons),
        cmocka_unit_test(test_circle),       cmocka_unit_test(test_not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
