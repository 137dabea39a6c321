#include "io/array.h"
#include "base/memory.h"
#include <string.h>
#include <zlib.h>

Array array_float(const char *name, const char *unit, const double *data, int rank, int d0, int d1)
{
    return (Array){
        .name = name, .unit = unit, .type = ARRAY_FLOAT64, .rank = rank, .dims = {d0, d1}, .data = data};
}

Array array_int(const char *name, const int *data, int rank, int d0, int d1)
{
    return (Array){
        .name = name, .unit = "", .type = ARRAY_INT32, .rank = rank, .dims = {d0, d1}, .data = data};
}

Array array_text(const char *name, const char *text)
{
    return (Array){
        .name = name, .unit = "", .type = ARRAY_TEXT, .rank = 1, .dims = {(int)strlen(text)}, .data = text};
}

bool array_is(const Array *array, ArrayType type, int rank, int width)
{
    return array->type == type && array->rank == rank && (width == 0 || array->dims[rank - 1] == width);
}

size_t array_count(const Array *array)
{
    size_t count = 1;
    for (int r = 0; r < array->rank; r++) count *= (size_t)array->dims[r];
    return count;
}

size_t array_bytes(const Array *array)
{
    static const size_t sizes[] = {
        [ARRAY_FLOAT64] = sizeof(double), [ARRAY_INT32] = sizeof(int32_t), [ARRAY_TEXT] = 1};
    return array_count(array) * sizes[array->type];
}

void array_clear(Array *array)
{
    mem_free((void *)array->name);
    mem_free((void *)array->unit);
    mem_free((void *)array->data);
    *array = (Array){0};
}

static uint32_t add_text_crc(uint32_t crc, const char *text)
{
    return (uint32_t)crc32(crc, (const Bytef *)text, (uInt)strlen(text) + 1);
}

uint32_t array_crc(const Array *array, const char *kind, int index)
{
    int32_t numbers[6] = {index, (int32_t)array->type, array->rank, 0, 0, 0};
    for (int r = 0; r < array->rank; r++) numbers[3 + r] = array->dims[r];
    uint32_t crc = add_text_crc(add_text_crc(add_text_crc(0, kind), array->name), array->unit);
    crc = (uint32_t)crc32(crc, (const Bytef *)numbers, sizeof numbers);
    size_t bytes = array_bytes(array); /* zlib would begin anew where there are none and no place for them */
    return bytes ? (uint32_t)crc32_z(crc, array->data, bytes) : crc;
}

bool array_own(Array *array, size_t bytes, const char *kind, int index, uint32_t crc)
{
    if (array->type > ARRAY_TEXT || array->rank < 0 || array->rank > ARRAY_MAX_RANK) return false;
    for (int r = 0; r < array->rank; r++)
        if (array->dims[r] < 0) return false;
    if (bytes != array_bytes(array) || array_crc(array, kind, index) != crc) return false;
    char *data = mem_alloc(bytes + 1, 1); /* a text ends with 0 */
    if (bytes) memcpy(data, array->data, bytes);
    array->name = mem_text(array->name);
    array->unit = mem_text(array->unit);
    array->data = data;
    return true;
}
