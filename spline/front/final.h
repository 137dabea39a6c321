/* final.h - what a drawing leaves: its strokes as a plotter draws them, energies and metrics. Part of
 * job_draw. */
#pragma once
#include "job/run.h"
#include "spline/front/drawing.h"

/* The strokes of the first parts, as they are, for those who look at a run that goes on. */
bool draw_put_strokes(Run *run, const Drawing *drawing, const Strokes *parts, int count, Error *err);

/* Puts the strokes of all parts in order, and all that is known of them: final/.. and metrics/..; info has
 * the energies. Says how long the plot takes. */
bool draw_finish(Run *run, const Drawing *drawing, const Strokes *parts, const RelaxInfo *info,
                 const char *status, Error *err);
