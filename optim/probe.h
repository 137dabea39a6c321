/* probe.h - a point of the body that lies between its vertices as masses have it: a vertex, a mean, or a centre of mass. Where
 * masses follow p, as a shell's its thicknesses and densities, so does the point. */
#pragma once
#include "base/vec3.h"
#include "solve/masses.h"
#include <stdbool.h>

/* q = sum m_k x_k / sum m_k, m_k the masses, x_k the places of the vertices. */
typedef struct Probe {
    int *vertices; /* [masses.count]; owned */
    Masses masses; /* owned                 */
} Probe;

/* The centre of mass of all points; takes the masses. */
Probe probe_center(Masses masses);

Probe probe_copy(const Probe *probe);
void probe_clear(Probe *probe);

/* Of one body: always at the same place? */
bool probe_is_same(const Probe *a, const Probe *b);

/* Places of all vertices, three numbers each, first in x. */
Vec3 probe_at(const Probe *probe, const double *x, const double *p);

/* How q changes along (vx, vp). */
Vec3 probe_change(const Probe *probe, const double *x, const double *p, const double *vx, const double *vp);

/* dx, dp += force . dq/d(x, p). */
void probe_pull(const Probe *probe, const double *x, const double *p, Vec3 force, double *dx, double *dp);
