#include "view/page.h"
#include "base/vec3.h"
#include "view/ticks.h"
#include <math.h>

const Color page_ink = {0.15, 0.15, 0.17, 1}, page_soft = {0.42, 0.42, 0.45, 1};
const double PAGE_WIDTH = 576, PAGE_MARGIN = 28, PAGE_GAP = 16, PAGE_SMALL = 8.5, PAGE_LABEL = 8;
static const double TITLE = 15, LEADING = 12, LENGTH = 60;

double page_head_end(PageHead head)
{
    return PAGE_MARGIN + (head.title ? TITLE + 8 : 0) + head.line_count * LEADING + 6;
}

double page_draw_fitted(Canvas *canvas, Vec2 at, const char *text, TextStyle style, double width)
{
    style.size *= fmin(1, width / fmax(canvas_text_width(canvas, text, style), 1e-6));
    canvas_text(canvas, at, text, style);
    return at.x + canvas_text_width(canvas, text, style);
}

void page_draw_head(Canvas *canvas, PageHead head)
{
    const TextStyle title = {.color = page_ink, .size = TITLE, .bold = true},
                    small = {.color = page_soft, .size = PAGE_SMALL};
    double y = PAGE_MARGIN, width = PAGE_WIDTH - 2 * PAGE_MARGIN;
    if (head.title) {
        y += TITLE;
        page_draw_fitted(canvas, (Vec2){PAGE_MARGIN, y - 2}, head.title, title, width);
        y += 6;
    }
    for (int i = 0; i < head.line_count; i++) {
        y += LEADING;
        page_draw_fitted(canvas, (Vec2){PAGE_MARGIN, y - 3}, head.lines[i], small, width);
    }
}

static Vec2 seen_along(const Camera *camera, Vec2 from, Vec3 direction, double length)
{
    return (Vec2){from.x + length * vec3_dot(direction, camera->right),
                  from.y - length * vec3_dot(direction, camera->up)};
}

void page_draw_axes(Canvas *canvas, const Camera *camera, Vec2 origin)
{
    static const char *const names[3] = {"x", "y", "z"};
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 3; k++) {
        Vec2 name = seen_along(camera, origin, axes[k], 18);
        canvas_line(canvas, origin, seen_along(camera, origin, axes[k], 13), (Pen){page_soft, 0.6, 0});
        canvas_text(canvas, (Vec2){name.x, name.y + 2.2}, names[k],
                    (TextStyle){.color = page_soft, .size = 7, .align = TEXT_CENTER});
    }
}

void page_draw_length(Canvas *canvas, double points, Vec2 end)
{
    double shown = ticks_round_down(LENGTH / points), left = end.x - shown * points;
    char text[64];
    unit_format(shown, "m", text, sizeof text);
    const Pen pen = {page_ink, 0.9, 0};
    canvas_line(canvas, (Vec2){left, end.y}, end, pen);
    canvas_line(canvas, (Vec2){left, end.y - 2.5}, (Vec2){left, end.y + 2.5}, pen);
    canvas_line(canvas, (Vec2){end.x, end.y - 2.5}, (Vec2){end.x, end.y + 2.5}, pen);
    canvas_text(canvas, (Vec2){0.5 * (left + end.x), end.y - 5}, text,
                (TextStyle){.color = page_ink, .size = PAGE_LABEL, .align = TEXT_CENTER});
}

void page_draw_gravity(Canvas *canvas, const Camera *camera, const double *gravity, Vec2 middle)
{
    Vec3 g = vec3_unit(vec3_load(gravity));
    double x = 6.5 * vec3_dot(g, camera->right), y = -6.5 * vec3_dot(g, camera->up);
    const Pen pen = {page_ink, 0.9, 0};
    canvas_text(canvas, (Vec2){middle.x - 10, middle.y + 2.5}, "g",
                (TextStyle){.color = page_ink, .size = PAGE_LABEL, .align = TEXT_CENTER});
    if (hypot(x, y) > 2) {
        canvas_arrow(canvas, (Vec2){middle.x - x, middle.y - y}, (Vec2){middle.x + x, middle.y + y}, pen);
        return;
    }
    canvas_circle(canvas, middle, 4, page_ink);
    canvas_circle(canvas, middle, 3.2, (Color){1, 1, 1, 1});
    if (vec3_dot(g, camera->toward) > 0)
        canvas_circle(canvas, middle, 1.2, page_ink);
    else
        for (int k = -1; k <= 1; k += 2)
            canvas_line(canvas, (Vec2){middle.x - 2.3, middle.y - 2.3 * k},
                        (Vec2){middle.x + 2.3, middle.y + 2.3 * k}, (Pen){page_ink, 0.7, 0});
}

bool page_check_width(const char *path, int width, Error *err)
{
    return (width >= 400 && width <= 4000) ||
           error_set(err, "%s: a width of %d pixels; 400 to 4000 are allowed", path, width);
}
