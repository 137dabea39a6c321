#include "world/ccd.h"
#include <math.h>

enum { ADVANCES = 200 }; /* beyond that they slide along each other: what was found is enough */

static const double NEAR = 1.1; /* of the distance to keep: near enough to stop */

/* Largest |dx_i - dx_j|, dx = to - from, over vertices i of the first and j of the other, which begins at vertex `second`. */
static double approach_of(const double from[DISTANCE_DOFS], const double to[DISTANCE_DOFS], int second)
{
    double largest = 0;
    for (int i = 0; i < second; i++)
        for (int j = second; j < 4; j++) {
            double square = 0;
            for (int k = 0; k < 3; k++) {
                double d = (to[3 * i + k] - from[3 * i + k]) - (to[3 * j + k] - from[3 * j + k]);
                square += d * d;
            }
            largest = fmax(largest, square);
        }
    return sqrt(largest);
}

double ccd_reach(DistanceOf *distance, const double from[DISTANCE_DOFS], const double to[DISTANCE_DOFS],
                 double keep, double most)
{
    double approach = approach_of(from, to, distance == distance_edges ? 2 : 1);
    double d = sqrt(distance(from).square), least = keep * d, part = 0, x[DISTANCE_DOFS];
    if (!(d > 0) || !(approach > 0) || approach * most <= d - least) return most;
    for (int k = 0; k < ADVANCES; k++) {
        part += (d - least) / approach;
        if (!(part < most)) return most;
        for (int i = 0; i < DISTANCE_DOFS; i++) x[i] = from[i] + part * (to[i] - from[i]);
        d = sqrt(distance(x).square);
        if (!(d > NEAR * least)) return part;
    }
    return part;
}
