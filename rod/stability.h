/* stability.h - is a rod in equilibrium stable: clamped at its first end, free at the other, dead loads.
 *
 * The energy depends on the rotations of the cross-sections only. A turn phi(s) of them, in their own axes
 * and zero at the clamp, changes it by d2E/2,
 *
 *     d2E = int eta.K eta + m.(eta x phi) + F0 |phi|^2 - (F.phi) phi_0 ds,    eta = phi' + k x phi,
 *
 * with the strains k, the moment m = R^T M and the force F = R^T T, all in the frames (tangent first).
 *
 * Quadratic elements for the turn with respect to the world, Simpson's rule on the stations: fourth order.
 * The unknowns are eliminated from the free end to the clamp; by Sylvester's law the negative pivots count
 * the unstable directions, and those met before a station the ones of the tail that begins there (a discrete
 * Jacobi field that needs no rescaling). All cost O(elements). */
#pragma once
#include "base/vec3.h"
#include <stdbool.h>

typedef struct RodEquilibrium {
    int elements;
    double length;     /* m */
    const Vec3 *k, *m; /* [2 elements + 1] strains, 1/m, and moments, N m, in the frames */
    const Vec3 *K; /* [3 elements] stiffness (GJ, EI1, EI2), N m^2, at each element's start, middle and end */
    const Vec3 *F; /* [3 elements] the pull of what lies beyond, N, in the frame at each element's start,
                        * middle and end: point loads make it jump at nodes */
} RodEquilibrium;

typedef struct RodStability {
    bool stable;
    int morse_index;          /* number of independent directions in which the energy falls */
    double lowest_eigenvalue; /* of d2E against EI int |phi|^2, EI the smaller one, 1/m^2 */
    double critical_factor;   /* see below */
    double stable_tail;       /* m, see below */
} RodStability;

/* How many bending lengths sqrt(EI/|F|), within which a force F turns a rod into its own direction, an element
 * has: the most of those that bend by more than a twentieth of a radian. Above 1 they do not tell how the rod
 * bends there, and nothing below can be trusted. */
double rod_bending_lengths(const RodEquilibrium *rod);

/* Everything below at once. */
RodStability rod_stability(const RodEquilibrium *rod);

int rod_morse_index(const RodEquilibrium *rod);

/* To 1e-8, or to 1e-8/length^2 where it is smaller than 1/length^2; round-off adds 1e-16 elements^2. */
double rod_lowest_eigenvalue(const RodEquilibrium *rod);

/* The rod is stable for all stiffnesses above this factor times K, with m and F as they are (the natural
 * shape is then always the one that sags into the same curve), and unstable just below: the critical Young's
 * modulus is that factor times the present one. To 1e-8. 0: stable at any stiffness, down to a millionth of
 * where the loads could do anything. */
double rod_critical_factor(const RodEquilibrium *rod);

/* The length of the longest tail that is stable by itself if clamped where it begins: from the free end to
 * the nearest conjugate point. The whole length of a stable rod. */
double rod_stable_tail(const RodEquilibrium *rod);
