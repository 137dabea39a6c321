#include "spline/terms.h"
#include <math.h>

#define X(name, scale, pen, spacing) {#name, spline_##name##_term, 0, scale, pen, spacing},
#define Y(name, scale, pen, spacing) {#name, 0, spline_##name##_bulk, scale, pen, spacing},
const SplineTermRow spline_term_rows[] = {SPLINE_TERMS(X) SPLINE_BULKS(Y)};
#undef X
#undef Y

_Static_assert(sizeof spline_term_rows / sizeof *spline_term_rows == SPLINE_WEIGHT_COUNT,
               "each energy has a weight, at the same place");

SplineWeights spline_weights_default(void)
{
    return (SplineWeights){.tone = 1, .strain = 0.5, .bend = 0.1, .align = 0.5, .wall = 0.1};
}

SplineWeights spline_weights_scaled(SplineWeights weights, double pen, double spacing)
{
    double *values = (double *)&weights;
    for (int k = 0; k < SPLINE_WEIGHT_COUNT; k++) {
        const SplineTermRow *row = &spline_term_rows[k];
        values[k] *= row->scale * pow(pen, row->pen) * pow(spacing, row->spacing);
    }
    return weights;
}
