/* stations.h - a discrete rod in equilibrium, seen at the stations of a curve (nodes and middles of
 * elements), as stability.h takes it. */
#pragma once
#include "rod/rod.h"

/* Of a strand: strains k[stations], moments K (k - kbar) m[stations] and pulls F[3 elements] in the frames: what
 * elements have, with means at nodes and continued to the ends; at a free end the couple there. Magnetisation counts along
 * the tangent only. */
typedef struct RodStations {
    Vec3 *k, *m, *F;
} RodStations;

void rod_stations(const Rod *rod, int strand, const RodLayout *layout, const double *x, const double *p,
                  RodStations to);

/* A single rod as a curve: the pieces of helices that its elements are, at their nodes and middles. To be cleared.
 */
void rod_curve_of(const Rod *rod, const RodLayout *layout, const double *x, RodCurve *curve);

/* What the rod beyond each element's middle does to what is before it, in the world, force[elements], N; in a motion what
 * moves it, too. */
void rod_element_forces(const Rod *rod, const RodLayout *layout, const double *x, const double *p,
                        Vec3 *force);

/* Moments at the nodes in the world, moment[nodes], N m. */
void rod_node_moments(const Rod *rod, const RodLayout *layout, const double *x, const double *p,
                      Vec3 *moment);
