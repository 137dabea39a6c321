/* pack.h - one number for each of a few elements side by side, one per vector lane.
 *
 * Kernels written with Pack in place of double work on PACK_LANES elements at once (gcc and clang vector
 * extensions): the formulas read the same, and the compiler needs no luck to vectorise them. */
#pragma once
#include <math.h>
#include <string.h>

enum { PACK_LANES = 8 };

typedef double Pack __attribute__((vector_size(8 * 8)));
typedef long long PackMask __attribute__((vector_size(8 * 8)));

typedef struct Pack3 {
    Pack x, y, z;
} Pack3;

static inline Pack pack_set(double a) { return (Pack){0} + a; }

static inline Pack pack_select(PackMask mask, Pack yes, Pack no)
{
    return (Pack)((mask & (PackMask)yes) | (~mask & (PackMask)no));
}

static inline Pack pack_abs(Pack a) { return pack_select(a < 0, -a, a); }

static inline Pack pack_sqrt(Pack a)
{
    Pack r;
    for (int l = 0; l < PACK_LANES; l++) r[l] = sqrt(a[l]);
    return r;
}

static inline Pack pack_atan2(Pack y, Pack x)
{
    Pack r;
    for (int l = 0; l < PACK_LANES; l++) r[l] = atan2(y[l], x[l]);
    return r;
}

static inline Pack pack_rint(Pack a)
{
    Pack r;
    for (int l = 0; l < PACK_LANES; l++) r[l] = rint(a[l]);
    return r;
}

static inline double pack_sum(Pack a, int lanes)
{
    double sum = 0;
    for (int l = 0; l < lanes; l++) sum += a[l];
    return sum;
}

static inline Pack3 pack3(Pack x, Pack y, Pack z) { return (Pack3){x, y, z}; }
static inline Pack3 pack3_load(const Pack *a) { return (Pack3){a[0], a[1], a[2]}; }
static inline void pack3_store(Pack *a, Pack3 v) { a[0] = v.x, a[1] = v.y, a[2] = v.z; }
static inline Pack3 pack3_add(Pack3 a, Pack3 b) { return pack3(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline Pack3 pack3_sub(Pack3 a, Pack3 b) { return pack3(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline Pack3 pack3_scale(Pack s, Pack3 a) { return pack3(s * a.x, s * a.y, s * a.z); }
static inline Pack3 pack3_neg(Pack3 a) { return pack3(-a.x, -a.y, -a.z); }
static inline Pack3 pack3_axpy(Pack s, Pack3 a, Pack3 b) { return pack3_add(pack3_scale(s, a), b); }
static inline Pack pack3_dot(Pack3 a, Pack3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static inline Pack3 pack3_cross(Pack3 a, Pack3 b)
{
    return pack3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
