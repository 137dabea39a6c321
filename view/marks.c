#include "view/marks.h"
#include "base/memory.h"
#include <math.h>

const double MARKS_SAMPLE = 22;

static const double RIM = 0.8, CASING = 0.7; /* pt */
static const Color paper = {1, 1, 1, 1};

typedef struct View {
    const Camera *camera;
    double resolution;
    Vec2 origin;
} View;

static Vec2 place(const View *view, const double *point)
{
    Vec3 at = camera_project(view->camera, vec3_load(point));
    return (Vec2){view->origin.x + at.x / view->resolution, view->origin.y + at.y / view->resolution};
}

static void draw_dot(Canvas *canvas, const MarkDot *dot, Vec2 at)
{
    canvas_circle(canvas, at, dot->radius + CASING, paper);
    canvas_circle(canvas, at, dot->radius, dot->color);
    if (dot->hollow) canvas_circle(canvas, at, dot->radius - RIM, paper);
}

/* Points that cannot be seen interrupt it. */
static void draw_line(Canvas *canvas, const MarkLine *line, const View *view, Pen pen)
{
    Vec2 *points = mem_alloc((size_t)line->count, sizeof *points);
    for (int i = 0, run = 0; i < line->count; i++) {
        Vec2 at = place(view, line->points[i]);
        bool seen = isfinite(at.x + at.y);
        if (seen) points[run++] = at;
        if (seen && i + 1 < line->count) continue;
        if (run > 0) canvas_polyline(canvas, points, run, pen);
        run = 0;
    }
    mem_free(points);
}

/* All lines on paper of their own, so that they are seen on bodies of any colour, and over each other. */
void marks_draw(Canvas *canvas, const Marks *marks, const Camera *camera, double resolution, Vec2 origin)
{
    View view = {camera, resolution, origin};
    for (int k = 0; k < 2 * marks->line_count; k++) {
        const MarkLine *line = &marks->lines[k % marks->line_count];
        bool casing = k < marks->line_count;
        draw_line(canvas, line, &view,
                  casing ? (Pen){paper, line->width + 2 * CASING, 0} : (Pen){line->color, line->width, 0});
    }
    for (int k = 0; k < marks->dot_count; k++) {
        Vec2 at = place(&view, marks->dots[k].at);
        if (isfinite(at.x + at.y)) draw_dot(canvas, &marks->dots[k], at);
    }
}

void marks_draw_line(Canvas *canvas, const MarkLine *line, Vec2 at)
{
    canvas_line(canvas, at, (Vec2){at.x + MARKS_SAMPLE, at.y}, (Pen){line->color, line->width, 0});
}

void marks_draw_dot(Canvas *canvas, const MarkDot *dot, Vec2 at)
{
    canvas_circle(canvas, (Vec2){at.x + 0.5 * MARKS_SAMPLE, at.y}, dot->radius, dot->color);
}
