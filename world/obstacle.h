/* obstacle.h - rigid things that a body meets: planes, balls, boxes, pipes, ground, meshes.
 *
 * Each is a signed distance phi(x) in its own frame, positive outside, with gradient and Hessian in closed form or of a
 * C2 spline; several are summed as energies, never by min or max, which would have kinks. Where phi is no true distance
 * (a height field, a tube along a line) |gradient| differs from 1: contact takes n = gradient/|gradient|. */
#pragma once
#include "field/cubic_grid.h"
#include "field/rigid_move.h"
#include "io/mesh_file.h"

/* phi and its derivatives at a point: m, 1, 1/m. */
typedef SpaceSample Gap;

typedef struct ObstacleOps {
    const char *kind; /* as in a scene: "sphere" */

    /* At a point in the obstacle's own frame. Re-entrant. */
    void (*gap)(const void *self, const double x[3], Gap *gap);

    /* Adds triangles of where phi = 0, about within a box, in its own frame (obstacle_surface). */
    void (*surface)(const void *self, const double box[2][3], MeshFile *surface);
    void (*destroy)(void *self);
} ObstacleOps;

typedef struct Obstacle {
    char *name; /* owned */
    const ObstacleOps *ops;
    void *self;
    double
        feature; /* m, the smallest radius or detail: a body's longer edges are sampled between their ends too;
                      * INFINITY: flat */
    double
        inradius; /* m, of the ball within it where it is thinnest: half as deep, a body is about to come out on its other
                      * side; INFINITY: it has none */
    double steepest;           /* largest |grad phi|; 0: 1 */
    bool bounded;              /* it ends: all of it is within a box along its own axes */
    double middle[3], half[3]; /* m: that box                                                          */
    RigidMove motion;          /* about its pivot                              */
} Obstacle;

/* False and a sentence, which names the obstacle, where a formula is not finite. Re-entrant. */
bool obstacle_pose(const Obstacle *obstacle, double time, RigidPose *pose, Error *err);

/* Is phi > distance >= 0 there, as the box around the obstacle tells? Where it is not, only phi does. Much cheaper than the
 * gap: most places of a body are far from what is small. Re-entrant. */
bool obstacle_is_beyond(const Obstacle *obstacle, const RigidPose *pose, const double x[3], double distance);

/* Its gap in space, there. Re-entrant. */
void obstacle_gap(const Obstacle *obstacle, const RigidPose *pose, const double x[3], Gap *gap);

/* Triangles of where phi = 0 in its own frame, for pictures: of what is endless (a plane, a cylinder, ground) a piece about
 * as large as the box there, its lowest and highest corner; of all else the whole. At most 16384, but of a mesh as many as it
 * has. Their normals point to where it is free; patches have vertices of their own. Clear it (mesh_file_clear). */
void obstacle_surface(const Obstacle *obstacle, const double box[2][3], MeshFile *surface);

/* Frees what it holds. */
void obstacle_clear(Obstacle *obstacle);
