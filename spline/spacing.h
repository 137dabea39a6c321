/* spacing.h - how evenly strokes are spaced: part of metrics.h, where the figures are defined. */
#pragma once
#include "spline/grid.h"
#include "spline/page.h"
#include "spline/strokes.h"

typedef struct SplineSpacing {
    SplinePage page;
    int columns, rows;
    double *density; /* [rows][columns] of the target, blurred; at pixel centres */
} SplineSpacing;

SplineSpacing spacing_create(const SplinePage *page, const SplineGrid *target);
void spacing_clear(SplineSpacing *spacing);

/* Every stroke gets points half a pen width apart; each fourth one is asked for its nearest point of another
 * stroke. Zeros where there are not two strokes. */
void spacing_measure(const SplineSpacing *spacing, const Strokes *strokes, double *mean, double *cv,
                     double *crowded);
