/* reference.h - of a trajectory, what its objectives of points ask for, and where these points went, for pictures and for
 * those who plot: arrays trajectory/.. (docs/result.md). */
#pragma once
#include "io/arrays.h"
#include "optim/case.h"
#include "optim/trajectory_adjoint.h"

/* trajectory/followed: the points; trajectory/reference/..: a row for each waypoint and curve of the case. Nothing where it has
 * none. Of the best motion, at the start and after each step. */
void reference_add(const Case *c, Trajectory *t, int steps, Arrays *list);
