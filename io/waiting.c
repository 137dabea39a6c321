#include "io/waiting.h"
#include "base/memory.h"

static Pending *add(Waiting *waiting, const char *kind, int index)
{
    if (waiting->count == waiting->room) {
        size_t room = 2 * waiting->room + 16;
        waiting->items = mem_resize(waiting->items, waiting->room, room, sizeof *waiting->items);
        waiting->room = room;
    }
    Pending *pending = &waiting->items[waiting->count++];
    *pending = (Pending){.kind = mem_text(kind), .index = index};
    return pending;
}

void waiting_push(Waiting *waiting, const char *kind, int index, const Array *array)
{
    Pending *pending = add(waiting, kind, index);
    pending->array = *array;
    pending->array.name = mem_text(array->name);
    pending->array.unit = mem_text(array->unit ? array->unit : "");
    pending->array.data = mem_copy(array->data, array_bytes(array), 1);
}

void waiting_push_end(Waiting *waiting, const char *kind)
{
    add(waiting, kind, 0);
}

void waiting_clear(Waiting *waiting)
{
    for (size_t k = 0; k < waiting->count; k++) {
        mem_free(waiting->items[k].kind);
        array_clear(&waiting->items[k].array);
    }
    mem_free(waiting->items);
    *waiting = (Waiting){0};
}
