/* What the document of a report packs is read back as it was, within the quantisation. */
#include "report/document.h"
#include "report/report.h"
#include "tests/leaks.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define NAME "test_report_document"
#include "tests/run_fixture.h"
#include "tests/report_fixture.h"

static Page close_document(Document *document)
{
    Page page = {.text = mem_text(document_json(document))};
    char *block = document_block(document);
    page.json = page.text;
    unpack_block(&page, block);
    mem_free(block);
    document_destroy(document);
    return page;
}

/* Some numbers of very different sizes that belong together by 3, every 7th of them none. */
static void fill(double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        values[i] = i % 7 == 3 ? NAN : 5 + sin(0.37 * (double)i) * (double)(1 + i % 3);
}

static void test_packed(void **unused)
{
    (void)unused;
    static const Packed shapes[] = {{1, 30, 3, 16, false},
                                    {4, 30, 3, 16, false},
                                    {3, 10, 1, 8, false},
                                    {1, 1, 1, 8, false},
                                    {5, 2, 2, 8, false}};
    double values[120];
    fill(values, 120);
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
        Document *document = document_create();
        document_open(document, NULL, '{');
        document_packed(document, "before", values, (Packed){1, 5, 1, 8, false});
        document_packed(document, "numbers", values, shapes[k]);
        document_close(document);
        Page page = close_document(document);
        Unpacked got = unpack(&page, page.json, "numbers");
        assert_int_equal(got.rows, shapes[k].rows);
        assert_int_equal(got.width, shapes[k].width);
        double step = (got.high - got.low) / (shapes[k].bits == 8 ? 254 : 65534);
        for (size_t i = 0; i < got.rows * got.width; i++)
            assert_true(isnan(values[i]) ? isnan(got.values[i])
                                         : fabs(got.values[i] - values[i]) <= 0.5001 * step + 1e-7);
        mem_free(got.values);
        page_clear(&page);
    }
}

/* One number everywhere is exact, nothing but NaN stays so. A narrow range far from 0 keeps its resolution. */
static void test_narrow(void **unused)
{
    (void)unused;
    const double same[3] = {0.1, 0.1, 0.1}, none[2] = {NAN, INFINITY}, far[3] = {1000, 1000.0005, 1000.001};
    Document *document = document_create();
    document_open(document, NULL, '{');
    document_packed(document, "same", same, (Packed){1, 3, 3, 16, false});
    document_packed(document, "none", none, (Packed){1, 2, 1, 8, false});
    document_packed(document, "far", far, (Packed){1, 3, 3, 16, false});
    document_close(document);
    Page page = close_document(document);
    Unpacked got = unpack(&page, page.json, "same");
    for (int i = 0; i < 3; i++) assert_true(got.values[i] == 0.1);
    mem_free(got.values);
    got = unpack(&page, page.json, "none");
    assert_true(isnan(got.values[0]) && isnan(got.values[1]));
    mem_free(got.values);
    got = unpack(&page, page.json, "far");
    for (int i = 0; i < 3; i++) assert_true(fabs(got.values[i] - far[i]) < 2e-8);
    mem_free(got.values);
    page_clear(&page);
}

/* Numbers of very different sizes by their logarithms: each as exact as the others. */
static void test_log(void **unused)
{
    (void)unused;
    double values[40];
    for (int i = 0; i < 40; i++) values[i] = i == 7 ? NAN : 1e-3 * pow(10, 0.2 * i);
    Document *document = document_create();
    document_open(document, NULL, '{');
    document_packed(document, "young", values, (Packed){1, 40, 1, 16, true});
    document_close(document);
    Page page = close_document(document);
    assert_true(!strncmp(after(page.json, "log"), "true", 4));
    Unpacked got = unpack(&page, page.json, "young");
    for (int i = 0; i < 40; i++)
        assert_true(i == 7 ? isnan(got.values[i]) : fabs(got.values[i] / values[i] - 1) < 2e-4);
    mem_free(got.values);
    page_clear(&page);
}

static void test_indices(void **unused)
{
    (void)unused;
    const int indices[] = {0, 1, 2, 2, 1, -1, 2000000000, -2000000000, 7};
    Document *document = document_create();
    document_open(document, NULL, '{');
    document_indices(document, "faces", indices, 9, 3);
    document_indices(document, "empty", NULL, 0, 1);
    document_close(document);
    Page page = close_document(document);
    Unpacked got = unpack(&page, page.json, "faces"), empty = unpack(&page, page.json, "empty");
    for (int k = 0; k < 9; k++) assert_int_equal((int)got.values[k], indices[k]);
    assert_int_equal(empty.width, 0);
    mem_free(got.values);
    mem_free(empty.values);
    page_clear(&page);
}

static void test_json(void **unused)
{
    (void)unused;
    const double numbers[] = {1.5, NAN, -INFINITY};
    Document *document = document_create();
    document_open(document, NULL, '{');
    document_text(document, "a\"b", "</script><!-- \\ \n\t\x01 \xc3\xa9");
    document_text(document, "none", NULL);
    document_numbers(document, "numbers", numbers, 3);
    document_flag(document, "yes", true);
    document_open(document, "list", '[');
    document_open(document, NULL, '{');
    document_close(document);
    document_number(document, NULL, 1e-30);
    document_close(document);
    document_close(document);
    assert_string_equal(
        document_json(document),
        "{\"a\\\"b\":\"\\u003c/script>\\u003c!-- \\\\ \\u000a\\u0009\\u0001 \xc3\xa9\",\"none\":null,"
        "\"numbers\":[1.5,null,null],\"yes\":true,\"list\":[{},1e-30]}");
    document_destroy(document);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test_teardown(test_packed, nothing_leaks),
                                       cmocka_unit_test_teardown(test_narrow, nothing_leaks),
                                       cmocka_unit_test_teardown(test_log, nothing_leaks),
                                       cmocka_unit_test_teardown(test_indices, nothing_leaks),
                                       cmocka_unit_test_teardown(test_json, nothing_leaks)};
    return cmocka_run_group_tests(tests, NULL, remove_run);
}
