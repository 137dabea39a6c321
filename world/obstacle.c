#include "world/obstacle.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

bool obstacle_pose(const Obstacle *obstacle, double time, RigidPose *pose, Error *err)
{
    return rigid_move_pose(&obstacle->motion, time, pose, err) ||
           error_prefix(err, "obstacle '%s'", obstacle->name);
}

bool obstacle_is_beyond(const Obstacle *obstacle, const RigidPose *pose, const double x[3], double distance)
{
    const double rounding = 1e-9; /* of the gap's own arithmetic, and more */
    double own[3];
    if (!obstacle->bounded) return false;
    rigid_own_place(pose, x, own);
    for (int i = 0; i < 3; i++)
        if (fabs(own[i] - obstacle->middle[i]) > (1 + rounding) * (obstacle->half[i] + distance)) return true;
    return false;
}

void obstacle_gap(const Obstacle *obstacle, const RigidPose *pose, const double x[3], Gap *gap)
{
    double own[3], gradient[3], half[3][3];
    rigid_own_place(pose, x, own);
    obstacle->ops->gap(obstacle->self, own, gap);
    if (!timed_is_given(&obstacle->motion.turn)) return; /* its axes are those of space */
    memcpy(gradient, gap->gradient, sizeof gradient);
    for (int i = 0; i < 3; i++) {
        gap->gradient[i] = 0;
        for (int j = 0; j < 3; j++) {
            gap->gradient[i] += pose->turn[i][j] * gradient[j];
            half[i][j] = 0;
            for (int k = 0; k < 3; k++) half[i][j] += pose->turn[i][k] * gap->hessian[k][j];
        }
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            gap->hessian[i][j] = 0;
            for (int k = 0; k < 3; k++) gap->hessian[i][j] += half[i][k] * pose->turn[j][k];
        }
}

void obstacle_surface(const Obstacle *obstacle, const double box[2][3], MeshFile *surface)
{
    *surface = (MeshFile){.path = mem_text(obstacle->name)};
    obstacle->ops->surface(obstacle->self, box, surface);
}

void obstacle_clear(Obstacle *obstacle)
{
    if (obstacle->ops) obstacle->ops->destroy(obstacle->self);
    rigid_move_clear(&obstacle->motion);
    mem_free(obstacle->name);
    *obstacle = (Obstacle){0};
}
