#include "view/show_rod.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "view/curves_picture.h"
#include "view/show_cases.h"
#include "view/show_framings.h"
#include "view/show_holds.h"
#include "view/show_motion.h"
#include "view/show_obstacles.h"
#include "view/show_probes.h"
#include "view/show_rod_lines.h"
#include "view/ticks.h"
#include <math.h>
#include <string.h>

enum { STRANDS_MANY = 20 };

static const Color input_ink = {0.62, 0.62, 0.64, 1};
static const MotionInk motion_ink = {{0.62, 0.62, 0.64, 1}, {0, 0.62, 0.451, 1}, 3};

static const double PLACE_DOT = 3; /* its radius, points */

/* One of the states of rest that are shown: of a load case, or the only one. */
typedef struct RodState {
    const char *name; /* NULL: the only one */
    const double (*x)[3], (*target)[3];
    bool line; /* its target has some */
} RodState;

/* A page of rods. */
typedef struct RodPage {
    ShowData *data;
    int strand_count, point_count;
    const int *strands; /* [strand_count + 1] first point of each */
    const double (*input)[3], (*natural)[3], (*x)[3];
    RodState *states;
    int state_count;
    Marks given;     /* of them: what of their targets is no line */
    CurvesSet *sets; /* owned */
    int set_count;
    RodLines lines;
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

static bool has_place(const double (*place)[3], int point, int count)
{
    return point >= 0 && point < count && !isnan(place[point][0]);
}

/* Each name once in the legend. */
static void add_dots(RodPage *page, const MarkDot *more, int count)
{
    Marks *given = &page->given;
    MarkDot *dots = show_block(page->data, (size_t)(given->dot_count + count), sizeof *dots);
    for (int k = 0; k < given->dot_count; k++) dots[k] = given->dots[k];
    for (int k = 0; k < count; k++) {
        dots[given->dot_count + k] = more[k];
        for (int n = 0; more[k].name && n < given->dot_count + k; n++)
            if (dots[n].name && !strcmp(dots[n].name, more[k].name)) dots[given->dot_count + k].name = NULL;
    }
    given->dots = dots, given->dot_count += count;
}

/* Of a target, what is no line of it: points whose neighbours have no place; and of a case its clouds. */
static void add_given(RodPage *page, const char *name, RodState *state)
{
    const MarkDot *cloud;
    int count = page->point_count, alone = 0,
        dots = show_case_cloud(page->data, name, state->x, count, input_ink, &cloud);
    if (dots) add_dots(page, cloud, dots);
    if (!state->target) return;
    MarkDot *places = show_block(page->data, (size_t)count, sizeof *places);
    for (int i = 0; i < count; i++) {
        if (!has_place(state->target, i, count)) continue;
        bool joined = has_place(state->target, i - 1, count) || has_place(state->target, i + 1, count);
        state->line |= joined;
        if (!joined) places[alone++] = (MarkDot){"target", state->target[i], input_ink, PLACE_DOT, false};
    }
    add_dots(page, places, alone);
}

/* Of a result without cases the state that it has. */
static bool read_states(RodPage *page, Error *err)
{
    ShowCases cases;
    size_t numbers = 3 * (size_t)page->point_count;
    if (!show_cases(page->data, &cases, err)) return false;
    page->states = show_block(page->data, (size_t)cases.count + 1, sizeof *page->states);
    for (int k = 0; k < cases.count; k++) {
        RodState *state = &page->states[page->state_count];
        state->name = cases.count > 1 ? cases.names[k] : NULL;
        state->x = show_case_dataset(page->data, cases.names[k], "x", numbers);
        if (!state->x) continue;
        page->state_count++;
        if (page->input) continue;
        state->target = show_case_target(page->data, cases.names[k], state->x, page->point_count);
        add_given(page, cases.names[k], state);
    }
    if (page->state_count) return true;
    page->states[0].x = show_dataset(page->data, "slender/rod/x", ARRAY_FLOAT64, numbers);
    page->state_count = page->states[0].x != NULL;
    return true;
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
    if (!read_states(page, err)) return false;
    page->x = page->states[0].x;
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

/* "target", of one of several cases "target, NAME". */
static const char *state_words(RodPage *page, const char *word, const RodState *state)
{
    return state->name ? show_text(page->data, "%s, %s", word, state->name) : word;
}

static void add_target(RodPage *page, const RodState *state)
{
    if (state->target)
        add_set(page, state_words(page, "target", state), state->target, input_ink)->width = 3.4;
}

/* Over the input, so that both are seen. */
static CurvesSet *add_simulated(RodPage *page, const char *name, const double (*points)[3])
{
    CurvesSet *set = add_set(page, name, points, colormap_series(1));
    if (page->input || page->states[0].target) set->width = 1.2, set->dash = 3;
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
    if (!set->marks.line_count && !set->marks.dot_count) set->marks = page->given;
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
    if (!page->state_count) add_simulated(page, "simulated", page->x);
    for (int k = 0; k < page->state_count; k++) {
        const RodState *state = &page->states[k];
        add_simulated(page, state_words(page, "simulated", state), state->x)->color = colormap_series(1 + k);
    }
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
    bool final = count == 0 && def->frame<0, stills = count> 0 && !moving && def->frame < 0;
    if (page->input) add_set(page, "input", page->input, input_ink)->width = 3.4;
    for (int k = 0; k < (final ? page->state_count : 1); k++) add_target(page, &page->states[k]);
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

/* Has any of the states one? */
static bool has_target(const RodPage *page)
{
    bool has = false;
    for (int k = 0; k < page->state_count; k++) has |= page->states[k].target != NULL;
    return has;
}

/* How far the simulated curve is from the input, or those of the states from their targets. */
static void add_distance(RodPage *page, const double *s)
{
    if (!(page->input || has_target(page)) || !page->x) return;
    int count = page->input ? 1 : page->state_count;
    ChartSeries *series = show_block(page->data, (size_t)count, sizeof *series);
    for (int k = 0; k < count; k++) {
        const double(*x)[3] = k ? page->states[k].x : page->x,
              (*to)[3] = page->input ? page->input : page->states[k].target;
        double *distance = show_block(page->data, (size_t)page->point_count, sizeof *distance);
        for (int i = 0; i < page->point_count; i++)
            distance[i] = to ? vec3_length(vec3_sub(vec3_load(x[i]), vec3_load(to[i]))) : NAN;
        const char *name = page->states[k].name;
        series[k] = make_series(page, name ? name : "simulated", s, distance, 1);
    }
    add_chart(page, (Chart){.x_label = "s",
                            .x_unit = "m",
                            .y_label = page->input ? "distance to input" : "distance to target",
                            .y_unit = "m",
                            .y_axis = CHART_LINEAR,
                            .series_count = count,
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
    bool any = page->input || has_target(page) || page->given.dot_count > 0 || page->motion.row_count > 0;
    return page->data->def->target == PICTURE_TARGET_AUTO || any ||
           error_set(err, "--target: there is none: no given curve, no place or curve of a motion");
}

static bool check_options(const ShowDef *def, Error *err)
{
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
    CurvesScene scene = curves_default();
    const char *slash = strrchr(result, '/');
    scene.title = slash ? slash + 1 : result;
    page->lines = show_rod_lines(page->data, page->strand_count, page->point_count);
    scene.lines = page->lines.text, scene.line_count = page->lines.count;
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
