#include "report/document.h"
#include "base/memory.h"
#include "base/plain.h"
#include "io/text.h"
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <zlib.h>

enum { DEPTH_MAX = 32 };

struct Document {
    Text json;
    int depth;
    char closing[DEPTH_MAX];
    bool filled[DEPTH_MAX]; /* has something in it: a comma comes next */
    unsigned char *bytes;
    size_t length, room;
};

Document *document_create(void)
{
    return mem_alloc(1, sizeof(Document));
}

void document_destroy(Document *document)
{
    if (!document) return;
    mem_free(document->json.text);
    mem_free(document->bytes);
    mem_free(document);
}

/* ---- JSON ---- */

/* In quotes; the page stands in HTML, where "</script" ends it, whoever says so. */
static void add_quoted(Document *d, const char *text)
{
    char *inside = plain_json(text);
    text_add(&d->json, "\"");
    for (char *c = inside, *end; *c; c = end) {
        end = c + strcspn(c, "<");
        text_add(&d->json, "%.*s", (int)(end - c), c);
        if (*end) text_add(&d->json, "\\u003c"), end++;
    }
    text_add(&d->json, "\"");
    mem_free(inside);
}

static void begin(Document *d, const char *key)
{
    if (d->filled[d->depth]) text_add(&d->json, ",");
    d->filled[d->depth] = true;
    if (!key) return;
    add_quoted(d, key);
    text_add(&d->json, ":");
}

void document_open(Document *d, const char *key, char bracket)
{
    begin(d, key);
    text_add(&d->json, "%c", bracket);
    d->depth++;
    d->closing[d->depth] = bracket == '{' ? '}' : ']', d->filled[d->depth] = false;
}

void document_close(Document *d)
{
    text_add(&d->json, "%c", d->closing[d->depth--]);
}

void document_text(Document *d, const char *key, const char *text)
{
    begin(d, key);
    if (text)
        add_quoted(d, text);
    else
        text_add(&d->json, "null");
}

static void add_number(Document *d, double value, int digits)
{
    if (isfinite(value))
        text_add(&d->json, "%.*g", digits, value);
    else
        text_add(&d->json, "null");
}

void document_number(Document *d, const char *key, double value)
{
    begin(d, key);
    add_number(d, value, 12);
}

void document_flag(Document *d, const char *key, bool value)
{
    begin(d, key);
    text_add(&d->json, value ? "true" : "false");
}

void document_numbers(Document *d, const char *key, const double *values, size_t count)
{
    document_open(d, key, '[');
    for (size_t k = 0; k < count; k++) begin(d, NULL), add_number(d, values[k], 7);
    document_close(d);
}

/* ---- The block ---- */

static unsigned char *extend(Document *d, size_t size)
{
    if (d->length + size > d->room) {
        size_t room = 2 * d->room + size;
        d->bytes = mem_resize(d->bytes, d->room, room, 1);
        d->room = room;
    }
    d->length += size;
    return d->bytes + d->length - size;
}

/* Differences, of so many bytes each, the lowest bytes first. */
static void add_differences(Document *d, const uint32_t *numbers, Packed shape, size_t size)
{
    size_t count = shape.rows * shape.width;
    unsigned char *bytes = extend(d, count * size);
    for (size_t i = 0; i < count; i++) {
        size_t back = i < shape.width ? shape.stride : shape.width;
        uint32_t difference = numbers[i] - (i >= back ? numbers[i - back] : 0);
        for (size_t b = 0; b < size; b++) bytes[b * count + i] = (unsigned char)(difference >> 8 * b);
    }
}

static void refer(Document *d, const char *type, Packed shape)
{
    document_number(d, "at", (double)d->length);
    document_text(d, "type", type);
    document_number(d, "rows", (double)shape.rows);
    document_number(d, "width", (double)shape.width);
    document_number(d, "stride", (double)shape.stride);
}

void document_indices(Document *d, const char *key, const int *values, size_t count, size_t stride)
{
    Packed shape = {1, count, stride, 32, false};
    uint32_t *numbers = mem_copy(values, count, sizeof *numbers);
    document_open(d, key, '{');
    refer(d, "i32", shape);
    document_close(d);
    add_differences(d, numbers, shape, 4);
    mem_free(numbers);
}

void document_range(const double *values, size_t count, double *low, double *high)
{
    *low = INFINITY, *high = -INFINITY;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i])) *low = fmin(*low, values[i]), *high = fmax(*high, values[i]);
    if (*low > *high) *low = *high = 0;
}

/* Where between the ends: 0 .. 1. */
static double part_of(double value, double low, double high, bool log_scale)
{
    if (!(high > low)) return 0;
    return log_scale ? log(value / low) / log(high / low) : (value - low) / (high - low);
}

void document_packed(Document *d, const char *key, const double *values, Packed shape)
{
    size_t count = shape.rows * shape.width;
    double low, high, top = shape.bits == 8 ? 254 : 65534;
    document_range(values, count, &low, &high);
    uint32_t *numbers = mem_alloc(count, sizeof *numbers);
    for (size_t i = 0; i < count; i++)
        numbers[i] = (uint32_t)(isfinite(values[i]) ? lround(top * part_of(values[i], low, high, shape.log))
                                                    : (long)top + 1);
    document_open(d, key, '{');
    refer(d, shape.bits == 8 ? "q8" : "q16", shape);
    document_number(d, "low", low);
    document_number(d, "high", high);
    document_flag(d, "log", shape.log);
    document_close(d);
    add_differences(d, numbers, shape, (size_t)shape.bits / 8);
    mem_free(numbers);
}

const char *document_json(const Document *d)
{
    return d->json.text;
}

/* ---- Compressed ---- */

static char *base64(const unsigned char *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = mem_alloc((size + 2) / 3 * 4 + 1, 1), *c = text;
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        uint32_t three = (uint32_t)bytes[i] << 16 | (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) |
                         (left > 2 ? bytes[i + 2] : 0u);
        for (int k = 0; k < 4; k++) *c++ = digits[three >> (18 - 6 * k) & 63];
        if (left < 3) c[-1] = '=';
        if (left < 2) c[-2] = '=';
    }
    return text;
}

char *document_block(const Document *d)
{
    uLongf size = compressBound(d->length);
    unsigned char *packed = mem_alloc(size, 1);
    if (compress2(packed, &size, d->bytes ? d->bytes : packed, d->length, 9) != Z_OK)
        mem_exhausted("the compression of a report");
    char *text = base64(packed, size);
    mem_free(packed);
    return text;
}
