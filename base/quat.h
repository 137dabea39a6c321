/* quat.h - unit quaternions as rotations: (w, v) turns by 2 acos(w) about v. quat_mul(a, b) turns by b first.
 */
#pragma once
#include "base/vec3.h"

typedef struct Quat {
    double w;
    Vec3 v;
} Quat;

static inline Quat quat_identity(void)
{
    return (Quat){1, {0, 0, 0}};
}
static inline Quat quat_conj(Quat q)
{
    return (Quat){q.w, vec3_scale(-1, q.v)};
}

static inline Quat quat_mul(Quat a, Quat b)
{
    Vec3 v = vec3_axpy(a.w, b.v, vec3_axpy(b.w, a.v, vec3_cross(a.v, b.v)));
    return (Quat){a.w * b.w - vec3_dot(a.v, b.v), v};
}

static inline Quat quat_unit(Quat q)
{
    double f = 1 / sqrt(q.w * q.w + vec3_dot(q.v, q.v));
    return (Quat){f * q.w, vec3_scale(f, q.v)};
}

/* The same of a quaternion whose length is off 1 by rounding only: neither root nor division. */
static inline Quat quat_trim(Quat q)
{
    double f = 1.5 - (q.w * q.w + vec3_dot(q.v, q.v)) / 2;
    return (Quat){f * q.w, vec3_scale(f, q.v)};
}

/* Turns by |r| about r. */
static inline Quat quat_exp(Vec3 r)
{
    double half2 = vec3_dot(r, r) / 4, half = sqrt(half2);
    double sinc = half2 < 1e-4 ? 1 - half2 / 6 * (1 - half2 / 20 * (1 - half2 / 42)) : sin(half) / half;
    return (Quat){half2 < 1e-4 ? 1 - half2 / 2 * (1 - half2 / 12 * (1 - half2 / 30)) : cos(half),
                  vec3_scale(sinc / 2, r)};
}

/* The shortest rotation vector r with quat_exp(r) = +-q. */
static inline Vec3 quat_log(Quat q)
{
    double sine = vec3_length(q.v), angle = 2 * atan2(sine, fabs(q.w));
    double scale = sine > 1e-8 ? angle / sine : 2;
    return vec3_scale(q.w < 0 ? -scale : scale, q.v);
}

static inline Vec3 quat_rotate(Quat q, Vec3 x)
{
    Vec3 twice = vec3_scale(2, vec3_cross(q.v, x));
    return vec3_add(x, vec3_axpy(q.w, twice, vec3_cross(q.v, twice)));
}

static inline double quat_dot(Quat a, Quat b)
{
    return a.w * b.w + vec3_dot(a.v, b.v);
}

/* The rotation that takes the axes to x, y, z (orthonormal, right-handed); the largest component first. */
static inline Quat quat_from_axes(Vec3 x, Vec3 y, Vec3 z)
{
    double w = 1 + x.x + y.y + z.z, i = 1 + x.x - y.y - z.z, j = 1 - x.x + y.y - z.z, k = 1 - x.x - y.y + z.z;
    if (w >= i && w >= j && w >= k) return quat_unit((Quat){w, {y.z - z.y, z.x - x.z, x.y - y.x}});
    if (i >= j && i >= k) return quat_unit((Quat){y.z - z.y, {i, x.y + y.x, z.x + x.z}});
    if (j >= k) return quat_unit((Quat){z.x - x.z, {x.y + y.x, j, y.z + z.y}});
    return quat_unit((Quat){x.y - y.x, {z.x + x.z, y.z + z.y, k}});
}
