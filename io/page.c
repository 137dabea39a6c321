#include "io/page.h"
#include "io/ticks.h"
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

bool page_check_width(const char *path, int width, Error *err)
{
    return (width >= 400 && width <= 4000) ||
           error_set(err, "%s: a width of %d pixels; 400 to 4000 are allowed", path, width);
}
