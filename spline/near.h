/* near.h - the nearest of many points in the plane: a grid of cells, searched in growing rings. */
#pragma once
#include "base/vec3.h"

typedef struct Near Near;

/* Points are copied; group[i] >= 0 (copied) tells which belong together. */
Near *near_create(const Vec2 *points, const int *group, int count);
void near_destroy(Near *near);

/* Later searches do not find the point. */
void near_remove(Near *near, int point);

/* Up to `most` points nearest to `at`, ascending by distance, then by number, none farther than `reach`, none
 * of the group `skip` (-1: all groups). Returns how many; their numbers are in found[]. */
int near_find(const Near *near, Vec2 at, int skip, double reach, int most, int *found);
