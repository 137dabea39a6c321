/* magnetic.h - the hard-magnetic energy of a magnetised surface in a field: a shell, or the skin of a solid. */
#pragma once
#include "solve/term.h"
#include "surface/face.h"
#include "surface/flux_field.h"

/* Where its numbers are: first entries in p. */
typedef struct MagneticSurfaceDef {
    int magnetization;             /* [row][3] A/m, in material space */
    int flux_density, field_scale; /* [3] T; [field] factors          */
    const FluxFields *fields;      /* borrowed by the term            */
} MagneticSurfaceDef;

/* Takes the layer. */
Term magnetic_surface_term(FaceLayer layer, const MagneticSurfaceDef *def);
