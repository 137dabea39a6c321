#include "job/recall.h"
#include "base/memory.h"
#include "io/result.h"
#include <string.h>

static const char FRAMES[] = "slender/frames/", PROBES[] = "slender/probes/";

/* Where a result has numbers per cell and per point, and as what the journal has them. */
static const struct {
    const char *data, *prefix;
    bool cells;
} kinds[] = {{"CellData", "cell", true}, {"PointData", "point", false}};

/* Is this step's array its own, or that of the step before? Fields that never change are stored once. */
static bool has_own(Result *result, int kind, const char *field, int step, bool *own, Error *err)
{
    Array offsets;
    *own = true;
    if (step == 0) return true;
    char *path = mem_format("VTKHDF/Steps/%sOffsets/%s", kinds[kind].data, field);
    bool ok = result_read_rows(result, path, step - 1, 2, &offsets, err);
    mem_free(path);
    if (!ok) return false;
    const int *at = offsets.data;
    *own = !array_is(&offsets, ARRAY_INT32, 1, 2) || at[0] != at[1];
    array_clear(&offsets);
    return true;
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

/* Leaves out the points that stand still, which come last; clears the array where that fails. */
static bool drop_still(Result *result, Array *points, Error *err)
{
    Array still;
    if (!result_has(result, "slender/still")) return true;
    if (!result_read(result, "slender/still", &still, err)) {
        array_clear(points);
        return false;
    }
    points->dims[0] -= still.dims[0];
    array_clear(&still);
    return true;
}

static bool recall_field(Journal *journal, Result *result, int kind, const char *field, int step, Error *err)
{
    Array array;
    bool own;
    if (!has_own(result, kind, field, step, &own, err)) return false;
    if (!own) return true;
    char *from = mem_format("%s/%s", kinds[kind].data, field),
         *to = mem_format("%s/%s", kinds[kind].prefix, field);
    bool ok = result_read_step(result, from, step, &array, err) &&
              (kinds[kind].cells || drop_still(result, &array, err));
    if (ok) {
        ok = put(journal, step, &array, to, array.rank, err);
        array_clear(&array);
    }
    mem_free(from);
    mem_free(to);
    return ok;
}

/* Positions of a step: float64 where the result has them. */
static bool read_positions(Result *result, int step, Array *x, Error *err)
{
    if (!result_has(result, "slender/frames/x"))
        return result_read_step(result, "Points", step, x, err) && drop_still(result, x, err);
    return result_read_rows(result, "slender/frames/x", step, 1, x, err);
}

static bool recall_step(Journal *journal, Result *result, int step, Error *err)
{
    Array x, time;
    if (!read_positions(result, step, &x, err)) return false;
    bool ok = put(journal, step, &x, "x", 2, err);
    array_clear(&x);
    if (!ok || !result_read_rows(result, "VTKHDF/Steps/Values", step, 1, &time, err)) return false;
    ok = put(journal, step, &time, "time", 0, err);
    array_clear(&time);
    return ok;
}

/* Of whole states: frames/NAME is state/NAME of the frame; and what is around. */
static bool recall_state(Journal *journal, Result *result, const char *name, int step, Error *err)
{
    Array array;
    bool around = result_is_around(name);
    if (!strcmp(name, "x")) return true;
    char *from = mem_format("%s%s", FRAMES, name), *to = mem_format("%s%s", around ? "" : "state/", name);
    bool ok = result_read_rows(result, from, step, 1, &array, err);
    if (ok) {
        ok = put(journal, step, &array, to, around ? 2 : array.rank, err);
        array_clear(&array);
    }
    mem_free(from);
    mem_free(to);
    return ok;
}

/* A row of probes/NAME. */
static bool recall_probe(Journal *journal, Result *result, const char *path, int step, Error *err)
{
    Array array;
    if (!result_read_rows(result, path, step, 1, &array, err)) return false;
    bool ok = put(journal, step, &array, path + strlen("slender/"), array.rank, err);
    array_clear(&array);
    return ok;
}

/* What a step has at a path of the result, if that is of the frames. */
static bool recall_path(Journal *journal, Result *result, const char *path, int step, Error *err)
{
    if (!strncmp(path, PROBES, sizeof PROBES - 1)) return recall_probe(journal, result, path, step, err);
    if (!strncmp(path, FRAMES, sizeof FRAMES - 1))
        return recall_state(journal, result, path + sizeof FRAMES - 1, step, err);
    for (int kind = 0; kind < 2; kind++) {
        char *folder = mem_format("VTKHDF/%s/", kinds[kind].data);
        size_t length = strlen(folder);
        bool is = !strncmp(path, folder, length);
        mem_free(folder);
        if (is) return recall_field(journal, result, kind, path + length, step, err);
    }
    return true;
}

bool recall_keep(Journal *journal, uint32_t sum, Error *err)
{
    double number = sum;
    Array array = array_float("crc32", "", &number, 0, 0, 0);
    return journal_put(journal, "result", 0, &array, 1, err);
}

/* Older journals do not know the sum; the scene is then what both have. */
static bool has_same_scene(Journal *journal, Result *result, bool *same, Error *err)
{
    Array here, there;
    if (!journal_get(journal, "meta", 0, "scene", &here, err)) return false;
    bool ok = result_read(result, "slender/scene", &there, err);
    *same = ok && !strcmp(here.data, there.data);
    array_clear(&here);
    if (ok) array_clear(&there);
    return ok;
}

static bool check_result(Journal *journal, Result *result, const char *path, Error *err)
{
    Array sum;
    bool same;
    if (!journal_find(journal, "result", 0, "crc32", &sum, err)) return false;
    if (!sum.data && !has_same_scene(journal, result, &same, err)) return false;
    if (sum.data) same = *(const double *)sum.data == result_sum(result);
    array_clear(&sum);
    return same ||
           error_set(err,
                     "%s is not the result that this run has written, and to which its frames went: put "
                     "that back, or start anew with --force",
                     path);
}

static bool check_precision(Result *result, const char *path, bool exact, Error *err)
{
    return !exact || result_has(result, "slender/frames/x") ||
           error_set(err,
                     "%s has the frames of this run in single precision; to extend it, output.precision must "
                     "stay so",
                     path);
}

bool recall_frames(Journal *journal, const char *path, bool exact, Error *err)
{
    Result *result = result_open(path, err);
    if (!result) return false;
    char **paths = NULL;
    int count = 0, steps = result_step_count(result), kept;
    bool ok = check_result(journal, result, path, err) && journal_count(journal, "frame", &kept, err) &&
              (kept >= steps ||
               (check_precision(result, path, exact, err) && result_list(result, &paths, &count, err)));
    for (int step = 0; ok && paths && step < steps; step++) {
        ok = recall_step(journal, result, step, err);
        for (int k = 0; ok && k < count; k++) ok = recall_path(journal, result, paths[k], step, err);
    }
    mem_free(paths);
    result_close(result);
    return ok;
}
