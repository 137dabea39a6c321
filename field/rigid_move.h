/* rigid_move.h - rigid things that follow formulas of the time: obstacles, magnets, coils. */
#pragma once
#include "field/timed.h"

/* What was at X is at turn (X - pivot) + pivot + move. */
typedef struct RigidMove {
    double pivot[3];  /* m, about which it turns                                                       */
    Timed move, turn; /* how far it has moved, m, and turned, a rotation vector, rad; owned           */
} RigidMove;

typedef struct RigidPose {
    double turn[3][3], shift[3]; /* x = turn X + shift */
} RigidPose;

/* The rotation of a rotation vector [Rodrigues]. */
void rigid_rotation(const double w[3], double R[3][3]);

/* J dw is the angular velocity with which that rotation changes as w does. */
void rigid_turn_rates(const double w[3], double J[3][3]);

static inline bool rigid_move_is_given(const RigidMove *move)
{
    return timed_is_given(&move->move) || timed_is_given(&move->turn);
}

/* How far it has moved and turned, 0 where nothing says so; and where it then is. False and a sentence where a formula is not
 * finite. Re-entrant. */
bool rigid_move_vectors(const RigidMove *move, double time, double moved[3], double turned[3], Error *err);
bool rigid_move_pose(const RigidMove *move, double time, RigidPose *pose, Error *err);

/* The place in the thing's own frame of one in space. */
void rigid_own_place(const RigidPose *pose, const double x[3], double own[3]);

/* Frees what it holds. */
void rigid_move_clear(RigidMove *move);
