#include "job/probe_table.h"
#include "base/memory.h"
#include "io/safe_file.h"
#include "io/text.h"
#include "model/probe.h"
#include <string.h>

typedef struct Columns {
    int count, rows, cases; /* rows of the result, with so many cases each */
    Array *arrays;          /* [count] what counts the rows, and the probes */
} Columns;

static void add_header(const Model *model, int cases, Text *text)
{
    text_add(text, "%s%s", model_probe_rows(model), cases > 1 ? ",case" : "");
    for (int k = 0; k < model->probe_count; k++) {
        const ModelProbe *probe = &model->probes[k];
        int width = model_probe_width(probe);
        if (width == 1) text_add(text, ",%s", probe->name);
        for (int i = 0; width > 1 && i < width; i++) text_add(text, ",%s.%c", probe->name, "xyz"[i]);
    }
    text_add(text, "\n");
}

static void add_line(const Model *model, const Columns *columns, int row, int load_case, Text *text)
{
    text_add(text, "%.17g", ((const double *)columns->arrays[0].data)[row]);
    if (columns->cases > 1) text_add(text, ",%d", load_case);
    for (int k = 0; k < model->probe_count; k++) {
        int width = model_probe_width(&model->probes[k]);
        const double *values = columns->arrays[1 + k].data;
        for (int i = 0; i < width; i++)
            text_add(text, ",%.17g", values[(row * columns->cases + load_case) * width + i]);
    }
    text_add(text, "\n");
}

static bool read_column(Result *result, const char *name, Array *array, Error *err)
{
    char *path = mem_format("slender/probes/%s", name);
    bool ok = result_read(result, path, array, err);
    mem_free(path);
    if (!ok || array->type == ARRAY_FLOAT64) return ok;
    array_clear(array);
    return error_set(err, "slender/probes/%s is not as slender writes it", name);
}

/* What there is; without any rows too. */
static bool read_columns(const Model *model, Result *result, Columns *columns, Error *err)
{
    const char *rows = model_probe_rows(model);
    char *path = mem_format("slender/probes/%s", rows);
    bool any = result_has(result, path), ok = true;
    mem_free(path);
    columns->arrays = mem_alloc(1 + (size_t)model->probe_count, sizeof *columns->arrays);
    for (int k = 0; any && ok && k <= model->probe_count; k++) {
        Array *array = &columns->arrays[k];
        ok = read_column(result, k ? model->probes[k - 1].name : rows, array, err);
        if (ok) columns->count++;
        if (ok && k == 0) columns->rows = (int)array_count(array);
        size_t each =
            k ? (size_t)(columns->rows * columns->cases * model_probe_width(&model->probes[k - 1])) : 0;
        if (ok && k && array_count(array) != each)
            ok = error_set(err, "slender/probes/%s is not as slender writes it", model->probes[k - 1].name);
    }
    return ok;
}

bool probe_table_write(const Model *model, Result *result, const char *path, Error *err)
{
    Columns columns = {.cases = model->job->probed == PROBED_EVALUATIONS ? model->case_count : 1};
    bool ok = read_columns(model, result, &columns, err);
    Text text = {0};
    add_header(model, columns.cases, &text);
    for (int r = 0; ok && r < columns.rows * columns.cases; r++)
        add_line(model, &columns, r / columns.cases, r % columns.cases, &text);
    ok = ok && safe_file_write(path, text.text, text.length, false, err);
    for (int k = 0; k < columns.count; k++) array_clear(&columns.arrays[k]);
    mem_free(columns.arrays);
    mem_free(text.text);
    return ok;
}
