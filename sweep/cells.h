/* cells.h - what stands in a sweep's table: the texts of columns. Private to table.c. */
#pragma once
#include "io/result.h"
#include "sweep/sweep.h"

enum { CELLS_WIDTH_MAX = 64 };

typedef struct Column {
    char *name;
    char *unit;   /* of its numbers; NULL: none */
    char **cells; /* [runs]; NULL: nothing there */
    double *
        numbers; /* in place of cells: too many for columns, [runs][rows][width], NaN where nothing is; else NULL */
    int rows, width;
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

/* What a run has under a path: numbers or a text; neither: nothing. */
typedef struct Cells {
    int rows, width;
    double *numbers; /* [rows][width] */
    char *text;
    char *unit; /* as in Column */
} Cells;

/* Of a result; nothing where it has no such path. False and a sentence where it cannot be read. */
bool cells_read(Result *result, const char *path, Cells *cells, Error *err);

/* Of a value as it is written: a number in SI, or a list of them; else its text. */
Cells cells_of_value(const char *text);
void cells_clear(Cells *cells);

/* How many columns they are. */
int cells_count(const Cells *cells);

/* Columns of what all the runs have, in the first unit that there is: one for each number, or one of all of them where a
 * run has more than CELLS_WIDTH_MAX. */
void columns_add_cells(Columns *columns, const char *name, const Cells *runs);
