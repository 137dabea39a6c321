#include "field/ring_nodes.h"
#include <stdbool.h>

/* The arithmetic-geometric mean of 1 and b, of the last means' squared difference; 0 of 0. */
static double mean_of(double b, RingNodes *nodes)
{
    const double little = 1e-8;
    double a = 1;
    nodes->means = 0;
    if (b == 0) return 0;
    while (true) {
        nodes->first[nodes->means] = a, nodes->second[nodes->means] = b;
        double mean = (a + b) / 2;
        if (++nodes->means == RING_MEANS || fabs(a - b) <= little * a) return mean;
        b = sqrt(a * b), a = mean;
    }
}

RingNodes ring_nodes(double radius, double rho, double zeta)
{
    const double digits = 45;
    double most = hypot(radius + rho, zeta), k = 2 * sqrt(radius * rho) / most,
           complement = hypot(radius - rho, zeta) / most;
    RingNodes nodes;
    double other = mean_of(k, &nodes); /* K'/K = mean/other */
    nodes.mean = mean_of(complement, &nodes);
    double count = nodes.mean > 0 ? digits * other / (2 * M_PI * nodes.mean) : 0;
    nodes.packs = 1 + (int)(count / PACK_LANES);
    return nodes;
}

RingNode ring_node(const RingNodes *nodes, int pack)
{
    int count = PACK_LANES * nodes->packs;
    Pack c, dn = pack_set(1), one = pack_set(1);
    for (int l = 0; l < PACK_LANES; l++)
        c[l] = nodes->mean / tan((PACK_LANES * pack + l + 0.5) * (M_PI / 2) / count);
    Pack a = c / nodes->mean;
    for (int k = nodes->means - 1; k >= 0; k--) { /* ascending Landen transformations */
        a = a * c;
        c = c * dn;
        dn = (nodes->second[k] + a) / (nodes->first[k] + a);
        a = c / nodes->first[k];
    }
    Pack sn = one / pack_sqrt(c * c + 1);
    return (RingNode){.sine = c * sn, .cosine = sn, .share = dn / (count * nodes->mean)};
}
