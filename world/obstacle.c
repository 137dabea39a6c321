#include "world/obstacle.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

/* Of a rotation vector [Rodrigues]. */
static void rotation(const double w[3], double R[3][3])
{
    double angle = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    double s = angle > 0 ? sin(angle) / angle : 1, h = angle > 0 ? sin(angle / 2) / angle : 0.5,
           c = 2 * h * h;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            R[i][j] = c * w[i] * w[j];
            if (i == j) R[i][j] += cos(angle);
        }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        R[j][i] += s * w[k];
        R[i][j] -= s * w[k];
    }
}

bool obstacle_pose(const Obstacle *obstacle, double time, ObstaclePose *pose, Error *err)
{
    double move[3] = {0}, turn[3] = {0};
    if (obstacle->move && !formula_eval(obstacle->move, &time, move, err))
        return error_prefix(err, "obstacle '%s': move", obstacle->name);
    if (obstacle->turn && !formula_eval(obstacle->turn, &time, turn, err))
        return error_prefix(err, "obstacle '%s': turn", obstacle->name);
    rotation(turn, pose->turn);
    for (int i = 0; i < 3; i++) {
        pose->shift[i] = obstacle->pivot[i] + move[i];
        for (int j = 0; j < 3; j++) pose->shift[i] -= pose->turn[i][j] * obstacle->pivot[j];
    }
    return true;
}

void obstacle_own_place(const ObstaclePose *pose, const double x[3], double own[3])
{
    for (int i = 0; i < 3; i++) {
        own[i] = 0;
        for (int j = 0; j < 3; j++) own[i] += pose->turn[j][i] * (x[j] - pose->shift[j]);
    }
}

bool obstacle_is_beyond(const Obstacle *obstacle, const ObstaclePose *pose, const double x[3],
                        double distance)
{
    const double rounding = 1e-9; /* of the gap's own arithmetic, and more */
    double own[3];
    if (!obstacle->bounded) return false;
    obstacle_own_place(pose, x, own);
    for (int i = 0; i < 3; i++)
        if (fabs(own[i] - obstacle->middle[i]) > (1 + rounding) * (obstacle->half[i] + distance)) return true;
    return false;
}

void obstacle_gap(const Obstacle *obstacle, const ObstaclePose *pose, const double x[3], Gap *gap)
{
    double own[3], gradient[3], half[3][3];
    obstacle_own_place(pose, x, own);
    obstacle->ops->gap(obstacle->self, own, gap);
    if (!obstacle->turn) return; /* its axes are those of space */
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

void obstacle_clear(Obstacle *obstacle)
{
    if (obstacle->ops) obstacle->ops->destroy(obstacle->self);
    formula_destroy(obstacle->move);
    formula_destroy(obstacle->turn);
    mem_free(obstacle->name);
    *obstacle = (Obstacle){0};
}
