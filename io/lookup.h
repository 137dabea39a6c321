/* lookup.h - finds the entries of a growing table by their keys, in a time that does not grow with it.
 * Private to io/.
 *
 * The table is the caller's; a Lookup holds the hashes of the keys and the indices of their entries. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct LookupSlot {
    uint64_t hash;
    int entry; /* its index + 1; 0: free */
} LookupSlot;

typedef struct Lookup {
    LookupSlot *slots; /* owned; zeroed: nothing in it yet */
    size_t size, count;
} Lookup;

/* Of some bytes, after those hashed before (0: none). */
uint64_t lookup_hash(uint64_t before, const void *bytes, size_t length);

/* The entry with that hash for which same(self, index) is true; -1: none. */
int lookup_find(const Lookup *lookup, uint64_t hash, bool (*same)(const void *self, int index),
                const void *self);

void lookup_add(Lookup *lookup, uint64_t hash, int index);

void lookup_clear(Lookup *lookup);
