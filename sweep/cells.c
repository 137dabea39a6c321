#include "sweep/cells.h"
#include "base/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- Columns ---- */

Column *columns_add(Columns *columns, char *name)
{
    size_t count = (size_t)columns->count++;
    columns->columns = mem_resize(columns->columns, count, count + 1, sizeof *columns->columns);
    columns->columns[count] =
        (Column){.name = name, .cells = mem_alloc((size_t)columns->rows, sizeof(char *))};
    return &columns->columns[count];
}

void columns_clear(Columns *columns)
{
    for (int k = 0; k < columns->count; k++) {
        for (int r = 0; r < columns->rows; r++) mem_free(columns->columns[k].cells[r]);
        mem_free(columns->columns[k].cells);
        mem_free(columns->columns[k].numbers);
        mem_free(columns->columns[k].name);
        mem_free(columns->columns[k].unit);
    }
    mem_free(columns->columns);
    *columns = (Columns){0};
}

static bool is_number(const char *text)
{
    char *end;
    strtod(text, &end);
    return end > text && !*end;
}

bool column_is_number(const Column *column, int rows)
{
    for (int r = 0; r < rows; r++)
        if (column->cells[r] && !is_number(column->cells[r])) return false;
    return true;
}

/* "tip.x" or "steps[4]". */
static char *part_name(const char *name, int width, int part)
{
    if (width == 1) return mem_text(name);
    return width == 3 ? mem_format("%s.%c", name, "xyz"[part]) : mem_format("%s[%d]", name, part);
}

/* NULL: there is none. */
static const char *unit_of(const Cells *runs, int count)
{
    for (int r = 0; r < count; r++)
        if (runs[r].unit) return runs[r].unit;
    return NULL;
}

/* NULL: it is not there; the caller frees. */
static char *part_text(const Cells *cells, int part)
{
    if (part >= cells_count(cells)) return NULL;
    if (cells->text) return mem_text(cells->text);
    char number[40];
    number_format(cells->numbers[part], number);
    return mem_text(number);
}

/* Each run's numbers stand in the first of as many rows and places as any run has. */
static void add_wide(Column *column, const Cells *runs, int count)
{
    for (int r = 0; r < count; r++) {
        column->rows = runs[r].rows > column->rows ? runs[r].rows : column->rows;
        column->width = runs[r].width > column->width ? runs[r].width : column->width;
    }
    size_t size = (size_t)column->rows * (size_t)column->width, all = size * (size_t)count;
    column->numbers = mem_alloc(all, sizeof *column->numbers);
    for (size_t i = 0; i < all; i++) column->numbers[i] = NAN;
    for (int r = 0; r < count; r++)
        for (int i = 0; i < runs[r].rows; i++)
            memcpy(&column->numbers[(size_t)r * size + (size_t)i * (size_t)column->width],
                   &runs[r].numbers[(size_t)i * (size_t)runs[r].width],
                   (size_t)runs[r].width * sizeof(double));
}

void columns_add_cells(Columns *columns, const char *name, const Cells *runs)
{
    int width = 1;
    for (int r = 0; r < columns->rows; r++)
        width = cells_count(&runs[r]) > width ? cells_count(&runs[r]) : width;
    bool wide = width > CELLS_WIDTH_MAX;
    for (int part = 0; part < (wide ? 1 : width); part++) {
        Column *column = columns_add(columns, wide ? mem_text(name) : part_name(name, width, part));
        column->unit = mem_text(unit_of(runs, columns->rows));
        for (int r = 0; r < columns->rows && !wide; r++) column->cells[r] = part_text(&runs[r], part);
        if (wide) add_wide(column, runs, columns->rows);
    }
}

/* ---- Cells ---- */

void cells_clear(Cells *cells)
{
    mem_free(cells->numbers);
    mem_free(cells->text);
    mem_free(cells->unit);
    *cells = (Cells){0};
}

int cells_count(const Cells *cells)
{
    return cells->text ? 1 : cells->rows * cells->width;
}

/* Has it a row for each time, stage or evaluation? */
static bool has_rows(const char *path)
{
    static const char *const groups[] = {"probes/", "history/", "stages/", "frames/", "trajectory/"};
    for (size_t k = 0; k < sizeof groups / sizeof *groups; k++)
        if (!strncmp(path, groups[k], strlen(groups[k]))) return true;
    return false;
}

/* Without the end of its last line; of lines the last one. */
static char *text_of(const char *text, bool rows)
{
    char *lines = mem_text(text), *end = strrchr(lines, '\n');
    if (end && !end[1]) *end = 0;
    char *line = rows ? strrchr(lines, '\n') : NULL;
    if (!line) return lines;
    line = mem_text(line + 1);
    mem_free(lines);
    return line;
}

/* All of it, or its last row. */
static void take_numbers(const Array *array, bool rows, Cells *cells)
{
    bool last = rows && array->rank && array->dims[0] > 0;
    size_t all = array_count(array), count = last ? all / (size_t)array->dims[0] : all, from = all - count;
    int first = last ? 1 : 0;
    cells->rows = array->rank > first ? array->dims[first] : 1;
    cells->width = cells->rows ? (int)(count / (size_t)cells->rows) : 0;
    cells->numbers = mem_alloc(count, sizeof *cells->numbers);
    for (size_t i = 0; i < count; i++)
        cells->numbers[i] = array->type == ARRAY_INT32 ? ((const int *)array->data)[from + i]
                                                       : ((const double *)array->data)[from + i];
    if (array->unit && *array->unit) cells->unit = mem_text(array->unit);
}

static void take(const Array *array, const char *path, Cells *cells)
{
    bool rows = has_rows(path);
    if (array->type == ARRAY_TEXT)
        cells->text = text_of(array->data, rows);
    else
        take_numbers(array, rows, cells);
}

bool cells_read(Result *result, const char *path, Cells *cells, Error *err)
{
    Array array;
    char *full = mem_format("slender/%s", path);
    bool status = !strcmp(path, "status") || !strcmp(path, "kernels"), ok = true;
    if (status || result_has(result, full)) {
        ok = result_read(result, full, &array, err);
        if (ok) take(&array, path, cells), array_clear(&array);
    }
    mem_free(full);
    return ok;
}

/* ---- Values ---- */

static void add(Cells *cells, double value)
{
    size_t count = (size_t)cells->rows++;
    cells->numbers = mem_resize(cells->numbers, count, count + 1, sizeof *cells->numbers);
    cells->numbers[count] = value;
    cells->width = 1;
}

/* "[0, 0, 10 mT]": numbers, up to CELLS_WIDTH_MAX. */
static bool add_list(Cells *cells, const char *text)
{
    char *copy = mem_text(text + 1), *rest = NULL, *end = strrchr(copy, ']');
    bool ok = end && !end[1];
    if (ok) *end = 0;
    for (char *item = ok ? strtok_r(copy, ",", &rest) : NULL; item && ok; item = strtok_r(NULL, ",", &rest)) {
        double value;
        char *said = yaml_value_text(item);
        ok = cells->rows < CELLS_WIDTH_MAX && yaml_quantity(said, &value);
        if (ok) add(cells, value);
        mem_free(said);
    }
    mem_free(copy);
    return ok && cells->rows;
}

Cells cells_of_value(const char *text)
{
    double value;
    Cells cells = {0};
    char *said = yaml_value_text(text);
    if (yaml_quantity(said, &value))
        add(&cells, value);
    else if (*said != '[' || !add_list(&cells, said)) {
        cells_clear(&cells);
        cells.text = mem_text(said);
    }
    mem_free(said);
    return cells;
}
