#include "view/show_rod.h"
#include "base/memory.h"
#include "view/curves_picture.h"
#include "view/show_cases.h"
#include "view/show_curves.h"
#include "view/show_holds.h"
#include "view/show_motion.h"
#include "view/show_obstacles.h"
#include "view/show_probes.h"
#include "view/show_rod_lines.h"
#include <math.h>
#include <string.h>

enum { STRANDS_MANY = 20 };

static const Color input_ink = {0.62, 0.62, 0.64, 1};
static const MotionInk motion_ink = {{0.62, 0.62, 0.64, 1}, {0, 0.62, 0.451, 1}, 3};

static const double PLACE_DOT = 3; /* its radius, points */

/* A page of rods. */
typedef struct RodPage {
    ShowData *data;
    ShowCurves curves; /* whose x is of the frame that is shown */
    Marks given;       /* of them: what of their targets is no line */
    CurvesSet *sets;   /* owned */
    int set_count;
    RodLines lines;
    Chart charts[CURVES_CHARTS_MAX];
    int chart_count;
    ShowObstacles obstacles;
    ShowMotion motion;
} RodPage;

/* ---- Curves ---- */

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

/* Has it two neighbours? */
static bool has_line(const RodPage *page, const double (*target)[3])
{
    int count = page->curves.point_count, i = 1;
    while (i < count && !(has_place(target, i - 1, count) && has_place(target, i, count))) i++;
    return i < count;
}

/* "target", of one of several cases "target, NAME". */
static const char *state_words(RodPage *page, const char *word, const ShowCurvesState *state)
{
    return state->name ? show_text(page->data, "%s, %s", word, state->name) : word;
}

/* Of a state's target, what is no line of it: points whose neighbours have no place. Where there is a line, it is what the legend
 * names. */
static void add_alone(RodPage *page, const ShowCurvesState *state)
{
    const char *name = has_line(page, state->target) ? NULL : state_words(page, "target", state);
    int count = page->curves.point_count, alone = 0;
    MarkDot *places = show_block(page->data, (size_t)count, sizeof *places);
    for (int i = 0; i < count; i++) {
        bool joined = has_place(state->target, i - 1, count) || has_place(state->target, i + 1, count);
        if (has_place(state->target, i, count) && !joined)
            places[alone++] = (MarkDot){name, state->target[i], input_ink, PLACE_DOT, false};
    }
    add_dots(page, places, alone);
}

/* Of each state its clouds, and what of its target is no line. */
static void add_given(RodPage *page)
{
    const ShowCurves *curves = &page->curves;
    for (int k = 0; k < curves->state_count && !curves->input; k++) {
        const ShowCurvesState *state = &curves->states[k];
        const MarkDot *cloud;
        int dots = state->load_case ? show_case_cloud(page->data, state->load_case, state->x,
                                                      curves->point_count, input_ink, &cloud)
                                    : 0;
        if (dots) add_dots(page, cloud, dots);
        if (state->target) add_alone(page, state);
    }
}

static CurvesSet *add_set(RodPage *page, const char *name, const double (*points)[3], Color color)
{
    size_t count = (size_t)page->set_count++;
    page->sets = mem_resize(page->sets, count, count + 1, sizeof *page->sets);
    page->sets[count] = (CurvesSet){.name = name,
                                    .curve_count = page->curves.strand_count,
                                    .offsets = page->curves.strands,
                                    .points = points,
                                    .color = color,
                                    .width = 1.6};
    return &page->sets[count];
}

static void add_target(RodPage *page, const ShowCurvesState *state)
{
    if (!state->target) return;
    const char *name = has_line(page, state->target) ? state_words(page, "target", state) : NULL;
    add_set(page, name, state->target, input_ink)->width = 3.4;
}

/* Over the input, so that both are seen. */
static CurvesSet *add_simulated(RodPage *page, const char *name, const double (*points)[3])
{
    CurvesSet *set = add_set(page, name, points, colormap_series(1));
    if (page->curves.input || page->curves.states[0].target) set->width = 1.2, set->dash = 3;
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
    bool fits = array.dims[0] >= page->curves.point_count;
    if (fits) {
        double(*x)[3] = show_block(page->data, (size_t)page->curves.point_count, sizeof *x);
        *points = (const double(*)[3])memcpy(x, array.data, (size_t)page->curves.point_count * sizeof *x);
    }
    array_clear(&array);
    return fits || error_set(err, "the result's frames have fewer points than its strands");
}

static bool add_frame(RodPage *page, int frame, Error *err)
{
    if (!read_frame(page, frame, &page->curves.x, err)) return false;
    add_simulated(page, show_text(page->data, "simulated, %s", show_frame_name(page->data, frame)),
                  page->curves.x);
    add_surroundings(page, frame);
    return true;
}

/* Moments over each other, later ones darker. */
static bool add_stills(RodPage *page, int count, Error *err)
{
    page->curves.x = NULL;
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
    if (!page->curves.x && moves && frames > 0 && !read_frame(page, frames - 1, &page->curves.x, err))
        return false;
    if (!page->curves.x) return true;
    if (!page->curves.state_count) add_simulated(page, "simulated", page->curves.x);
    for (int k = 0; k < page->curves.state_count; k++) {
        const ShowCurvesState *state = &page->curves.states[k];
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
    if (!asked && page->curves.strand_count > STRANDS_MANY) count = 0;
    bool final = count == 0 && def->frame<0, stills = count> 0 && !moving && def->frame < 0;
    if (page->curves.input) add_set(page, "input", page->curves.input, input_ink)->width = 3.4;
    for (int k = 0; k < (final ? page->curves.state_count : 1); k++)
        add_target(page, &page->curves.states[k]);
    if (page->curves.natural && !stills) add_set(page, "natural", page->curves.natural, colormap_series(0));
    if (def->frame >= 0) return add_frame(page, def->frame, err);
    if (count == 0) return asked ? show_check_frame(page->data, 0, err) : add_final(page, err);
    if (moving) return add_motion(page, count, err);
    if (!add_stills(page, count, err)) return false;
    if (page->curves.natural) add_set(page, "natural", page->curves.natural, colormap_series(0))->width = 1;
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

static void add_chart(RodPage *page, Chart chart)
{
    if (page->chart_count < CURVES_CHARTS_MAX) page->charts[page->chart_count++] = chart;
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
    Chart chart;
    page->chart_count = show_curves_strains(&page->curves, page->charts);
    add_over_time(page);
    if (show_history(page->data, &chart)) add_chart(page, chart);
    if (show_curves_distance(&page->curves, &chart)) add_chart(page, chart);
}

/* ---- The page ---- */

/* There is one, if it was asked for. */
static bool check_target(const RodPage *page, Error *err)
{
    bool any = page->curves.input || show_curves_have_target(&page->curves) || page->given.dot_count > 0 ||
               page->motion.row_count > 0;
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
    if (!check_options(def, err) || !show_curves_read(&page->curves, page->data, err)) return false;
    add_given(page);
    if (!show_motion_read(&page->motion, page->data, err) || !check_target(page, err) ||
        !show_obstacles_read(&page->obstacles, page->data, err) || !add_curves(page, err))
        return false;
    frame_obstacles(page);
    CurvesScene scene = curves_default();
    const char *slash = strrchr(result, '/');
    scene.title = slash ? slash + 1 : result;
    page->lines = show_rod_lines(&page->curves);
    scene.lines = page->lines.text, scene.line_count = page->lines.count;
    scene.sets = page->sets, scene.set_count = page->set_count;
    show_clamps(page->data, page->curves.strand_count, page->curves.strands, &scene);
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
