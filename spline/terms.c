#include "spline/terms.h"
#include <math.h>

#define X(name, pen, spacing) {#name, spline_##name##_term, 0, pen, spacing},
#define Y(name, pen, spacing) {#name, 0, spline_##name##_bulk, pen, spacing},
const SplineTermRow spline_term_rows[] = {SPLINE_TERMS(X) SPLINE_BULKS(Y)};
#undef X
#undef Y

_Static_assert(sizeof spline_term_rows / sizeof *spline_term_rows == SPLINE_WEIGHT_COUNT,
               "each energy has a weight, at the same place");

SplineWeights spline_weights_default(void)
{
    return (SplineWeights){.tone = 1, .strain = 0.05, .bend = 0.05, .align = 0.1, .wall = 0.02};
}

SplineWeights spline_weights_scaled(SplineWeights weights, double pen, double spacing)
{
    double *values = (double *)&weights;
    for (int k = 0; k < SPLINE_WEIGHT_COUNT; k++)
        values[k] *= pow(pen, spline_term_rows[k].pen) * pow(spacing, spline_term_rows[k].spacing);
    return weights;
}
