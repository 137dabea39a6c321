/* arrays.h - a growing list of arrays for the journal, with the texts and numbers that belong to it. */
#pragma once
#include "io/journal.h"

typedef struct Arrays {
    size_t count, room, owned_count, owned_room;
    Array *arrays;
    void **owned;
} Arrays;

/* Takes a block of memory, which is freed with the list. */
void *arrays_keep(Arrays *list, void *block);

/* So many numbers, 0, that belong to the list. */
double *arrays_numbers(Arrays *list, size_t count);

void arrays_add(Arrays *list, Array array);
void arrays_clear(Arrays *list);

/* Puts all as one unit into the journal, and clears the list. */
bool arrays_put(Arrays *list, Journal *journal, const char *kind, int index, Error *err);

/* The same in the place of all that is under this kind (journal_replace). */
bool arrays_replace(Arrays *list, Journal *journal, const char *kind, Error *err);
