#include "view/holds.h"
#include "base/memory.h"
#include "view/page.h"
#include <math.h>

static const double SIDE = 5, REACH = 8, AXIS = 16; /* pt: the square, the outline's half-width, the axes */
static const double OUTLINE = 0.9, LINE = 1.4, WAY = 0.9, DASH = 2;
static const Color axes[2] = {{0.48, 0.20, 0.58, 1}, {0.80, 0.28, 0.55, 1}}; /* n1, n2 */

bool holds_have_frames(const Holds *holds)
{
    bool have = false;
    for (int k = 0; k < holds->count; k++) have |= isfinite(holds->items[k].n1[0]);
    return have;
}

bool holds_have_ways(const Holds *holds)
{
    bool have = false;
    for (int k = 0; k < holds->count; k++) have |= holds->items[k].way_count > 1;
    return have;
}

static void draw_begin(Canvas *canvas, Vec2 at)
{
    canvas_frame(canvas, (Box){at.x - 0.5 * SIDE, at.y - 0.5 * SIDE, SIDE, SIDE}, (Pen){page_ink, WAY, 0});
}

void holds_draw_way(Canvas *canvas, Vec2 at, double length)
{
    canvas_line(canvas, at, (Vec2){at.x + length, at.y}, (Pen){page_ink, WAY, DASH});
    draw_begin(canvas, at);
}

void holds_draw_square(Canvas *canvas, Vec2 at, double side)
{
    canvas_fill(canvas, (Box){at.x - 0.5 * side, at.y - 0.5 * side, side, side}, page_ink);
}

void holds_draw_axis(Canvas *canvas, int axis, Vec2 at, double length)
{
    canvas_line(canvas, at, (Vec2){at.x + length, at.y}, (Pen){axes[axis - 1], LINE, 0});
}

/* So many points along n1 and n2 from a place on the page. */
static Vec2 beside(const Hold *hold, const Camera *camera, Vec2 from, double along1, double along2)
{
    Vec3 way = vec3_axpy(along1, vec3_load(hold->n1), vec3_scale(along2, vec3_load(hold->n2)));
    return (Vec2){from.x + vec3_dot(way, camera->right), from.y - vec3_dot(way, camera->up)};
}

static void draw_outline(Canvas *canvas, const Holds *holds, const Hold *hold, const Camera *camera,
                         Vec2 from)
{
    int count = holds->outline_count;
    double widest = 0;
    for (int i = 0; i < count; i++) widest = fmax(widest, hypot(holds->outline[i][0], holds->outline[i][1]));
    if (!(widest > 0)) return;
    Vec2 *points = mem_alloc((size_t)count + 1, sizeof *points);
    for (int i = 0; i <= count; i++) {
        const double *at = holds->outline[i % count];
        points[i] = beside(hold, camera, from, REACH / widest * at[0], REACH / widest * at[1]);
    }
    canvas_polyline(canvas, points, count + 1, (Pen){page_ink, OUTLINE, 0});
    mem_free(points);
}

static void draw_frame(Canvas *canvas, const Holds *holds, const Hold *hold, const Camera *camera, Vec2 from)
{
    draw_outline(canvas, holds, hold, camera, from);
    for (int k = 0; k < 2; k++)
        canvas_line(canvas, from, beside(hold, camera, from, k ? 0 : AXIS, k ? AXIS : 0),
                    (Pen){axes[k], LINE, 0});
}

static void draw_way(Canvas *canvas, const Hold *hold, const Camera *camera, Vec2 origin)
{
    if (hold->way_count < 2) return;
    Vec2 *points = mem_alloc((size_t)hold->way_count, sizeof *points);
    for (int i = 0; i < hold->way_count; i++) {
        Vec3 seen = camera_project(camera, vec3_load(hold->way[i]));
        points[i] = (Vec2){origin.x + seen.x, origin.y + seen.y};
    }
    canvas_polyline(canvas, points, hold->way_count, (Pen){page_ink, WAY, DASH});
    draw_begin(canvas, points[0]);
    mem_free(points);
}

void holds_draw(Canvas *canvas, const Holds *holds, const Camera *camera, Vec2 origin)
{
    for (int k = 0; k < holds->count; k++) {
        const Hold *hold = &holds->items[k];
        Vec3 seen = camera_project(camera, vec3_load(hold->at));
        Vec2 at = {origin.x + seen.x, origin.y + seen.y};
        if (!isfinite(at.x + at.y)) continue;
        draw_way(canvas, hold, camera, origin);
        if (isfinite(hold->n1[0])) draw_frame(canvas, holds, hold, camera, at);
        holds_draw_square(canvas, at, SIDE);
    }
}
