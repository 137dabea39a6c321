/* solid.h - an elastic solid of tetrahedra, whose skin may be magnetised, and may be a film: geometry at rest, material constants, parameter
 * layout and what is held.
 *
 * Dofs: 3 node_count positions, m. Energies: docs/theory.md, solids. */
#pragma once
#include "solid/tets.h"
#include "solve/masses.h"
#include "solve/params.h"
#include "solve/system.h"
#include "field/flux.h"
#include "surface/membrane.h"
#include "world/world.h"

typedef enum SolidMaterial {
    SOLID_NEO_HOOKEAN,     /* mu/2 (I - 3) - mu (J - 1) + (lambda + mu)/2 (J - 1)^2: finite at J <= 0 */
    SOLID_NEO_HOOKEAN_LOG, /* mu/2 (I - 3) - mu ln J + lambda/2 (ln J)^2                              */
    SOLID_ST_VENANT_KIRCHHOFF,
} SolidMaterial;

typedef struct Solid {
    Tets *tets; /* owned */
    SolidMaterial material;
    double poisson, density; /* 1, kg/m^3 */
    double coercivity;       /* A/m, of what it is magnetised with; NAN: not known */
    /* Part (0..1) of lambda/2 (J - 1)^2 whose J is a mean, against locking: over the tetrahedron if quadratic, else over a
     * patch of them (tet_patches.h). Of SOLID_NEO_HOOKEAN only, else 0; of quadratic ones at most 0.6: more collapses in
     * compression. Its energy is `mean_dilation`. */
    double averaging;
    double skin; /* m, thickness of the layer on the surface; 0: there is none                         */
    bool film;   /* the layer resists stretching, with a modulus and a material of its own              */
    double film_poisson;
    MembraneMaterial film_material;
    bool *skin_on; /* [surface face] has it the layer? owned; NULL: all                                  */
    FluxFields
        fields;   /* parts of the flux density that vary in space; owned                                */
    bool *fixed;  /* [3*node_count] coordinates that are held; owned                                    */
    World *world; /* what it meets; owned; NULL: nothing                                                */

    Params params;            /* blocks and their first entries in p:                       */
    int young;                /* [tet] Pa                                                   */
    int magnetization;        /* [surface face][3] A/m, of the skin, in material space; -1: there is none */
    int skin_young;           /* [surface face] Pa, of the film; -1: there is none                        */
    int volume_magnetization; /* [tet][3] A/m, in material space                            */
    FluxBlocks flux;          /* flux_density [3] T, the uniform part, and those of fields */
    int gravity;              /* [3] m/s^2                                                  */
    int load;                 /* [node][3] N, dead                                          */
    int damping;              /* [1] N s/m at every node, in steps of time                  */
} Solid;

typedef struct SolidDef {
    SolidMaterial material;
    double poisson, density, averaging, skin;
    bool film;
    double film_poisson;
    MembraneMaterial film_material;
} SolidDef;

/* Takes the tetrahedra and the fields (NULL: none). Sets up the blocks of parameters, and nothing held. The block of the skin's
 * magnetisation is named `magnetization`, or, without a skin, that of the volume, which else is `volume_magnetization`; that of
 * a film's modulus `skin_young`. */
Solid *solid_create(Tets *tets, const SolidDef *def, const FluxFields *fields);
void solid_destroy(Solid *solid);

static inline int solid_dof_count(const Solid *solid)
{
    return 3 * tets_node_count(solid->tets);
}

/* What it shows to the world; borrowed from the solid. */
WorldBody solid_world_body(const Solid *solid);

/* All terms over the solid's dofs, prepared, with inertia and damping for steps of time. The solid must outlive it. */
System *solid_system(const Solid *solid, bool motion);

/* Default values of every block: young and skin_young 1e6, scales and strengths of fields 1, the rest 0. p[params.size]. */
void solid_default_params(const Solid *solid, double *p);

/* Lumped mass of each node, kg: corners of quadratic tetrahedra bear 1/36 of them, middles 4/27 [Hinton, Rock, Zienkiewicz
 * 1976]; the caller's. */
Masses solid_masses(const Solid *solid);

/* The least det F in the state, at corners and middles of edges too: where it is not positive, the solid is turned inside
 * out there; and the tetrahedron (NULL: not asked for). */
double solid_least_jacobian(const Solid *solid, const double *x, int *tet);

/* Is a solid with that least det F none any more: inside out somewhere, or flattened to a thousandth of its volume and less?
 * St. Venant-Kirchhoff's is at rest so, and stable, where the principal strains E of the other two sum to more than
 * (1 - nu)/(2 nu). */
bool solid_is_tangled(double least_jacobian);

/* That of each tetrahedron. */
void solid_jacobians(const Solid *solid, const double *x, double *least);
