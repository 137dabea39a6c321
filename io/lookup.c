#include "io/lookup.h"
#include "base/memory.h"

/* FNV-1a, and a last mixing, because slots are taken by the lower bits. */
uint64_t lookup_hash(uint64_t before, const void *bytes, size_t length)
{
    uint64_t hash = before ^ 0xcbf29ce484222325u;
    for (size_t k = 0; k < length; k++) hash = (hash ^ ((const unsigned char *)bytes)[k]) * 0x100000001b3u;
    return hash ^ hash >> 32;
}

int lookup_find(const Lookup *lookup, uint64_t hash, bool (*same)(const void *self, int index),
                const void *self)
{
    if (!lookup->size) return -1;
    for (size_t k = hash & (lookup->size - 1); lookup->slots[k].entry; k = (k + 1) & (lookup->size - 1))
        if (lookup->slots[k].hash == hash && same(self, lookup->slots[k].entry - 1))
            return lookup->slots[k].entry - 1;
    return -1;
}

static void put(Lookup *lookup, LookupSlot slot)
{
    size_t k = slot.hash & (lookup->size - 1);
    while (lookup->slots[k].entry) k = (k + 1) & (lookup->size - 1);
    lookup->slots[k] = slot;
}

void lookup_add(Lookup *lookup, uint64_t hash, int index)
{
    if (2 * lookup->count >= lookup->size) { /* at most half full */
        Lookup larger = {.size = lookup->size ? 2 * lookup->size : 16, .count = lookup->count};
        larger.slots = mem_alloc(larger.size, sizeof *larger.slots);
        for (size_t k = 0; k < lookup->size; k++)
            if (lookup->slots[k].entry) put(&larger, lookup->slots[k]);
        mem_free(lookup->slots);
        *lookup = larger;
    }
    put(lookup, (LookupSlot){hash, index + 1});
    lookup->count++;
}

void lookup_clear(Lookup *lookup)
{
    mem_free(lookup->slots);
    *lookup = (Lookup){0};
}
