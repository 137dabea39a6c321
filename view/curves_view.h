/* curves_view.h - private to curves_picture: one view of curves in space, with its scales. */
#pragma once
#include "view/curves_picture.h"
#include "view/raster.h"
#include "view/ticks.h"

enum { CURVES_VIEWS_MAX = 3 };

/* A parallel projection onto a box of the page. */
typedef struct CurvesView {
    const char *name;            /* "front"; NULL: from anywhere, without scales along its edges  */
    const char *right, *upwards; /* names of the axes along them                                  */
    Camera camera;               /* only its directions are used                                  */
    double low[2], high[2];      /* what is shown, to the right and upwards, m                    */
    UnitScale unit;              /* of the scales, the same in all views                          */
    Box box;                     /* where it lies on the page                                     */
    double scale;                /* pt per metre                                                  */
} CurvesView;

/* Room around a view's box for its name and scales, pt. */
typedef struct CurvesMargins {
    double left, above, below;
} CurvesMargins;
CurvesMargins curves_view_margins(const CurvesView *view);

/* The views that show something of the curves, each with its name and what it shows; returns how many. 0:
 * there is no point at all. */
int curves_views(const CurvesScene *scene, CurvesView views[CURVES_VIEWS_MAX]);

/* Draws a view that has its box and scale. only: the set that is shown of those that are moments; -1: all. */
void curves_view_draw(Canvas *canvas, const CurvesScene *scene, const CurvesView *view, int only);

/* Of the sets that are shown (only: as below) the last one's that has any; NULL: none has. */
const Marks *curves_marks(const CurvesScene *scene, int only);

/* The pen for a set's curves on the page. */
Pen curves_pen(const CurvesSet *set);
