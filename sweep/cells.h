/* cells.h - what stands in a sweep's table: the texts of columns. Private to table.c. */
#pragma once
#include "io/result.h"
#include "sweep/sweep.h"

enum { CELLS_WIDTH_MAX = 64 };

typedef struct Column {
    char *name;
    char *unit;   /* of its numbers; NULL: none */
    char **cells; /* [runs]; NULL: nothing there */
} Column;

typedef struct Columns {
    int count, rows;
    Column *columns;
} Columns;

/* A new one, empty; it is good until the next one comes. Takes the name. */
Column *columns_add(Columns *columns, char *name);
void columns_clear(Columns *columns);

/* Is each cell that is there a number? */
bool column_is_number(const Column *column, int rows);

/* What a run has under a path, up to CELLS_WIDTH_MAX texts. */
typedef struct Cells {
    int count;
    char **texts;
    char *unit; /* as in Column */
} Cells;

/* Of a result; nothing where it has no such path. False and a sentence where that is too much for columns. */
bool cells_read(Result *result, const char *path, Cells *cells, Error *err);

/* Of a value as it is written: a number in SI, or a list of them; else its text. */
Cells cells_of_value(const char *text);
void cells_clear(Cells *cells);

/* Columns of what all the runs have, whose texts go into them, in the first unit that there is. */
void columns_add_cells(Columns *columns, const char *name, Cells *runs);
