/* arrays.h - a growing list of arrays for the journal, with the texts and numbers that belong to it. */
#pragma once
#include "io/journal.h"

enum { ARRAYS_MAX = 96 };

typedef struct Arrays {
    int count, owned_count;
    Array arrays[ARRAYS_MAX];
    void *owned[2 * ARRAYS_MAX];
} Arrays;

/* Takes a block of memory, which is freed with the list. */
void *arrays_keep(Arrays *list, void *block);

/* So many numbers, 0, that belong to the list. */
double *arrays_numbers(Arrays *list, size_t count);

void arrays_add(Arrays *list, Array array);
void arrays_clear(Arrays *list);

/* Puts all as one unit into the journal, and clears the list. */
bool arrays_put(Arrays *list, Journal *journal, const char *kind, int index, Error *err);
