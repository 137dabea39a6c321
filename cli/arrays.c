#include "cli/arrays.h"
#include "base/memory.h"
#include <assert.h>

void *arrays_keep(Arrays *list, void *block)
{
    assert(list->owned_count < 2 * ARRAYS_MAX);
    list->owned[list->owned_count++] = block;
    return block;
}

double *arrays_numbers(Arrays *list, size_t count)
{
    return arrays_keep(list, mem_alloc(count, sizeof(double)));
}

void arrays_add(Arrays *list, Array array)
{
    assert(list->count < ARRAYS_MAX);
    list->arrays[list->count++] = array;
}

void arrays_clear(Arrays *list)
{
    for (int k = 0; k < list->owned_count; k++) mem_free(list->owned[k]);
    *list = (Arrays){0};
}

bool arrays_put(Arrays *list, Journal *journal, const char *kind, int index, Error *err)
{
    bool ok = journal_put(journal, kind, index, list->arrays, list->count, err);
    arrays_clear(list);
    return ok;
}
