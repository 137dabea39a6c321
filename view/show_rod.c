#include "view/show_rod.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "view/curves_picture.h"
#include "view/show_framings.h"
#include "view/show_holds.h"
#include "view/show_motion.h"
#include "view/show_obstacles.h"
#include "view/show_probes.h"
#include "view/ticks.h"
#include <math.h>
#include <string.h>

enum { LINES_MAX = 4, LINE_LENGTH = 110, STRANDS_MANY = 20 };

static const Color input_ink = {0.62, 0.62, 0.64, 1};
static const MotionInk motion_ink = {{0.62, 0.62, 0.64, 1}, {0, 0.62, 0.451, 1}, 3};

/* A page of rods. */
typedef struct RodPage {
    ShowData *data;
    int strand_count, point_count;
    const int *strands; /* [strand_count + 1] first point of each */
    const double (*input)[3], (*natural)[3], (*x)[3];
    const char *input_name; /* "input", or the "target" of a design */
    CurvesSet *sets;        /* owned */
    int set_count;
    const char *lines[LINES_MAX];
    int line_count;
    Chart charts[CURVES_CHARTS_MAX];
    int chart_count;
    ShowObstacles obstacles;
    ShowMotion motion;
} RodPage;

bool show_has_rod(const ShowData *data)
{
    Result *result = data->result;
    return !result_has(result, "slender/faces") &&
           (result_has(result, "slender/rod/input") || result_has(result, "slender/rod/x"));
}

/* ---- Curves ---- */

/* Offsets that begin at 0 and grow. */
static bool offsets_fit(const Array *array)
{
    const int *offsets = array->data;
    bool fits = array->dims[0] >= 2 && offsets[0] == 0;
    for (int k = 1; fits && k < array->dims[0]; k++) fits = offsets[k] > offsets[k - 1];
    return fits;
}

/* One strand: all points of the curves. */
static bool read_one_strand(RodPage *page, Error *err)
{
    Result *result = page->data->result;
    Array array;
    const char *path = result_has(result, "slender/rod/x") ? "slender/rod/x" : "slender/rod/input";
    if (!result_read_as(result, path, ARRAY_FLOAT64, 2, 3, &array, err)) return false;
    int *offsets = show_block(page->data, 2, sizeof *offsets);
    offsets[1] = array.dims[0];
    page->strands = offsets, page->strand_count = 1;
    array_clear(&array);
    return true;
}

/* Of a design: where the first case should be. */
static void read_target(RodPage *page)
{
    Array names;
    if (!result_has(page->data->result, "slender/case_names") ||
        !result_read_as(page->data->result, "slender/case_names", ARRAY_TEXT, 1, 0, &names, NULL))
        return;
    const char *first = names.data;
    char *path = mem_format("slender/cases/%.*s/target", (int)strcspn(first, "\n"), first);
    double(*target)[3] = show_dataset(page->data, path, ARRAY_FLOAT64, 3 * (size_t)page->point_count);
    if (target && page->x) show_fill_places(target, page->x, page->point_count);
    page->input = (const double(*)[3])target;
    page->input_name = "target";
    mem_free(path);
    array_clear(&names);
}

static bool read_curves(RodPage *page, Error *err)
{
    static const char STRANDS[] = "slender/rod/strands";
    Array array;
    if (!result_has(page->data->result, STRANDS)) {
        if (!read_one_strand(page, err)) return false;
    } else {
        if (!result_read_as(page->data->result, STRANDS, ARRAY_INT32, 1, 0, &array, err)) return false;
        page->strands = show_keep(page->data, array);
        page->strand_count = array.dims[0] - 1;
        if (!offsets_fit(&array)) return error_set(err, "%s is not as slender writes it", STRANDS);
    }
    page->point_count = page->strands[page->strand_count];
    size_t numbers = 3 * (size_t)page->point_count;
    page->input = show_dataset(page->data, "slender/rod/input", ARRAY_FLOAT64, numbers);
    page->natural = show_dataset(page->data, "slender/rod/natural", ARRAY_FLOAT64, numbers);
    page->x = show_dataset(page->data, "slender/rod/x", ARRAY_FLOAT64, numbers);
    page->input_name = "input";
    if (!page->input) read_target(page);
    return page->input || page->x || error_set(err, "the result's curves are not as slender writes them");
}

static CurvesSet *add_set(RodPage *page, const char *name, const double (*points)[3], Color color)
{
    size_t count = (size_t)page->set_count++;
    page->sets = mem_resize(page->sets, count, count + 1, sizeof *page->sets);
    page->sets[count] = (CurvesSet){.name = name,
                                    .curve_count = page->strand_count,
                                    .offsets = page->strands,
                                    .points = points,
                                    .color = color,
                                    .width = 1.6};
    return &page->sets[count];
}

/* Over the input, so that both are seen. */
static CurvesSet *add_simulated(RodPage *page, const char *name, const double (*points)[3])
{
    CurvesSet *set = add_set(page, name, points, colormap_series(1));
    if (page->input) set->width = 1.2, set->dash = 3;
    return set;
}

/* What the last set meets and follows, in a frame; -1: in the last one. */
static void add_surroundings(RodPage *page, int frame)
{
    CurvesSet *set = &page->sets[page->set_count - 1];
    set->around = show_obstacles_at(&page->obstacles, frame);
    set->time = frame < 0 ? NAN : show_frame_time(page->data, frame);
    set->marks = show_motion_marks(&page->motion, set->time, motion_ink);
    set->holds = show_holds(page->data, frame);
}

/* The simulated points of a frame, which are the first ones. */
static bool read_frame(RodPage *page, int frame, const double (**points)[3], Error *err)
{
    Array array;
    if (!show_check_frame(page->data, frame, err) ||
        !result_read_step(page->data->result, "Points", frame, &array, err))
        return false;
    bool fits = array.dims[0] >= page->point_count;
    if (fits) {
        double(*x)[3] = show_block(page->data, (size_t)page->point_count, sizeof *x);
        *points = (const double(*)[3])memcpy(x, array.data, (size_t)page->point_count * sizeof *x);
    }
    array_clear(&array);
    return fits || error_set(err, "the result's frames have fewer points than its strands");
}

static bool add_frame(RodPage *page, int frame, Error *err)
{
    if (!read_frame(page, frame, &page->x, err)) return false;
    add_simulated(page, show_text(page->data, "simulated, %s", show_frame_name(page->data, frame)), page->x);
    add_surroundings(page, frame);
    return true;
}

/* Moments over each other, later ones darker. */
static bool add_stills(RodPage *page, int count, Error *err)
{
    page->x = NULL;
    for (int k = 0; k < count; k++) {
        int frame = show_frame(page->data, k);
        const double(*points)[3];
        if (!read_frame(page, frame, &points, err)) return false;
        CurvesSet *set = add_set(page, show_frame_name(page->data, frame), points, colormap_series(1));
        if (count > 1) set->color = curves_fade(set->color, (double)k / (count - 1));
        set->moment = true;
        add_surroundings(page, frame);
    }
    return true;
}

/* Moments one after the other. */
static bool add_motion(RodPage *page, int count, Error *err)
{
    for (int k = 0; k < count; k++) {
        if (!add_frame(page, show_frame(page->data, k), err)) return false;
        CurvesSet *set = &page->sets[page->set_count - 1];
        set->moment = true, set->dash = 0; /* dashes that crawl along a moving curve are no help */
    }
    return true;
}

/* The final state, or that of the last frame. */
static bool add_final(RodPage *page, Error *err)
{
    int frames = result_step_count(page->data->result);
    bool moves = result_has(page->data->result, "slender/history/time");
    if (!page->x && moves && frames > 0 && !read_frame(page, frames - 1, &page->x, err)) return false;
    if (!page->x) return true;
    add_simulated(page, "simulated", page->x);
    add_surroundings(page, -1);
    return true;
}

/* What was asked for: one frame, moments of a motion, or the final state. Many strands in moments over each
 * other would show nothing but their hull: they are shown so only when that is asked for. */
static bool add_curves(RodPage *page, Error *err)
{
    const ShowDef *def = page->data->def;
    bool moving = def->seconds > 0, asked = moving || def->stills > 0;
    int count = show_frame_count(page->data);
    if (!asked && page->strand_count > STRANDS_MANY) count = 0;
    bool stills = count > 0 && !moving && def->frame < 0;
    if (page->input) add_set(page, page->input_name, page->input, input_ink)->width = 3.4;
    if (page->natural && !stills) add_set(page, "natural", page->natural, colormap_series(0));
    if (def->frame >= 0) return add_frame(page, def->frame, err);
    if (count == 0) return asked ? show_check_frame(page->data, 0, err) : add_final(page, err);
    if (moving) return add_motion(page, count, err);
    if (!add_stills(page, count, err)) return false;
    if (page->natural) add_set(page, "natural", page->natural, colormap_series(0))->width = 1;
    return true;
}

/* The views have room for obstacles that are no larger than the curves and near them. */
static void frame_obstacles(RodPage *page)
{
    ShowWay way = show_way();
    for (int s = 0; s < page->set_count; s++) {
        const CurvesSet *set = &page->sets[s];
        show_way_add(&way, set->points, set->offsets[set->curve_count]);
    }
    for (int s = 0; s < page->set_count; s++)
        show_obstacles_find_near(&page->obstacles, way, &page->sets[s].around);
}

/* ---- Small print ---- */

/* Adds to the last line, or begins another one where that is full. */
static void add_text(RodPage *page, const char *text)
{
    if (page->line_count > 0) {
        const char *last = page->lines[page->line_count - 1];
        if (strlen(last) + strlen(text) < LINE_LENGTH) {
            page->lines[page->line_count - 1] = show_text(page->data, "%s, %s", last, text);
            return;
        }
    }
    if (page->line_count < LINES_MAX) page->lines[page->line_count++] = show_text(page->data, "%s", text);
}

/* Numbers at a path, as doubles: one, or one for each strand. NULL where there are none. */
static const double *numbers(RodPage *page, const char *path, int *count, const char **unit)
{
    Array array;
    if (!result_has(page->data->result, path) || !result_read(page->data->result, path, &array, NULL))
        return NULL;
    *count = array.type == ARRAY_TEXT ? 0 : (int)array_count(&array);
    *unit = show_text(page->data, "%s", array.unit ? array.unit : "");
    double *values = show_block(page->data, (size_t)*count, sizeof *values);
    for (int k = 0; k < *count; k++)
        values[k] =
            array.type == ARRAY_INT32 ? ((const int *)array.data)[k] : ((const double *)array.data)[k];
    array_clear(&array);
    return *count ? values : NULL;
}

/* "lowest eigenvalue 25.8 1/m²", of several strands the least or the greatest. */
static void add_number(RodPage *page, const char *path, const char *words, bool least)
{
    int count;
    const char *unit;
    char text[64];
    const double *values = numbers(page, path, &count, &unit);
    if (!values) return;
    double shown = values[0];
    for (int k = 1; k < count; k++) shown = least ? fmin(shown, values[k]) : fmax(shown, values[k]);
    if (!isfinite(shown)) return;
    unit_format(shown, unit, text, sizeof text);
    add_text(page, show_text(page->data, "%s %s", words, text));
}

static void add_stability(RodPage *page)
{
    int count, stable = 0;
    const char *unit;
    const double *values = numbers(page, "slender/rod/stable", &count, &unit);
    for (int k = 0; values && k < count; k++) stable += values[k] != 0;
    if (values && count > 1)
        add_text(page, show_text(page->data, "%d of %d stable", stable, count));
    else if (values)
        add_text(page, stable ? "stable" : "unstable");
    add_number(page, "slender/rod/lowest_eigenvalue", "lowest eigenvalue", true);
    add_number(page, "slender/rod/critical_young", "stable above a Young's modulus of", false);
    if (values && stable < count) add_number(page, "slender/rod/morse_index", "Morse index", false);
}

/* Each number below a group, named as it is: metrics/largest_distance is "largest distance". */
static void add_group(RodPage *page, const char *group)
{
    char **paths;
    int count;
    size_t length = strlen(group);
    if (!result_list(page->data->result, &paths, &count, NULL)) return;
    for (int k = 0; k < count; k++) {
        int values;
        const char *unit;
        if (strncmp(paths[k], group, length) || !numbers(page, paths[k], &values, &unit) || values > 1)
            continue;
        char *words = show_text(page->data, "%s", paths[k] + length);
        for (char *c = words; *c; c++)
            if (*c == '_' || *c == '/') *c = ' ';
        add_number(page, paths[k], words, true);
    }
    mem_free(paths);
}

static void add_lines(RodPage *page)
{
    Array status;
    if (result_read(page->data->result, "slender/status", &status, NULL)) {
        add_text(page, status.data);
        array_clear(&status);
    }
    if (page->strand_count > 1)
        add_text(page, show_text(page->data, "%d strands, %d points", page->strand_count, page->point_count));
    else
        add_text(page, show_text(page->data, "%d elements", page->point_count - 1));
    add_stability(page);
    add_group(page, "slender/rod/identified/");
    add_group(page, "slender/metrics/");
}

/* ---- Charts ---- */

/* A series over s, interrupted between the strands. values: every `stride`-th number. */
static ChartSeries make_series(RodPage *page, const char *name, const double *s, const double *values,
                               int stride)
{
    int count = page->point_count + page->strand_count, at = 0;
    double *x = show_block(page->data, (size_t)count, sizeof *x),
           *y = show_block(page->data, (size_t)count, sizeof *y);
    for (int k = 0; k < page->strand_count; k++) {
        for (int i = page->strands[k]; i < page->strands[k + 1]; i++)
            x[at] = s[i], y[at++] = values[i * stride];
        x[at] = s[page->strands[k]], y[at++] = NAN;
    }
    return (ChartSeries){.name = name, .count = count, .x = x, .y = y};
}

static void add_chart(RodPage *page, Chart chart)
{
    if (page->chart_count < CURVES_CHARTS_MAX) page->charts[page->chart_count++] = chart;
}

static void add_strains(RodPage *page, const double *s)
{
    static const char *const names[] = {"twist", "k1", "k2"};
    const double *strain =
        show_dataset(page->data, "slender/rod/natural_strain", ARRAY_FLOAT64, 3 * (size_t)page->point_count);
    if (!strain) return;
    page->chart_count = show_framings(page->data, page->strand_count, page->strands, s, strain, page->charts);
    if (page->chart_count) return;
    ChartSeries *series = show_block(page->data, 3, sizeof *series);
    for (int k = 0; k < 3; k++) series[k] = make_series(page, names[k], s, strain + k, 3);
    add_chart(page, (Chart){.x_label = "s",
                            .x_unit = "m",
                            .y_label = "natural strain",
                            .y_unit = "1/m",
                            .y_axis = CHART_LINEAR,
                            .series_count = 3,
                            .series = series,
                            .first_color = 2});
}

/* How far the simulated curve is from the input. */
static void add_distance(RodPage *page, const double *s)
{
    if (!page->input || !page->x) return;
    double *distance = show_block(page->data, (size_t)page->point_count, sizeof *distance);
    for (int i = 0; i < page->point_count; i++)
        distance[i] = vec3_length(vec3_sub(vec3_load(page->x[i]), vec3_load(page->input[i])));
    ChartSeries *series = show_block(page->data, 1, sizeof *series);
    *series = make_series(page, "simulated", s, distance, 1);
    add_chart(page, (Chart){.x_label = "s",
                            .x_unit = "m",
                            .y_label = "distance to input",
                            .y_unit = "m",
                            .y_axis = CHART_LINEAR,
                            .series_count = 1,
                            .series = series,
                            .first_color = 1});
}

/* The moments that are shown, in charts over time. */
static void mark_moments(RodPage *page, int first)
{
    double *times = show_block(page->data, (size_t)page->set_count, sizeof *times);
    int count = 0;
    for (int k = 0; k < page->set_count; k++)
        if (page->sets[k].moment) times[count++] = page->sets[k].time;
    for (int k = first; k < page->chart_count; k++)
        if (!strcmp(page->charts[k].x_unit, "s"))
            page->charts[k].marks = times, page->charts[k].mark_count = count;
}

static void add_over_time(RodPage *page)
{
    Chart charts[SHOW_MOTION_CHARTS];
    int first = page->chart_count;
    page->chart_count += show_probes_charts(page->data, page->charts + page->chart_count,
                                            CURVES_CHARTS_MAX - page->chart_count);
    int count = show_motion_charts(&page->motion, charts);
    for (int k = 0; k < count; k++) add_chart(page, charts[k]);
    mark_moments(page, first);
}

static void add_charts(RodPage *page)
{
    const double *s = show_dataset(page->data, "slender/rod/s", ARRAY_FLOAT64, (size_t)page->point_count);
    bool few = s && page->strand_count <= STRANDS_MANY;
    Chart history;
    if (few) add_strains(page, s);
    add_over_time(page);
    if (show_history(page->data, &history)) add_chart(page, history);
    if (few) add_distance(page, s);
}

/* ---- The page ---- */

/* There is one, if it was asked for. */
static bool check_target(const RodPage *page, Error *err)
{
    return page->data->def->target == PICTURE_TARGET_AUTO || page->input || page->motion.row_count > 0 ||
           error_set(err, "--target: there is none: no given curve, no place or curve of a motion");
}

static bool check_options(const ShowDef *def, Error *err)
{
    if (def->only) return error_set(err, "--case %s: rods have no load cases", def->only);
    if (def->field) return error_set(err, "--field %s: curves have no faces to colour", def->field);
    if (def->target == PICTURE_TARGET_BESIDE || def->target == PICTURE_TARGET_BOTH)
        return error_set(err, "--target: the input of a rod is always drawn under the simulated curve");
    return def->arrows || error_set(err, "--no-arrows: curves carry no arrows of magnetization");
}

static bool write_page(RodPage *page, const char *result, const char *picture, Error *err)
{
    const ShowDef *def = page->data->def;
    if (!check_options(def, err) || !read_curves(page, err) ||
        !show_motion_read(&page->motion, page->data, err) || !check_target(page, err) ||
        !show_obstacles_read(&page->obstacles, page->data, err) || !add_curves(page, err))
        return false;
    frame_obstacles(page);
    add_lines(page);
    CurvesScene scene = curves_default();
    const char *slash = strrchr(result, '/');
    scene.title = slash ? slash + 1 : result;
    scene.lines = page->lines, scene.line_count = page->line_count;
    scene.sets = page->sets, scene.set_count = page->set_count;
    show_clamps(page->data, page->strand_count, page->strands, &scene);
    const double *gravity = show_dataset(page->data, "slender/rod/gravity", ARRAY_FLOAT64, 3);
    if (gravity) memcpy(scene.gravity, gravity, sizeof scene.gravity);
    memcpy(scene.view, def->view, sizeof scene.view);
    scene.width = def->width;
    page->data->drawn = true;
    if (def->seconds > 0)
        add_over_time(page);
    else
        add_charts(page);
    scene.charts = page->charts, scene.chart_count = page->chart_count;
    if (def->seconds > 0)
        return curves_animate(picture, &scene, def->seconds / show_frame_count(page->data), err);
    return curves_write(picture, &scene, err);
}

bool show_rod(ShowData *data, const char *result, const char *picture, Error *err)
{
    RodPage page = {.data = data};
    bool ok = write_page(&page, result, picture, err);
    mem_free(page.sets);
    return ok;
}
