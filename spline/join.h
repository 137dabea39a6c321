/* join.h - strokes whose ends all but meet become one, so that the pen need not lift.
 *
 * End 2k is the beginning of stroke k, end 2k + 1 its other end. Two ends may be joined where they are at
 * most `gap` apart and one stroke goes on as the other does: the turn from one end's direction to the other's
 * is at most `angle`, and so is, on either side, the turn from the joint's direction to the chord of the
 * segment that ends there. The two nodes become one in the middle between them; its direction is the mean,
 * its speed |v| the lesser of both, so that no segment can overshoot. The joined stroke is C1 like any other.
 * Of a gap of a pen's width nothing is seen: round ends overlap there, and each moves by half of it at most.
 */
#pragma once
#include "spline/grid.h"
#include "spline/strokes.h"
#include <stdbool.h>

typedef struct JoinDef {
    double gap;                /* in units of the page; 0: nothing is joined, even where ends meet */
    double angle;              /* rad */
    const SplineGrid *outline; /* no joint leads out of it (contour.h); NULL: any may; borrowed */
    const SplinePage *page;    /* of that */
} JoinDef;

Vec2 join_end(const Strokes *strokes, int end);

/* partner[2 count] of ends: the end that it is joined to, -1: none. Ends of one layer only, each end once,
 * nearest pairs first. A stroke that comes back to within two gaps of its beginning closes on itself or not
 * at all: joined to others, rings would become spirals. Returns how many pairs. */
int join_find(const Strokes *strokes, JoinDef def, int *partner);

/* The node (p, v) that takes the place of both ends, as seen by a pen that arrives at end a and goes on from
 * end b. false where they do not go on as each other. */
bool join_node(const Strokes *strokes, int a, int b, double angle, double node[4]);
