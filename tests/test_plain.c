/* Words of strangers on terminals and in JSON. */
#include "base/memory.h"
#include "base/plain.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static const struct {
    const char *text, *plain, *json;
} rows[] = {
    {"", "", ""},
    {"Zähne, 1 µm, 漢字 \U0001F600", "Zähne, 1 µm, 漢字 \U0001F600", "Zähne, 1 µm, 漢字 \U0001F600"},
    {"a\"b\\c", "a\"b\\c", "a\\\"b\\\\c"},
    {"\x1b[31m\a", "\\x1b[31m\\x07", "\\u001b[31m\\u0007"},
    {"one\ntwo\tthree\r", "one\\x0atwo\\x09three\\x0d", "one\\u000atwo\\u0009three\\u000d"},
    {"\x7f\xc2\x9b"
     "31m",
     "\\x7f\\u009b31m", "\\u007f\\u009b31m"}, /* a control sequence of 8 bits */
    {"\u202etxt\u2066\ufeff", "\\u202etxt\\u2066\\ufeff", "\\u202etxt\\u2066\\ufeff"}, /* reversed writing */
    {"\xff\xc3", "\\xff\\xc3", "\\ufffd\\ufffd"},                                      /* no UTF-8, cut off */
    {"\xc0\xaf\xed\xa0\x80", "\\xc0\\xaf\\xed\\xa0\\x80",
     "\\ufffd\\ufffd\\ufffd\\ufffd\\ufffd"}, /* overlong, a surrogate */
    {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80",
     "\\ufffd\\ufffd\\ufffd\\ufffd"}, /* beyond the last character */
};

static void test_rows(void **state)
{
    (void)state;
    long blocks = mem_live_count();
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        char *plain = plain_text(rows[k].text, ""), *json = plain_json(rows[k].text);
        assert_string_equal(plain, rows[k].plain);
        assert_string_equal(json, rows[k].json);
        assert_true(plain_is(plain));
        assert_int_equal(plain_is(rows[k].text), k < 3);
        mem_free(plain);
        mem_free(json);
    }
    char *kept = plain_text("one\ntwo\tthree\r", "\n\t");
    assert_string_equal(kept, "one\ntwo\tthree\\x0d");
    mem_free(kept);
    assert_int_equal(mem_live_count(), blocks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_rows)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
