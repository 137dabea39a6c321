/* hinge.h - the dihedral angle about an edge with its first two derivatives, for packs of edges (pure functions).
 *
 * The edge runs from a to b, the own face is (a, b, o), the flap (b, a, y). The angle theta turns the own normal into
 * the flap's about b - a: positive where the surface is a ridge seen from the normals' side. With e = b - a and for
 * each wing its unit normal n, height h over the edge, foot s (0 at a, 1 at b) and m = direction from the edge into
 * the wing:
 *     dtheta/do = -n/h,     M = (n m^T + m n^T)/h^2
 *     d2theta/do do = M,    d2theta/do db = -s M + e n^T/(|e|^2 h)
 *     d2theta/db db = sum over wings of s^2 M - s (n e^T + e n^T)/(|e|^2 h) + n m^T/|e|^2,  d2theta/do dy = 0
 * and the rows of a follow from translation. Equal to [Tamstorf & Grinspun 2013], derived in docs/theory.md. */
#pragma once
#include "base/pack_mat.h"

typedef struct Wing {
    Pack3 normal, inward; /* n, m                 */
    Pack height, foot;    /* h (m), s             */
} Wing;

typedef struct Dihedral {
    Pack3 along; /* unit edge vector             */
    Pack length; /* of the edge, m               */
    Wing own, flap;
    Pack angle; /* rad, in (-pi, pi]             */
} Dihedral;

/* Derivatives of the angle; corners in the order a, b, o, y. */
typedef struct DihedralGradient {
    Pack3 a, b, o, y;
} DihedralGradient;

typedef struct DihedralHessian {
    PackMat aa, bb, oo, yy, ab, ao, ay, bo, by; /* rows of the first, columns of the second; oy is zero */
} DihedralHessian;

Dihedral dihedral_angle(Pack3 a, Pack3 b, Pack3 o, Pack3 y);
DihedralGradient dihedral_gradient(const Dihedral *d);
DihedralHessian dihedral_hessian(const Dihedral *d);
