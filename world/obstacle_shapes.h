/* obstacle_shapes.h - the obstacles there are.
 *
 * Each begins where it is given, without name or motion, and turns about the place that is said. Clear it
 * (obstacle_clear). Lengths in m. */
#pragma once
#include "io/mesh_file.h"
#include "world/obstacle.h"

/* A half space: free where the normal (not 0) points to. Turns about the point. */
Obstacle obstacle_plane(const double point[3], const double normal[3]);

/* A ball, or inside of one is free. Turns about its centre. */
Obstacle obstacle_sphere(const double center[3], double radius, bool inside);

/* An infinite cylinder along an axis (not 0), or a pipe: inside is free. Turns about the point. */
Obstacle obstacle_cylinder(const double point[3], const double axis[3], double radius, bool inside);

/* A box whose edges and corners are rounded, 0 < rounding <= half[i]: without, its normal would jump at the edges. Turns
 * about its centre. */
Obstacle obstacle_box(const double center[3], const double half[3], double rounding);

/* Ground: phi = z - h(x, y), h the bicubic spline through height[cells[0] + 1][cells[1] + 1], row after row along x,
 * over range[0]..range[1] (x, y). Beyond the range it goes on level: h is there what its last cell's polynomial is one
 * cell beyond the edge, which it reaches within two (cubic_grid.h). Turns about the middle of the range, z = 0. */
Obstacle obstacle_height_field(const double range[2][2], const int cells[2], const double *height);

/* A tube along a coordinate axis (0, 1, 2), inside is free: phi = R(s) - |w - c(s)|, s along the axis, w and c the other
 * two coordinates in their order; R and c cubic splines through sample[cells + 1] = {R, c1, c2} over range[0]..range[1].
 * Beyond the range it goes straight on, as wide as it is there. False with a sentence where R is not positive. Turns
 * about its centre line's middle. */
bool obstacle_tube(int axis, const double range[2], int cells, const double (*sample)[3], Obstacle *obstacle,
                   Error *err);

/* What a closed triangle mesh encloses: its signed distance at the nodes of a grid with that cell (NAN: 1/48 of the mesh's
 * diagonal) that reaches six cells beyond it, and a tricubic spline through them: corners are round on the scale of a cell,
 * what is thinner is lost, and deep inside, where several faces are as near, the gradient may vanish. Beyond the grid it is
 * as near the grid's edge plus the distance from there, smoothed over a cell. Vertices at equal places are one. A mesh that
 * is inside out is turned; one that crosses itself has the distance of its faces, inside too. False with a sentence: a mesh
 * that is not closed, whose faces do not agree on its outside or that is no surface otherwise (surface/mesh.h), a grid of
 * too many nodes, or one with none inside. Turns about its box's middle. */
bool obstacle_mesh(const MeshFile *file, double cell, Obstacle *obstacle, Error *err);
