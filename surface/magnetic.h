/* magnetic.h - the hard-magnetic energy of a magnetised surface in a field: a shell, or the skin of a solid. */
#pragma once
#include "solve/term.h"
#include "surface/flux_field.h"

/* Triangles whose vertices number dofs (3*vertex + axis) and places, so that they may be some of a body's. */
typedef struct MagneticSurfaceDef {
    int face_count;
    int (*faces)[3];                              /* [face] vertices, whichever way round                 */
    const int *rows;                              /* [face] its row of magnetization; NULL: its own       */
    double (*rest)[3];                            /* [vertex] m                                           */
    const double *volume;                         /* [face] m^3 that is magnetised: area by thickness     */
    int magnetization, flux_density, field_scale; /* first entries in p: [face][3] A/m, in material space;
                                                   * [3] T; [field] factors                               */
    const FluxFields *fields;
} MagneticSurfaceDef;

/* The term borrows the fields; all else is only read here. */
Term magnetic_surface_term(const MagneticSurfaceDef *def);
