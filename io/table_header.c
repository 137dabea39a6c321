/* What the header of a table says about its columns: their names and units. */
#include "base/memory.h"
#include "io/table.h"
#include "io/yaml_private.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { UNIT_MAX = 32 };

/* A cell of the header, and the column that it belongs to. */
typedef struct Cell {
    const char *text;
    int length, column;
    bool begins; /* the column, with its name; else it is a unit split from it by blanks */
} Cell;

static bool is_word(char c)
{
    return (c >= '0' && c <= '9') || ((c | 32) >= 'a' && (c | 32) <= 'z');
}

static bool is_edge(char c)
{
    return c && strchr(" \t\r\"'", c);
}

/* As the numbers are split: by the first of these that is there. */
static char separator_of(const char *header)
{
    return strchr(header, ';') ? ';' : strchr(header, '\t') ? '\t' : strchr(header, ',') ? ',' : ' ';
}

static bool next_cell(const char **at, char separator, Cell *cell)
{
    const char *c = *at;
    while (is_edge(*c) && *c != separator) c++;
    if (separator == ' ') c += strspn(c, " ");
    if (!*c) return false;
    size_t length = strcspn(c, (char[]){separator, 0});
    *at = c + length + (c[length] != 0);
    while (length && is_edge(c[length - 1])) length--;
    cell->text = c, cell->length = (int)length;
    cell->begins = !length || !strchr("[(", c[0]) || cell->column < 0;
    cell->column += cell->begins;
    return true;
}

/* Column k of "s [m], x, y, z": its name, and its unit, empty where it has none. False: there are fewer. */
static bool name_of(const char *names, int k, const char **name, size_t *size, char unit[UNIT_MAX])
{
    for (; k > 0 && *names; k--) {
        names += strcspn(names, ",");
        names += strspn(names, ", ");
    }
    *name = names;
    *size = strcspn(names, ", ");
    unit[0] = 0;
    const char *bracket = names + *size;
    if (bracket[0] == ' ' && bracket[1] == '[')
        snprintf(unit, UNIT_MAX, "%.*s", (int)strcspn(bracket + 2, "]"), bracket + 2);
    return *names;
}

/* Place among the names of the word that a cell begins with; -1: it is none of them. */
static int column_of(const char *names, const Cell *cell)
{
    const char *name;
    char unit[UNIT_MAX];
    size_t size, length = 0;
    while ((int)length < cell->length && is_word(cell->text[length])) length++;
    for (int k = 0; name_of(names, k, &name, &size, unit); k++)
        if (size == length && !strncasecmp(name, cell->text, size)) return k;
    return -1;
}

static bool is_unit(const char *text)
{
    double factor;
    char number[UNIT_MAX + 2], wrong[200];
    snprintf(number, sizeof number, "1 %s", text);
    return *text && unit_parse(number, text, &factor, wrong, sizeof wrong);
}

/* What a cell says of its unit: "s [mm]", "s (mm)", "s/mm"; and "s_mm", "s mm" where that is one. Empty: nothing. */
static void unit_of(const Cell *cell, char unit[UNIT_MAX])
{
    int at = 0, end = cell->length;
    while (at < end && !strchr("[(/", cell->text[at])) at++;
    bool said = at < end;
    if (!said)
        for (at = end - 1; at > 0 && cell->text[at] != '_' && cell->text[at] != ' ';) at--;
    char close = said && cell->text[at] == '[' ? ']' : said && cell->text[at] == '(' ? ')' : 0;
    const char *from = cell->text + at + 1,
               *to = close && at + 1 < end ? memchr(from, close, (size_t)(end - at - 1)) : NULL;
    if (!to) to = cell->text + end;
    while (from < to && is_edge(*from)) from++;
    while (to > from && is_edge(to[-1])) to--;
    snprintf(unit, UNIT_MAX, "%.*s", to > from && (said || at > 0) ? (int)(to - from) : 0, from);
    if (!said && !is_unit(unit)) unit[0] = 0;
}

/* What its numbers are multiplied with; 0: nothing is said. False: it is another kind of unit, or none. */
static bool factor_of(const Cell *cell, const char *wanted, double *factor)
{
    char unit[UNIT_MAX], number[UNIT_MAX + 2], wrong[200];
    *factor = 0;
    unit_of(cell, unit);
    if (!unit[0]) return true;
    *factor = 1;
    if (!*wanted) return !strcmp(unit, "-") || !strcmp(unit, "1");
    snprintf(number, sizeof number, "1 %s", unit);
    return unit_parse(number, wanted, factor, wrong, sizeof wrong);
}

/* A comment is a header only where all its words are the columns' names. */
static bool is_header(const char *note, const char *names, int columns)
{
    Cell cell = {.column = -1};
    const char *at = note;
    while (next_cell(&at, separator_of(note), &cell))
        if (cell.begins && column_of(names, &cell) < 0) return false;
    return cell.column == columns - 1;
}

static bool refuse(const Table *table, const char *path, const Cell *cell, const char *what,
                   const char *allowed, Error *err)
{
    return error_set(err, "%s:%d: column %d is headed '%.*s'; %s%s", path, table->header_line,
                     cell->column + 1, cell->length > 40 ? 40 : cell->length, cell->text, what, allowed);
}

/* factors[columns]; 0 where a column is given no unit. */
static bool read_factors(const Table *table, const char *path, const char *header, const char *names,
                         double *factors, Error *err)
{
    Cell cell = {.column = -1};
    char separator = separator_of(header);
    while (next_cell(&header, separator, &cell) && cell.column < table->columns) {
        const char *name;
        size_t size;
        char unit[UNIT_MAX];
        int column = cell.begins ? column_of(names, &cell) : -1;
        if (column >= 0 && column != cell.column)
            return refuse(table, path, &cell, "the columns must be ", names, err);
        if (!name_of(names, cell.column, &name, &size, unit)) break;
        if (!factor_of(&cell, unit, &factors[cell.column]))
            return refuse(table, path, &cell, *unit ? "it must be in " : "it must be without a unit", unit,
                          err);
    }
    return true;
}

/* Where one column is in another unit than usual, what the others are in must be said. */
static bool check_factors(const Table *table, const char *path, const char *names, const double *factors,
                          Error *err)
{
    for (int k = 0; table->scaled && k < table->columns; k++) {
        const char *name;
        size_t size;
        char unit[UNIT_MAX];
        if (name_of(names, k, &name, &size, unit) && *unit && factors[k] == 0)
            return error_set(err, "%s:%d: column %d, %.*s, is headed without a unit, and others with one",
                             path, table->header_line, k + 1, (int)size, name);
    }
    return true;
}

bool table_take_header(Table *table, const char *path, const char *names, Error *err)
{
    const char *header = table->header;
    if (!header && table->note && is_header(table->note, names, table->columns)) header = table->note;
    if (!header) return true;
    double *factors = mem_alloc((size_t)table->columns, sizeof *factors);
    bool ok = read_factors(table, path, header, names, factors, err);
    for (int k = 0; k < table->columns; k++) table->scaled |= factors[k] != 0 && factors[k] != 1;
    ok = ok && check_factors(table, path, names, factors, err);
    for (size_t i = 0; ok && i < (size_t)table->rows * (size_t)table->columns; i++) {
        double factor = factors[i % (size_t)table->columns];
        if (factor != 0 && factor != 1) table->values[i] *= factor;
    }
    mem_free(factors);
    return ok;
}
