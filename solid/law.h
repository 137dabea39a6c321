/* law.h - the laws of elastic materials: energy per volume of a deformation gradient F, with two derivatives.
 *
 * All of Young's modulus 1, as Lame's constants are. J = det F, y_a = dJ/dF grad N_a. A law is a row. */
#pragma once
#include "solid/solid.h"
#include "solid/tet_pack.h"

typedef struct Lame {
    double mu, lambda; /* over Young's modulus */
} Lame;

Lame lame_of(double poisson);

/* A point of integration of a pack of elements. */
typedef struct LawPoint {
    Pack weight; /* m^3 */
    PackMat F, cofactor;
    Pack J;
    Pack3 gradient[TET_MAX_NODES]; /* of the shape functions, 1/m */
} LawPoint;

/* Second derivatives at F with singular values s: between s_i and s_j, and of d = (u_i v_j^T -/+ u_j v_i^T)/sqrt 2, with
 * k the third: eigenvalues of the Hessian in F [Smith, de Goes, Kim 2019]. */
typedef struct LawModes {
    double stretch[3][3], twist[3], flip[3];
} LawModes;

typedef struct Law {
    /* psi over Young's modulus, and dpsi/dF to P, which may be NULL. */
    Pack (*stress)(Lame lame, const LawPoint *at, PackMat *P);

    /* Adds d2E/dx dx of that many nodes, over all points, to H. */
    void (*stiffness)(Lame lame, const LawPoint *points, int point_count, int nodes, Pack *H);

    LawModes (*modes)(Lame lame, const double s[3]);
} Law;

const Law *law_of(SolidMaterial material);

/* Adds instead the part of the stiffness that is not negative, point by point (law_clamped.c). */
void law_clamped_stiffness(const Law *law, Lame lame, const LawPoint *points, int point_count, int nodes,
                           Pack *H);
