/* document.h - what a report tells its page: JSON, in which arrays of many numbers are references to one block of bytes
 * that is compressed at the end. page/10_data.js reads it.
 *
 *     {"at": first byte, "type": "i32" | "q8" | "q16", "rows": R, "width": W, "stride": S,
 *      "low": .., "high": .., "log": true | false}
 *
 * is R x W numbers. q8 and q16 are quantised to whole numbers q of 8 or 16 bits: they mean low + (high - low) q / (2^bits - 2),
 * with log low (high / low)^(q / (2^bits - 2)), and NaN where q is the largest, 2^bits - 1. Every q is kept as its difference
 * from the same one of the row before, in the first row from the one `stride` before it, modulo 2^bits; the lowest bytes of
 * all come first, then the next ones. So a motion takes a byte or two a number before it is compressed, and half after. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct Document Document;

Document *document_create(void);
void document_destroy(Document *document);

/* What is added stands in the innermost object or list that is open. key: NULL within a list. */
void document_open(Document *document, const char *key, char bracket); /* '{' or '[' */
void document_close(Document *document);
void document_text(Document *document, const char *key, const char *text); /* NULL: null */
void document_number(Document *document, const char *key, double value);   /* 12 digits; not finite: null */
void document_flag(Document *document, const char *key, bool value);

/* As a list in the JSON, seven digits each. */
void document_numbers(Document *document, const char *key, const double *values, size_t count);

/* rows x width numbers by reference; `stride` numbers belong together (3: a point, or the corners of a face). */
typedef struct Packed {
    size_t rows, width, stride;
    int bits; /* 8 or 16 */
    bool log; /* the logarithm is quantised: all that are finite must be positive */
} Packed;

/* The least and the greatest finite number; 0 and 0 where there is none. */
void document_range(const double *values, size_t count, double *low, double *high);

void document_indices(Document *document, const char *key, const int *values, size_t count, size_t stride);

/* Between the least and the greatest of them. */
void document_packed(Document *document, const char *key, const double *values, Packed shape);

/* The JSON, valid until the next call, and the block of bytes, compressed by zlib and in base64. The caller frees the latter. */
const char *document_json(const Document *document);
char *document_block(const Document *document);
