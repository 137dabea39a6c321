/* pair.h - the kernels of the energy between strokes: functions g of d^2, 1 at d = 0, 0 from R on; but for Coulomb's, 1 at d = R,
 * which has no end and is infinite at 0. */
#pragma once
#include "spline/model.h"

/* Does a stroke act on itself? Where g is infinite at 0 it cannot. */
static inline bool pair_kernel_has_own(PairKernel kernel)
{
    return kernel != PAIR_COULOMB;
}

/* g, dg/d(d^2), d2g/d(d^2)^2. */
typedef struct PairValue {
    double g, first, second;
} PairValue;

/* d2 < SplineModel.pair_reach^2. [Wendland 1995] */
static inline PairValue pair_kernel_at(PairKernel kernel, double d2, double R)
{
    if (kernel == PAIR_TRIWEIGHT) {
        double i2 = 1 / (R * R), z = 1 - d2 * i2;
        return (PairValue){z * z * z, -3 * i2 * z * z, 6 * i2 * i2 * z};
    }
    double d = sqrt(d2), z = 1 - d / R;
    if (kernel == PAIR_COULOMB) return (PairValue){R / d, -R / (2 * d * d2), 3 * R / (4 * d * d2 * d2)};
    return (PairValue){z * z * z * z * (4 * d / R + 1), -10 / (R * R) * z * z * z,
                       15 / (R * R * R * fmax(d, 1e-12 * R)) * z * z};
}

/* g and dg/d(d^2) for any d2. */
static inline Pack pair_kernel_pack(PairKernel kernel, Pack d2, double R, Pack *first)
{
    Pack zero = {0};
    if (kernel == PAIR_TRIWEIGHT) {
        Pack z = 1 - d2 / (R * R);
        z = pack_select(z > zero, z, zero);
        *first = -3 / (R * R) * z * z;
        return z * z * z;
    }
    Pack d = pack_sqrt(d2), z = 1 - d / R;
    if (kernel == PAIR_COULOMB) return *first = -R / (2 * d * d2), R / d;
    z = pack_select(z > zero, z, zero);
    *first = -10 / (R * R) * z * z * z;
    return z * z * z * z * (4 / R * d + 1);
}
