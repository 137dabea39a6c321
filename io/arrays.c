#include "io/arrays.h"
#include "base/memory.h"

/* Room for one more. */
static void *grow(void *block, size_t count, size_t *room, size_t size)
{
    if (count < *room) return block;
    size_t more = 2 * *room + 16, before = *room;
    *room = more;
    return mem_resize(block, before, more, size);
}

void *arrays_keep(Arrays *list, void *block)
{
    list->owned = grow(list->owned, list->owned_count, &list->owned_room, sizeof *list->owned);
    list->owned[list->owned_count++] = block;
    return block;
}

double *arrays_numbers(Arrays *list, size_t count)
{
    return arrays_keep(list, mem_alloc(count, sizeof(double)));
}

void arrays_add(Arrays *list, Array array)
{
    list->arrays = grow(list->arrays, list->count, &list->room, sizeof *list->arrays);
    list->arrays[list->count++] = array;
}

void arrays_clear(Arrays *list)
{
    for (size_t k = 0; k < list->owned_count; k++) mem_free(list->owned[k]);
    mem_free(list->owned);
    mem_free(list->arrays);
    *list = (Arrays){0};
}

bool arrays_put(Arrays *list, Journal *journal, const char *kind, int index, Error *err)
{
    bool ok = journal_put(journal, kind, index, list->arrays, (int)list->count, err);
    arrays_clear(list);
    return ok;
}

bool arrays_replace(Arrays *list, Journal *journal, const char *kind, Error *err)
{
    bool ok = journal_replace(journal, kind, 0, list->arrays, (int)list->count, err);
    arrays_clear(list);
    return ok;
}
