/* vec3.h - vectors and 3x3 matrices by value, so that a formula reads as it is written. */
#pragma once
#include <math.h>

typedef struct Vec2 {
    double x, y;
} Vec2;

typedef struct Vec3 {
    double x, y, z;
} Vec3;

/* Rows of a 3x3 matrix. */
typedef struct Mat3 {
    Vec3 r0, r1, r2;
} Mat3;

static inline Vec3 vec3(double x, double y, double z)
{
    return (Vec3){x, y, z};
}
static inline Vec3 vec3_load(const double *a)
{
    return (Vec3){a[0], a[1], a[2]};
}
static inline void vec3_store(double *a, Vec3 v)
{
    a[0] = v.x, a[1] = v.y, a[2] = v.z;
}
static inline Vec3 vec3_add(Vec3 a, Vec3 b)
{
    return vec3(a.x + b.x, a.y + b.y, a.z + b.z);
}
static inline Vec3 vec3_sub(Vec3 a, Vec3 b)
{
    return vec3(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline Vec3 vec3_scale(double s, Vec3 a)
{
    return vec3(s * a.x, s * a.y, s * a.z);
}
static inline Vec3 vec3_axpy(double s, Vec3 a, Vec3 b)
{
    return vec3_add(vec3_scale(s, a), b);
}
static inline double vec3_dot(Vec3 a, Vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline double vec3_length(Vec3 a)
{
    return sqrt(vec3_dot(a, a));
}
static inline Vec3 vec3_unit(Vec3 a)
{
    return vec3_scale(1 / vec3_length(a), a);
}

static inline Vec3 vec3_cross(Vec3 a, Vec3 b)
{
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline Mat3 mat3_outer(Vec3 a, Vec3 b)
{
    return (Mat3){vec3_scale(a.x, b), vec3_scale(a.y, b), vec3_scale(a.z, b)};
}

static inline Mat3 mat3_add(Mat3 a, Mat3 b)
{
    return (Mat3){vec3_add(a.r0, b.r0), vec3_add(a.r1, b.r1), vec3_add(a.r2, b.r2)};
}

static inline Mat3 mat3_scale(double s, Mat3 a)
{
    return (Mat3){vec3_scale(s, a.r0), vec3_scale(s, a.r1), vec3_scale(s, a.r2)};
}

static inline Mat3 mat3_identity(void)
{
    return (Mat3){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

static inline Vec3 mat3_times(Mat3 a, Vec3 v)
{
    return vec3(vec3_dot(a.r0, v), vec3_dot(a.r1, v), vec3_dot(a.r2, v));
}
