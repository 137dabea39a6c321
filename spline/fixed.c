#include "spline/fixed.h"
#include "spline/tone.h"
#include <math.h>

/* Their area: lines with half a disc beyond each end. */
static double area(const SplineFixed *fixed)
{
    if (!fixed->strokes) return 0;
    return fixed->pen * (strokes_length(fixed->strokes) + fixed->strokes->count * M_PI / 4 * fixed->pen);
}

double spline_fixed_length(const SplineFixed *fixed, double pen)
{
    return fixed->share * area(fixed) / pen;
}

void spline_fixed_take_ink(const SplineFixed *fixed, SplineTarget *target)
{
    Probes *probes = target->probes;
    if (!fixed->strokes || !fixed->strokes->count || fixed->share == 0) return;
    Tone tone = tone_of_strokes(target, fixed->strokes, fixed->pen);
    for (long k = 0; k < probes->size; k++)
        if (probes->inverse[k] != 0) probes->target[k] -= fixed->share * tone.ink[k];
    tone_clear(&tone);
    target->density -= fixed->share * area(fixed);
}
