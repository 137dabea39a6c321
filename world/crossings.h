/* crossings.h - where a surface passes through itself or another piece: nothing that self contact could mend. */
#pragma once
#include "world/neighbours.h"

/* How many edges pass through faces that they share no vertex with, at places x, whole vector; the first `max` of them are
 * written to pairs: {edge, face}, by edge. Of a rod: {edge, edge} that may meet (self_contact.h) and are nearer than a
 * tenth of D. */
int self_contact_crossings(const SelfContactDef *def, const double *x, int (*pairs)[2], int max);

/* The same again and again, of what n is of. */
int crossings_find(Neighbours *n, const double *x, int (*pairs)[2], int max);
