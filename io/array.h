/* array.h - a named n-dimensional array of numbers or a text: what journal, result and export exchange. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum ArrayType { ARRAY_FLOAT64, ARRAY_INT32, ARRAY_TEXT } ArrayType;

enum { ARRAY_MAX_RANK = 3 };

typedef struct Array {
    const char *name; /* path below its place, e.g. "design/young"                       */
    const char *unit; /* e.g. "Pa"; "" where there is none                              */
    ArrayType type;
    int rank;                 /* 0: a scalar                                                     */
    int dims[ARRAY_MAX_RANK]; /* of a text: dims[0] = bytes without the closing 0, rank 1 */
    const void *data;         /* row-major; borrowed by writers, owned after a read (array_clear) */
} Array;

/* Borrowing constructors; dims beyond rank are ignored. */
Array array_float(const char *name, const char *unit, const double *data, int rank, int d0, int d1);
Array array_int(const char *name, const int *data, int rank, int d0, int d1);
Array array_text(const char *name, const char *text);

/* Of that type and rank, its last dimension being `width` (0: any). */
bool array_is(const Array *array, ArrayType type, int rank, int width);

size_t array_bytes(const Array *array);
size_t array_count(const Array *array);

/* Frees name, unit and data of an array that a reader filled. */
void array_clear(Array *array);

/* Makes a borrowed array an owned one if it is what was kept under that key: so many bytes of data, of that
 * CRC32. Else false, and nothing is owned. */
bool array_own(Array *array, size_t bytes, const char *kind, int index, uint32_t crc);

/* CRC32 over the bytes, over all that is said of them, and over the key under which they are kept. */
uint32_t array_crc(const Array *array, const char *kind, int index);
