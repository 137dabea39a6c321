#include "job/probe_table.h"
#include "base/memory.h"
#include "io/safe_file.h"
#include "io/text.h"
#include "model/probe.h"
#include <string.h>

typedef struct Column {
    const char *name;
    int width; /* numbers in a row, of one case */
    Array array;
} Column;

/* What a table is of: what counts its rows, and the probes in the scene's order. */
typedef struct ProbeNames {
    const char *rows;
    int cases, count;
    const char **names; /* [count] borrowed; the list is owned      */
    int *widths;        /* [count] numbers in a row; owned          */
} ProbeNames;

typedef struct Columns {
    int count, rows, cases; /* rows of the result, with so many cases each */
    Column *items; /* [count] what counts the rows, the probes, and what a sequence has beside them */
} Columns;

/* Of the stages of a sequence, or of load steps; those that there are, and of which not all numbers are 0. */
static const struct {
    const char *name, *path;
    int width;
} staged[] = {{"t", "stages/time", 1},
              {"load_part", "stages/load_part", 1},
              {"B", "stages/flux_density", 3},
              {"gravity", "stages/gravity", 3}};

enum { STAGED = sizeof staged / sizeof *staged };

static void add_header(const Columns *columns, Text *text)
{
    for (int k = 0; k < columns->count; k++) {
        const Column *column = &columns->items[k];
        if (column->width == 1) text_add(text, "%s%s", k ? "," : "", column->name);
        for (int i = 0; column->width > 1 && i < column->width; i++)
            text_add(text, ",%s.%c", column->name, "xyz"[i]);
        if (k == 0 && columns->cases > 1) text_add(text, ",case");
    }
    text_add(text, "\n");
}

static void add_line(const Columns *columns, int row, int load_case, Text *text)
{
    for (int k = 0; k < columns->count; k++) {
        const Column *column = &columns->items[k];
        const double *values = column->array.data;
        int at = k ? row * columns->cases + load_case : row;
        for (int i = 0; i < column->width; i++)
            text_add(text, "%s%.17g", k ? "," : "", values[at * column->width + i]);
        if (k == 0 && columns->cases > 1) text_add(text, ",%d", load_case);
    }
    text_add(text, "\n");
}

/* At a path of the result. What counts the rows comes first, and says how many they are. */
static bool add_column(Result *result, const char *at, Column column, Columns *columns, Error *err)
{
    char *path = mem_format("slender/%s", at);
    bool ok = result_read(result, path, &column.array, err);
    if (ok && columns->count == 0) columns->rows = (int)array_count(&column.array);
    int rows = columns->count ? columns->rows * columns->cases : columns->rows;
    bool fits = ok && column.array.type == ARRAY_FLOAT64 &&
                array_count(&column.array) == (size_t)rows * (size_t)column.width;
    if (ok) columns->items[columns->count++] = column;
    if (ok && !fits) ok = error_set(err, "%s is not as slender writes it", path);
    mem_free(path);
    return ok;
}

static bool add_probe(Result *result, const char *name, int width, Columns *columns, Error *err)
{
    char *at = mem_format("probes/%s", name);
    bool ok = add_column(result, at, (Column){.name = name, .width = width}, columns, err);
    mem_free(at);
    return ok;
}

static bool has(Result *result, const char *at)
{
    char *path = mem_format("slender/%s", at);
    bool is = result_has(result, path);
    mem_free(path);
    return is;
}

static bool is_zero(const Array *array)
{
    bool zero = true;
    for (size_t i = 0; i < array_count(array); i++) zero &= ((const double *)array->data)[i] == 0;
    return zero;
}

/* What there is; without any rows too, whose columns are then named alone. */
static bool read_columns(const ProbeNames *probes, Result *result, Columns *columns, Error *err)
{
    const char *rows = probes->rows;
    columns->items = mem_alloc(1 + (size_t)probes->count + STAGED, sizeof *columns->items);
    char *counter = mem_format("probes/%s", rows);
    bool any = has(result, counter), ok = true, stages = any && has(result, "stages/time");
    mem_free(counter);
    if (any) ok = add_probe(result, rows, 1, columns, err);
    if (!any) columns->items[columns->count++] = (Column){.name = rows, .width = 1};
    for (int k = 0; ok && k < probes->count; k++) {
        const char *name = probes->names[k];
        int width = probes->widths[k];
        if (any) ok = add_probe(result, name, width, columns, err);
        if (!any) columns->items[columns->count++] = (Column){.name = name, .width = width};
    }
    for (int k = 0; ok && stages && k < STAGED; k++) {
        if (!has(result, staged[k].path)) continue;
        ok = add_column(result, staged[k].path, (Column){.name = staged[k].name, .width = staged[k].width},
                        columns, err);
        Array *array = &columns->items[columns->count - 1].array;
        if (ok && is_zero(array)) columns->count--, array_clear(array);
    }
    return ok;
}

/* NULL and a sentence where it cannot be read. Clears the names. */
static char *make_table(ProbeNames *probes, Result *result, Error *err)
{
    Columns columns = {.cases = probes->cases};
    bool ok = read_columns(probes, result, &columns, err);
    Text text = {0};
    if (ok) add_header(&columns, &text);
    for (int r = 0; ok && r < columns.rows * columns.cases; r++)
        add_line(&columns, r / columns.cases, r % columns.cases, &text);
    for (int k = 0; k < columns.count; k++) array_clear(&columns.items[k].array);
    mem_free(columns.items);
    mem_free(probes->names);
    mem_free(probes->widths);
    return text.text;
}

static ProbeNames names_create(const char *rows, int cases, int count)
{
    return (ProbeNames){rows, cases, count, mem_alloc((size_t)count, sizeof(char *)),
                        mem_alloc((size_t)count, sizeof(int))};
}

bool probe_table_write(const Model *model, Result *result, const char *path, Error *err)
{
    int cases = model->job->probed == PROBED_EVALUATIONS ? model->case_count : 1;
    ProbeNames probes = names_create(model_probe_rows(model), cases, model->probe_count);
    for (int k = 0; k < probes.count; k++)
        probes.names[k] = model->probes[k].name, probes.widths[k] = model_probe_width(&model->probes[k]);
    char *text = make_table(&probes, result, err);
    bool ok = text && safe_file_write(path, text, strlen(text), false, err);
    mem_free(text);
    return ok;
}

/* ---- Of a result alone ---- */

/* How many numbers a dataset has; 0: it cannot be read. */
static int count_at(Result *result, const char *name)
{
    Array array;
    char *path = mem_format("slender/probes/%s", name);
    int count = 0;
    if (result_read(result, path, &array, NULL)) {
        count = (int)array_count(&array);
        array_clear(&array);
    }
    mem_free(path);
    return count;
}

static int count_cases(Result *result)
{
    Array names;
    int count = 1;
    if (!result_read_as(result, "slender/case_names", ARRAY_TEXT, 1, 0, &names, NULL)) return 1;
    for (const char *c = names.data; *c; c++) count += c[0] == '\n' && c[1];
    array_clear(&names);
    return count;
}

char *probe_table_text(const Scene *scene, Result *result, Error *err)
{
    const char *rows = has(result, "probes/stage")        ? "stage"
                       : has(result, "probes/time")       ? "time"
                       : has(result, "probes/evaluation") ? "evaluation"
                                                          : NULL;
    int count = rows ? count_at(result, rows) : 0;
    if (!count || !scene->probes_count)
        return error_set(err, "the result has no rows of probes, which a scene names in `probes`"), NULL;
    ProbeNames probes =
        names_create(rows, strcmp(rows, "evaluation") ? 1 : count_cases(result), scene->probes_count);
    for (int k = 0; k < probes.count; k++) {
        probes.names[k] = scene->probes[k].name;
        probes.widths[k] = count_at(result, probes.names[k]) / (count * probes.cases);
    }
    return make_table(&probes, result, err);
}
