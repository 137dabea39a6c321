#include "sweep/table.h"
#include "base/memory.h"
#include "io/arrays_file.h"
#include "io/safe_file.h"
#include "io/text.h"
#include "sweep/cells.h"
#include "sweep/state.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* What is read of each run: [paths][runs], those to be collected and the one that says which is best. */
typedef struct Reading {
    const Sweep *sweep;
    const Host *host;
    int path_count, best; /* which of them that is */
    const char **paths;
    Cells *cells;
    char **status;
    bool *told;          /* [paths] it cannot be read, or is nowhere: that was said */
    bool *read, *solved; /* [runs] there is a result; it is a solution */
} Reading;

/* ---- Reading ---- */

/* What cannot be read is an empty cell: all else is there. Said once. */
static void warn_of_unread(Reading *reading, int k, const char *file, const Error *err)
{
    if (!reading->told[k])
        host_warn(reading->host, "%s: %s; its cells are empty where it cannot be read", file, err->text);
    reading->told[k] = true;
}

static void read_result(Reading *reading, int run)
{
    Error err;
    char *name = sweep_run_name(reading->sweep, run), *path = mem_format("%s.vtkhdf", name);
    Result *result = result_open(path, &err);
    reading->read[run] = result != NULL;
    for (int k = 0; k < reading->path_count; k++)
        if (!result || !cells_read(result, reading->paths[k],
                                   &reading->cells[k * reading->sweep->run_count + run], &err))
            warn_of_unread(reading, k, path, &err);
    result_close(result);
    mem_free(name);
    mem_free(path);
}

/* Has it come to what the job looks for? What a design leaves is the best that it found, however it ended. */
static bool is_solved(const RunState *state, const Scene *scene, const char *status)
{
    return state->code == RUN_DONE ||
           (scene_job(scene)->design && state->code == RUN_NOT_CONVERGED && strcmp(status, "unsolved") != 0);
}

static void read_run(Reading *reading, int run)
{
    YamlFile *file;
    Scene scene;
    if (sweep_load(reading->sweep, run, &file, &scene)) {
        RunState state = state_read(reading->sweep, run, &scene);
        reading->status[run] = state_word(&state, reading->sweep, run);
        reading->solved[run] = is_solved(&state, &scene, reading->status[run]);
        if (state.record == RECORD_FINISHED) read_result(reading, run);
        state_clear(&state);
    } else {
        reading->status[run] = mem_text("refused");
    }
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
}

static int add_path(Reading *reading, const char *path)
{
    int k = 0;
    while (k < reading->path_count && strcmp(reading->paths[k], path)) k++;
    if (k == reading->path_count) reading->paths[reading->path_count++] = path;
    return k;
}

static Reading begin_reading(const Sweep *sweep, const Host *host)
{
    Reading reading = {.sweep = sweep, .host = host};
    reading.paths = mem_alloc((size_t)sweep->collect_count + 1, sizeof *reading.paths);
    for (int k = 0; k < sweep->collect_count; k++)
        if (strcmp(sweep->collect[k], "status")) add_path(&reading, sweep->collect[k]);
    if (sweep->best) reading.best = add_path(&reading, sweep->best);
    reading.cells = mem_alloc((size_t)reading.path_count * (size_t)sweep->run_count, sizeof *reading.cells);
    reading.told = mem_alloc((size_t)reading.path_count, sizeof *reading.told);
    reading.read = mem_alloc((size_t)sweep->run_count, sizeof *reading.read);
    reading.solved = mem_alloc((size_t)sweep->run_count, sizeof *reading.solved);
    reading.status = mem_alloc((size_t)sweep->run_count, sizeof *reading.status);
    return reading;
}

static void end_reading(Reading *reading)
{
    for (int i = 0; i < reading->path_count * reading->sweep->run_count; i++) cells_clear(&reading->cells[i]);
    for (int r = 0; r < reading->sweep->run_count; r++) mem_free(reading->status[r]);
    mem_free(reading->cells);
    mem_free(reading->paths);
    mem_free(reading->status);
    mem_free(reading->told);
    mem_free(reading->read);
    mem_free(reading->solved);
}

/* ---- Columns ---- */

static void add_runs(Columns *columns)
{
    Column *column = columns_add(columns, mem_text("run"));
    for (int r = 0; r < columns->rows; r++) column->cells[r] = mem_format("%d", r + 1);
}

/* All values as numbers, of equal count, or all as texts. */
static void add_key(Columns *columns, const Sweep *sweep, int key)
{
    Cells *cells = mem_alloc((size_t)columns->rows, sizeof *cells);
    bool alike = true;
    for (int r = 0; r < columns->rows; r++) {
        cells[r] = cells_of_value(sweep_value(sweep, r, key)->text);
        alike = alike && !cells[r].text && cells_count(&cells[r]) == cells_count(&cells[0]);
    }
    for (int r = 0; r < columns->rows && !alike; r++) {
        cells_clear(&cells[r]);
        cells[r].text = yaml_value_text(sweep_value(sweep, r, key)->text);
    }
    if (alike) cells[0].unit = mem_text(yaml_unit(scene_table(), sweep->keys[key].name));
    columns_add_cells(columns, sweep->keys[key].name, cells);
    for (int r = 0; r < columns->rows; r++) cells_clear(&cells[r]);
    mem_free(cells);
}

/* The run with the best finite number, of those that are solutions. */
static int find_best(const Reading *reading)
{
    const Sweep *sweep = reading->sweep;
    const Cells *cells = &reading->cells[reading->best * sweep->run_count];
    double record = NAN;
    int best = -1;
    for (int r = 0; r < sweep->run_count; r++) {
        double value = !cells[r].text && cells_count(&cells[r]) == 1 ? cells[r].numbers[0] : NAN;
        if (!isfinite(value) || !reading->solved[r] ||
            !(best < 0 || (sweep->least ? value < record : value > record)))
            continue;
        best = r;
        record = value;
    }
    return best;
}

static void add_best(Columns *columns, int best)
{
    Column *column = columns_add(columns, mem_text("best"));
    for (int r = 0; r < columns->rows; r++) column->cells[r] = mem_text(r == best ? "1" : "0");
}

static Columns make_columns(Reading *reading, int best)
{
    const Sweep *sweep = reading->sweep;
    Columns columns = {.rows = sweep->run_count};
    add_runs(&columns);
    for (int k = 0; k < sweep->key_count; k++) add_key(&columns, sweep, k);
    Column *status = columns_add(&columns, mem_text("status"));
    for (int r = 0; r < columns.rows; r++) status->cells[r] = mem_text(reading->status[r]);
    for (int k = 0; k < reading->path_count; k++)
        columns_add_cells(&columns, reading->paths[k], &reading->cells[k * columns.rows]);
    if (sweep->best) add_best(&columns, best);
    return columns;
}

/* ---- Files ---- */

static void add_quoted(Text *text, const char *cell)
{
    if (!cell[strcspn(cell, ",\"\n\r")]) {
        text_add(text, "%s", cell);
        return;
    }
    text_add(text, "\"");
    for (; *cell; cell++) text_add(text, *cell == '"' ? "\"\"" : "%c", *cell);
    text_add(text, "\"");
}

static bool write_csv(const char *path, const Columns *columns, Error *err)
{
    Text text = {0};
    for (int r = -1; r < columns->rows; r++) {
        for (int k = 0; k < columns->count; k++) {
            const Column *column = &columns->columns[k];
            if (column->numbers) continue;
            const char *cell = r < 0 ? column->name : column->cells[r];
            if (k) text_add(&text, ",");
            add_quoted(&text, cell ? cell : "");
        }
        text_add(&text, "\n");
    }
    bool ok = safe_file_write(path, text.text, text.length, false, err);
    mem_free(text.text);
    return ok;
}

/* [runs][rows], [runs][rows][width]; the column's own. */
static Array wide_array(const Column *column, int runs)
{
    Array array = array_float(column->name, column->unit ? column->unit : "", column->numbers,
                              column->width > 1 ? 3 : 2, runs, column->rows);
    array.dims[2] = column->width;
    return array;
}

/* Numbers, or a text of a line for each run, in which a line's end is \n, and a backslash two. */
static Array column_array(const Column *column, int rows)
{
    if (column->numbers) return wide_array(column, rows);
    if (column_is_number(column, rows)) {
        double *values = mem_alloc((size_t)rows, sizeof *values);
        for (int r = 0; r < rows; r++) values[r] = column->cells[r] ? strtod(column->cells[r], NULL) : NAN;
        return array_float(column->name, column->unit ? column->unit : "", values, 1, rows, 0);
    }
    Text text = {0};
    for (int r = 0; r < rows; r++) {
        text_add(&text, "%s", r ? "\n" : "");
        for (const char *c = column->cells[r]; c && *c; c++)
            text_add(&text, *c == '\n' ? "\\n" : *c == '\\' ? "\\\\" : "%c", *c);
    }
    return array_text(column->name, text.text);
}

static bool write_h5(const char *path, const Columns *columns, Error *err)
{
    Array *arrays = mem_alloc((size_t)columns->count, sizeof *arrays);
    for (int k = 0; k < columns->count; k++) arrays[k] = column_array(&columns->columns[k], columns->rows);
    bool ok = arrays_file_write(path, arrays, columns->count, err);
    for (int k = 0; k < columns->count; k++)
        if (!columns->columns[k].numbers) mem_free((void *)arrays[k].data);
    mem_free(arrays);
    return ok;
}

/* A link beside the results, put in the place of the one before. */
static bool link_best(const Sweep *sweep, int best, Error *err)
{
    char *to = mem_format("%04d.vtkhdf", best + 1), *path = mem_format("%s/best.vtkhdf", sweep->name),
         *fresh = mem_format("%s/best.vtkhdf.%ld", sweep->name, (long)getpid());
    bool ok =
        best < 0 ? unlink(path) == 0 || errno == ENOENT : symlink(to, fresh) == 0 && rename(fresh, path) == 0;
    if (!ok) error_set(err, "%s: cannot be written: %s", path, strerror(errno));
    mem_free(to);
    mem_free(path);
    mem_free(fresh);
    return ok;
}

static bool write_files(const Sweep *sweep, const Columns *columns, Error *err)
{
    char *csv = mem_format("%s.csv", sweep->name), *h5 = mem_format("%s.h5", sweep->name);
    bool ok = state_make_folder(sweep, err) && write_csv(csv, columns, err) && write_h5(h5, columns, err);
    mem_free(csv);
    mem_free(h5);
    return ok;
}

static void warn_of_missing(const Reading *reading)
{
    int runs = reading->sweep->run_count;
    bool any = false;
    for (int r = 0; r < runs; r++) any = any || reading->read[r];
    for (int k = 0; k < reading->path_count && any; k++) {
        int r = 0;
        while (r < runs && !cells_count(&reading->cells[k * runs + r])) r++;
        if (r == runs && !reading->told[k])
            host_warn(reading->host, "%s is in none of the results; slender info lists what is there",
                      reading->paths[k]);
    }
}

static void say_wide(const Sweep *sweep, const Columns *columns, const Host *host)
{
    for (int k = 0; k < columns->count; k++) {
        const Column *column = &columns->columns[k];
        if (column->numbers)
            host_say(host, "%s has up to %d numbers for a run, and %d can be columns: they are in %s.h5 only",
                     column->name, column->rows * column->width, CELLS_WIDTH_MAX, sweep->name);
    }
}

bool table_collect(const Sweep *sweep, const Host *host, int *best, Error *err)
{
    Reading reading = begin_reading(sweep, host);
    for (int r = 0; r < sweep->run_count; r++) read_run(&reading, r);
    warn_of_missing(&reading);
    *best = sweep->best ? find_best(&reading) : -1;
    Columns columns = make_columns(&reading, *best);
    say_wide(sweep, &columns, host);
    bool ok = write_files(sweep, &columns, err) && (!sweep->best || link_best(sweep, *best, err));
    columns_clear(&columns);
    end_reading(&reading);
    return ok;
}
