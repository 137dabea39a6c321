/* frame.h - orthonormal frames (n0 tangent, n1, n2) along a curve: Frenet, Bishop, and turned about the
 * tangent.
 *
 * The Darboux vector k = (twist, k1, k2) in the frame: n0' = k2 n1 - k1 n2, n1' = k0 n2 - k2 n0, n2' = k1 n0
 * - k0 n1. */
#pragma once
#include "base/quat.h"
#include "rod/curve.h"

typedef struct RodFrame {
    Vec3 n0, n1, n2;
} RodFrame;

/* The frame that turns least about the tangent, from n1 = the part of `normal` across the first tangent on,
 * at all stations. Double reflection, fourth order [Wang 2008]. */
void rod_bishop(const RodCurve *curve, Vec3 normal, RodFrame *frames);

/* n1 along the curvature. Where there is none, the last n1 is carried on without turning. */
void rod_frenet(const RodCurve *curve, RodFrame *frames);

/* Turns each frame by an angle about its tangent: n1 towards n2. */
RodFrame rod_turned(RodFrame frame, double angle);

/* A vector of the world in the frame, and the other way. */
static inline Vec3 rod_to_frame(RodFrame f, Vec3 v)
{
    return vec3(vec3_dot(f.n0, v), vec3_dot(f.n1, v), vec3_dot(f.n2, v));
}
static inline Vec3 rod_to_world(RodFrame f, Vec3 v)
{
    return vec3_axpy(v.x, f.n0, vec3_axpy(v.y, f.n1, vec3_scale(v.z, f.n2)));
}

/* Twist of a frame along the curve from station to station, by differences of fourth order of the angle to
 * the Bishop frame. twist[stations]. */
void rod_twist(const RodCurve *curve, const RodFrame *frames, double *twist);

/* The curve's own torsion t.(c x c')/|c|^2 at all stations, 1/m, c' by differences of fourth order: that is the twist of
 * Frenet's frames. NAN where the curve is straight and has none. torsion[stations]. */
void rod_torsion(const RodCurve *curve, double *torsion);

/* The rotation from an element's start to its end, seen from its start, and the one to its middle: R' = R
 * [w]x with the rates w at its start, middle and end. Fourth order. */
static inline Quat rod_turn(double h, Vec3 w0, Vec3 w1, Vec3 w2, Quat *half)
{
    Vec3 whole = vec3_axpy(h / 6, vec3_add(w0, w2), vec3_scale(4 * h / 6, w1));
    Vec3 first = vec3_axpy(5 * h / 24, w0, vec3_axpy(8 * h / 24, w1, vec3_scale(-h / 24, w2)));
    *half = quat_exp(vec3_axpy(h * h / 48, vec3_cross(w0, w1), first));
    return quat_exp(vec3_axpy(h * h / 12, vec3_cross(w0, w2), whole));
}
