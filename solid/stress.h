/* stress.h - what the tetrahedra of a solid bear in a state. */
#pragma once
#include "solid/solid.h"

typedef struct TetStress {
    double
        cauchy[6]; /* Pa, xx yy zz xy yz xz: the mean over the points of integration, in the world's axes  */
    double von_mises; /* Pa, of that                                                                        */
    double stretch;   /* the largest principal one at these points                                          */
} TetStress;

/* stress[tet]; the system is one of the solid's. */
void solid_stresses(const Solid *solid, const System *sys, const Point *at, TetStress *stress);
