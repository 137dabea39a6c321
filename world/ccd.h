/* ccd.h - how far two features may move along straight ways and not come too near: conservative advancement
 * [Li, Kaufman, Jiang 2021, "Codimensional Incremental Potential Contact", 5].
 *
 * No point of one can come nearer to a point of the other than the fastest of their vertices do, relative to each other: so
 * they go on by what is left of the distance, over and over. */
#pragma once
#include "world/distance.h"

/* The largest part of the ways to[] - from[], up to `most`, found on which the distance stays above `keep` of what it is at
 * the beginning; 0 < keep < 1. Never more; `most` where they do not come near, or touch from the beginning. Of two edges, or
 * of a point and a triangle. */
double ccd_reach(DistanceOf *distance, const double from[DISTANCE_DOFS], const double to[DISTANCE_DOFS],
                 double keep, double most);
