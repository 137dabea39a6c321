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

typedef struct Pack2 {
    Pack x, y;
} Pack2;

typedef struct Pack3 {
    Pack x, y, z;
} Pack3;

static inline Pack pack_set(double a)
{
    return (Pack){0} + a;
}

static inline Pack pack_load(const double *from)
{
    Pack r;
    memcpy(&r, from, sizeof r);
    return r;
}

static inline void pack_store(double *to, Pack a)
{
    memcpy(to, &a, sizeof a);
}

static inline Pack pack_select(PackMask mask, Pack yes, Pack no)
{
    return (Pack)((mask & (PackMask)yes) | (~mask & (PackMask)no));
}

static inline Pack pack_abs(Pack a)
{
    return pack_select(a < 0, -a, a);
}

static inline Pack pack_sqrt(Pack a)
{
    Pack r = {0}; /* without {0}, gcc 12 warns of spline/pair.c */
    for (int l = 0; l < PACK_LANES; l++) r[l] = sqrt(a[l]);
    return r;
}

/* Angles in (-pi, pi] to 2 units in the last place: reduced to |r| <= tan(pi/8), then the rational function
 * of Moshier's Cephes library. Eight calls of the C library take twenty times as long. atan2(0, 0) = 0. */
static inline Pack pack_atan2(Pack y, Pack x)
{
    Pack a = pack_abs(y), b = pack_abs(x), zero = {0};
    PackMask steep = a > b;
    Pack low = pack_select(steep, b, a), high = pack_select(steep, a, b);
    PackMask far = low > 0.41421356237309503 * high; /* beyond pi/8: from pi/4 down */
    Pack top = pack_select(far, low - high, low), bottom = pack_select(far, low + high, high);
    Pack r = top / pack_select(bottom == 0, pack_set(1), bottom), z = r * r;
    Pack P =
        (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z - 7.500855792314704667340e1) * z -
         1.228866684490136173410e2) *
            z -
        6.485021904942025371773e1;
    Pack Q =
        ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z + 4.328810604912902668951e2) *
             z +
         4.853903996359136964868e2) *
            z +
        1.945506571482613964425e2;
    Pack angle = r + r * z * P / Q + pack_select(far, pack_set(M_PI / 4), zero);
    angle = pack_select(steep, M_PI / 2 - angle, angle);
    angle = pack_select(x < 0, M_PI - angle, angle);
    return pack_select(y < 0, -angle, angle);
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

static inline Pack3 pack3(Pack x, Pack y, Pack z)
{
    return (Pack3){x, y, z};
}
static inline Pack3 pack3_load(const Pack *a)
{
    return (Pack3){a[0], a[1], a[2]};
}
static inline void pack3_store(Pack *a, Pack3 v)
{
    a[0] = v.x, a[1] = v.y, a[2] = v.z;
}
static inline Pack3 pack3_add(Pack3 a, Pack3 b)
{
    return pack3(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline Pack3 pack3_sub(Pack3 a, Pack3 b)
{
    return pack3(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline Pack3 pack3_scale(Pack s, Pack3 a)
{
    return pack3(s * a.x, s * a.y, s * a.z);
}
static inline Pack3 pack3_neg(Pack3 a)
{
    return pack3(-a.x, -a.y, -a.z);
}
static inline Pack3 pack3_axpy(Pack s, Pack3 a, Pack3 b)
{
    return pack3_add(pack3_scale(s, a), b);
}
static inline Pack pack3_dot(Pack3 a, Pack3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline Pack3 pack3_cross(Pack3 a, Pack3 b)
{
    return pack3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

/* ---- Elements in packs: faces, tetrahedra, .. ---- */

/* So many hold them all. */
static inline int pack_count(int elements)
{
    return (elements + PACK_LANES - 1) / PACK_LANES;
}

/* The one in a lane of a pack; the last one fills up. */
static inline int pack_element(int elements, int pack, int lane)
{
    int element = pack * PACK_LANES + lane, last = elements - 1;
    return element < last ? element : last;
}

/* A number of each: a component of values[elements][width]. */
static inline Pack pack_param(int elements, int pack, const double *values, int width, int component)
{
    Pack r;
    for (int l = 0; l < PACK_LANES; l++) r[l] = values[pack_element(elements, pack, l) * width + component];
    return r;
}
