/* terms.h - the energy terms of a solid. This list is the only place that names them all (docs/adding_a_term.md). */
#pragma once
#include "solid/solid.h"
#include "solve/term.h"

#define SOLID_TERMS(X)                                                                                       \
    X(elastic)         /* hyperelastic tetrahedra, linear or quadratic                                 */    \
    X(mean_dilation)   /* the part of it that depends on mean volumes: averaging                       */    \
    X(magnetic)        /* hard-magnetic work of the skin -A h (F M).B    [Chen 2022, eq. 24 and 6.4]   */    \
    X(membrane)        /* stretch of a film on the skin            [Chen 2022, eqs. 18, 22]            */    \
    X(volume_magnetic) /* and of magnetised volumes, -V (F M).B                                        */    \
    X(gravity)         /* weight of the lumped masses                                                  */    \
    X(load)            /* dead loads on the nodes                                                      */

/* The term borrows the solid; the caller owns the result and passes it to system_add(). */
typedef Term SolidTermCreate(const Solid *solid);

#define X(name) SolidTermCreate solid_##name##_term;
SOLID_TERMS(X)
#undef X

typedef struct SolidTermRow {
    const char *name;
    SolidTermCreate *create;
} SolidTermRow;

extern const SolidTermRow solid_term_rows[];
extern const int solid_term_row_count;

/* Of the term of mean dilation: what it adds to the stress of each tetrahedron in all directions, Pa; tension[tet]. */
void solid_mean_tensions(const Term *mean_dilation, const Point *at, double *tension);
