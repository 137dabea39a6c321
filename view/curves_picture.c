#include "view/curves_picture.h"
#include "base/memory.h"
#include "view/animation.h"
#include "view/curves_layout.h"
#include "view/page.h"
#include <math.h>

/* Points. */
static const double LEGEND_ROW = 15, SAMPLE = 22, SQUARE = 5, SAMPLE_GAP = 6, ENTRY_GAP = 18;

CurvesScene curves_default(void)
{
    return (CurvesScene){.width = 1600};
}

Color curves_fade(Color color, double t)
{
    const double PALEST = 0.3;
    double s = PALEST + (1 - PALEST) * fmin(fmax(t, 0), 1);
    return (Color){1 - s * (1 - color.r), 1 - s * (1 - color.g), 1 - s * (1 - color.b), color.a};
}

static PageHead scene_head(const CurvesScene *scene)
{
    return (PageHead){scene->title, scene->lines, scene->line_count};
}

/* ---- The legend ---- */

/* Entries in rows from the left. */
typedef struct Legend {
    Canvas *canvas, *ruler; /* to draw on, NULL: nothing is drawn; to measure texts with */
    double x, y;
} Legend;

/* Writes an entry's name; returns the left end of its sample, which is the caller's to draw. */
static Vec2 legend_place(Legend *legend, double sample, const char *name)
{
    const TextStyle style = {.color = page_ink, .size = PAGE_SMALL};
    double width = sample + SAMPLE_GAP + canvas_text_width(legend->ruler, name, style);
    if (legend->x > PAGE_MARGIN && legend->x + width > PAGE_WIDTH - PAGE_MARGIN) {
        legend->x = PAGE_MARGIN;
        legend->y += LEGEND_ROW;
    }
    Vec2 at = {legend->x, legend->y};
    legend->x += width + ENTRY_GAP;
    if (legend->canvas)
        canvas_text(legend->canvas, (Vec2){at.x + sample + SAMPLE_GAP, at.y + 0.36 * PAGE_SMALL}, name,
                    style);
    return at;
}

/* Sets that are moments, or those that are none: names with a piece of their line each. */
static void legend_add_sets(Legend *legend, const CurvesScene *scene, bool moments, int only)
{
    for (int s = 0; s < scene->set_count; s++) {
        const CurvesSet *set = &scene->sets[s];
        if (!set->name || set->moment != moments || (moments && only >= 0 && s != only)) continue;
        Vec2 at = legend_place(legend, SAMPLE, set->name);
        Pen pen = curves_pen(set);
        pen.color = set->color, pen.width = set->width;
        if (legend->canvas) canvas_line(legend->canvas, at, (Vec2){at.x + SAMPLE, at.y}, pen);
    }
}

/* Their lines and dots that have names. */
static void legend_add_marks(Legend *legend, const Marks *marks)
{
    for (int k = 0; k < marks->line_count; k++) {
        if (!marks->lines[k].name) continue;
        Vec2 at = legend_place(legend, MARKS_SAMPLE, marks->lines[k].name);
        if (legend->canvas) marks_draw_line(legend->canvas, &marks->lines[k], at);
    }
    for (int k = 0; k < marks->dot_count; k++) {
        if (!marks->dots[k].name) continue;
        Vec2 at = legend_place(legend, MARKS_SAMPLE, marks->dots[k].name);
        if (legend->canvas) marks_draw_dot(legend->canvas, &marks->dots[k], at);
    }
}

/* Clamps, and the axes of their frames. */
static void legend_add_holds(Legend *legend, const CurvesScene *scene, int only)
{
    static const char *const names[] = {"n1", "n2"};
    const Holds *holds = curves_holds(scene, only);
    if (!scene->clamp_count && !holds) return;
    Vec2 at = legend_place(legend, SQUARE, scene->clamps_name ? scene->clamps_name : "clamp");
    if (legend->canvas) holds_draw_square(legend->canvas, (Vec2){at.x + 0.5 * SQUARE, at.y}, SQUARE);
    for (int k = 0; holds && holds_have_frames(holds) && k < 2; k++) {
        at = legend_place(legend, SAMPLE, names[k]);
        if (legend->canvas) holds_draw_axis(legend->canvas, k + 1, at, SAMPLE);
    }
    if (!holds || !holds_have_ways(holds)) return;
    at = legend_place(legend, SAMPLE, "its way");
    if (legend->canvas) holds_draw_way(legend->canvas, at, SAMPLE);
}

/* Returns where the legend ends. The names of moments come last: in an animation nothing else moves. */
static double draw_legend(Canvas *canvas, Canvas *ruler, const CurvesScene *scene, int only)
{
    double top = page_head_end(scene_head(scene));
    Legend legend = {canvas, ruler, PAGE_MARGIN, top + 0.5 * LEGEND_ROW};
    legend_add_sets(&legend, scene, false, only);
    legend_add_holds(&legend, scene, only);
    const Marks *marks = curves_marks(scene, only);
    if (marks) legend_add_marks(&legend, marks);
    legend_add_sets(&legend, scene, true, only);
    return legend.x > PAGE_MARGIN ? legend.y + LEGEND_ROW : top;
}

/* ---- The page ---- */

static void draw_page(Canvas *canvas, const CurvesScene *scene, const CurvesLayout *layout, int only)
{
    page_draw_head(canvas, scene_head(scene));
    draw_legend(canvas, canvas, scene, only);
    for (int v = 0; v < layout->view_count; v++) curves_view_draw(canvas, scene, &layout->views[v], only);
    for (int k = 0; k < scene->chart_count; k++) {
        Chart chart = scene->charts[k];
        if (only >= 0) chart.marks = &scene->sets[only].time, chart.mark_count = 1;
        chart_draw(canvas, &chart, layout->charts[k]);
    }
}

static bool lay_out(const char *path, const CurvesScene *scene, int only, CurvesLayout *layout, Error *err)
{
    if (!page_check_width(path, scene->width, err)) return false;
    Canvas *ruler = canvas_create("ruler.png", 1, 1, 1, err);
    if (!ruler) return false;
    double top = draw_legend(NULL, ruler, scene, only);
    canvas_destroy(ruler);
    return curves_layout(scene, top, layout) ||
           error_set(err, "%s: there is nothing to draw: the curves have no points", path);
}

bool curves_write(const char *path, const CurvesScene *scene, Error *err)
{
    CurvesLayout layout;
    if (!lay_out(path, scene, -1, &layout, err)) return false;
    Canvas *canvas =
        canvas_create(path, PAGE_WIDTH, layout.end + PAGE_MARGIN, scene->width / PAGE_WIDTH, err);
    if (!canvas) return false;
    draw_page(canvas, scene, &layout, -1);
    bool ok = canvas_save(canvas, err);
    canvas_destroy(canvas);
    return ok;
}

bool curves_animate(const char *path, const CurvesScene *scene, double seconds, Error *err)
{
    CurvesLayout layout;
    int last = scene->set_count - 1;
    while (last >= 0 && !scene->sets[last].moment) last--;
    if (!lay_out(path, scene, last, &layout, err)) return false;
    Animation *animation = animation_create(path, err);
    bool ok = animation;
    for (int s = 0; ok && s < scene->set_count; s++) {
        if (!scene->sets[s].moment) continue;
        Canvas *canvas =
            canvas_create("page.png", PAGE_WIDTH, layout.end + PAGE_MARGIN, scene->width / PAGE_WIDTH, err);
        ok = canvas;
        if (ok) draw_page(canvas, scene, &layout, s);
        ok = ok && animation_add(animation, canvas, seconds, err);
        canvas_destroy(canvas);
    }
    ok = ok && animation_save(animation, err);
    animation_destroy(animation);
    return ok;
}
