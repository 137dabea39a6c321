#include "world/pair_memory.h"
#include "base/memory.h"
#include <string.h>

/* Steps of two motions of a thousand each, with room to spare; and what all slots take at most, with lists in proportion. */
enum { SLOTS = 4096 };
static const size_t BYTES = (size_t)128 << 20;

/* FNV-1a, word by word. */
static uint64_t key_of(const PairMemory *memory, const double *places)
{
    uint64_t key = 14695981039346656037u;
    for (int i = 0; i < memory->numbers; i++) {
        uint64_t word;
        memcpy(&word, &places[i], sizeof word);
        key = (key ^ word) * 1099511628211u;
        key ^= key >> 29;
    }
    return key;
}

PairMemory pair_memory_create(int vertex_count)
{
    return (PairMemory){.numbers = 3 * vertex_count};
}

void pair_memory_clear(PairMemory *memory)
{
    for (int k = 0; memory->slots && k < SLOTS; k++) {
        mem_free(memory->slots[k].places);
        pair_list_clear(&memory->slots[k].list);
    }
    mem_free(memory->slots);
}

static void copy_list(const PairList *from, PairList *to)
{
    if (to->room < from->count) {
        mem_free(to->pairs);
        to->pairs = mem_alloc((size_t)from->count, sizeof *to->pairs);
        to->room = from->count;
    }
    if (from->count) memcpy(to->pairs, from->pairs, (size_t)from->count * sizeof *to->pairs);
    to->count = from->count, to->points = from->points;
}

bool pair_memory_find(const PairMemory *memory, const double *places, PairList *list)
{
    if (!memory->slots) return false;
    uint64_t key = key_of(memory, places);
    const Remembered *slot = &memory->slots[key % SLOTS];
    if (!slot->places || slot->key != key ||
        memcmp(slot->places, places, (size_t)memory->numbers * sizeof *places))
        return false;
    copy_list(&slot->list, list);
    return true;
}

void pair_memory_keep(PairMemory *memory, const double *places, const PairList *list)
{
    size_t numbers = (size_t)memory->numbers;
    if (numbers * sizeof *places + (size_t)list->count * sizeof *list->pairs > BYTES / SLOTS) return;
    if (!memory->slots) memory->slots = mem_alloc(SLOTS, sizeof *memory->slots);
    uint64_t key = key_of(memory, places);
    Remembered *slot = &memory->slots[key % SLOTS];
    slot->key = key;
    if (!slot->places) slot->places = mem_alloc(numbers, sizeof *places);
    memcpy(slot->places, places, numbers * sizeof *places);
    copy_list(list, &slot->list);
}
