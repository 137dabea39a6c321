#include "view/show.h"
#include "base/memory.h"
#include "base/vec3.h"
#include "spline/drawn.h"
#include "view/picture_panel.h"
#include "view/show_drawing.h"
#include "view/show_mesh.h"
#include "view/show_cases.h"
#include "view/show_motion.h"
#include "view/show_obstacles.h"
#include "view/show_probes.h"
#include "view/show_curves.h"
#include "view/show_rod.h"
#include "view/ticks.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PROBE_CHARTS = 3, CHARTS = PROBE_CHARTS + SHOW_MOTION_CHARTS };

/* A page of a mesh. */
typedef struct Show {
    ShowData *data;
    const ShowDef *def;
    ShowMesh mesh;
    PicturePanel *panels;
    int *steps; /* [panel] the frame that it shows; -1: the last */
    int panel_count;
    ShowObstacles obstacles;
    ShowMotion motion;
    Chart charts[CHARTS];
} Show;

static const MotionInk motion_ink = {{0.835, 0.369, 0, 1}, {0.25, 0.25, 0.27, 1}, 2.6};

ShowDef show_default(void)
{
    return (ShowDef){.frame = -1, .arrows = true, .history = true, .width = 1600};
}

/* ---- Panels ---- */

/* Of the body with its vertices at x; step: the frame, -1: none. */
static PicturePanel *add_panel(Show *show, const char *name, int step, const double (*x)[3])
{
    size_t count = (size_t)show->panel_count++;
    show->panels = mem_resize(show->panels, count, count + 1, sizeof *show->panels);
    show->steps = mem_resize(show->steps, count, count + 1, sizeof *show->steps);
    show->steps[count] = step;
    PicturePanel *panel = &show->panels[count];
    *panel = (PicturePanel){.name = name, .x = show_mesh_points(&show->mesh, x), .time = NAN};
    if (show->def->arrows && show->mesh.magnetic) panel->vectors = show_mesh_carried(&show->mesh, step, x);
    return panel;
}

/* An array of a case, or NULL. */
/* Root of the mean square distance of the vertices that have a target; NaN where none has. */
static double target_away(const double (*x)[3], const double (*target)[3], int count)
{
    double sum = 0;
    int have = 0;
    for (int v = 0; v < count; v++) {
        Vec3 d = vec3_sub(vec3_load(x[v]), vec3_load(target[v]));
        if (!isfinite(vec3_dot(d, d))) continue;
        sum += vec3_dot(d, d);
        have++;
    }
    return sqrt(sum / have);
}

/* Of a load case, with the body's vertices at x. */
static void add_target(Show *show, PicturePanel *panel, const char *name, const double (*x)[3])
{
    int vertices = show->mesh.body.vertex_count;
    const double(*target)[3] = show_case_target(show->data, name, x, vertices);
    panel->target = show_mesh_points(&show->mesh, target);
    if (target) panel->target_away = target_away(x, target, vertices);
}

/* Of a motion: what it was to meet, where it went, and the time. */
static void add_moment(Show *show, PicturePanel *panel, int frame, const double (*x)[3])
{
    panel->time = show_frame_time(show->data, frame);
    panel->marks = show_motion_marks(&show->motion, panel->time, motion_ink);
    panel->gravity = show_dataset(show->data, "slender/design/gravity", ARRAY_FLOAT64, 3);
    ShowCases cases;
    if (show_cases(show->data, &cases, NULL) && cases.count == 1) add_target(show, panel, cases.names[0], x);
}

/* A frame, with its field. */
static bool add_frame(Show *show, int frame, Error *err)
{
    Array array, flux;
    Result *result = show->data->result;
    if (!show_check_frame(show->data, frame, err)) return false;
    if (!result_read_step(result, "Points", frame, &array, err)) return false;
    const double(*points)[3] = show_keep(show->data, array);
    if (array.dims[0] != show->mesh.body.vertex_count)
        return error_set(err, "the result's frame %d has other points than its mesh", frame);
    PicturePanel *panel = add_panel(show, show_frame_name(show->data, frame), frame, points);
    if (show->data->motion) add_moment(show, panel, frame, points);
    if (result_has(result, "slender/frames/flux_density") &&
        result_read_rows(result, "slender/frames/flux_density", frame, 1, &flux, NULL)) {
        char number[64];
        const double *B = show_keep(show->data, flux);
        if (!array_is(&flux, ARRAY_FLOAT64, 2, 3))
            return error_set(err, "slender/frames/flux_density is not as slender writes it");
        panel->flux_density = B;
        unit_format(vec3_length(vec3_load(panel->flux_density)), "T", number, sizeof number);
        bool varies = result_has(result, "slender/design/field_scale");
        panel->note = varies ? "B varies" : show_text(show->data, "B = %s", number);
    }
    return true;
}

static void add_case(Show *show, const char *name)
{
    size_t count = 3 * (size_t)show->mesh.body.vertex_count;
    const double(*x)[3] = show_case_dataset(show->data, name, "x", count);
    if (!x) return;
    PicturePanel *panel = add_panel(show, show_text(show->data, "%s", name), -1, x);
    add_target(show, panel, name, x);
    panel->marks = show_motion_marks(&show->motion, NAN, motion_ink);
    if (!panel->marks.dot_count)
        panel->marks.dot_count = show_case_cloud(show->data, name, x, show->mesh.body.vertex_count,
                                                 panel_target_ink, &panel->marks.dots);
    panel->gravity = show_case_dataset(show->data, name, "gravity", 3);
    const double *flux = show_case_dataset(show->data, name, "flux_density", 3);
    if (flux && vec3_length(vec3_load(flux)) > 0) panel->flux_density = flux;
    Array status;
    char *path = mem_format("slender/cases/%s/status", name);
    if (result_read_as(show->data->result, path, ARRAY_TEXT, 1, 0, &status, NULL)) {
        panel->note = show_text(show->data, "%s", (const char *)status.data);
        array_clear(&status);
    }
    mem_free(path);
}

static bool add_cases(Show *show, Error *err)
{
    ShowCases cases;
    if (!show_cases(show->data, &cases, err)) return false;
    for (int k = 0; k < cases.count; k++) add_case(show, cases.names[k]);
    return true;
}

/* The colours, and what the arrows are. */
static bool dress(Show *show, PictureScene *page, Error *err)
{
    page->vectors_name = "magnetization", page->vectors_unit = "A/m";
    for (int k = 0; k < show->panel_count; k++)
        if (!show_mesh_field(&show->mesh, show->steps[k], &show->panels[k].field, &page->field_name,
                             &page->field_unit, err))
            return false;
    return true;
}

/* What was asked for: moments for an animation or stills, one frame, or the final state of each case. */
static bool add_panels(Show *show, Error *err)
{
    if (!result_check_state(show->data->result, err)) return false;
    if (show->def->frame >= 0) return add_frame(show, show->def->frame, err);
    int count = show_frame_count(show->data);
    for (int k = 0; k < count; k++)
        if (!add_frame(show, show_frame(show->data, k), err)) return false;
    if (count > 0) return true;
    if (show->def->seconds > 0 || show->def->stills > 0) return show_check_frame(show->data, 0, err);
    if (!add_cases(show, err)) return false;
    return show->panel_count > 0 ||
           add_frame(show, result_step_count(show->data->result) - 1, err); /* unfinished */
}

/* What the body meets, in each panel; what of it the pictures have room for follows from where the body is in all. */
static bool add_obstacles(Show *show, Error *err)
{
    if (!show_obstacles_read(&show->obstacles, show->data, err)) return false;
    ShowWay way = show_way();
    for (int k = 0; k < show->panel_count; k++)
        show_way_add(&way, show->panels[k].x, show->mesh.clip.point_count);
    for (int k = 0; k < show->panel_count; k++) {
        PicturePanel *panel = &show->panels[k];
        panel->around = show_obstacles_at(&show->obstacles, show->steps[k]);
        show_obstacles_find_near(&show->obstacles, way, &panel->around);
    }
    return true;
}

/* Where targets are shown; a sentence where one was asked for and there is none, or it can only be over the body. */
static bool place_targets(const Show *show, PictureTarget *place, Error *err)
{
    const ShowDef *def = show->def;
    bool any = false, marks = show->motion.row_count > 0;
    for (int k = 0; k < show->panel_count; k++) any |= show->panels[k].target != NULL;
    *place = def->target;
    if (def->target == PICTURE_TARGET_AUTO)
        return *place = show->steps[0] >= 0 ? PICTURE_TARGET_OVER : PICTURE_TARGET_BESIDE, true;
    if (!any && !marks)
        return error_set(err, "--target: there is none: no shape of a load case that is shown, no place or "
                              "curve of a motion");
    if (def->target == PICTURE_TARGET_OVER || (any && !(def->seconds > 0))) return true;
    return error_set(err, any ? "--target: an animation has its target over the body"
                              : "--target: the places and curves of a motion are always over the body");
}

/* What the scene wanted to be told, and, where there is room for them, what else there is of a motion. */
static int add_charts(Show *show)
{
    int count = show_probes_charts(show->data, show->charts, PROBE_CHARTS);
    if (count <= 1) count += show_motion_charts(&show->motion, show->charts + count);
    return count < PICTURE_CHARTS_MAX ? count : PICTURE_CHARTS_MAX;
}

static bool write_page(Show *show, const char *result, const char *picture, Error *err)
{
    const ShowDef *def = show->def;
    PictureScene page = picture_default();
    if (!show_mesh_read(&show->mesh, show->data, err) || !show_motion_read(&show->motion, show->data, err))
        return false;
    if (!add_panels(show, err) || !add_obstacles(show, err) || !place_targets(show, &page.target, err))
        return false;
    if (!dress(show, &page, err)) return false;
    const char *slash = strrchr(result, '/');
    page.title = slash ? slash + 1 : result;
    const Clip *clip = &show->mesh.clip;
    page.vertex_count = clip->point_count, page.face_count = clip->face_count;
    page.faces = (const int(*)[3])clip->faces;
    page.panel_count = show->panel_count, page.panels = show->panels;
    page.width = def->width;
    page.charts = show->charts, page.chart_count = add_charts(show);
    memcpy(page.view, def->view, sizeof page.view);
    page.same_view = show->steps[0] >= 0;
    show->data->drawn = true;
    if (def->seconds > 0) return picture_animate(picture, &page, def->seconds / show->panel_count, err);
    Chart history;
    if (show_history(show->data, &history)) page.history = &history;
    return picture_write(picture, &page, err);
}

ShowStatus show_result(const char *result, const char *picture, const ShowDef *def, Error *err)
{
    ShowData data = {0};
    Show show = {.data = &data, .def = def};
    bool ok = show_data_open(&data, result, def, err);
    bool drawn = ok && drawn_has(data.result), rod = ok && !drawn && show_curves_has(&data);
    if ((drawn || rod) && clip_is_given(&def->clip))
        ok = error_set(err, "a plane cuts shells and solids open; %s",
                       drawn ? "a drawing has no inside" : "rods are lines");
    else if (drawn)
        ok = show_drawing(&data, result, picture, err);
    else if (rod)
        ok = show_rod(&data, result, picture, err);
    else
        ok = ok && write_page(&show, result, picture, err);
    show_mesh_clear(&show.mesh);
    mem_free(show.panels);
    mem_free(show.steps);
    show_data_clear(&data);
    return ok ? SHOW_DONE : data.drawn ? SHOW_CANNOT_WRITE : SHOW_HAS_NOT;
}
