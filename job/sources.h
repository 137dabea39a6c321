/* sources.h - what a result shows of magnets and coils: what they look like, and where they are in each frame; and what a run
 * says of them. */
#pragma once
#include "job/run.h"

/* source_names and, for each that has a shape, sources/NAME/kind, points, faces and pole [face], how much of a north (1) or
 * south pole (-1) it is, in its own frame. */
void sources_add(const Model *model, Arrays *list);

/* Of a frame: source_pose [source][12], rows of 3x4 matrices (R | s), x = R X + s; NaN where the frame's load case is without
 * it. Nothing where there are none. */
void sources_add_poses(const Model *model, const Snapshot *shot, Arrays *list);

/* Of a frame: flux_uniform [3] T, the part of the flux density that is the same everywhere, and flux_sources [field][7], what the
 * others are then: the factor on what the scene says, how far they are moved (m) and turned (a rotation vector, rad) beyond where
 * it has them. Nothing where there are no others. */
void sources_add_numbers(const Model *model, const Snapshot *shot, Arrays *list);

/* Warns of each magnet and coil that the body is in, or at the winding of, the first time that it is: in a step of time, or in
 * the frame of that number. */
void sources_tell_within(Run *run, const Snapshot *shot, int frame);
