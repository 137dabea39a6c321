/* revise.h - more strokes or fewer: by what each does to the energy.
 *
 * The change of the energy when a stroke comes or goes is exact (local.h): of its own terms, of the ink that
 * all probes around see, of its pairs. The number of strokes that a picture asks for follows from its ink
 * (spline_stroke_budget, target.h); what is here mends where the start had too many or too few. */
#pragma once
#include "spline/relax.h"

/* Takes out strokes without which the energy is less, and at least so many: in the order of what that gains,
 * each judged anew when its turn comes. Returns how many went. */
int spline_remove_strokes(const SplineTarget *target, const RelaxDef *def, int least, Strokes *strokes);

/* Appends candidates: strokes of up to so many segments of the rest length (RelaxDef) along the target's
 * directions, where within a square as wide as a stroke is long more than half a stroke of ink is missing; no
 * two in one such square. */
void spline_propose_strokes(const SplineTarget *target, const RelaxDef *def, const Strokes *strokes,
                            int segments, Strokes *candidates);

/* Takes out what is too much of the ink, puts in all candidates (of up to so many segments) and relaxes, from
 * strokes that are relaxed (*best says how). True where that lowers the energy: strokes and *best are then
 * the new ones, with iterations and seconds added up; else they stay. False, too, after the observer stopped
 * it (best->status says so). */
bool spline_refine_once(const SplineTarget *target, const RelaxDef *def, int segments, Strokes *strokes,
                        RelaxInfo *best, const RelaxObserver *observer);

/* Relaxes, and refines at most so many times, as long as the energy falls. */
RelaxInfo spline_refine(const SplineTarget *target, const RelaxDef *def, int rounds, int segments,
                        Strokes *strokes, const RelaxObserver *observer);
