/* bytes.h - the inside of a binary file, as it grows. Little-endian, as the processors that slender is for. */
#pragma once
#include <stddef.h>
#include <stdint.h>

typedef struct Bytes {
    unsigned char *data; /* owned */
    size_t size, room;
} Bytes;

void bytes_add(Bytes *bytes, const void *data, size_t size);
void bytes_add_text(Bytes *bytes, const char *text); /* without its closing 0 */
void bytes_add_u8(Bytes *bytes, unsigned number);
void bytes_add_u16(Bytes *bytes, unsigned number);
void bytes_add_u32(Bytes *bytes, uint32_t number);
void bytes_add_float(Bytes *bytes, double number); /* in single precision */

void bytes_clear(Bytes *bytes);
