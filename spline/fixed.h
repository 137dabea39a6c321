/* fixed.h - strokes that stay where they are, beside those that relax: contours. The tone counts their ink. */
#pragma once
#include "spline/strokes.h"
#include "spline/target.h"

typedef struct SplineFixed {
    const Strokes *strokes; /* borrowed; NULL: none                            */
    double pen;             /* width of their line, in units of the page       */
    SplineGrid
        counts; /* the part of their ink that is counted, at each place; no columns: all of it; borrowed */
} SplineFixed;

/* What these strokes cover is asked of no others any more: takes the ink that each probe sees, as far as it counts where
 * the probe is, out of what the probe asks for, and so out of the target's mean density. */
void spline_fixed_take_ink(const SplineFixed *fixed, SplineTarget *target);

/* The counted ink, as a length of lines of the page's pen. */
double spline_fixed_length(const SplineFixed *fixed, const SplinePage *page);
