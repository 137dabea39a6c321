#include "sweep/cells.h"
#include "base/memory.h"
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

void columns_add_cells(Columns *columns, const char *name, Cells *runs)
{
    int width = 1;
    for (int r = 0; r < columns->rows; r++) width = runs[r].count > width ? runs[r].count : width;
    for (int part = 0; part < width; part++) {
        Column *column = columns_add(columns, part_name(name, width, part));
        column->unit = mem_text(unit_of(runs, columns->rows));
        for (int r = 0; r < columns->rows; r++)
            if (part < runs[r].count) column->cells[r] = runs[r].texts[part], runs[r].texts[part] = NULL;
    }
}

/* ---- Cells ---- */

void cells_clear(Cells *cells)
{
    for (int i = 0; i < cells->count; i++) mem_free(cells->texts[i]);
    mem_free(cells->texts);
    mem_free(cells->unit);
    *cells = (Cells){0};
}

static void add(Cells *cells, char *text)
{
    size_t count = (size_t)cells->count++;
    cells->texts = mem_resize(cells->texts, count, count + 1, sizeof *cells->texts);
    cells->texts[count] = text;
}

/* Has it a row for each time, stage or evaluation? */
static bool has_rows(const char *path)
{
    static const char *const groups[] = {"probes/", "history/", "stages/", "frames/", "trajectory/"};
    for (size_t k = 0; k < sizeof groups / sizeof *groups; k++)
        if (!strncmp(path, groups[k], strlen(groups[k]))) return true;
    return false;
}

static void add_number(Cells *cells, const Array *array, size_t i)
{
    add(cells, array->type == ARRAY_INT32 ? mem_format("%d", ((const int *)array->data)[i])
                                          : mem_format("%.17g", ((const double *)array->data)[i]));
}

/* Of lines the last one. */
static void add_text(Cells *cells, const char *text, bool rows)
{
    const char *line = rows ? strrchr(text, '\n') : NULL;
    add(cells, mem_text(line && line[1] ? line + 1 : text));
}

static bool take(const Array *array, const char *path, Cells *cells, Error *err)
{
    bool rows = has_rows(path);
    if (array->type == ARRAY_TEXT) {
        add_text(cells, array->data, rows);
        return true;
    }
    size_t all = array_count(array),
           count = rows && array->rank && array->dims[0] > 0 ? all / (size_t)array->dims[0] : all;
    if (count > CELLS_WIDTH_MAX)
        return error_set(err, "%s has %zu numbers, and %d can be columns: slender export has the others",
                         path, count, CELLS_WIDTH_MAX);
    if (array->unit && *array->unit) cells->unit = mem_text(array->unit);
    for (size_t i = all - count; i < all; i++) add_number(cells, array, i);
    return true;
}

bool cells_read(Result *result, const char *path, Cells *cells, Error *err)
{
    Array array;
    char *full = mem_format("slender/%s", path);
    bool status = !strcmp(path, "status") || !strcmp(path, "kernels"), ok = true;
    if (status || result_has(result, full)) {
        ok = result_read(result, full, &array, err);
        if (ok) ok = take(&array, path, cells, err), array_clear(&array);
    }
    mem_free(full);
    return ok;
}

/* ---- Values ---- */

/* "[0, 0, 10 mT]": numbers, up to CELLS_WIDTH_MAX. */
static bool add_list(Cells *cells, const char *text)
{
    char *copy = mem_text(text + 1), *rest = NULL, *end = strrchr(copy, ']');
    bool ok = end && !end[1];
    if (ok) *end = 0;
    for (char *item = ok ? strtok_r(copy, ",", &rest) : NULL; item && ok; item = strtok_r(NULL, ",", &rest)) {
        double value;
        item += strspn(item, " ");
        ok = cells->count < CELLS_WIDTH_MAX && yaml_quantity(item, &value);
        if (ok) add(cells, mem_format("%.17g", value));
    }
    mem_free(copy);
    return ok && cells->count;
}

Cells cells_of_value(const char *text)
{
    double value;
    Cells cells = {0};
    if (yaml_quantity(text, &value))
        add(&cells, mem_format("%.17g", value));
    else if (*text != '[' || !add_list(&cells, text)) {
        cells_clear(&cells);
        add(&cells, mem_text(text));
    }
    return cells;
}
