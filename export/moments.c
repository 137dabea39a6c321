#include "export/moments.h"
#include "export/mesh.h"
#include <math.h>

bool moments_choose(ShowData *data, const ExportDef *def, Moments *moments, Error *err)
{
    int all = result_step_count(data->result), count = def->frame >= 0 ? 1 : all;
    if (!result_check_state(data->result, err)) return false;
    if (def->frame >= 0 && !show_check_frame(data, def->frame, err)) return false;
    if (count > def->frames) count = def->frames;
    bool final = count == 0;
    if (final) count = 1;
    int *frames = show_block(data, (size_t)count, sizeof *frames);
    float *times = show_block(data, (size_t)count, sizeof *times);
    for (int k = 0; k < count; k++) {
        frames[k] = final ? -1 : def->frame >= 0 ? def->frame : show_moment(all, count, k);
        double since = show_frame_time(data, frames[k]) - show_frame_time(data, frames[0]);
        times[k] = isfinite(since) ? (float)since : (float)(frames[k] - frames[0]);
    }
    if (count == 1 && all > 1 && def->frame < 0) frames[0] = all - 1; /* --frames 1: the end */
    *moments = (Moments){count, frames, times};
    return true;
}

static const double (*read_points(ShowData *data, int frame, const char *final, int count, Error *err))[3]
{
    Array points;
    bool ok = frame >= 0 ? result_read_step(data->result, "Points", frame, &points, err)
                         : result_read_as(data->result, final, ARRAY_FLOAT64, 2, 3, &points, err);
    if (!ok) return NULL;
    const double(*x)[3] = show_keep(data, points);
    if (points.dims[0] < count) return error_set(err, "there are fewer points in it than the body has"), NULL;
    return export_check_points(x, count, err) ? x : NULL;
}

const double (**moments_points(ShowData *data, const Moments *moments, const char *final, int count,
                               Error *err))[3]
{
    const double(**x)[3] = show_block(data, (size_t)moments->count, sizeof *x);
    for (int k = 0; k < moments->count; k++)
        if (!(x[k] = read_points(data, moments->frames[k], final, count, err))) return NULL;
    return x;
}

Vec3 moments_middle(const Moments *moments, const double (*const *x)[3], int count)
{
    const double FAR = 100; /* of its size: single numbers are 1e-5 of it apart there */
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int k = 0; k < moments->count; k++)
        for (int i = 0; i < 3 * count; i++) {
            low[i % 3] = fmin(low[i % 3], x[k][i / 3][i % 3]);
            high[i % 3] = fmax(high[i % 3], x[k][i / 3][i % 3]);
        }
    Vec3 size = vec3_sub(vec3_load(high), vec3_load(low)),
         middle = vec3_scale(0.5, vec3_axpy(1, vec3_load(low), vec3_load(high)));
    return vec3_length(middle) > FAR * vec3_length(size) ? middle : vec3(0, 0, 0);
}
