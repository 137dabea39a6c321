#include "export/bytes.h"
#include "base/memory.h"
#include <string.h>

void bytes_add(Bytes *bytes, const void *data, size_t size)
{
    if (bytes->size + size > bytes->room) {
        size_t room = 2 * bytes->room > bytes->size + size ? 2 * bytes->room : bytes->size + size + 256;
        bytes->data = mem_resize(bytes->data, bytes->room, room, 1);
        bytes->room = room;
    }
    if (size) memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
}

void bytes_add_text(Bytes *bytes, const char *text)
{
    bytes_add(bytes, text, strlen(text));
}

void bytes_add_u8(Bytes *bytes, unsigned number)
{
    uint8_t byte = (uint8_t)number;
    bytes_add(bytes, &byte, sizeof byte);
}

void bytes_add_u16(Bytes *bytes, unsigned number)
{
    uint16_t two = (uint16_t)number;
    bytes_add(bytes, &two, sizeof two);
}

void bytes_add_u32(Bytes *bytes, uint32_t number)
{
    bytes_add(bytes, &number, sizeof number);
}

void bytes_add_float(Bytes *bytes, double number)
{
    float single = (float)number;
    bytes_add(bytes, &single, sizeof single);
}

void bytes_clear(Bytes *bytes)
{
    mem_free(bytes->data);
    *bytes = (Bytes){0};
}
