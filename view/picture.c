#include "view/picture.h"
#include "base/memory.h"
#include "view/animation.h"
#include "view/page.h"
#include "view/picture_target.h"
#include "view/ticks.h"
#include <math.h>
#include <stdio.h>

/* Points; see the sketch in picture.h. */
static const double HEADING = 18, PADDING = 6, KEYS = 180, CHART_HEIGHT = 150, TIME_CHART_HEIGHT = 118,
                    MARK_KEY = 14;

/* Where everything goes. Lengths that a raster image fills are whole pixels. */
typedef struct Layout {
    double cell_width;
    Box *cells; /* [panel] without their headings; owned */
    double footer, footer_height, charts, height;
} Layout;

PictureScene picture_default(void)
{
    return (PictureScene){.target = PICTURE_TARGET_BESIDE, .edges = true, .width = 1600};
}

static double snap(double length, double resolution)
{
    return round(length * resolution) / resolution;
}

/* Lines and dots that the key names. */
static int marks_named(const PictureScene *scene)
{
    const Marks *marks = &scene->panels[0].marks;
    int named = 0;
    for (int k = 0; scene->panel_count && k < marks->line_count; k++) named += marks->lines[k].name != NULL;
    for (int k = 0; scene->panel_count && k < marks->dot_count; k++) named += marks->dots[k].name != NULL;
    return named;
}

static int keys_count(const PictureScene *scene)
{
    return panel_any_field(scene) + panel_any_vectors(scene) + picture_target_any_over(scene) +
           (marks_named(scene) > 0);
}

/* Of axes and lengths below a panel: apart from what obstacles fill. */
static double measures_height(const PictureScene *scene)
{
    bool full = false;
    for (int i = 0; i < scene->panel_count; i++) full = full || scene->panels[i].around.obstacles;
    return full ? 42 : 24;
}

static int scene_columns(const PictureScene *scene)
{
    if (picture_target_any_beside(scene)) return 2;
    return scene->panel_count <= 1 ? 1 : scene->panel_count <= 4 ? 2 : 3;
}

static double scene_cell_width(const PictureScene *scene, double resolution)
{
    int columns = scene_columns(scene);
    return snap((PAGE_WIDTH - 2 * PAGE_MARGIN - (columns - 1) * PAGE_GAP) / columns, resolution);
}

/* Rows are as high as their highest panel; cases beside their targets have a row each. Returns the lowest
 * row's end. */
static double layout_cells(const PanelStyle *style, double top, double width, Box *cells)
{
    const PictureScene *scene = style->scene;
    int per_row = picture_target_any_beside(scene) ? 1 : scene_columns(scene);
    for (int first = 0; first < scene->panel_count; first += per_row) {
        int end = first + per_row < scene->panel_count ? first + per_row : scene->panel_count;
        double height = 40;
        for (int i = first; i < end; i++) height = fmax(height, style->heights[i]);
        for (int i = first; i < end; i++)
            cells[i] = (Box){snap(PAGE_MARGIN + (i - first) * (width + PAGE_GAP), style->resolution),
                             snap(top + HEADING, style->resolution), width,
                             snap(height + 2 * PADDING, style->resolution)};
        top += HEADING + height + 2 * PADDING + measures_height(scene) + PAGE_GAP;
    }
    return top;
}

static PageHead scene_head(const PictureScene *scene)
{
    return (PageHead){scene->title, scene->lines, scene->line_count};
}

static Layout layout_page(const PictureScene *scene, const PanelStyle *style, double width)
{
    Layout page = {.cell_width = width};
    page.cells = mem_alloc((size_t)scene->panel_count, sizeof *page.cells);
    page.footer = layout_cells(style, page_head_end(scene_head(scene)), width, page.cells);
    int keys = keys_count(scene);
    int lines = marks_named(scene) + picture_target_any_over(scene);
    page.footer_height = keys ? fmax(44, lines * MARK_KEY + 4) : 0;
    if (scene->history) page.footer_height = keys ? CHART_HEIGHT : 2 * CHART_HEIGHT;
    page.charts = page.footer + page.footer_height + (page.footer_height > 0 ? PAGE_GAP : 0);
    page.height = page.charts + (scene->chart_count ? TIME_CHART_HEIGHT : 0) + PAGE_MARGIN;
    if (!scene->chart_count) page.height = page.footer + page.footer_height + PAGE_MARGIN;
    return page;
}

/* Bold name, then small print, above a panel. */
static void draw_cell_heading(Canvas *canvas, Box cell, const char *name, const char *note)
{
    const TextStyle bold = {.color = page_ink, .size = 10, .bold = true},
                    small = {.color = page_soft, .size = PAGE_SMALL};
    double y = cell.y - 6;
    double end = page_draw_fitted(canvas, (Vec2){cell.x, y}, name, bold, 0.6 * cell.width) + 8;
    page_draw_fitted(canvas, (Vec2){end, y}, note, small, cell.x + cell.width - end);
}

/* Name and note; how far the target is away, unless its own panel says so. */
static void draw_result_heading(Canvas *canvas, const PictureScene *scene, const PicturePanel *panel, Box box)
{
    char number[64], note[256];
    const char *given = panel->note ? panel->note : "";
    snprintf(note, sizeof note, "%s", given);
    if (panel->target && picture_target_place(scene, panel) == PICTURE_TARGET_OVER) {
        unit_format(panel->target_away, "m", number, sizeof number);
        snprintf(note, sizeof note, "%s%starget %s away (rms)", given, given[0] ? ", " : "", number);
    }
    draw_cell_heading(canvas, box, panel->name ? panel->name : "result", note);
}

static void draw_target_cell(Canvas *canvas, const PanelStyle *style, int index, Box box)
{
    char number[64], note[96];
    unit_format(style->scene->panels[index].target_away, "m", number, sizeof number);
    snprintf(note, sizeof note, "%s away (rms)", number);
    draw_cell_heading(canvas, box, "target", note);
    panel_draw_target(canvas, style, index, box);
}

static void draw_panels(Canvas *canvas, const PanelStyle *style, const Layout *page)
{
    const PictureScene *scene = style->scene;
    for (int i = 0; i < scene->panel_count; i++) {
        Box box = page->cells[i];
        draw_result_heading(canvas, scene, &scene->panels[i], box);
        panel_draw_result(canvas, style, i, box);
        panel_draw_measures(canvas, style, i,
                            (Box){box.x, box.y, box.width, box.height + measures_height(scene)});
        box.x = snap(box.x + page->cell_width + PAGE_GAP, style->resolution);
        if (scene->panels[i].target && picture_target_place(scene, &scene->panels[i]) != PICTURE_TARGET_OVER)
            draw_target_cell(canvas, style, i, box);
    }
}

/* Name and unit above a bar of colours with ticks below. */
static void draw_color_key(Canvas *canvas, const PanelStyle *style, Box box)
{
    const PictureScene *scene = style->scene;
    const ColorScale *scale = &style->colors;
    UnitScale unit =
        unit_scale(scene->field_unit ? scene->field_unit : "", fmax(fabs(scale->low), fabs(scale->high)));
    char title[160];
    snprintf(title, sizeof title, unit.unit[0] ? "%s (%s)" : "%s", scene->field_name ? scene->field_name : "",
             unit.unit);
    canvas_text(canvas, (Vec2){box.x, box.y + 8}, title, (TextStyle){.color = page_ink, .size = 8});
    Box bar = {box.x, box.y + 14, box.width, 9};
    enum { SLICES = 128 };
    for (int i = 0; i < SLICES; i++) { /* each reaches under the next, so that no seams show */
        double left = bar.width * i / SLICES, right = fmin(bar.width, bar.width * (i + 2) / SLICES);
        canvas_fill(canvas, (Box){bar.x + left, bar.y, right - left, bar.height},
                    colormap_color(scale->map, (i + 0.5) / SLICES));
    }
    Ticks ticks = ticks_linear(scale->low * unit.factor, scale->high * unit.factor, 5);
    for (int i = 0; i < ticks.count; i++) {
        double t = (ticks.value[i] / unit.factor - scale->low) / (scale->high - scale->low);
        Vec2 at = {bar.x + t * bar.width, bar.y + bar.height};
        canvas_line(canvas, at, (Vec2){at.x, at.y + 2.5}, (Pen){page_soft, 0.6, 0});
        canvas_text(canvas, (Vec2){at.x, at.y + 11}, ticks.text[i],
                    (TextStyle){.color = page_ink, .size = 8, .align = TEXT_CENTER});
    }
}

static void draw_arrow_key(Canvas *canvas, const PanelStyle *style, Box box)
{
    if (!(style->arrow_greatest > 0)) return;
    const PictureScene *scene = style->scene;
    double shown = ticks_round_down(style->arrow_greatest);
    double length = shown / style->arrow_greatest * style->arrow_length * style->scale / style->resolution;
    char number[64], text[160];
    unit_format(shown, scene->vectors_unit ? scene->vectors_unit : "", number, sizeof number);
    snprintf(text, sizeof text, "%s %s", scene->vectors_name ? scene->vectors_name : "", number);
    double y = box.y + 11;
    canvas_arrow(canvas, (Vec2){box.x, y}, (Vec2){box.x + length, y}, (Pen){style->arrow_color, 1.6, 0});
    canvas_text(canvas, (Vec2){box.x + length + 8, y + 3}, text, (TextStyle){.color = page_ink, .size = 8});
}

/* Wires where any target has faces, else a dot. */
static void draw_target_key(Canvas *canvas, const PictureScene *scene, Box box)
{
    bool wires = false;
    double y = box.y + 11;
    for (int i = 0; i < scene->panel_count; i++)
        wires = wires || (scene->panels[i].target && picture_target_has_face(scene, &scene->panels[i]));
    if (wires)
        canvas_line(canvas, (Vec2){box.x, y}, (Vec2){box.x + 22, y}, (Pen){panel_target_ink, 0.8, 0});
    else
        canvas_circle(canvas, (Vec2){box.x + 11, y}, 2.2, panel_target_ink);
    canvas_text(canvas, (Vec2){box.x + 30, y + 3}, "target", (TextStyle){.color = page_ink, .size = 8});
}

/* A row for each that has a name. */
static void draw_marks_key(Canvas *canvas, const PictureScene *scene, Box box)
{
    const Marks *marks = &scene->panels[0].marks;
    const TextStyle style = {.color = page_ink, .size = 8};
    Vec2 at = {box.x, box.y + 11};
    for (int k = 0; k < marks->line_count + marks->dot_count; k++) {
        const MarkLine *line = k < marks->line_count ? &marks->lines[k] : NULL;
        const MarkDot *dot = line ? NULL : &marks->dots[k - marks->line_count];
        const char *name = line ? line->name : dot->name;
        if (!name) continue;
        if (line)
            marks_draw_line(canvas, line, at);
        else
            marks_draw_dot(canvas, dot, at);
        canvas_text(canvas, (Vec2){at.x + MARKS_SAMPLE + 8, at.y + 3}, name, style);
        at.y += MARK_KEY;
    }
}

/* Below each other beside a chart, otherwise in a row. */
static void draw_keys(Canvas *canvas, const PanelStyle *style, const Layout *page)
{
    const PictureScene *scene = style->scene;
    bool stacked = scene->history;
    Box box = {PAGE_MARGIN, page->footer, KEYS - 20, 40};
    if (panel_any_field(scene)) {
        draw_color_key(canvas, style, box);
        *(stacked ? &box.y : &box.x) += stacked ? 48 : KEYS;
    }
    if (panel_any_vectors(scene)) {
        draw_arrow_key(canvas, style, box);
        *(stacked ? &box.y : &box.x) += stacked ? 24 : KEYS;
    }
    if (picture_target_any_over(scene)) {
        draw_target_key(canvas, scene, box);
        box.y += MARK_KEY;
    }
    if (marks_named(scene)) draw_marks_key(canvas, scene, box);
}

/* Side by side, with these moments marked in them. */
static void draw_charts(Canvas *canvas, const PictureScene *scene, const double *times, int count, double top)
{
    double width =
        (PAGE_WIDTH - 2 * PAGE_MARGIN - (scene->chart_count - 1) * PAGE_GAP) / fmax(scene->chart_count, 1);
    for (int k = 0; k < scene->chart_count; k++) {
        Chart chart = scene->charts[k];
        chart.marks = times, chart.mark_count = count;
        chart_draw(canvas, &chart,
                   (Box){PAGE_MARGIN + k * (width + PAGE_GAP), top, width, TIME_CHART_HEIGHT});
    }
}

static void draw_panels_charts(Canvas *canvas, const PictureScene *scene, double top)
{
    double *times = mem_alloc((size_t)scene->panel_count, sizeof *times);
    for (int i = 0; i < scene->panel_count; i++) times[i] = scene->panels[i].time;
    draw_charts(canvas, scene, times, scene->panel_count, top);
    mem_free(times);
}

static void draw_page(Canvas *canvas, const PictureScene *scene, const PanelStyle *style, const Layout *page)
{
    page_draw_head(canvas, scene_head(scene));
    draw_panels(canvas, style, page);
    if (scene->panel_count) draw_keys(canvas, style, page);
    draw_panels_charts(canvas, scene, page->charts);
    if (!scene->history) return;
    double left = keys_count(scene) ? PAGE_MARGIN + KEYS + PAGE_GAP : PAGE_MARGIN;
    chart_draw(canvas, scene->history,
               (Box){left, page->footer, PAGE_WIDTH - PAGE_MARGIN - left, page->footer_height});
}

static bool check_scene(const char *path, const PictureScene *scene, Error *err)
{
    if (scene->panel_count == 0 && !scene->history)
        return error_set(err, "%s: there is nothing to draw: neither a frame nor a history", path);
    return page_check_width(path, scene->width, err);
}

bool picture_write(const char *path, const PictureScene *scene, Error *err)
{
    if (!check_scene(path, scene, err)) return false;
    double resolution = scene->width / PAGE_WIDTH, width = scene_cell_width(scene, resolution);
    PanelStyle style = panel_style_create(scene, resolution, width - 2 * PADDING,
                                          width * (scene_columns(scene) == 1 ? 0.62 : 1));
    Layout page = layout_page(scene, &style, width);
    Canvas *canvas = canvas_create(path, PAGE_WIDTH, page.height, resolution, err);
    bool ok = canvas;
    if (canvas) {
        draw_page(canvas, scene, &style, &page);
        ok = canvas_save(canvas, err);
    }
    canvas_destroy(canvas);
    mem_free(page.cells);
    panel_style_clear(&style);
    return ok;
}

/* One page: the whole width is the panel's. */
static bool animate_panel(Animation *animation, const PanelStyle *style, const Layout *page, int index,
                          double seconds, Error *err)
{
    const PictureScene *scene = style->scene;
    Canvas *canvas = canvas_create("page.png", PAGE_WIDTH, page->height, style->resolution, err);
    if (!canvas) return false;
    Box box = page->cells[0];
    page_draw_head(canvas, scene_head(scene));
    draw_result_heading(canvas, scene, &scene->panels[index], box);
    panel_draw_result(canvas, style, index, box);
    panel_draw_measures(canvas, style, index,
                        (Box){box.x, box.y, box.width, box.height + measures_height(scene)});
    draw_keys(canvas, style, page);
    draw_charts(canvas, scene, &scene->panels[index].time, 1, page->charts);
    bool ok = animation_add(animation, canvas, seconds, err);
    canvas_destroy(canvas);
    return ok;
}

bool picture_animate(const char *path, const PictureScene *scene, double seconds, Error *err)
{
    if (!check_scene(path, scene, err)) return false;
    PictureScene one = *scene; /* as a page with one panel is laid out */
    one.panel_count = 1, one.history = NULL, one.target = PICTURE_TARGET_OVER;
    double resolution = scene->width / PAGE_WIDTH, width = snap(PAGE_WIDTH - 2 * PAGE_MARGIN, resolution);
    Animation *animation = animation_create(path, err);
    if (!animation) return false;
    PanelStyle style = panel_style_create(scene, resolution, width - 2 * PADDING, 0.62 * width);
    Layout page;
    style.scene = &one;
    page = layout_page(&one, &style, width);
    PictureScene all = *scene;
    all.history = NULL, all.target = PICTURE_TARGET_OVER;
    style.scene = &all;
    bool ok = true;
    for (int i = 0; ok && i < scene->panel_count; i++)
        ok = animate_panel(animation, &style, &page, i, seconds, err);
    ok = ok && animation_save(animation, err);
    animation_destroy(animation);
    mem_free(page.cells);
    panel_style_clear(&style);
    return ok;
}
