#include "field/rigid_move.h"
#include <math.h>

void rigid_rotation(const double w[3], double R[3][3])
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

/* I + (1 - cos a)/a^2 [w]x + (a - sin a)/a^3 [w]x [w]x */
void rigid_turn_rates(const double w[3], double J[3][3])
{
    double square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2], angle = sqrt(square), half = sin(angle / 2);
    bool small = square < 1e-4;
    double b = small ? 0.5 - square / 24 * (1 - square / 30) : 2 * half * half / square,
           c = small ? (1 - square / 20 * (1 - square / 42)) / 6 : (1 - sin(angle) / angle) / square;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) J[i][j] = c * w[i] * w[j] + (i == j) * (1 - c * square);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        J[j][i] += b * w[k];
        J[i][j] -= b * w[k];
    }
}

bool rigid_move_vectors(const RigidMove *move, double time, double moved[3], double turned[3], Error *err)
{
    for (int i = 0; i < 3; i++) moved[i] = turned[i] = 0;
    if (timed_is_given(&move->move) && !timed_eval(&move->move, time, moved, err))
        return error_prefix(err, "move");
    return !timed_is_given(&move->turn) || timed_eval(&move->turn, time, turned, err) ||
           error_prefix(err, "turn");
}

bool rigid_move_pose(const RigidMove *move, double time, RigidPose *pose, Error *err)
{
    double moved[3], turned[3];
    if (!rigid_move_vectors(move, time, moved, turned, err)) return false;
    rigid_rotation(turned, pose->turn);
    for (int i = 0; i < 3; i++) {
        pose->shift[i] = move->pivot[i] + moved[i];
        for (int j = 0; j < 3; j++) pose->shift[i] -= pose->turn[i][j] * move->pivot[j];
    }
    return true;
}

void rigid_own_place(const RigidPose *pose, const double x[3], double own[3])
{
    for (int i = 0; i < 3; i++) {
        own[i] = 0;
        for (int j = 0; j < 3; j++) own[i] += pose->turn[j][i] * (x[j] - pose->shift[j]);
    }
}

void rigid_move_clear(RigidMove *move)
{
    timed_clear(&move->move);
    timed_clear(&move->turn);
    *move = (RigidMove){0};
}
