/* segment.h - the relative rotation of an element's two nodes, p = conj(q_a) q_b = (w, v), for a pack of
 * elements: strain, chord, and how functions of p change with the two turns.
 *
 * theta = 2 g(w) v is the rotation vector from a to b, g = acos(w)/sqrt(1 - w^2), and theta/h the strain. The
 * chord of the helix over h, in the frame of a, is
 *
 *     c(p) = w f e_x + b v (v.e_x) + f v x e_x,   f = 1/g,   b = (1 - w f)/(1 - w^2).
 *
 * A turn phi of a node makes q (1, phi/2), of length 1, of q: to second order
 *
 *     dp = (p phi_b - phi_a p)/2,   d2p = -(|phi_a|^2 + |phi_b|^2) p/4 - phi_a p phi_b/2. */
#pragma once
#include "rod/rod.h"
#include "solve/element.h"

typedef struct PackQuat {
    Pack w;
    Pack3 v;
} PackQuat;

/* r(u) = (g - 1)/u, u = 1 - w, and what follows from it; derivatives with respect to w. */
typedef struct Radial {
    Pack g, g1, g2, f, f1, f2, b, b1, b2;
} Radial;

typedef struct Segment {
    PackQuat qa, p;
    Pack3 turn_a, turn_b;
    Radial radial;
} Segment;

/* First and second derivatives of a function of p. */
typedef struct Jet {
    Pack w;
    Pack3 v;
    Pack ww;
    Pack3 wv;
    PackMat vv;
} Jet;

/* Elements of the pack at x (whole vector), with turns[6] of a and b. The last element fills up. */
Segment segment_at(const RodLayout *layout, int pack, const double *x, const Pack *turns);

static inline int segment_lane(const RodLayout *layout, int pack, int lane)
{
    int e = pack * PACK_LANES + lane, last = layout->elements - 1;
    return e < last ? e : last;
}

static inline Pack3 segment_theta(const Segment *s)
{
    return pack3_scale(2 * s->radial.g, s->p.v);
}

/* The chord over h, in the frame of a. */
Pack3 segment_chord(const Segment *s);

/* v of the world in the frame of a, and the other way. */
Pack3 segment_to_body(const Segment *s, Pack3 v);
Pack3 segment_to_world(const Segment *s, Pack3 v);

/* The same of b. */
Pack3 segment_to_body_b(const Segment *s, Pack3 v);
Pack3 segment_to_world_b(const Segment *s, Pack3 v);

/* dp for turns phi_a, phi_b. */
PackQuat segment_rate(const Segment *s, Pack3 a, Pack3 b);

/* d theta and d chord of dp. */
Pack3 segment_theta_rate(const Segment *s, PackQuat dp);
Pack3 segment_chord_rate(const Segment *s, PackQuat dp);

/* The function m.theta: its derivatives for a constant m (second ones with `second`). */
Jet segment_theta_jet(const Segment *s, Pack3 m, bool second);

/* The function F.chord, F constant in the frame of a. */
Jet segment_chord_jet(const Segment *s, Pack3 F, bool second);

/* Gradient with respect to the turns: g[6] += */
void segment_pull_gradient(const Segment *s, const Jet *jet, Pack *g);

/* Second derivatives with respect to the turns, as blocks aa, ab (rows a), bb. */
void segment_pull_hessian(const Segment *s, const Jet *jet, PackMat block[3]);

/* The derivative with respect to a turn that is not 0, from that with respect to a further one: for trial
 * points. */
Pack3 segment_turned(Pack3 turn, Pack3 gradient);
