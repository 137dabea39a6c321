/* report_fixture.h - what a report's page holds, read anew as its page does; after cmocka.h. */
#pragma once
#include "base/memory.h"
#include "report/report.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

typedef struct Page {
    char *text, *json; /* the latter within the former */
    unsigned char *bytes;
    size_t length;
} Page;

/* An array that the document refers to. */
typedef struct Unpacked {
    size_t rows, width;
    double low, high, *values;
} Unpacked;

static inline char *page_text(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file) fail_msg("%s is not there", path);
    fseek(file, 0, SEEK_END);
    size_t size = (size_t)ftell(file);
    char *text = mem_alloc(size + 1, 1);
    rewind(file);
    assert_int_equal(fread(text, 1, size, file), size);
    fclose(file);
    return text;
}

static inline int digit_of(char c)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *at = strchr(digits, c);
    return at ? (int)(at - digits) : 0;
}

/* The text between two words, which it ends. */
static inline char *between(char *text, const char *first, const char *last)
{
    char *from = strstr(text, first);
    assert_non_null(from);
    from += strlen(first);
    char *end = strstr(from, last);
    assert_non_null(end);
    *end = 0;
    return from;
}

/* base64, then zlib. */
static inline void unpack_block(Page *page, const char *block)
{
    size_t letters = strlen(block), size = letters / 4 * 3;
    assert_int_equal(letters % 4, 0);
    unsigned char *packed = mem_alloc(size + 1, 1);
    for (size_t k = 0; k < letters; k += 4) {
        unsigned three = 0;
        for (int i = 0; i < 4; i++) three = three << 6 | (unsigned)digit_of(block[k + (size_t)i]);
        for (size_t i = 0; i < 3; i++) packed[k / 4 * 3 + i] = (unsigned char)(three >> (16 - 8 * i));
    }
    while (letters && block[letters - 1] == '=') letters--, size--;
    uLongf length = 1100 * size + 1024; /* zeros take a thousandth */
    page->bytes = mem_alloc(length, 1);
    assert_int_equal(uncompress(page->bytes, &length, packed, size), Z_OK);
    page->length = length;
    mem_free(packed);
}

static inline Page page_read(const char *path)
{
    Page page = {.text = page_text(path)};
    char *block = strstr(page.text, "<script id=\"block\"");
    page.json = between(page.text, "<script id=\"document\" type=\"application/json\">", "</script>");
    unpack_block(&page, between(block, "type=\"text/plain\">", "</script>"));
    return page;
}

static inline void page_clear(Page *page)
{
    mem_free(page->text);
    mem_free(page->bytes);
}

/* The page of one result, of so many frames; 0: as many as there is room for. */
static inline Page page_of(const char *result, const char *html, int frames)
{
    Error err;
    if (report_write(&result, 1, html, &(ReportDef){.frames = frames}, &err) != SHOW_DONE)
        fail_msg("%s", err.text);
    return page_read(html);
}

/* What stands after a key, the first one from there on. */
static inline const char *after(const char *json, const char *key)
{
    char quoted[80];
    snprintf(quoted, sizeof quoted, "\"%s\":", key);
    const char *at = strstr(json, quoted);
    if (!at) fail_msg("no %s in the document", key);
    return at + strlen(quoted);
}

static inline double number_after(const char *json, const char *key)
{
    return strtod(after(json, key), NULL);
}

/* The array of that key, the first one from there on. */
static inline Unpacked unpack(const Page *page, const char *json, const char *key)
{
    const char *ref = after(json, key), *type = after(ref, "type");
    size_t at = (size_t)number_after(ref, "at"), stride = (size_t)number_after(ref, "stride"),
           size = !strncmp(type, "\"i32\"", 5)   ? 4
                  : !strncmp(type, "\"q16\"", 5) ? 2
                                                 : 1;
    Unpacked array = {.rows = (size_t)number_after(ref, "rows"), .width = (size_t)number_after(ref, "width")};
    bool logarithmic = size < 4 && !strncmp(after(ref, "log"), "true", 4);
    if (size < 4) array.low = number_after(ref, "low"), array.high = number_after(ref, "high");
    size_t count = array.rows * array.width;
    assert_true(at + size * count <= page->length);
    uint32_t *q = mem_alloc(count, sizeof *q), top = size == 1 ? 254 : 65534;
    array.values = mem_alloc(count, sizeof *array.values);
    for (size_t i = 0; i < count; i++) {
        size_t back = i < array.width ? stride : array.width;
        for (size_t b = 0; b < size; b++) q[i] |= (uint32_t)page->bytes[at + b * count + i] << 8 * b;
        if (i >= back) q[i] += q[i - back];
        if (size < 4) q[i] &= size == 1 ? 0xff : 0xffff;
        array.values[i] = size == 4     ? (int32_t)q[i]
                          : q[i] > top  ? NAN
                          : logarithmic ? array.low * pow(array.high / array.low, (double)q[i] / top)
                                        : array.low + (array.high - array.low) * q[i] / top;
    }
    mem_free(q);
    return array;
}

/* Places of the page's first result, as they are in the world. */
static inline Unpacked unpack_places(const Page *page, const char *json, const char *key)
{
    Unpacked places = unpack(page, json, key);
    const char *origin = after(page->json, "origin");
    double at[3];
    assert_int_equal(sscanf(origin, "[%lf,%lf,%lf]", &at[0], &at[1], &at[2]), 3);
    for (size_t i = 0; i < places.rows * places.width; i++) places.values[i] += at[i % 3];
    return places;
}
