/* table.h - rows of numbers from a text file: split by commas, semicolons or blanks; `#` starts a comment. */
#pragma once
#include "base/error.h"

typedef struct Table {
    int rows, columns;
    double *values; /* [rows*columns]; owned */
    int *line;      /* [rows] line in the file, from 1; owned */
} Table;

/* Reads rows that all have `columns` numbers (0: as many as the first row). A row of another length, a word,
 * NaN or an infinity is refused with file:line. A first line of words (a header) is skipped. */
bool table_read(const char *path, int columns, Table *table, Error *err);

/* The same from memory. */
bool table_parse(const char *path, const char *text, long length, int columns, Table *table, Error *err);

/* Writes with every bit; header may be NULL. */
bool table_write(const char *path, const char *header, const double *values, int rows, int columns,
                 Error *err);

void table_clear(Table *table);
