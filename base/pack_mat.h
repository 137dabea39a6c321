/* pack_mat.h - 3x3 matrices of packs, as rows. */
#pragma once
#include "base/pack.h"

typedef struct PackMat {
    Pack3 r0, r1, r2;
} PackMat;

static inline PackMat pack_mat_outer(Pack3 a, Pack3 b)
{
    return (PackMat){pack3_scale(a.x, b), pack3_scale(a.y, b), pack3_scale(a.z, b)};
}

static inline PackMat pack_mat_add(PackMat a, PackMat b)
{
    return (PackMat){pack3_add(a.r0, b.r0), pack3_add(a.r1, b.r1), pack3_add(a.r2, b.r2)};
}

static inline PackMat pack_mat_scale(Pack s, PackMat a)
{
    return (PackMat){pack3_scale(s, a.r0), pack3_scale(s, a.r1), pack3_scale(s, a.r2)};
}

static inline PackMat pack_mat_neg(PackMat a)
{
    return (PackMat){pack3_neg(a.r0), pack3_neg(a.r1), pack3_neg(a.r2)};
}

static inline PackMat pack_mat_transpose(PackMat a)
{
    return (PackMat){{a.r0.x, a.r1.x, a.r2.x}, {a.r0.y, a.r1.y, a.r2.y}, {a.r0.z, a.r1.z, a.r2.z}};
}

/* a b^T + b a^T */
static inline PackMat pack_mat_symmetric(Pack3 a, Pack3 b)
{
    PackMat m = pack_mat_outer(a, b);
    return pack_mat_add(m, pack_mat_transpose(m));
}

static inline PackMat pack_mat_diagonal(Pack s)
{
    Pack zero = {0};
    return (PackMat){{s, zero, zero}, {zero, s, zero}, {zero, zero, s}};
}

static inline Pack3 pack_mat_times(PackMat a, Pack3 v)
{
    return pack3(pack3_dot(a.r0, v), pack3_dot(a.r1, v), pack3_dot(a.r2, v));
}

/* v^T A */
static inline Pack3 pack_mat_left(Pack3 v, PackMat a)
{
    return pack3_add(pack3_scale(v.x, a.r0), pack3_add(pack3_scale(v.y, a.r1), pack3_scale(v.z, a.r2)));
}

static inline PackMat pack_mat_product(PackMat a, PackMat b)
{
    return (PackMat){pack_mat_left(a.r0, b), pack_mat_left(a.r1, b), pack_mat_left(a.r2, b)};
}

/* [a]x: the matrix with [a]x v = a x v. */
static inline PackMat pack_mat_cross(Pack3 a)
{
    Pack zero = {0};
    return (PackMat){{zero, -a.z, a.y}, {a.z, zero, -a.x}, {-a.y, a.x, zero}};
}
