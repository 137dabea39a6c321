/* Results. */
#include "base/memory.h"
#include "io/result.h"
#include "lib/objects.h"
#include <string.h>

struct SlenderResult {
    Result *result;
    char **names;
    int count;
};

typedef struct Opening {
    const char *path;
    SlenderResult *made;
} Opening;

static SlenderStatus open_result(void *self, Error *err)
{
    Opening *opening = self;
    Result *result = result_open(opening->path, err);
    if (!result) return SLENDER_REFUSED;
    SlenderResult *made = mem_alloc(1, sizeof *made);
    made->result = result;
    if (result_list(result, &made->names, &made->count, err)) {
        opening->made = made;
        return SLENDER_DONE;
    }
    result_close(result);
    mem_free(made);
    return SLENDER_REFUSED;
}

SlenderResult *slender_result_open(const char *path, SlenderError *err)
{
    Opening opening = {.path = path};
    lib_call(open_result, &opening, err);
    return opening.made;
}

void slender_result_close(SlenderResult *result)
{
    if (!result) return;
    result_close(result->result);
    mem_free(result->names);
    mem_free(result);
}

const char *slender_result_name(const SlenderResult *result, int number)
{
    return number >= 0 && number < result->count ? result->names[number] : NULL;
}

int slender_result_frames(SlenderResult *result)
{
    return result_step_count(result->result);
}

typedef struct Reading {
    SlenderResult *result;
    const char *name;
    int frame;
    Array array;
} Reading;

static SlenderStatus read_array(void *self, Error *err)
{
    Reading *reading = self;
    Result *result = reading->result->result;
    if (reading->frame >= result_step_count(result))
        return lib_refuse(err, "there is no frame %d: the result has %d, from 0 on", reading->frame,
                          result_step_count(result));
    bool ok = reading->frame < 0
                  ? result_read(result, reading->name, &reading->array, err)
                  : result_read_step(result, reading->name, reading->frame, &reading->array, err);
    return ok ? SLENDER_DONE : SLENDER_REFUSED;
}

SlenderArray lib_array(const Array *from)
{
    SlenderArray array = {.type = from->type == ARRAY_FLOAT64 ? SLENDER_DOUBLE
                                  : from->type == ARRAY_INT32 ? SLENDER_INT
                                                              : SLENDER_TEXT,
                          .rank = from->rank,
                          .unit = from->unit,
                          .data = (void *)from->data,
                          .name = from->name};
    memcpy(array.dims, from->dims, sizeof array.dims);
    return array;
}

SlenderStatus slender_result_read(SlenderResult *result, const char *name, int frame, SlenderArray *array,
                                  SlenderError *err)
{
    Reading reading = {.result = result, .name = name, .frame = frame};
    SlenderStatus status = lib_call(read_array, &reading, err);
    *array = status == SLENDER_DONE ? lib_array(&reading.array) : (SlenderArray){0};
    return status;
}

void slender_array_free(SlenderArray *array)
{
    if (!array) return;
    Array owned = {.name = array->name, .unit = array->unit, .data = array->data};
    array_clear(&owned);
    *array = (SlenderArray){0};
}
