/* pbd.h - a rod in motion for the eye: an extended position-based (XPBD) Cosserat rod.
 *
 * Nodes carry mass, elements between them carry a material frame each. Two constraints with the compliance
 * of a real rod hold them together [Kugelstadt & Schoemer 2016, Macklin 2016]: an element's chord keeps the
 * length and direction it has in its frame (compliance 1/(K h) along its tangent, n1 and n2, K = EA, kappa G A; one that
 * does not shear resists that by EA, too), two neighbouring frames keep their natural rotation (h/(4 K), K = GJ, EI1, EI2;
 * h/2 in place of h at a clamp). They are satisfied one after the other, sweep by sweep along the rod and back. Magnets in a
 * uniform field turn the frames by m x B, taken at the start of each substep.
 *
 * A preview, not the reference: sweeps that end too soon leave a rod softer than it is. At rest, the helix
 * of 0.3 m of tests/test_pbd.c with 50 elements and dt = 0.01 s is 0.5 mm from its equilibrium with 100
 * substeps of one sweep, 0.7 mm with 10 of 10, 9 mm with 20 of one, 37 mm with 4 of 4: substeps serve better
 * than sweeps, and more elements need more of them. With enough the error is the discretisation's and falls
 * with h^2 (0.7 mm at 25 elements, 0.2 mm at 50).
 *
 * Two liberties: each element resists turning like its mass at the distance 2 h from its middle, much more
 * than a thin rod does. Sweeps gain on the error far faster so; bending motions over many elements are as
 * fast as they should be, twisting ones slower. And implicit steps damp. */
#pragma once
#include "rod/rod.h"

typedef struct PbdRodDef {
    int elements;
    double length; /* m */
    RodSection section;
    Vec3 stretch;               /* against stretch, and shear along n1, n2, N                       */
    const Vec3 *natural_strain; /* [elements] twist, k1, k2, 1/m                                    */
    const Vec3 *start_strain;   /* [elements] those it starts with, at rest; NULL: the natural ones */
    Vec3 position;              /* of node 0 at the start                                           */
    const Vec3 *start_places;   /* [elements + 1] of all nodes; NULL: from there, as the strains say */
    Quat clamp;                 /* takes the axes to its material frame there, and                  */
    Quat end_frame;             /* to that at the last node, of a clamped end                       */
    RodSupport start, end;
    const Vec3 *magnet;   /* [elements] magnetic moments in the frames, A m^2; NULL: none     */
    Vec3 gravity;         /* m/s^2                                                            */
    const Vec3 *force;    /* [elements + 1] on the nodes, N; NULL: none                       */
    double drag;          /* force on a moving mass over its momentum, 1/s                    */
    int substeps, sweeps; /* of a step, of a substep; at least 1                              */
} PbdRodDef;

typedef struct PbdRod PbdRod;

/* All of def is copied. */
PbdRod *pbd_rod_create(const PbdRodDef *def);
void pbd_rod_destroy(PbdRod *rod);

void pbd_rod_step(PbdRod *rod, double dt);

/* The field that magnets feel from now on, T; none at first. */
void pbd_rod_set_field(PbdRod *rod, Vec3 flux_density);

/* Where what holds the first or the last node is after the next step, and its frame (of a clamp): it goes there evenly, and turns
 * by less than half a turn. */
void pbd_rod_lead(PbdRod *rod, bool last, Vec3 place, Quat frame);

/* [elements + 1], m and m/s; valid until the rod is destroyed. */
const Vec3 *pbd_rod_positions(const PbdRod *rod);
const Vec3 *pbd_rod_velocities(const PbdRod *rod);

/* All that a step depends on, in pbd_rod_state_count numbers: positions, velocities, the elements' quaternions (w, v) and
 * rates of turning, and which way the next sweep goes. A rod that it is put into goes on bit by bit. */
int pbd_rod_state_count(int elements);
void pbd_rod_get_state(const PbdRod *rod, double *state);
void pbd_rod_set_state(PbdRod *rod, const double *state);

/* The material frames in the middles of the elements, frames[elements]. */
void pbd_rod_frames(const PbdRod *rod, RodFrame *frames);

/* Stretch and shear of the elements in their frames, strain[elements]. */
void pbd_rod_stretches(const PbdRod *rod, Vec3 *strain);

/* Sums over the rod. It is at rest where the kinetic energy is and stays small beside the elastic one. */
typedef struct PbdRodSums {
    double kinetic, elastic, potential; /* J; potential of weight and nodal forces, 0 at the origin */
    double magnetic;                    /* J */
    Vec3 momentum, spin;                /* N s, N m s about the origin                              */
} PbdRodSums;
PbdRodSums pbd_rod_sums(const PbdRod *rod);
