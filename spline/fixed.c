#include "spline/fixed.h"
#include "spline/tone.h"
#include <math.h>

static double counted_at(const SplineFixed *fixed, const SplinePage *page, Vec2 at)
{
    double counted = 1;
    if (fixed->counts.columns) spline_grid_sample(&fixed->counts, page, at, &counted);
    return counted;
}

double spline_fixed_length(const SplineFixed *fixed, const SplinePage *page)
{
    const Strokes *strokes = fixed->strokes;
    double length = 0;
    for (int k = 0; strokes && k < strokes->count; k++)
        for (int first = strokes->start[k], end = strokes->start[k + 1] - 1, node = first; node < end;
             node++) {
            const double *p = strokes->q + 4 * node;
            double own = strokes_segment_length(strokes, node) +
                         M_PI / 8 * fixed->pen * ((node == first) + (node + 1 == end));
            length += own * counted_at(fixed, page, (Vec2){(p[0] + p[4]) / 2, (p[1] + p[5]) / 2});
        }
    return length * fixed->pen / page->pen;
}

static void take_level(const SplineFixed *fixed, const Tone *tone, const ProbeLevel *level,
                       SplineTarget *target)
{
    for (int j = 0; j < level->rows; j++)
        for (int i = 0; i < level->columns; i++) {
            long k = level->first + (long)j * level->stride + i;
            if (target->probes->inverse[k] == 0) continue;
            Vec2 at = {(i + 0.5) * level->dx, (j + 0.5) * level->dy};
            target->probes->target[k] -= counted_at(fixed, &target->page, at) * tone->ink[k];
        }
}

void spline_fixed_take_ink(const SplineFixed *fixed, SplineTarget *target)
{
    if (!fixed->strokes || !fixed->strokes->count) return;
    Tone tone = tone_of_strokes(target, fixed->strokes, fixed->pen);
    for (int l = 0; l < target->probes->level_count; l++)
        take_level(fixed, &tone, &target->probes->levels[l], target);
    tone_clear(&tone);
    target->density -= spline_fixed_length(fixed, &target->page) * target->page.pen;
}
