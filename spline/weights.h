/* weights.h - how much each energy of a drawing counts. 0 switches it off.
 *
 * In the hands of a user they are pure numbers, "energy per length of ink", that mean the same on every page
 * and with every pen; spline_weights_scaled makes of them the factors in the energies. All members are
 * doubles, in the order of SPLINE_TERMS and SPLINE_BULKS (terms.h): a SplineWeights is what the terms find in
 * Point.p. */
#pragma once

typedef struct SplineWeights {
    /* What makes good line art. */
    double strain, bend, align, wall, outline;
    /* The other energies of Linewise, corrected. */
    double stretch, curvature, potential, flow, boundary;
    /* Where strokes act on each other. */
    double tone, pair, length;
} SplineWeights;

enum { SPLINE_WEIGHT_COUNT = sizeof(SplineWeights) / sizeof(double) };

/* tone 1, strain 0.5, bend 0.1, align 0.5, wall 0.1. */
SplineWeights spline_weights_default(void);

/* Times what makes factors of them: powers of the pen's width and of the mean distance of lines, and numbers
 * (terms.h) with which the defaults give the best drawings. */
SplineWeights spline_weights_scaled(SplineWeights weights, double pen, double spacing);
