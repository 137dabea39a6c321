/* self_contact.h - a body that does not pass through itself, and pieces that do not pass through each other.
 *
 * Between a vertex and a face, and between two edges, nearer than D acts
 *
 *     E = k w m psi(e),   psi = e^3/(3 (1 - e)),   e = (D - d)/D:
 *
 * soft at first (C2 at d = D) and hardening without bound as d goes to 0, so that no stiffness is too small. w is the
 * vertex's area over the mean one, or the like of the two edges; 1 in a rod, whose vertices stand against its edges.
 * m takes edges that are nearly parallel out (distance.h), for their distance has kinks: their ends are vertices, and stand
 * against the other's face or edge.
 *
 * Where the body's outside is not the same everywhere, D is a pair's own, the sum of what its two sides have, and k is that
 * of the largest D there is: k (D/largest)^3 of others, as a stiffness Y D^3 is of them. It does not change with x.
 *
 * Left out are pairs that share a vertex, pairs of one piece nearer than 1.6 D at rest, and pairs that are held as a
 * whole. Pieces always meet.
 *
 * The elements are a function of the point. The State remembers places y of the vertices; where x is, beside a motion of
 * the whole, no further than half a margin from y, the elements are the pairs nearer than D + margin at y, else those at
 * x; y becomes x where an accepted x is further away. So the elements hold every pair that acts, a slow motion changes
 * nothing, and a resumed run has the elements of the uninterrupted one.
 *
 * Nothing passes through: a Newton step ends where a pair has come to a tenth of its distance (TermOps.reach), and a trial
 * that did not come along such a step (inertial guesses, sheets that turn, vertices that are moved) is pulled back towards
 * where it came from, or, where that would move held vertices or positions that follow from other dofs, is not finite and
 * so refused (TermOps.project). */
#pragma once
#include "solve/term.h"

/* Pairs of one piece nearer at rest are left out; parts of D: more than a quarter of a circle around it
 * (rod/self_contact.h). */
static const double SELF_CONTACT_REST = 1.6;

typedef struct SelfContactDef {
    int vertex_count, first;    /* positions of vertex v are the dofs first + 3v ..              */
    int face_count, edge_count; /* a rod has no faces                                            */
    const int (*faces)[3], (*edges)[2];
    const double (*rest)[3]; /* [vertex] m; all borrowed                                      */
    const int *part;         /* [vertex] piece that it belongs to; NULL: one                  */
    const bool *fixed;       /* [3*vertex_count] held; NULL: nothing                          */
    bool derived;            /* positions follow from other dofs, a rod's from its turns      */
    double distance;         /* D, m: a shell's thickness, twice a rod's radius; the largest  */
    /* m, from each vertex, edge, face (of a rod edge) to its outside; borrowed; NULL: half of the distance. */
    const double *vertex_outside, *edge_outside, *face_outside;
    double margin;           /* in parts of D; 0: 1/4                                         */
    int stiffness, friction; /* first entries in p: k, J; the coefficient of friction         */
    double slip_speed;       /* m/s: friction is full from there on                           */
} SelfContactDef;

Term self_contact_term(const SelfContactDef *def);

/* Between pairs nearer than D at x_lag (point_lag), with normal force N = -dE/dd, nearest points and normal n there:
 *
 *     E = dt mu N f0(|u|/dt),   u = (I - n n^T) sum w_i (x_i - x_prev,i),
 *
 * f0 the smoothed |v| of docs/theory.md, with slip_speed. Nothing in statics. */
Term self_friction_term(const SelfContactDef *def);

/* Of the pairs that act at x, whole vector, with stiffness k. */
typedef struct SelfContactFigures {
    int pairs;
    double distance; /* m, the least; INFINITY where none is nearer than D */
    double force;    /* N, the sum of all N                                */
} SelfContactFigures;

SelfContactFigures self_contact_figures(const Term *self_contact, const double *x, double stiffness);

/* The least distance, m, of pairs that may meet and are nearer than so many parts of D at x, and a vertex of each side of
 * that pair; INFINITY: there is none. */
double self_contact_nearest(const SelfContactDef *def, const double *x, double parts, int vertices[2]);

/* Of one piece that at rest is no larger than 1.6 D, all pairs are left out: nothing may meet. Its size, m, or INFINITY
 * where something may. */
double self_contact_nothing(const SelfContactDef *def);
