#include "spline/trace.h"
#include "base/memory.h"
#include "spline/direction.h"

static const double closest = 0.75;        /* of the spacing                */
static const double least_coherence = 0.1; /* of a direction to follow      */
static const double no_direction = 1e-3;   /* below this coherence: any will do */
static const double straight = 0.88;       /* cos of the sharpest turn in half a step */

void points_add(Points *points, Vec2 at)
{
    if (points->count == points->room) {
        int room = 2 * points->room + 256;
        points->at = mem_resize(points->at, (size_t)points->room, (size_t)room, sizeof *points->at);
        points->room = room;
    }
    points->at[points->count++] = at;
}

double trace_spacing(const Tracer *tracer, Vec2 at)
{
    const SplinePage *page = tracer->page;
    double edge = page->pen, density, depth;
    if (!(at.x >= edge && at.y >= edge && at.x <= page->width - edge && at.y <= page->height - edge))
        return 0;
    if (tracer->outline.columns) {
        spline_grid_sample(&tracer->outline, page, at, &depth);
        if (depth < page->pen / 2) return 0;
    }
    spline_grid_sample(tracer->tone, page, at, &density);
    if (density < tracer->blank) return 0;
    return tracer->separation * page->pen / density;
}

static Vec2 along(Vec2 from, double length, Vec2 v)
{
    return (Vec2){from.x + length * v.x, from.y + length * v.y};
}

/* The direction in the sense of `before`; straight on where there is none. */
static Vec2 heading(const Tracer *tracer, Vec2 at, Vec2 before, double *coherence)
{
    Vec2 v = spline_direction_at(tracer->direction, tracer->page, at, coherence);
    if (*coherence < no_direction) return before;
    return v.x * before.x + v.y * before.y < 0 ? (Vec2){-v.x, -v.y} : v;
}

static bool is_followed(double coherence)
{
    return coherence < no_direction || coherence >= least_coherence;
}

/* Steps by the midpoint rule; what is nearer along the curve than half a circle of that diameter is no
 * neighbour. */
static void trace_way(Tracer *tracer, Vec2 from, Vec2 v, int steps, int sign, Points *curve)
{
    for (int k = 1; k <= steps; k++) {
        double coherence;
        Vec2 turned = heading(tracer, along(from, tracer->step / 2, v), v, &coherence);
        Vec2 to = along(from, tracer->step, turned);
        double near = closest * trace_spacing(tracer, to);
        if (!(near > 0) || !is_followed(coherence) || v.x * turned.x + v.y * turned.y < straight) return;
        int gap = (int)(M_PI / 2 * near / tracer->step) + 2;
        if (tracer->lanes && lanes_near(tracer->lanes, to, near, tracer->curve, sign * k, gap)) return;
        if (tracer->lanes) lanes_add(tracer->lanes, to, tracer->curve, sign * k);
        points_add(curve, to);
        Vec2 next = heading(tracer, to, turned, &coherence);
        tracer->turn += sign * atan2(v.x * next.y - v.y * next.x, v.x * next.x + v.y * next.y);
        if (fabs(tracer->turn) > 2 * M_PI) return;
        v = next;
        from = to;
    }
}

void trace_curve(Tracer *tracer, Vec2 seed, int behind, int total, Points *curve)
{
    Vec2 v = spline_direction_at(tracer->direction, tracer->page, seed, NULL);
    curve->count = 0;
    tracer->turn = 0;
    if (tracer->lanes) lanes_add(tracer->lanes, seed, tracer->curve, 0);
    trace_way(tracer, seed, (Vec2){-v.x, -v.y}, behind, -1, curve);
    for (int i = 0, j = curve->count - 1; i < j; i++, j--) {
        Vec2 swap = curve->at[i];
        curve->at[i] = curve->at[j];
        curve->at[j] = swap;
    }
    points_add(curve, seed);
    trace_way(tracer, seed, v, total + 1 - curve->count, 1, curve);
}
