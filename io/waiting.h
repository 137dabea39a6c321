/* waiting.h - arrays that wait for their commit. Private to journal.c. */
#pragma once
#include "io/array.h"

typedef struct Pending {
    char *kind;
    int index;
    Array array; /* owned; without a name: all of the kind goes */
} Pending;

typedef struct Waiting {
    size_t count, room;
    Pending *items;
} Waiting;

/* Copies the array. */
void waiting_push(Waiting *waiting, const char *kind, int index, const Array *array);

/* What is under this kind goes before what is pushed later comes. */
void waiting_push_end(Waiting *waiting, const char *kind);

/* Frees everything. */
void waiting_clear(Waiting *waiting);
