/* pose_fixture.h - poses of one rod: equilibria by shooting from the clamp, exact to rounding, for tests. */
#pragma once
#include "base/memory.h"
#include "base/quat.h"
#include "rod/identify.h"
#include "rod/section.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

enum { N = 200, STATIONS = 2 * N + 1, POSES = 3 };

/* The rod: made of something like soft rubber, its natural strains a formula. */
typedef struct Rod {
    double radius, density, young, poisson, length;
    Vec3 (*natural)(double s);
    Vec3 tip; /* N, at its end */
} Rod;

static inline Vec3 curly(double s)
{
    return vec3(8 + 20 * s, 12 * sin(14 * s), 25 - 30 * s);
}

static inline Vec3 flat(double s)
{
    return vec3(0, 12 * cos(9 * s), 0);
}

static const Rod curly_rod = {1.3e-3, 1180, 6e6, 0.42, 0.2, curly, {0, 0, 0}},
                 flat_rod = {1.3e-3, 1180, 6e6, 0.42, 0.2, flat, {0, 0, 0}};
static const Vec3 gravity = {0, 0, -9.81};

/* As a scene may have them, with four digits; the last one head down. */
static const RodFrame clamps[POSES] = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{0.9397, 0, -0.3420}, {0.3368, -0.1736, 0.9254}, {-0.0594, -0.9848, -0.1632}},
    {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
};

/* A section of the hanging rod: place, frame, moment of what hangs beyond. */
typedef struct Section {
    Vec3 x, M;
    Quat q;
} Section;

static inline Vec3 strain_at(const Rod *rod, Section at, double s)
{
    RodSection section = rod_circle(rod->radius, rod->young, rod->poisson, rod->density);
    Vec3 m = quat_rotate(quat_conj(at.q), at.M);
    return vec3_add(rod->natural(s), vec3(m.x / section.twist, m.y / section.bend1, m.z / section.bend2));
}

static inline Section slope_at(const Rod *rod, Section at, double s, Vec3 line)
{
    Vec3 t = quat_rotate(at.q, vec3(1, 0, 0));
    Quat turn = quat_mul(at.q, (Quat){0, vec3_scale(0.5, strain_at(rod, at, s))});
    Vec3 pull = vec3_axpy(rod->length - s, line, rod->tip);
    return (Section){t, vec3_scale(-1, vec3_cross(t, pull)), turn};
}

static inline Section along(Section a, double h, Section slope)
{
    Quat q = {a.q.w + h * slope.q.w, vec3_axpy(h, slope.q.v, a.q.v)};
    return (Section){vec3_axpy(h, slope.x, a.x), vec3_axpy(h, slope.M, a.M), q};
}

/* From station to station, `parts` Runge-Kutta steps each; curve may be NULL. Returns the moment that is left
 * at the free end. */
static inline Vec3 hang(const Rod *rod, Section at, Vec3 line, int parts, RodCurve *curve)
{
    double h = rod->length / (2 * N * parts);
    for (int k = 0; k <= 2 * N * parts; k++) {
        double s = k * h;
        if (curve && k % parts == 0) {
            Vec3 strain = strain_at(rod, at, s);
            curve->x[k / parts] = at.x;
            curve->t[k / parts] = quat_rotate(at.q, vec3(1, 0, 0));
            curve->c[k / parts] = quat_rotate(at.q, vec3(0, strain.z, -strain.y));
        }
        if (k == 2 * N * parts) break;
        Section a = slope_at(rod, at, s, line), b = slope_at(rod, along(at, h / 2, a), s + h / 2, line);
        Section c = slope_at(rod, along(at, h / 2, b), s + h / 2, line),
                d = slope_at(rod, along(at, h, c), s + h, line);
        at = along(along(along(along(at, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
        at.q = quat_unit(at.q);
    }
    return at.M;
}

/* Newton on the clamp's moment until none is left at the end. */
static inline Vec3 clamp_moment(const Rod *rod, Quat clamp, Vec3 line, int parts, Vec3 M)
{
    for (int k = 0; k < 20; k++) {
        Section at = {vec3(0, 0, 0), M, clamp};
        Vec3 left = hang(rod, at, line, parts, NULL), column[3];
        const double step = 1e-8;
        for (int i = 0; i < 3; i++) {
            at.M = vec3_add(M, vec3(i == 0 ? step : 0, i == 1 ? step : 0, i == 2 ? step : 0));
            column[i] = vec3_scale(1 / step, vec3_sub(hang(rod, at, line, parts, NULL), left));
        }
        double volume = vec3_dot(column[0], vec3_cross(column[1], column[2]));
        Vec3 off = vec3(vec3_dot(left, vec3_cross(column[1], column[2])),
                        vec3_dot(left, vec3_cross(column[2], column[0])),
                        vec3_dot(left, vec3_cross(column[0], column[1])));
        M = vec3_axpy(-1 / volume, off, M);
        if (vec3_length(left) < 1e-15) break;
    }
    return M;
}

enum { LOAD_STEPS = 50 };

/* The equilibrium, its weight put on in steps, and the pose it is, held in just that frame. */
static inline RodPose equilibrium(const Rod *rod, RodFrame clamp, RodCurve *curve)
{
    *curve = (RodCurve){N, rod->length, mem_alloc(STATIONS, sizeof(Vec3)), mem_alloc(STATIONS, sizeof(Vec3)),
                        mem_alloc(STATIONS, sizeof(Vec3))};
    Vec3 weight = vec3_scale(rod->density * M_PI * rod->radius * rod->radius, gravity), M = vec3(0, 0, 0);
    Quat q = quat_from_axes(clamp.n0, clamp.n1, clamp.n2);
    Rod part = *rod;
    for (int k = 1; k <= LOAD_STEPS; k++) {
        part.tip = vec3_scale((double)k / LOAD_STEPS, rod->tip);
        M = clamp_moment(&part, q, vec3_scale((double)k / LOAD_STEPS, weight), 1, M);
    }
    M = clamp_moment(rod, q, weight, 3, M);
    Vec3 left = hang(rod, (Section){vec3(0, 0, 0), M, q}, weight, 3, curve);
    assert_true(vec3_length(left) < 1e-12 * vec3_length(M));
    RodFrame frame = {quat_rotate(q, vec3(1, 0, 0)), quat_rotate(q, vec3(0, 1, 0)),
                      quat_rotate(q, vec3(0, 0, 1))};
    return (RodPose){.curve = curve, .clamp = frame};
}
