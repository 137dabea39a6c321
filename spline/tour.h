/* tour.h - a short way of the lifted pen through lines that may be drawn from either end.
 *
 * Greedy: always to the nearest end [Rosenkrantz, Stearns and Lewis 1977]. Then 2-opt moves (a part of the
 * way is turned round) and Or-opt moves (one to three lines move elsewhere), tried among the nearest ends
 * only, until none shortens the way [Bentley 1992]. Deterministic. */
#pragma once
#include "base/vec3.h"
#include <stdbool.h>

/* ends[2k] and ends[2k + 1] are the two ends of line k. tour[i] is the end where the i-th line begins: end
 * 2k: line k as it is, end 2k + 1: turned round. On entry it holds an order of all lines, and what comes out
 * is never longer. The pen comes from `home` and returns there.
 * work bounds the time: lines turned or moved, a second for some 1e9; false where it ended the search. */
bool tour_shorten(const Vec2 *ends, int count, Vec2 home, long work, int *tour);

/* How far the pen moves while it is lifted, from home and back to it. */
double tour_travel(const Vec2 *ends, int count, Vec2 home, const int *tour);
