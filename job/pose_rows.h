/* pose_rows.h - poses as results have them: rows of 3x4 matrices (R | s), x = R X + s. */
#pragma once
#include "field/rigid_move.h"
#include <string.h>

static inline void pose_put_row(const RigidPose *pose, double row[12])
{
    for (int i = 0; i < 3; i++) {
        memcpy(row + 4 * i, pose->turn[i], 3 * sizeof *row);
        row[4 * i + 3] = pose->shift[i];
    }
}
