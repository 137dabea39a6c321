/* lanes.h - which curves pass near a place: samples along curves in grids of cells of doubling size. */
#pragma once
#include "base/vec3.h"
#include "spline/page.h"
#include <stdbool.h>

typedef struct Lanes Lanes;

/* Curves will be sampled every `step`; distances up to `reach` will be asked for. */
Lanes *lanes_create(const SplinePage *page, double step, double reach);
void lanes_destroy(Lanes *lanes);

/* A sample of the newest curve, the `along`-th from its start (may be negative). */
void lanes_add(Lanes *lanes, Vec2 at, int curve, int along);

/* Removes the newest samples until only so many are left. */
int lanes_count(const Lanes *lanes);
void lanes_shrink(Lanes *lanes, int count);

/* Is a curve nearer than `distance`? Of the curve `own`, samples less than `gap` steps from `along` are
 * passed over. Distances are to samples, at most 3 % too long. */
bool lanes_near(const Lanes *lanes, Vec2 at, double distance, int own, int along, int gap);
