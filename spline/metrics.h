/* metrics.h - how well a drawing shows its target: tone, spacing of the lines, ink, way of the lifted pen.
 *
 * Tone is compared as an eye far away sees it: drawing and target blurred by a Gaussian with sigma = 1.5
 * hbar, hbar = pen/mean(target) the mean distance of lines that would give the target's tone, mirrored at the
 * edges of the page. [line_metric.py of the project's benchmark; Lagae et al. 2008 for spacing by nearest
 * neighbours] */
#pragma once
#include "spline/grid.h"
#include "spline/page.h"
#include "spline/strokes.h"

typedef struct SplineMetrics {
    double ink_length;  /* of all strokes, in units of the page                         */
    double ink_budget;  /* mean(target)/pen: the length that gives the target's tone    */
    double ink, target; /* mean covered part of the page, mean of the target            */
    double tone_rmse;   /* root mean square of the difference of the blurred pictures   */
    double tone_scaled; /* the same after the drawing's tone is multiplied by the best factor: blind to too
                           much or too little ink */
    double ssim; /* structural similarity of the blurred pictures [Wang et al. 2004], Gaussian windows of the
                    same sigma, c1 = 1e-4, c2 = 9e-4; 1 at best */
    double spacing_mean;    /* distance from points of a stroke to the nearest other stroke, over pen/target
                               there    (a target blurred by 0.02 and at least 0.03); 1 at best */
    double spacing_cv;      /* its standard deviation over its mean                         */
    double crowded;         /* part of the points where it is below 0.35                    */
    double travel_over_ink; /* from stroke to stroke in their order, over ink_length     */
} SplineMetrics;

/* A target made ready to be compared with. */
typedef struct SplineJudge SplineJudge;

/* The target's first numbers are densities: 0 white, 1 covered with ink. It is not needed afterwards. A mean
 * density below 0.001 counts as 0.001. */
SplineJudge *spline_judge_create(const SplinePage *page, const SplineGrid *target);
void spline_judge_destroy(SplineJudge *judge);

/* tone_rmse alone: the cheapest figure, for every few iterations of a relaxation. */
double spline_judge_tone(SplineJudge *judge, const Strokes *strokes);

/* All of them. Figures of spacing are 0 where there are not two strokes, ratios to ink where there is none.
 */
SplineMetrics spline_judge_measure(SplineJudge *judge, const Strokes *strokes);
