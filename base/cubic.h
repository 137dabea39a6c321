/* cubic.h - one cubic Bezier curve in the plane, given by its four control points. */
#pragma once
#include "base/vec3.h"

/* The point at s in 0..1. */
Vec2 cubic_at(const Vec2 c[4], double s);

/* Control points of the piece from s = from to s = to; backwards where to < from. part may not be c. */
void cubic_part(const Vec2 c[4], double from, double to, Vec2 part[4]);

/* Chords of equal steps in s that stay within `tolerance` of the curve: 1..10000. With |r''| <= 6 M, M the
 * longest second difference of the control points, n chords are off by at most 6 M/(8 n^2). */
int cubic_steps(const Vec2 c[4], double tolerance);

/* Zeros in (0, 1) of a cubic polynomial with these Bernstein coefficients, ascending; returns how many. One
 * that only touches zero may be missed. */
int cubic_roots(const double b[4], double roots[3]);
