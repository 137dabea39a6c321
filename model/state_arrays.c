#include "model/state_arrays.h"
#include "base/memory.h"
#include <string.h>

/* ---- Writing ---- */

typedef struct Writing {
    const char *prefix;
    bool row;
    Arrays *list;
} Writing;

/* Those without numbers are left out. */
static void add(const Writing *w, const char *name, const char *unit, const double *values, int count)
{
    if (count == 0) return;
    char *path = arrays_keep(w->list, mem_format("%s/%s", w->prefix, name));
    arrays_add(w->list, w->row ? array_float(path, unit, values, 2, 1, count)
                               : array_float(path, unit, values, 1, count, 0));
}

void state_arrays_add(const Model *model, const Snapshot *shot, const char *prefix, bool row, Arrays *list)
{
    const State *at = &shot->at;
    Writing w = {prefix, row, list};
    double *time = arrays_numbers(list, 1);
    *time = at->time;
    arrays_add(list,
               array_float(arrays_keep(list, mem_format("%s/time", prefix)), "s", time, row ? 1 : 0, 1, 0));
    add(&w, "dofs", "", at->x, at->dofs);
    if (model->job->motion && at->v) add(&w, "velocities", "m/s", at->v, at->dofs);
    add(&w, "memory", "", at->memory, at->memory_count);
    if (shot->anchor) add(&w, "anchor", "", shot->anchor, system_anchor_count(shot->load_case->sys));
    for (int b = 0; b < model->params->block_count; b++) {
        const ParamBlock *block = &model->params->blocks[b];
        char *name = arrays_keep(list, mem_format("loads/%s", block->name));
        if (block->load) add(&w, name, block->unit, shot->p + block->offset, block->count * block->width);
    }
}

/* ---- Reading ---- */

bool state_arrays_find(const StatePlace *place, const char *name, Array *array, Error *err)
{
    char *path = mem_format("%s/%s", place->prefix, name);
    *array = (Array){0};
    bool ok = !result_has(place->result, path) ||
              (place->row < 0 ? result_read(place->result, path, array, err)
                              : result_read_rows(place->result, path, place->row, 1, array, err));
    if (ok && array->data && array->type != ARRAY_FLOAT64) {
        array_clear(array);
        ok = error_set(err, "%s is not as slender writes it", path);
    }
    mem_free(path);
    return ok;
}

bool state_arrays_get(const StatePlace *place, const char *name, size_t count, double *values, bool *has,
                      Error *err)
{
    Array array;
    if (!state_arrays_find(place, name, &array, err)) return false;
    *has = array.data && array_count(&array) == count;
    if (*has) memcpy(values, array.data, count * sizeof *values);
    array_clear(&array);
    return true;
}
