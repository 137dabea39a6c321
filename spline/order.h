/* order.h - the order in which a plotter draws strokes: layer by layer, with little way for the lifted pen.
 *
 * Ends that all but meet are joined (join.h), then each layer is put in order and strokes are turned round
 * where that helps (tour.h). The pen begins each layer at the paper's top left corner and returns there. */
#pragma once
#include "spline/grid.h"
#include "spline/strokes.h"
#include <stdbool.h>

typedef struct OrderDef {
    double join_gap;           /* ends so near are joined where they are smooth, in pen widths; 0: none */
    double join_angle;         /* greatest turn at a joint, rad */
    long work;                 /* bound of the search, about 1e9 per second */
    const SplineGrid *outline; /* no joint leads out of it (contour.h); NULL: any may; borrowed */
} OrderDef;

/* 1.75 pen widths, 45 degrees, 3e9. */
OrderDef order_default(void);

typedef struct OrderInfo {
    double before, after; /* way of the lifted pen, in units of the page */
    int joints;
    bool whole; /* false: work ended the search */
} OrderInfo;

/* The way of the lifted pen for strokes as they are. */
double order_travel(const Strokes *strokes, const SplinePage *page);

/* Replaces the strokes by the same in their new order, sorted by layer. The way is never longer than it was:
 * where nothing better was found they are only sorted by layer. */
OrderInfo order_strokes(Strokes *strokes, const SplinePage *page, OrderDef def);
