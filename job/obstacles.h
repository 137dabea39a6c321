/* obstacles.h - what a result shows of obstacles: their surfaces, and where those that move are in each frame. */
#pragma once
#include "job/run.h"

/* Under the journal's kind "obstacles", in the place of what is there: obstacle_names and, for each, NAME/kind, points and
 * faces, in its own frame. Of what is endless a piece around all that the obstacle sees of the body: at rest, at its
 * start, and in the frames so far. */
bool obstacles_put(const Run *run, Error *err);

/* Of a frame: obstacle_pose [obstacle][12], rows of 3x4 matrices (R | s), x = R X + s; nothing where all stand still. */
void obstacles_add_poses(const Model *model, double time, Arrays *list);
