/* obstacle.h - rigid things that a body meets: planes, balls, boxes, pipes, ground, meshes.
 *
 * Each is a signed distance phi(x) in its own frame, positive outside, with gradient and Hessian in closed form or of a
 * C2 spline; several are summed as energies, never by min or max, which would have kinks. Where phi is no true distance
 * (a height field, a tube along a line) |gradient| differs from 1: contact takes n = gradient/|gradient|. */
#pragma once
#include "io/formula.h"
#include "io/mesh_file.h"

/* phi and its derivatives at a point: m, 1, 1/m. */
typedef struct Gap {
    double value, gradient[3], hessian[3][3];
} Gap;

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
    double pivot[3];           /* m, about which it turns                        */
    /* Three expressions of the time t each: how far it has moved, m, and turned, a rotation vector, rad; NULL: not. Owned. */
    Formula *move, *turn;
} Obstacle;

/* Where an obstacle is: what was at X is at turn (X - pivot) + pivot + move. */
typedef struct ObstaclePose {
    double turn[3][3], shift[3]; /* x = turn X + shift */
} ObstaclePose;

/* False and a sentence, which names the obstacle, where a formula is not finite. Re-entrant. */
bool obstacle_pose(const Obstacle *obstacle, double time, ObstaclePose *pose, Error *err);

/* The place in the obstacle's own frame of one in space. */
void obstacle_own_place(const ObstaclePose *pose, const double x[3], double own[3]);

/* Is phi > distance >= 0 there, as the box around the obstacle tells? Where it is not, only phi does. Much cheaper than the
 * gap: most places of a body are far from what is small. Re-entrant. */
bool obstacle_is_beyond(const Obstacle *obstacle, const ObstaclePose *pose, const double x[3],
                        double distance);

/* Its gap in space, there. Re-entrant. */
void obstacle_gap(const Obstacle *obstacle, const ObstaclePose *pose, const double x[3], Gap *gap);

/* Triangles of where phi = 0 in its own frame, for pictures: of what is endless (a plane, a cylinder, ground) a piece about
 * as large as the box there, its lowest and highest corner; of all else the whole. At most 16384, but of a mesh as many as it
 * has. Their normals point to where it is free; patches have vertices of their own. Clear it (mesh_file_clear). */
void obstacle_surface(const Obstacle *obstacle, const double box[2][3], MeshFile *surface);

/* Frees what it holds. */
void obstacle_clear(Obstacle *obstacle);
