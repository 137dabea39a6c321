/* table.h - rows of numbers from a text file.
 *
 * The first row says how its numbers are split, for the whole file: by semicolons, by tabs, by commas or by
 * blanks, the first of these that is in it. Numbers have decimal points throughout or, where semicolons or
 * tabs split them, decimal commas throughout. `#` starts a comment. A first row of words, none of them a
 * number, is a header. */
#pragma once
#include "base/error.h"

typedef struct Table {
    int rows, columns;
    double *values; /* [rows*columns]; owned */
    int *line;      /* [rows] line in the file, from 1; owned */
    char *header;   /* its words; NULL: none; owned */
    int header_line;
} Table;

/* Reads rows of columns with these names, "s, x, y, z"; NULL: as many as the first row has. A header may have
 * other names, but none of these in another's place (table_check_header). A row of another length, a word,
 * NaN or an infinity is refused with file:line. */
bool table_read(const char *path, const char *names, Table *table, Error *err);

/* The same from memory. */
bool table_parse(const char *path, const char *text, long length, const char *names, Table *table,
                 Error *err);

/* Of a table that was read without names. */
bool table_check_header(const Table *table, const char *path, const char *names, Error *err);

/* Does the first column, which is called `name`, increase from row to row? */
bool table_check_increasing(const Table *table, const char *path, const char *name, Error *err);

/* Writes with every bit; header may be NULL. */
bool table_write(const char *path, const char *header, const double *values, int rows, int columns,
                 Error *err);

void table_clear(Table *table);
