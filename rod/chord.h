/* chord.h - the work of a force on an element's chord, which weight (hang.c) and inextensibility (link.c)
 * share. */
#pragma once
#include "rod/term.h"

typedef struct Chord {
    Segment s;
    Pack h;  /* m */
    Pack3 C; /* in the frame of the first node, m */
} Chord;

Chord chord_at(const RodTerm *term, int pack, const double *x, const Pack *turns);

/* R_a C */
Pack3 chord_world(const Chord *chord);

/* d(R_a C) of turns. */
Pack3 chord_rate(const Chord *chord, Pack3 turn_a, Pack3 turn_b);

/* -T.R_a C for a force T of the world: adds its gradient to g[6]; writes its second derivatives as blocks aa,
 * ab, bb. */
void chord_gradient(const Chord *chord, Pack3 T, Pack *g);
void chord_hessian(const Chord *chord, Pack3 T, PackMat block[3]);
