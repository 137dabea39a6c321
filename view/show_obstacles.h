/* show_obstacles.h - the obstacles of a result, and the magnets and coils around, as its pictures draw them: seen from where
 * they are free only, so that one looks into a pipe and from above onto what stands on a floor. Obstacles are plain, magnets
 * red at their north pole and blue at their south pole, coils of copper. */
#pragma once
#include "view/raster.h"
#include "view/show_data.h"

typedef struct ShowObstacle {
    int point_count, face_count;
    const double (*points)[3]; /* m, in its own frame */
    const int (*faces)[3];
    const double *pole;      /* [face] of a magnet or coil: 1 north .. -1 south; NULL: an obstacle */
    const char *name, *kind; /* "floor"; "magnet", .. */
} ShowObstacle;

typedef struct ShowObstacles {
    ShowData *data; /* keeps all */
    int count;      /* 0: there are none, and nothing below */
    int obstacles;  /* those of them that are obstacles, the first ones */
    ShowObstacle *list;
    int point_count, face_count, (*faces)[3]; /* of all, one after the other */
    Color *colors;                            /* [face_count] */
} ShowObstacles;

/* False and a sentence where they are not as slender writes them. */
bool show_obstacles_read(ShowObstacles *obstacles, ShowData *data, Error *err);

/* Where they are in a frame (-1: the last): a 3x4 matrix (R | s) by rows for each, x = R X + s; NaN: not there. Kept in the data. */
const double (*show_obstacles_poses(const ShowObstacles *obstacles, int frame))[12];

/* The colour of its face. */
Color show_obstacle_color(const ShowObstacle *obstacle, int face);

/* Where they are in a frame; -1: the last. */
Surroundings show_obstacles_at(const ShowObstacles *obstacles, int frame);

/* The box that some points are in, NaN aside. */
typedef struct ShowWay {
    Vec3 low, high;
} ShowWay;

ShowWay show_way(void);
void show_way_add(ShowWay *way, const double (*points)[3], int count);

/* Finds the points of those that are not much larger than the way of the body and near it: a picture shows them whole. */
void show_obstacles_find_near(const ShowObstacles *obstacles, ShowWay way, Surroundings *around);
