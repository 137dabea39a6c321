#include "io/picture.h"
#include "base/memory.h"
#include "io/picture_panel.h"
#include "io/ticks.h"
#include <math.h>
#include <stdio.h>

/* Points; see the sketch in picture.h. */
static const double PAGE = 576, MARGIN = 28, GAP = 16, TITLE = 15, SMALL = 8.5, LEADING = 12, HEADING = 18;
static const double TRIAD = 24, PADDING = 6, KEYS = 180, CHART_HEIGHT = 150;

static const Color ink = {0.15, 0.15, 0.17, 1}, soft = {0.42, 0.42, 0.45, 1};

/* Where everything goes. Lengths that a raster image fills are whole pixels. */
typedef struct Layout {
    double cell_width;
    Box *cells; /* [panel] without their headings; owned */
    double footer, footer_height, height;
} Layout;

PictureScene picture_default(void)
{
    return (PictureScene){.edges = true, .width = 1600};
}

static double snap(double length, double resolution)
{
    return round(length * resolution) / resolution;
}

static int keys_count(const PictureScene *scene)
{
    bool length = scene->panel_count > 0 && !(scene->perspective > 0);
    return panel_any_field(scene) + panel_any_vectors(scene) + length;
}

static int scene_columns(const PictureScene *scene)
{
    if (panel_any_beside(scene)) return 2;
    return scene->panel_count <= 1 ? 1 : scene->panel_count <= 4 ? 2 : 3;
}

static double scene_cell_width(const PictureScene *scene, double resolution)
{
    int columns = scene_columns(scene);
    return snap((PAGE - 2 * MARGIN - (columns - 1) * GAP) / columns, resolution);
}

/* Rows are as high as their highest panel; cases beside their targets have a row each. Returns the lowest
 * row's end. */
static double layout_cells(const PanelStyle *style, double top, double width, Box *cells)
{
    const PictureScene *scene = style->scene;
    int per_row = panel_any_beside(scene) ? 1 : scene_columns(scene);
    for (int first = 0; first < scene->panel_count; first += per_row) {
        int end = first + per_row < scene->panel_count ? first + per_row : scene->panel_count;
        double height = 40;
        for (int i = first; i < end; i++) height = fmax(height, style->heights[i]);
        for (int i = first; i < end; i++)
            cells[i] = (Box){snap(MARGIN + (i - first) * (width + GAP), style->resolution),
                             snap(top + HEADING, style->resolution), width,
                             snap(height + 2 * PADDING, style->resolution)};
        top += HEADING + height + 2 * PADDING + TRIAD + GAP;
    }
    return top;
}

static Layout layout_page(const PictureScene *scene, const PanelStyle *style, double width)
{
    Layout page = {.cell_width = width};
    page.cells = mem_alloc((size_t)scene->panel_count, sizeof *page.cells);
    double top = MARGIN + (scene->title ? TITLE + 8 : 0) + scene->line_count * LEADING + 6;
    page.footer = layout_cells(style, top, width, page.cells);
    int keys = keys_count(scene);
    page.footer_height = keys ? 44 : 0;
    if (scene->history) page.footer_height = keys ? CHART_HEIGHT : 2 * CHART_HEIGHT;
    page.height = page.footer + page.footer_height + MARGIN;
    return page;
}

static void draw_heading(Canvas *canvas, const PictureScene *scene)
{
    double y = MARGIN;
    if (scene->title) {
        y += TITLE;
        canvas_text(canvas, (Vec2){MARGIN, y - 2}, scene->title,
                    (TextStyle){.color = ink, .size = TITLE, .bold = true});
        y += 6;
    }
    for (int i = 0; i < scene->line_count; i++) {
        y += LEADING;
        canvas_text(canvas, (Vec2){MARGIN, y - 3}, scene->lines[i],
                    (TextStyle){.color = soft, .size = SMALL});
    }
}

/* Bold name, then small print. */
static void draw_cell_heading(Canvas *canvas, Vec2 at, const char *name, const char *note)
{
    const TextStyle bold = {.color = ink, .size = 10, .bold = true};
    canvas_text(canvas, at, name, bold);
    if (!note) return;
    at.x += canvas_text_width(canvas, name, bold) + 8;
    canvas_text(canvas, at, note, (TextStyle){.color = soft, .size = SMALL});
}

/* Root of the mean square distance of the vertices that have a target; NaN where none has. */
static double target_distance(const PictureScene *scene, const PicturePanel *panel)
{
    double sum = 0;
    int count = 0;
    for (int v = 0; v < scene->vertex_count; v++) {
        Vec3 d = vec3_sub(vec3_load(panel->x[v]), vec3_load(panel->target[v]));
        if (!isfinite(vec3_dot(d, d))) continue;
        sum += vec3_dot(d, d);
        count++;
    }
    return sqrt(sum / count);
}

static void draw_target_cell(Canvas *canvas, const PanelStyle *style, int index, Box box)
{
    char number[64], note[96];
    unit_format(target_distance(style->scene, &style->scene->panels[index]), "m", number, sizeof number);
    snprintf(note, sizeof note, "%s away (rms)", number);
    draw_cell_heading(canvas, (Vec2){box.x, box.y - 6}, "target", note);
    panel_draw_target(canvas, style, index, box);
}

static void draw_panels(Canvas *canvas, const PanelStyle *style, const Layout *page)
{
    const PictureScene *scene = style->scene;
    for (int i = 0; i < scene->panel_count; i++) {
        const PicturePanel *panel = &scene->panels[i];
        Box box = page->cells[i];
        draw_cell_heading(canvas, (Vec2){box.x, box.y - 6}, panel->name ? panel->name : "result",
                          panel->note);
        panel_draw_result(canvas, style, i, box);
        panel_draw_triad(canvas, style, i, (Box){box.x, box.y, box.width, box.height + TRIAD});
        box.x = snap(box.x + page->cell_width + GAP, style->resolution);
        if (panel->target && panel_any_beside(scene)) draw_target_cell(canvas, style, i, box);
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
    canvas_text(canvas, (Vec2){box.x, box.y + 8}, title, (TextStyle){.color = ink, .size = 8});
    Box bar = {box.x, box.y + 14, box.width, 9};
    enum { SLICES = 128 };
    for (int i = 0; i < SLICES; i++) { /* each covers the rest of the bar, so that no seams show */
        double left = bar.width * i / SLICES;
        canvas_fill(canvas, (Box){bar.x + left, bar.y, bar.width - left, bar.height},
                    colormap_color(scale->map, (i + 0.5) / SLICES));
    }
    Ticks ticks = ticks_linear(scale->low * unit.factor, scale->high * unit.factor, 5);
    for (int i = 0; i < ticks.count; i++) {
        double t = (ticks.value[i] / unit.factor - scale->low) / (scale->high - scale->low);
        Vec2 at = {bar.x + t * bar.width, bar.y + bar.height};
        canvas_line(canvas, at, (Vec2){at.x, at.y + 2.5}, (Pen){soft, 0.6, 0});
        canvas_text(canvas, (Vec2){at.x, at.y + 11}, ticks.text[i],
                    (TextStyle){.color = ink, .size = 8, .align = TEXT_CENTER});
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
    canvas_text(canvas, (Vec2){box.x + length + 8, y + 3}, text, (TextStyle){.color = ink, .size = 8});
}

static void draw_length_key(Canvas *canvas, const PanelStyle *style, Box box)
{
    double points = style->scale / style->resolution; /* per metre */
    double shown = ticks_round_down(60 / points), length = shown * points;
    char text[64];
    unit_format(shown, "m", text, sizeof text);
    const Pen pen = {ink, 1, 0};
    double y = box.y + 11;
    canvas_line(canvas, (Vec2){box.x, y}, (Vec2){box.x + length, y}, pen);
    canvas_line(canvas, (Vec2){box.x, y - 3}, (Vec2){box.x, y + 3}, pen);
    canvas_line(canvas, (Vec2){box.x + length, y - 3}, (Vec2){box.x + length, y + 3}, pen);
    canvas_text(canvas, (Vec2){box.x + length + 8, y + 3}, text, (TextStyle){.color = ink, .size = 8});
}

/* Below each other beside a chart, otherwise in a row. */
static void draw_keys(Canvas *canvas, const PanelStyle *style, const Layout *page)
{
    const PictureScene *scene = style->scene;
    bool stacked = scene->history;
    Box box = {MARGIN, page->footer, KEYS - 20, 40};
    if (panel_any_field(scene)) {
        draw_color_key(canvas, style, box);
        *(stacked ? &box.y : &box.x) += stacked ? 48 : KEYS;
    }
    if (panel_any_vectors(scene)) {
        draw_arrow_key(canvas, style, box);
        *(stacked ? &box.y : &box.x) += stacked ? 24 : KEYS;
    }
    if (!(scene->perspective > 0)) draw_length_key(canvas, style, box);
}

static void draw_page(Canvas *canvas, const PictureScene *scene, const PanelStyle *style, const Layout *page)
{
    draw_heading(canvas, scene);
    draw_panels(canvas, style, page);
    if (scene->panel_count) draw_keys(canvas, style, page);
    if (!scene->history) return;
    double left = keys_count(scene) ? MARGIN + KEYS + GAP : MARGIN;
    chart_draw(canvas, scene->history, (Box){left, page->footer, PAGE - MARGIN - left, page->footer_height});
}

bool picture_write(const char *path, const PictureScene *scene, Error *err)
{
    if (scene->panel_count == 0 && !scene->history)
        return error_set(err, "%s: there is nothing to draw: neither a frame nor a history", path);
    if (scene->width < 400 || scene->width > 4000)
        return error_set(err, "%s: a width of %d pixels; 400 to 4000 are allowed", path, scene->width);
    double resolution = scene->width / PAGE, width = scene_cell_width(scene, resolution);
    PanelStyle style = panel_style_create(scene, resolution, width - 2 * PADDING,
                                          width * (scene_columns(scene) == 1 ? 0.62 : 1));
    Layout page = layout_page(scene, &style, width);
    Canvas *canvas = canvas_create(path, PAGE, page.height, resolution, err);
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
