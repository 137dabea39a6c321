#include "spline/along.h"
#include "base/memory.h"
#include <math.h>
#include <stdbool.h>

/* A polyline with the length of it up to each point. */
typedef struct Line {
    const Vec2 *points;
    double *along;
    int count;
} Line;

static Line line_of(const Vec2 *points, int count)
{
    Line line = {points, mem_alloc((size_t)count, sizeof *line.along), count};
    for (int i = 1; i < count; i++)
        line.along[i] =
            line.along[i - 1] + hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
    return line;
}

static Vec2 line_at(const Line *line, double at)
{
    int low = 0, high = line->count - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (line->along[middle] <= at)
            low = middle;
        else
            high = middle;
    }
    Vec2 a = line->points[low], b = line->points[high];
    double s = fmin(fmax((at - line->along[low]) / fmax(line->along[high] - line->along[low], 1e-300), 0), 1);
    return (Vec2){a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)};
}

static bool is_closed(const Line *line)
{
    Vec2 a = line->points[0], b = line->points[line->count - 1];
    return a.x == b.x && a.y == b.y;
}

void strokes_along(const Vec2 *points, int count, double segment, int layer, Strokes *strokes)
{
    Line line = line_of(points, count);
    double length = line.along[count - 1];
    bool closed = is_closed(&line);
    int segments = (int)fmax(lround(length / segment), closed ? 3 : 1);
    double each = length / segments;
    double(*q)[4] = length > 0 ? strokes_extend(strokes, segments + 1, layer) : NULL;
    for (int k = 0; q && k <= segments; k++) {
        bool wraps = closed && (k == 0 || k == segments);
        double from = wraps ? length - each / 2 : fmax((k - 0.5) * each, 0),
               to = wraps ? each / 2 : fmin((k + 0.5) * each, length);
        Vec2 p = line_at(&line, k * each), a = line_at(&line, from), b = line_at(&line, to);
        double third = each / (3 * (wraps ? each : to - from));
        q[k][0] = p.x, q[k][1] = p.y;
        q[k][2] = third * (b.x - a.x), q[k][3] = third * (b.y - a.y);
    }
    mem_free(line.along);
}
