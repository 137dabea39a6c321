#include "io/table.h"
#include "base/memory.h"
#include "io/scan.h"
#include <errno.h>
#include <stdio.h>
#include <string.h>

/* Numbers and line numbers that fit before the arrays grow. */
typedef struct Room {
    size_t values, rows;
} Room;

/* A first line that begins with a word is a header; "nan" and "inf" are no words but bad numbers. */
static bool is_header(Word word)
{
    return !strchr("0123456789+-.", word.text[0]) && !word_begins(word, "nan") && !word_begins(word, "inf");
}

/* Appends the line's numbers. */
static bool read_row(Scan *scan, Table *table, Room *room)
{
    int columns = 0;
    for (Word word; scan_word(scan, &word); columns++) {
        double value;
        if (!word_number(word, &value)) {
            if (table->rows == 0 && columns == 0 && is_header(word)) return true;
            return scan_refuse(scan, "'%.*s' is no finite number", word.length > 40 ? 40 : word.length,
                               word.text);
        }
        size_t place = (size_t)table->rows * (size_t)table->columns + (size_t)columns;
        if (place >= room->values) {
            table->values = mem_resize(table->values, room->values, 2 * place + 64, sizeof *table->values);
            room->values = 2 * place + 64;
        }
        table->values[place] = value;
    }
    if (table->columns == 0) table->columns = columns;
    if (columns != table->columns)
        return scan_refuse(scan, "%d number%s in this row, and %d are needed", columns,
                           columns == 1 ? "" : "s", table->columns);
    size_t rows = (size_t)table->rows;
    if (rows == room->rows) {
        table->line = mem_resize(table->line, rows, 2 * rows + 64, sizeof *table->line);
        room->rows = 2 * rows + 64;
    }
    table->line[table->rows++] = scan->line;
    return true;
}

bool table_parse(const char *path, const char *text, long length, int columns, Table *table, Error *err)
{
    Room room = {0};
    size_t left = (size_t)length;
    *table = (Table){.columns = columns};
    bool ok = scan_skip_mark(path, &text, &left, err);
    Scan scan = scan_start(path, text, left, '#', ",;", err);
    while (ok && scan_line(&scan)) ok = read_row(&scan, table, &room);
    if (ok && table->rows == 0) ok = error_set(err, "%s: there are no numbers in it", path);
    if (!ok) table_clear(table);
    return ok;
}

bool table_read(const char *path, int columns, Table *table, Error *err)
{
    char *text;
    size_t length;
    *table = (Table){0};
    if (!scan_file(path, &text, &length, err)) return false;
    bool ok = table_parse(path, text, (long)length, columns, table, err);
    mem_free(text);
    return ok;
}

bool table_write(const char *path, const char *header, const double *values, int rows, int columns,
                 Error *err)
{
    FILE *file = fopen(path, "w");
    if (!file) return error_set(err, "%s: cannot be written: %s", path, strerror(errno));
    if (header) fprintf(file, "%s\n", header);
    for (long i = 0; i < (long)rows * columns; i++)
        fprintf(file, "%.17g%s", values[i], (i + 1) % columns ? ", " : "\n");
    bool failed = ferror(file) != 0;
    failed |= fclose(file) != 0;
    return !failed || error_set(err, "%s: cannot be written: %s", path, strerror(errno));
}

void table_clear(Table *table)
{
    mem_free(table->values);
    mem_free(table->line);
    *table = (Table){0};
}
