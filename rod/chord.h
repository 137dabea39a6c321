/* chord.h - the way from an element's first node to its second, and the work of a force on it, which weight
 * (hang.c) and the link of positions (link.c) share.
 *
 * An element of a Cosserat rod stretches and shears, too: by the strain G = (along the tangent, n1, n2), the
 * same all along it, in the frames of both its nodes (the trapezoidal rule for r' = R (e_x + G)):
 *
 *     x_b - x_a = R_a C + h/2 (R_a + R_b) G,   C the chord of the helix, and the bow. */
#pragma once
#include "rod/term.h"

typedef struct Chord {
    Segment s;
    Pack h; /* m */
    bool stretches;
    Pack3 C; /* what turns with the first node, in its frame: C + h/2 G, m */
    Pack3 V; /* and what turns with the second one, in its frame: h/2 G, m */
} Chord;

/* own: the element's turns[6] and, if the rod stretches, its strain[3]. */
Chord chord_at(const RodTerm *term, int pack, const double *x, const Pack *own);

Pack3 chord_world(const Chord *chord);

/* How it changes with the turns, and with the strain. */
Pack3 chord_rate(const Chord *chord, Pack3 turn_a, Pack3 turn_b);
Pack3 chord_strain_rate(const Chord *chord, Pack3 strain);

/* -T.chord for a force T of the world: adds its gradient to g, which is laid out as `own`; writes its second derivatives
 * of the turns as blocks aa, ab, bb, and those of the strain (rows) and the turn of a or b. */
void chord_gradient(const Chord *chord, Pack3 T, Pack *g);
void chord_hessian(const Chord *chord, Pack3 T, PackMat block[3]);
void chord_mixed_hessian(const Chord *chord, Pack3 T, PackMat block[2]);
