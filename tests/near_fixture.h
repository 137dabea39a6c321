/* near_fixture.h - random places, and edges that are nearly parallel, for tests. */
#pragma once
#include "base/random.h"
#include "world/distance.h"

static inline void choose(Random *random, int count, double size, double *x)
{
    for (int i = 0; i < count; i++) x[i] = size * random_signed(random);
}

/* Edges 0, 1 and 2, 3 that are parallel but for `off` of their length. */
static inline void make_parallel(Random *random, double off, double x[DISTANCE_DOFS])
{
    double stretch = 0.5 + random_uniform(random);
    for (int i = 0; i < 3; i++)
        x[9 + i] = x[6 + i] + stretch * (x[3 + i] - x[i]) + off * random_signed(random);
}
