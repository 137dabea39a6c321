/* line_charge.h - the field of unit charges on straight lines, for a pack of them: what blocks, cylinders and coils are
 * summed of.
 *
 *     F(x) = integral of r/r^3 dl,  r = x - x' (m),  F = -grad U,  U = integral of dl/r
 *
 * A surface charge B_r.n (T) on a magnet and a current I (A) along a line follow from it [Jackson, 5]: B = (1/4 pi) B_r.n F,
 * and B = (mu_0 I/4 pi) t x F. F has no curl and, off the line, no divergence: all its derivatives are symmetric. On the
 * line's extension beyond its ends all is smooth, and so it is computed: differences of nearly equal terms are taken out of
 * the formulas, so that a body may be right above an edge of a magnet. */
#pragma once
#include "base/pack.h"

/* Derivatives in a symmetric order: F_x, F_y, F_z; F_xx, F_xy, F_xz, F_yy, F_yz, F_zz; F_xxx, F_xxy, F_xxz, F_xyy, F_xyz,
 * F_xzz, F_yyy, F_yyz, F_yzz, F_zzz. */
enum { LINE_FIRST = 3, LINE_SECOND = 6, LINE_THIRD = 10, LINE_ALL = LINE_FIRST + LINE_SECOND + LINE_THIRD };

typedef struct LineField {
    Pack f[LINE_ALL]; /* 1/m, 1/m^2, 1/m^3 */
} LineField;

/* Of lines along z from low to high, at the distance (x, y) from them; z of the point is 0. */
LineField line_field(Pack x, Pack y, Pack low, Pack high);

/* Beside such lines (low < 0 < high) less the field 2 (x, y)/(x^2 + y^2) of lines without ends: finite at the lines. */
LineField line_ends(Pack x, Pack y, Pack low, Pack high);

/* U of them. */
Pack line_potential(Pack x, Pack y, Pack low, Pack high);

/* r/r^3 of single points. */
LineField point_field(Pack3 r);
