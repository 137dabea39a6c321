#include "spline/join.h"
#include "base/memory.h"
#include "spline/near.h"
#include "spline/outline.h"
#include <stdlib.h>

enum { CANDIDATES = 8, RING_LEAST = 3 /* segments, or its two ends would meet its middle */ };

typedef struct Pair {
    double square; /* of the distance */
    int a, b;
} Pair;

Vec2 join_end(const Strokes *strokes, int end)
{
    const double *q = strokes->q + 4 * (end & 1 ? strokes->start[end / 2 + 1] - 1 : strokes->start[end / 2]);
    return (Vec2){q[0], q[1]};
}

/* At an end: the node's place, the unit vector that leads out of the stroke, |v|, and the stroke's next node.
 */
typedef struct Tip {
    Vec2 at, out, inner;
    double speed;
} Tip;

static Tip tip(const Strokes *strokes, int end)
{
    int node = end & 1 ? strokes->start[end / 2 + 1] - 1 : strokes->start[end / 2], sign = end & 1 ? 1 : -1;
    const double *q = strokes->q + 4 * node, *inner = q - 4 * sign;
    double speed = hypot(q[2], q[3]);
    return (Tip){.at = {q[0], q[1]},
                 .out = {sign * q[2] / speed, sign * q[3] / speed},
                 .inner = {inner[0], inner[1]},
                 .speed = speed};
}

/* Whether the angle between a unit vector and any vector is at most that with the given cosine. */
static bool within(Vec2 unit, Vec2 vector, double cosine)
{
    return unit.x * vector.x + unit.y * vector.y >= cosine * hypot(vector.x, vector.y);
}

bool join_node(const Strokes *strokes, int a, int b, double angle, double node[4])
{
    Tip from = tip(strokes, a), to = tip(strokes, b);
    double cosine = cos(angle);
    Vec2 p = {0.5 * (from.at.x + to.at.x), 0.5 * (from.at.y + to.at.y)};
    Vec2 mean = {from.out.x - to.out.x, from.out.y - to.out.y};
    double length = hypot(mean.x, mean.y);
    Vec2 along = {mean.x / length, mean.y / length};
    double speed = fmin(from.speed, to.speed);
    if (!(speed > 0 && length > 0)) return false;
    node[0] = p.x;
    node[1] = p.y;
    node[2] = speed * along.x;
    node[3] = speed * along.y;
    return within(from.out, (Vec2){-to.out.x, -to.out.y}, cosine) &&
           within(along, (Vec2){p.x - from.inner.x, p.y - from.inner.y}, cosine) &&
           within(along, (Vec2){to.inner.x - p.x, to.inner.y - p.y}, cosine);
}

/* Both segments beside a joint, from their other nodes to its own, within the outline. */
static bool stays_inside(const Strokes *strokes, int a, int b, const double node[4], const JoinDef *def)
{
    for (int k = 0; def->outline && k < 2; k++) {
        int end = k ? b : a, way = k ? -1 : 1, sign = end & 1 ? 1 : -1;
        int inner = end & 1 ? strokes->start[end / 2 + 1] - 2 : strokes->start[end / 2] + 1;
        const double *q = strokes->q + 4 * inner;
        Vec2 c[4] = {{q[0], q[1]},
                     {q[0] + sign * q[2], q[1] + sign * q[3]},
                     {node[0] - way * node[2], node[1] - way * node[3]},
                     {node[0], node[1]}};
        if (spline_outline_depth(def->outline, def->page, c) < 0) return false;
    }
    return true;
}

static int by_distance(const void *left, const void *right)
{
    const Pair *l = left, *r = right;
    if (l->square != r->square) return l->square < r->square ? -1 : 1;
    if (l->a != r->a) return l->a < r->a ? -1 : 1;
    return (l->b > r->b) - (l->b < r->b);
}

/* Its ends are near each other, and it is no dash. */
static bool is_ring(const Strokes *strokes, int stroke, double gap)
{
    Vec2 a = join_end(strokes, 2 * stroke), b = join_end(strokes, 2 * stroke + 1);
    return hypot(b.x - a.x, b.y - a.y) < 2 * gap && strokes_stroke_length(strokes, stroke) > 8 * gap;
}

/* Ends of strokes, where they are, and which strokes are rings. */
typedef struct Ends {
    Vec2 *points;
    int *stroke;
    bool *ring;
    Near *near;
} Ends;

static Ends ends_create(const Strokes *strokes, double gap)
{
    size_t count = 2 * (size_t)strokes->count;
    Ends ends = {.points = mem_alloc(count, sizeof *ends.points),
                 .stroke = mem_alloc(count, sizeof *ends.stroke),
                 .ring = mem_alloc(count / 2, sizeof *ends.ring)};
    for (int e = 0; e < 2 * strokes->count; e++) {
        ends.points[e] = join_end(strokes, e);
        ends.stroke[e] = e / 2;
        ends.ring[e / 2] = is_ring(strokes, e / 2, gap);
    }
    ends.near = near_create(ends.points, ends.stroke, (int)count);
    return ends;
}

static void ends_clear(Ends *ends)
{
    near_destroy(ends->near);
    mem_free(ends->points);
    mem_free(ends->stroke);
    mem_free(ends->ring);
}

/* Each end with others within the gap; those of a ring with each other alone. */
static int find_pairs(const Strokes *strokes, JoinDef def, Pair *pairs)
{
    Ends ends = ends_create(strokes, def.gap);
    int count = 0;
    for (int e = 0; e < 2 * strokes->count; e++) {
        int found[CANDIDATES] = {e ^ 1}, most = 1;
        if (!ends.ring[e / 2]) most = near_find(ends.near, ends.points[e], e / 2, def.gap, CANDIDATES, found);
        for (int k = 0; k < most; k++) {
            Vec2 a = ends.points[e], b = ends.points[found[k]];
            double node[4], dx = b.x - a.x, dy = b.y - a.y;
            if (ends.ring[found[k] / 2] == ends.ring[e / 2] &&
                strokes->layer[found[k] / 2] == strokes->layer[e / 2] &&
                join_node(strokes, e, found[k], def.angle, node) &&
                stays_inside(strokes, e, found[k], node, &def))
                pairs[count++] = (Pair){dx * dx + dy * dy, e, found[k]};
        }
    }
    ends_clear(&ends);
    return count;
}

int join_find(const Strokes *strokes, JoinDef def, int *partner)
{
    size_t ends = 2 * (size_t)strokes->count;
    for (size_t e = 0; e < ends; e++) partner[e] = -1;
    if (!(def.gap > 0)) return 0;
    Pair *pairs = mem_alloc(CANDIDATES * ends, sizeof *pairs);
    int *far = mem_alloc(2 * ends, sizeof *far); /* of what an end's stroke has been joined to */
    int *segments = far + ends;                  /* in that */
    int count = find_pairs(strokes, def, pairs), joined = 0;
    qsort(pairs, (size_t)count, sizeof *pairs, by_distance);
    for (size_t e = 0; e < ends; e++) {
        far[e] = (int)(e ^ 1);
        segments[e] = strokes->start[e / 2 + 1] - strokes->start[e / 2] - 1;
    }
    for (int k = 0; k < count; k++) {
        int a = pairs[k].a, b = pairs[k].b, begin = far[a], end = far[b];
        bool ring = begin == b;
        if (partner[a] >= 0 || partner[b] >= 0 || (ring && segments[a] < RING_LEAST)) continue;
        partner[a] = b;
        partner[b] = a;
        far[begin] = end;
        far[end] = begin;
        segments[begin] = segments[end] = segments[a] + segments[b];
        joined++;
    }
    mem_free(pairs);
    mem_free(far);
    return joined;
}
