/* membrane.h - the stretching energy of a thin layer: a shell's, or a film on a solid's skin. */
#pragma once
#include "solve/term.h"
#include "surface/face.h"

typedef struct MembraneDef {
    double poisson;
    int young; /* first entry in p of [row] Pa */
} MembraneDef;

/* Takes the layer. Where steps turn (TermOps.follow), its Hessian heeds Point.x_from. */
Term membrane_term(FaceLayer layer, const MembraneDef *def);
