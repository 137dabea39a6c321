/* curves_layout.h - private to curves_picture: where the views and charts of a page go. */
#pragma once
#include "view/curves_view.h"

typedef struct CurvesLayout {
    int view_count;
    CurvesView views[CURVES_VIEWS_MAX]; /* with their boxes and scale */
    Box charts[CURVES_CHARTS_MAX];
    double end; /* of the lowest of them, pt */
} CurvesLayout;

/* Arranges what a scene shows below `top` so that the curves become as large as they can. False if it has no
 * point. */
bool curves_layout(const CurvesScene *scene, double top, CurvesLayout *layout);
