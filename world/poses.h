/* poses.h - where obstacles are at the end and at the start of a step of time. */
#pragma once
#include "solve/term.h"
#include "world/obstacle.h"

typedef struct Poses {
    const Obstacle *obstacles; /* [count] borrowed                          */
    int count;
    bool moves;             /* one of them does                          */
    bool known;             /* the poses are of this time and step:      */
    double time, dt;        /* s                                         */
    RigidPose *end, *start; /* [count] in statics the same               */
} Poses;

/* Of obstacles that all stand still the poses are known at once. */
Poses poses_create(const Obstacle *obstacles, int count);
void poses_destroy(Poses *poses);

/* Has them follow the point; NaN where a formula is not finite, which energies then are, too. True the first time. */
bool poses_update(Poses *poses, const Point *at);

/* Those at which lagged quantities are taken. */
static inline const RigidPose *poses_lag(const Poses *poses, const Point *at)
{
    return at->x_lag ? poses->end : poses->start;
}
