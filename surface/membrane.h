/* membrane.h - the stretching energy of a thin layer: a shell's, or a film on a solid's skin. */
#pragma once
#include "solve/term.h"
#include "surface/face.h"

/* In the order of the scene's keys `material`. */
typedef enum MembraneMaterial {
    MEMBRANE_ST_VENANT_KIRCHHOFF, /* resists being crushed less and less: energy finite without area */
    MEMBRANE_NEO_HOOKEAN,         /* incompressible for a Poisson's ratio of 1/2                     */
} MembraneMaterial;

typedef struct MembraneDef {
    MembraneMaterial material;
    double poisson;
    int young; /* first entry in p of [row] Pa */
} MembraneDef;

/* Takes the layer. Where steps turn (TermOps.follow), its Hessian heeds Point.x_from. */
Term membrane_term(FaceLayer layer, const MembraneDef *def);
