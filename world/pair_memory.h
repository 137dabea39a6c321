/* pair_memory.h - lists of pairs that were made for some places, for when a body comes back to these: the sweeps along a
 * motion, many times each, do. What a list is, it knows nothing of: a list that is remembered is the one that would be made. */
#pragma once
#include "world/neighbours.h"
#include <stdint.h>

/* One list, and where it was made. */
typedef struct Remembered {
    uint64_t key;
    double *places; /* [3*vertex_count]; NULL: none */
    PairList list;
} Remembered;

typedef struct PairMemory {
    int numbers;       /* of the places                       */
    Remembered *slots; /* by their keys; NULL: not yet needed */
} PairMemory;

PairMemory pair_memory_create(int vertex_count);
void pair_memory_clear(PairMemory *memory);

/* Puts the list of these places into `list`; false: it is not known. */
bool pair_memory_find(const PairMemory *memory, const double *places, PairList *list);

/* In place of another, if need be; a list that is too large for it is not kept. */
void pair_memory_keep(PairMemory *memory, const double *places, const PairList *list);
