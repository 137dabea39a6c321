/* ring_nodes.h - where an integral around a circle is summed whose integrand is sharp at one angle: at a point near the
 * circle, of what the circle carries.
 *
 * The square of the distance of a point from the circle's, R^2 = (a + rho)^2 + zeta^2 - 4 a rho cos^2(psi/2), is that of
 * Jacobi's dn(u | k) with cos(psi/2) = sn u, 4 a rho = k^2 ((a + rho)^2 + zeta^2). In u the integrand has the period 2 K, and
 * what is singular in it where R = 0 lies at Im u = K', however near the point is: the trapezoidal rule in u has an error of
 * exp(-2 pi n K'/K) with n nodes for psi in (0, pi), and K'/K falls with the logarithm of the distance only. sn, cn and dn
 * come of the arithmetic-geometric mean [Bulirsch 1965], cn without cancellation near the point. */
#pragma once
#include "base/pack.h"

enum { RING_MEANS = 16 };

typedef struct RingNodes {
    int packs, means;
    double first[RING_MEANS], second[RING_MEANS], mean; /* of 1 and k' */
} RingNodes;

/* For rounding, at a distance rho from the axis of a circle of a radius, and zeta (all m) from its plane. */
RingNodes ring_nodes(double radius, double rho, double zeta);

/* A pack of them: sine and cosine of psi/2, psi in (0, pi) from the point, and the shares of what is even in psi in its mean
 * around the circle. On the circle itself shares are not finite. */
typedef struct RingNode {
    Pack sine, cosine, share;
} RingNode;

RingNode ring_node(const RingNodes *nodes, int pack);
