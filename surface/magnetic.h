/* magnetic.h - the hard-magnetic energy of a magnetised surface in a field: a shell, or the skin of a solid. */
#pragma once
#include "field/flux.h"
#include "solve/term.h"
#include "surface/face.h"

/* Where its numbers are: first entries in p. */
typedef struct MagneticSurfaceDef {
    int magnetization; /* [row][3] A/m, in material space */
    FluxBlocks flux;
    const FluxFields *fields; /* borrowed by the term */
} MagneticSurfaceDef;

/* Takes the layer. */
Term magnetic_surface_term(FaceLayer layer, const MagneticSurfaceDef *def);
