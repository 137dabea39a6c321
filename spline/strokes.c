#include "spline/strokes.h"
#include "base/memory.h"
#include <string.h>

/* Room for one more stroke and its nodes: more than that, so that many one by one are not copied each time.
 */
static void reserve(Strokes *strokes, int nodes)
{
    int count = strokes->count, before = strokes_node_count(strokes);
    if (count >= strokes->room) {
        size_t room = 2 * (size_t)count + 1;
        strokes->start = mem_resize(strokes->start, (size_t)count + 1, room + 1, sizeof *strokes->start);
        strokes->layer = mem_resize(strokes->layer, (size_t)count, room, sizeof *strokes->layer);
        strokes->room = (int)room;
    }
    if (before + nodes > strokes->node_room) {
        size_t room = 2 * (size_t)before + (size_t)nodes;
        strokes->q = mem_resize(strokes->q, 4 * (size_t)before, 4 * room, sizeof *strokes->q);
        strokes->node_room = (int)room;
    }
}

double (*strokes_extend(Strokes *strokes, int nodes, int layer))[4]
{
    reserve(strokes, nodes);
    int count = strokes->count, before = strokes_node_count(strokes);
    strokes->start[count] = before;
    strokes->start[count + 1] = before + nodes;
    strokes->layer[count] = layer;
    strokes->count++;
    return (double(*)[4])strokes->q + before;
}

void strokes_add(Strokes *strokes, int nodes, const double (*q)[4], int layer)
{
    memcpy(strokes_extend(strokes, nodes, layer), q, (size_t)nodes * sizeof *q);
}

void strokes_add_from(Strokes *strokes, const Strokes *from, int stroke)
{
    int first = from->start[stroke];
    strokes_add(strokes, from->start[stroke + 1] - first, (const double(*)[4])(from->q + 4 * first),
                from->layer[stroke]);
}

Strokes strokes_of_layer(const Strokes *strokes, int layer)
{
    Strokes some = {0};
    for (int k = 0; k < strokes->count; k++)
        if (strokes->layer[k] == layer) strokes_add_from(&some, strokes, k);
    return some;
}

void strokes_append(Strokes *strokes, const Strokes *more, int layer)
{
    for (int k = 0; k < more->count; k++) {
        strokes_add_from(strokes, more, k);
        strokes->layer[strokes->count - 1] = layer;
    }
}

Strokes strokes_copy(const Strokes *strokes)
{
    size_t count = (size_t)strokes->count;
    return (Strokes){.count = strokes->count,
                     .start =
                         mem_copy(strokes->start, strokes->start ? count + 1 : 0, sizeof *strokes->start),
                     .layer = mem_copy(strokes->layer, count, sizeof *strokes->layer),
                     .q = mem_copy(strokes->q, 4 * (size_t)strokes_node_count(strokes), sizeof *strokes->q)};
}

void strokes_clear(Strokes *strokes)
{
    mem_free(strokes->start);
    mem_free(strokes->layer);
    mem_free(strokes->q);
    *strokes = (Strokes){0};
}

void strokes_bezier(const Strokes *strokes, int node, Vec2 control[4])
{
    const double *a = strokes->q + 4 * node, *b = a + 4;
    control[0] = (Vec2){a[0], a[1]};
    control[1] = (Vec2){a[0] + a[2], a[1] + a[3]};
    control[2] = (Vec2){b[0] - b[2], b[1] - b[3]};
    control[3] = (Vec2){b[0], b[1]};
}

double strokes_segment_length(const Strokes *strokes, int node)
{
    static const double at[5] = {0.04691007703066800, 0.23076534494715845, 0.5, 0.76923465505284155,
                                 0.95308992296933200};
    static const double weight[5] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                     0.23931433524968324, 0.11846344252809454};
    Vec2 c[4];
    double length = 0;
    strokes_bezier(strokes, node, c);
    for (int k = 0; k < 5; k++) {
        double s = at[k], u = 1 - s, a = 3 * u * u, b = 6 * u * s, d = 3 * s * s;
        length += weight[k] * hypot(a * (c[1].x - c[0].x) + b * (c[2].x - c[1].x) + d * (c[3].x - c[2].x),
                                    a * (c[1].y - c[0].y) + b * (c[2].y - c[1].y) + d * (c[3].y - c[2].y));
    }
    return length;
}

double strokes_stroke_length(const Strokes *strokes, int stroke)
{
    double length = 0;
    for (int k = strokes->start[stroke]; k < strokes->start[stroke + 1] - 1; k++)
        length += strokes_segment_length(strokes, k);
    return length;
}

double strokes_length(const Strokes *strokes)
{
    double length = 0;
    for (int k = 0; k < strokes->count; k++) length += strokes_stroke_length(strokes, k);
    return length;
}
