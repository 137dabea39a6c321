#include "view/show_data.h"
#include "base/memory.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { STILLS = 6, FRAMES_PER_SECOND = 25 };

void show_data_borrow(ShowData *data, Result *result, const ShowDef *def)
{
    *data = (ShowData){.def = def, .result = result, .borrowed = true};
    data->motion =
        result_has(result, "slender/history/time") || result_has(result, "slender/trajectory/flux_density");
}

bool show_data_open(ShowData *data, const char *result, const ShowDef *def, Error *err)
{
    Result *own = result_open(result, err);
    *data = (ShowData){.def = def};
    if (own) show_data_borrow(data, own, def);
    data->borrowed = false;
    return own != NULL;
}

void show_data_clear(ShowData *data)
{
    for (int k = 0; k < data->array_count; k++) array_clear(&data->arrays[k]);
    for (int k = 0; k < data->block_count; k++) mem_free(data->blocks[k]);
    mem_free(data->arrays);
    mem_free(data->blocks);
    if (!data->borrowed) result_close(data->result);
}

/* Takes a block over. */
static void *own(ShowData *data, void *block)
{
    size_t count = (size_t)data->block_count++;
    data->blocks = mem_resize(data->blocks, count, count + 1, sizeof *data->blocks);
    return data->blocks[count] = block;
}

void *show_block(ShowData *data, size_t count, size_t size)
{
    return own(data, mem_alloc(count, size));
}

void *show_keep(ShowData *data, Array array)
{
    size_t count = (size_t)data->array_count++;
    data->arrays = mem_resize(data->arrays, count, count + 1, sizeof *data->arrays);
    data->arrays[count] = array;
    return (void *)array.data;
}

void *show_dataset(ShowData *data, const char *path, ArrayType type, size_t count)
{
    Array array;
    if (!result_has(data->result, path) || !result_read(data->result, path, &array, NULL)) return NULL;
    if (array.type == type && array_count(&array) == count) return show_keep(data, array);
    array_clear(&array);
    return NULL;
}

void show_fill_places(double (*places)[3], const double (*x)[3], int count)
{
    for (int v = 0; v < count; v++) {
        double *place = places[v];
        if (isnan(place[0]) && isnan(place[1]) && isnan(place[2])) continue;
        for (int i = 0; i < 3; i++)
            if (isnan(place[i])) place[i] = x[v][i];
    }
}

char *show_text(ShowData *data, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return own(data, mem_text(text));
}

int show_moment_count(int frames, double seconds)
{
    return (int)fmin(frames, ceil(seconds * FRAMES_PER_SECOND));
}

int show_moment(int frames, int count, int k)
{
    return count > 1 ? (int)lround((double)k * (frames - 1) / (count - 1)) : 0;
}

int show_frame_count(const ShowData *data)
{
    const ShowDef *def = data->def;
    int frames = result_step_count(data->result);
    if (def->seconds > 0) return show_moment_count(frames, def->seconds);
    int most = def->stills ? def->stills : data->motion && !def->only ? STILLS : 0;
    return frames < most ? frames : most;
}

int show_frame(const ShowData *data, int k)
{
    return show_moment(result_step_count(data->result), show_frame_count(data), k);
}

bool show_check_frame(const ShowData *data, int frame, Error *err)
{
    int frames = result_step_count(data->result);
    if (frames == 0) return error_set(err, "the result has no frames");
    return frame < frames || error_set(err, "the result has %d frames, from 0", frames);
}

double show_frame_time(const ShowData *data, int frame)
{
    Array times;
    if (!data->motion || !result_read_rows(data->result, "VTKHDF/Steps/Values", frame, 1, &times, NULL))
        return NAN;
    double time = array_is(&times, ARRAY_FLOAT64, 1, 1) ? *(const double *)times.data : NAN;
    array_clear(&times);
    return time;
}

char *show_frame_name(ShowData *data, int frame)
{
    double time = show_frame_time(data, frame);
    return data->motion ? show_text(data, "t = %.4g s", time) : show_text(data, "frame %d", frame);
}

bool show_history(ShowData *data, Chart *chart)
{
    Array history;
    if (!data->def->history || !result_has(data->result, "slender/history/objective") ||
        !result_read_as(data->result, "slender/history/objective", ARRAY_FLOAT64, 1, 0, &history, NULL))
        return false;
    ChartSeries *series = show_block(data, 1, sizeof *series);
    *series = (ChartSeries){
        .name = "objective", .count = (int)array_count(&history), .y = show_keep(data, history)};
    *chart = (Chart){.x_label = "evaluation",
                     .x_unit = "",
                     .x_counts = true,
                     .y_label = "objective",
                     .y_unit = "",
                     .series_count = 1,
                     .series = series};
    return true;
}
