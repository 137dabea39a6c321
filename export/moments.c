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

const double (*moments_points(ShowData *data, int frame, const char *final, int count, Error *err))[3]
{
    Array points;
    bool ok = frame >= 0 ? result_read_step(data->result, "Points", frame, &points, err)
                         : result_read_as(data->result, final, ARRAY_FLOAT64, 2, 3, &points, err);
    if (!ok) return NULL;
    const double(*x)[3] = show_keep(data, points);
    if (points.dims[0] < count) return error_set(err, "there are fewer points in it than the body has"), NULL;
    return export_check_points(x, count, err) ? x : NULL;
}
