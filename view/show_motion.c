#include "view/show_motion.h"
#include "base/vec3.h"
#include <math.h>
#include <string.h>

static const char REFERENCE[] = "slender/trajectory/reference", FOLLOWED[] = "slender/trajectory/followed";

static const double WAY = 0.9, PLACE = 2.6, POINT = 1.7; /* width and radii, pt */

/* ---- Reading ---- */

static const char *row_name(const ShowMotion *motion, int row)
{
    const char *name = motion->names;
    for (int k = 0; name && k < row; k++) name = strchr(name, '\n') ? strchr(name, '\n') + 1 : NULL;
    return name ? name : "";
}

/* A place is one point. */
static bool is_place(const ShowMotion *motion, int row)
{
    return motion->offsets[row + 1] - motion->offsets[row] == 1;
}

/* Do the rows name points and frames that there are? */
static bool rows_fit(const ShowMotion *motion, int points)
{
    bool fit = motion->offsets[0] == 0 && motion->offsets[motion->row_count] == points;
    for (int k = 0; fit && k < motion->row_count; k++) {
        const int *frames = motion->frames[k];
        fit = motion->offsets[k + 1] > motion->offsets[k] && motion->follows[k] >= 0 &&
              motion->follows[k] < motion->followed_count && frames[0] >= 0 && frames[0] <= frames[1] &&
              frames[1] <= motion->steps && row_name(motion, k)[0];
    }
    return fit;
}

static bool read_rows(ShowMotion *motion, Error *err)
{
    ShowData *data = motion->data;
    Array followed, points, names;
    if (!result_has(data->result, FOLLOWED)) return true;
    if (!result_read_as(data->result, FOLLOWED, ARRAY_FLOAT64, 3, 3, &followed, err)) return false;
    motion->followed = show_keep(data, followed);
    if (!result_read_as(data->result, show_text(data, "%s/points", REFERENCE), ARRAY_FLOAT64, 2, 3, &points,
                        err))
        return false;
    motion->points = show_keep(data, points);
    if (!result_read_as(data->result, show_text(data, "%s/names", REFERENCE), ARRAY_TEXT, 1, 0, &names, err))
        return false;
    motion->names = show_keep(data, names);
    int rows = 0;
    for (const char *c = motion->names; *c; c++) rows += *c == '\n';
    size_t count = (size_t)rows, frames = (size_t)followed.dims[1];
    motion->followed_count = followed.dims[0], motion->steps = followed.dims[1] - 1;
    motion->frames = show_dataset(data, show_text(data, "%s/frames", REFERENCE), ARRAY_INT32, 2 * count);
    motion->follows = show_dataset(data, show_text(data, "%s/follows", REFERENCE), ARRAY_INT32, count);
    motion->offsets = show_dataset(data, show_text(data, "%s/offsets", REFERENCE), ARRAY_INT32, count + 1);
    motion->distance =
        show_dataset(data, show_text(data, "%s/distance", REFERENCE), ARRAY_FLOAT64, count * frames);
    motion->row_count = rows;
    bool whole = motion->frames && motion->follows && motion->offsets && motion->distance && frames > 0;
    return (whole && rows_fit(motion, points.dims[0])) ||
           error_set(err, "%s is not as slender writes it", REFERENCE);
}

static bool varies(const double *rows, int count)
{
    for (int k = 3; k < 3 * count; k++)
        if (rows[k] != rows[k - 3]) return true;
    return false;
}

/* What acts in each step of a trajectory, or at each frame of a simulation. */
static void read_field(ShowMotion *motion, const double *frame_times, int frames)
{
    static const char STEPS[] = "slender/trajectory/flux_density", FRAMES[] = "slender/frames/flux_density";
    ShowData *data = motion->data;
    bool designed = result_has(data->result, STEPS);
    const char *path = designed ? STEPS : FRAMES;
    Array array;
    if (!result_has(data->result, path) ||
        !result_read_as(data->result, path, ARRAY_FLOAT64, 2, 3, &array, NULL))
        return;
    int count = array.dims[0];
    motion->field = show_keep(data, array);
    if (!varies(motion->field, count) || (!designed && count != frames)) return;
    double *times = show_block(data, (size_t)count, sizeof *times);
    for (int k = 0; k < count; k++)
        times[k] =
            designed ? motion->begin + (motion->end - motion->begin) * (k + 1) / count : frame_times[k];
    motion->field_count = count, motion->times = times;
}

bool show_motion_read(ShowMotion *motion, ShowData *data, Error *err)
{
    *motion = (ShowMotion){.data = data};
    int frames = result_step_count(data->result);
    if (!data->motion || frames == 0) return true;
    const double *times = show_dataset(data, "VTKHDF/Steps/Values", ARRAY_FLOAT64, (size_t)frames);
    if (!times) return error_set(err, "the times of the result's frames are not as slender writes them");
    motion->begin = times[0], motion->end = times[frames - 1];
    read_field(motion, times, frames);
    return read_rows(motion, err);
}

/* ---- Marks ---- */

static int step_at(const ShowMotion *motion, double time)
{
    double part = (time - motion->begin) / (motion->end - motion->begin);
    return isfinite(part) ? (int)lround(fmin(fmax(part, 0), 1) * motion->steps) : motion->steps;
}

/* Places whose last frame is the next one to come. */
static int next_last(const ShowMotion *motion, int step)
{
    int next = motion->steps;
    for (int k = 0; k < motion->row_count; k++)
        if (is_place(motion, k) && motion->frames[k][1] >= step && motion->frames[k][1] < next)
            next = motion->frames[k][1];
    return next;
}

/* Is it the first row of its kind? */
static bool is_first(const ShowMotion *motion, int row, bool place)
{
    for (int k = 0; k < row; k++)
        if (is_place(motion, k) == place) return false;
    return true;
}

/* Curves below ways, a way for each point. */
static void add_lines(const ShowMotion *motion, int step, MotionInk ink, Marks *marks)
{
    int rows = motion->row_count, frames = motion->steps + 1;
    MarkLine *lines = show_block(motion->data, (size_t)(rows + motion->followed_count), sizeof *lines);
    for (int k = 0; k < rows; k++)
        if (!is_place(motion, k))
            lines[marks->line_count++] = (MarkLine){
                is_first(motion, k, false) ? "reference" : NULL, motion->offsets[k + 1] - motion->offsets[k],
                motion->points + motion->offsets[k], ink.reference, ink.width};
    for (int k = 0; k < motion->followed_count; k++)
        lines[marks->line_count++] =
            (MarkLine){k ? NULL : "path", step + 1, motion->followed + k * frames, ink.path, WAY};
    marks->lines = lines;
}

/* Places, and where the points are. */
static void add_dots(const ShowMotion *motion, int step, MotionInk ink, Marks *marks)
{
    int rows = motion->row_count, frames = motion->steps + 1, turn = next_last(motion, step);
    MarkDot *dots = show_block(motion->data, (size_t)(rows + motion->followed_count), sizeof *dots);
    for (int k = 0; k < rows; k++)
        if (is_place(motion, k))
            dots[marks->dot_count++] =
                (MarkDot){is_first(motion, k, true) ? "place" : NULL, motion->points[motion->offsets[k]],
                          ink.reference, PLACE, motion->frames[k][1] != turn};
    for (int k = 0; k < motion->followed_count; k++)
        dots[marks->dot_count++] =
            (MarkDot){NULL, motion->followed[k * frames + step], ink.path, POINT, false};
    marks->dots = dots;
}

Marks show_motion_marks(const ShowMotion *motion, double time, MotionInk ink)
{
    Marks marks = {0};
    if (motion->row_count == 0) return marks;
    int step = step_at(motion, time);
    add_lines(motion, step, ink, &marks);
    add_dots(motion, step, ink, &marks);
    return marks;
}

/* ---- Charts ---- */

/* Frames of a row, with a gap behind them. */
static void add_piece(const ShowMotion *motion, ChartSeries *series, int row, int first, int last)
{
    double *t = (double *)series->x, *distance = (double *)series->y;
    for (int n = first; n <= last + 1; n++) {
        t[series->count] = motion->begin + (motion->end - motion->begin) * n / fmax(motion->steps, 1);
        distance[series->count++] = n > last ? NAN : motion->distance[row * (motion->steps + 1) + n];
    }
}

/* When the point of a place has left the one before. */
static int turn_begins(const ShowMotion *motion, int row)
{
    int begins = 0;
    for (int k = 0; k < motion->row_count; k++) {
        int last = motion->frames[k][1];
        if (is_place(motion, k) && motion->follows[k] == motion->follows[row] &&
            last < motion->frames[row][1] && last > begins)
            begins = last;
    }
    return begins;
}

/* To curves and to places at the frames at which they count, and on the way to places. */
static Chart distance_chart(const ShowMotion *motion)
{
    enum { TO_CURVE, TO_PLACE, APPROACH, KINDS };
    static const char *const names[KINDS] = {"curve", "place", "approach"};
    size_t room = (size_t)motion->row_count * ((size_t)motion->steps + 2);
    ChartSeries *series = show_block(motion->data, KINDS, sizeof *series);
    for (int s = 0; s < KINDS; s++)
        series[s] = (ChartSeries){.name = names[s],
                                  .x = show_block(motion->data, room, sizeof(double)),
                                  .y = show_block(motion->data, room, sizeof(double))};
    for (int k = 0; k < motion->row_count; k++) {
        const int *frames = motion->frames[k];
        bool place = is_place(motion, k);
        add_piece(motion, &series[place ? TO_PLACE : TO_CURVE], k, frames[0], frames[1]);
        int begins = place ? turn_begins(motion, k) : frames[0];
        if (begins < frames[0]) add_piece(motion, &series[APPROACH], k, begins, frames[0]);
    }
    int count = 0;
    for (int s = 0; s < KINDS; s++)
        if (series[s].count) series[count++] = series[s];
    return (Chart){.x_label = "t",
                   .x_unit = "s",
                   .x_low = motion->begin,
                   .x_high = motion->end,
                   .y_label = "distance",
                   .y_unit = "m",
                   .series_count = count,
                   .series = series};
}

static Chart field_chart(const ShowMotion *motion)
{
    static const char *const names[] = {"Bx", "By", "Bz"};
    int count = motion->field_count;
    double *B = show_block(motion->data, 3 * (size_t)count, sizeof *B);
    ChartSeries *series = show_block(motion->data, 3, sizeof *series);
    for (int k = 0; k < 3 * count; k++) B[k % 3 * count + k / 3] = motion->field[k];
    for (int i = 0; i < 3; i++)
        series[i] = (ChartSeries){.name = names[i], .count = count, .x = motion->times, .y = B + i * count};
    return (Chart){.x_label = "t",
                   .x_unit = "s",
                   .x_low = motion->begin,
                   .x_high = motion->end,
                   .y_label = "flux density",
                   .y_unit = "T",
                   .y_axis = CHART_LINEAR,
                   .series_count = 3,
                   .series = series,
                   .first_color = 3};
}

/* The line of that number of a text; "" where there is none. */
static const char *line_of(ShowData *data, const char *path, int number)
{
    Array text;
    if (!result_has(data->result, path) || !result_read_as(data->result, path, ARRAY_TEXT, 1, 0, &text, NULL))
        return "";
    const char *line = show_keep(data, text);
    for (int k = 0; k < number && *line; k++) line += strcspn(line, "\n") + (strchr(line, '\n') != NULL);
    return show_text(data, "%.*s", (int)strcspn(line, "\n"), line);
}

/* Of sources whose strengths are unknown over time: those that change, some of them where they are many. */
static bool strength_chart(const ShowMotion *motion, Chart *chart)
{
    enum { SOURCES = 4 };
    static const char PATH[] = "slender/trajectory/source_strength",
                      NAMES[] = "slender/trajectory/source_names";
    ShowData *data = motion->data;
    Array array;
    if (!result_has(data->result, PATH) ||
        !result_read_as(data->result, PATH, ARRAY_FLOAT64, 2, 0, &array, NULL))
        return false;
    int steps = array.dims[0], width = array.dims[1], shown = 0;
    const double *rows = show_keep(data, array);
    double *times = show_block(data, (size_t)steps, sizeof *times);
    ChartSeries *series = show_block(data, SOURCES, sizeof *series);
    for (int n = 0; n < steps; n++)
        times[n] = motion->begin + (motion->end - motion->begin) * (n + 1) / steps;
    for (int s = 0; s < width && shown < SOURCES; s++) {
        double *y = show_block(data, (size_t)steps, sizeof *y), change = 0;
        for (int n = 0; n < steps; n++) y[n] = rows[n * width + s], change = fmax(change, fabs(y[n] - y[0]));
        if (change > 0)
            series[shown++] =
                (ChartSeries){.name = line_of(data, NAMES, s), .count = steps, .x = times, .y = y};
    }
    *chart = (Chart){.x_label = "t",
                     .x_unit = "s",
                     .x_low = motion->begin,
                     .x_high = motion->end,
                     .y_label = "strength of sources",
                     .y_unit = "",
                     .y_axis = CHART_LINEAR,
                     .series_count = shown,
                     .series = series};
    return shown > 0;
}

int show_motion_charts(const ShowMotion *motion, Chart charts[SHOW_MOTION_CHARTS])
{
    int count = 0;
    if (motion->row_count > 0) charts[count++] = distance_chart(motion);
    if (motion->field_count > 0) charts[count++] = field_chart(motion);
    return count + strength_chart(motion, &charts[count]);
}
