/* stress.h - what the faces of a shell bear in a state [Kirchhoff, Love]: strain of the middle surface, change of curvature,
 * and stress across the thickness, of the shell's material at Green's strain G + z K.
 *
 * K = sum_i q_i t_i t_i^T/(2 A |a_i|) (bending.c) is positive where the side that the face's normal points to (top,
 * z = h/2) is stretched. */
#pragma once
#include "shell/shell.h"

enum { STRESS_BOTTOM, STRESS_MIDDLE, STRESS_TOP };

typedef struct FaceStress {
    double strain[2];    /* principal values of G, the larger one first                          */
    double curvature[2]; /* of K, 1/m, without the edges' factors `fold`                         */
    double von_mises[3]; /* Pa, of Cauchy's stress; K with the factors, as the energy has it */
} FaceStress;

/* stress[face]; the system is one of the shell's. */
void shell_stresses(const Shell *shell, const System *sys, const Point *at, FaceStress *stress);
