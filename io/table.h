/* table.h - rows of numbers from a text file.
 *
 * The first row says how its numbers are split, for the whole file: by semicolons, by tabs, by commas or by
 * blanks, the first of these that is in it. Numbers have decimal points throughout or, where semicolons or
 * tabs split them, decimal commas throughout. `#` starts a comment. A first row of words, none of them a
 * number, is a header; so is the last comment before the rows where all its words are the columns' names. A header
 * may say units ("s [mm]", "t (ms)", "t/ms", "t_ms"), which are honoured. */
#pragma once
#include "base/error.h"

typedef struct Table {
    int rows, columns;
    double *values; /* [rows*columns]; owned */
    int *line;      /* [rows] line in the file, from 1; owned */
    char *header;   /* its words; NULL: none; owned */
    char *note;     /* the last comment before the rows; NULL: none; owned */
    int header_line;
    bool scaled; /* numbers were in other units, which the header says */
} Table;

/* Reads rows of columns with these names and units, "s [m], x, y, z"; NULL: as many as the first row has. A header may
 * have other names, but none of these in another's place, and units of these kinds (table_take_header). A row of another length, a word,
 * NaN or an infinity is refused with file:line. */
bool table_read(const char *path, const char *names, Table *table, Error *err);

/* The same from memory. */
bool table_parse(const char *path, const char *text, long length, const char *names, Table *table,
                 Error *err);

/* Of a table that was read without names: checks them, and multiplies what is in other units. */
bool table_take_header(Table *table, const char *path, const char *names, Error *err);

/* Does the first column, which is called `name`, increase from row to row? */
bool table_check_increasing(const Table *table, const char *path, const char *name, Error *err);

/* Writes with every bit; header may be NULL. */
bool table_write(const char *path, const char *header, const double *values, int rows, int columns,
                 Error *err);

void table_clear(Table *table);
