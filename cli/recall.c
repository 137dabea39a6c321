#include "cli/recall.h"
#include "base/memory.h"
#include "io/result.h"
#include <stdio.h>
#include <string.h>

static const char CELLS[] = "VTKHDF/CellData/";

/* Is this step's array its own, or that of the step before? Fields that never change are stored once. */
static bool has_own(Result *result, const char *field, int step)
{
    char path[300];
    Array offsets;
    snprintf(path, sizeof path, "VTKHDF/Steps/CellDataOffsets/%.200s", field);
    if (step == 0 || !result_read_rows(result, path, step - 1, 2, &offsets, NULL)) return true;
    const int *at = offsets.data;
    bool own = !array_is(&offsets, ARRAY_INT32, 1, 2) || at[0] != at[1];
    array_clear(&offsets);
    return own;
}

/* One array of a frame, under another name; with one dimension less where its first is the step alone. */
static bool put(Journal *journal, int step, Array *array, const char *name, int rank, Error *err)
{
    Array named = *array;
    named.name = name;
    if (named.rank > rank) memmove(named.dims, named.dims + 1, (size_t)rank * sizeof *named.dims);
    named.rank = rank;
    return journal_put(journal, "frame", step, &named, 1, err);
}

static bool recall_field(Journal *journal, Result *result, const char *field, int step, Error *err)
{
    char from[300], to[300];
    Array array;
    if (!has_own(result, field, step)) return true;
    snprintf(from, sizeof from, "CellData/%.200s", field);
    snprintf(to, sizeof to, "cell/%.200s", field);
    if (!result_read_step(result, from, step, &array, err)) return false;
    bool ok = put(journal, step, &array, to, array.rank, err);
    array_clear(&array);
    return ok;
}

/* Positions of a step, without the points that stand still: float64 where the result has them. */
static bool read_positions(Result *result, int step, Array *x, Error *err)
{
    Array still;
    if (!result_has(result, "slender/frames/x")) {
        if (!result_read_step(result, "Points", step, x, err)) return false;
        if (result_has(result, "slender/still") && result_read(result, "slender/still", &still, NULL)) {
            x->dims[0] -= still.dims[0];
            array_clear(&still);
        }
        return true;
    }
    return result_read_rows(result, "slender/frames/x", step, 1, x, err);
}

static bool recall_step(Journal *journal, Result *result, int step, Error *err)
{
    Array x, time, flux;
    if (!read_positions(result, step, &x, err)) return false;
    bool ok = put(journal, step, &x, "x", 2, err);
    array_clear(&x);
    if (!ok || !result_read_rows(result, "VTKHDF/Steps/Values", step, 1, &time, err)) return false;
    ok = put(journal, step, &time, "time", 0, err);
    array_clear(&time);
    if (!ok || !result_has(result, "slender/frames/flux_density")) return ok;
    if (!result_read_rows(result, "slender/frames/flux_density", step, 1, &flux, err)) return false;
    ok = put(journal, step, &flux, "flux_density", 2, err);
    array_clear(&flux);
    return ok;
}

bool recall_frames(Journal *journal, const char *path, Error *err)
{
    Result *result = result_open(path, err);
    if (!result) return false;
    char **paths = NULL;
    int count = 0, steps = result_step_count(result), cells = (int)strlen(CELLS);
    bool ok = journal_count(journal, "frame") >= steps || result_list(result, &paths, &count, err);
    for (int step = 0; ok && paths && step < steps; step++) {
        ok = recall_step(journal, result, step, err);
        for (int k = 0; ok && k < count; k++)
            if (!strncmp(paths[k], CELLS, (size_t)cells))
                ok = recall_field(journal, result, paths[k] + cells, step, err);
    }
    mem_free(paths);
    result_close(result);
    return ok;
}
