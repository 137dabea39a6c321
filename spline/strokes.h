/* strokes.h - the strokes of a drawing: C1 splines of cubic segments, all in one flat vector.
 *
 * A stroke of n segments has n + 1 nodes (p, v); segment k runs from p_k to p_(k+1), and as a Bezier curve
 * has the control points p_k, p_k + v_k, p_(k+1) - v_(k+1), p_(k+1), so that r'(k) = 3 v_k [Linewise]. Dofs
 * of a node are four: p.x, p.y, v.x, v.y, in units of the page (page.h). */
#pragma once
#include "base/vec3.h"

typedef struct Strokes {
    int count;
    int *start;          /* [count + 1] first node of each stroke; at least two nodes each; owned */
    int *layer;          /* [count] pen or tone that draws it, from 0; owned                      */
    double *q;           /* [start[count]][4] owned                                               */
    int room, node_room; /* strokes and nodes that there is room for, if more            */
} Strokes;

static inline int strokes_node_count(const Strokes *strokes)
{
    return strokes->count ? strokes->start[strokes->count] : 0;
}

static inline int strokes_segment_count(const Strokes *strokes)
{
    return strokes_node_count(strokes) - strokes->count;
}

/* Appends a stroke of so many nodes, which the caller fills in before the next one. */
double (*strokes_extend(Strokes *strokes, int nodes, int layer))[4];

/* Appends a stroke of so many nodes (copied). strokes may be zeroed before the first one. */
void strokes_add(Strokes *strokes, int nodes, const double (*q)[4], int layer);

/* Appends one stroke of others; all of others, as strokes of one layer. */
void strokes_add_from(Strokes *strokes, const Strokes *from, int stroke);
void strokes_append(Strokes *strokes, const Strokes *more, int layer);

/* Those of one layer, alone; the caller frees. */
Strokes strokes_of_layer(const Strokes *strokes, int layer);

/* A copy; and frees what it owns. */
Strokes strokes_copy(const Strokes *strokes);
void strokes_clear(Strokes *strokes);

/* The four control points of the segment that begins at that node (not the last one of a stroke). */
void strokes_bezier(const Strokes *strokes, int node, Vec2 control[4]);

/* Length of a segment, of a stroke, of all: five-point Gauss quadrature. */
double strokes_segment_length(const Strokes *strokes, int node);
double strokes_stroke_length(const Strokes *strokes, int stroke);
double strokes_length(const Strokes *strokes);
