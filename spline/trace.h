/* trace.h - curves along a field of directions. */
#pragma once
#include "spline/grid.h"
#include "spline/lanes.h"

typedef struct Points {
    Vec2 *at; /* [count] owned (mem_free) */
    int count, room;
} Points;

void points_add(Points *points, Vec2 at);

/* Where curves may run, and what is in their way. */
typedef struct Tracer {
    const SplineGrid *tone, *direction;
    const SplinePage *page;
    SplineGrid outline; /* signed distances (contour.h); no columns: the page is the region               */
    double step;        /* from point to point                                                            */
    double blank;       /* density below which nothing is drawn                                           */
    double separation;  /* of neighbours, in units of w/D                                                 */
    Lanes *lanes; /* the curves that exist; the one under way adds its points. NULL: none are in the way */
    int curve;    /* the number of the one under way                                                     */
    double turn;  /* of it, rad                                                                          */
} Tracer;

/* The spacing that neighbours should have at a place; 0 where nothing is drawn: on blank paper, outside the
 * page and within a pen's width of its edge, outside the outline and within half of that of it. */
double trace_spacing(const Tracer *tracer, Vec2 at);

/* The curve through a seed, which is in the drawn part: at most `behind` steps back from it and `total` in
 * all. It ends where nothing is drawn, where no direction is sure or it turns within less than a step or two,
 * and where it comes nearer than three quarters of the spacing to another curve or to another part of itself,
 * and after a whole turn: what winds on is drawn as rings. */
void trace_curve(Tracer *tracer, Vec2 seed, int behind, int total, Points *curve);
