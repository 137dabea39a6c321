#include "io/array.h"
#include "base/memory.h"
#include <string.h>

Array array_float(const char *name, const char *unit, const double *data, int rank, int d0, int d1)
{
    return (Array){.name = name, .unit = unit, .type = ARRAY_FLOAT64, .rank = rank, .dims = {d0, d1}, .data = data};
}

Array array_int(const char *name, const int *data, int rank, int d0, int d1)
{
    return (Array){.name = name, .unit = "", .type = ARRAY_INT32, .rank = rank, .dims = {d0, d1}, .data = data};
}

Array array_text(const char *name, const char *text)
{
    return (Array){.name = name, .unit = "", .type = ARRAY_TEXT, .rank = 1, .dims = {(int)strlen(text)}, .data = text};
}

size_t array_count(const Array *array)
{
    size_t count = 1;
    for (int r = 0; r < array->rank; r++) count *= (size_t)array->dims[r];
    return count;
}

size_t array_bytes(const Array *array)
{
    static const size_t sizes[] = {[ARRAY_FLOAT64] = sizeof(double), [ARRAY_INT32] = sizeof(int32_t), [ARRAY_TEXT] = 1};
    return array_count(array) * sizes[array->type];
}

void array_clear(Array *array)
{
    mem_free((void *)array->name);
    mem_free((void *)array->unit);
    mem_free((void *)array->data);
    *array = (Array){0};
}
