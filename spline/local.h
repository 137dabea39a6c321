/* local.h - how the energy changes when one stroke changes, comes or goes: for moves that are tried one after
 * the other. */
#pragma once
#include "spline/model.h"

typedef struct Local Local;

/* Of the strokes of the model at x (copied); absent (NULL: none) marks those that are not there yet. Weights
 * as Point.p. The model is borrowed. */
Local *local_create(const SplineModel *model, const SplineWeights *weights, const double *x,
                    const bool *absent);
void local_destroy(Local *local);

/* The change of the energy if the stroke's dofs become q[nodes][4]; NULL: if it goes. Not finite where the
 * energy would not be. Before the next one, the change is either made or not. */
double local_change(Local *local, int stroke, const double *q);
void local_accept(Local *local);
void local_reject(Local *local);

/* Sums the ink anew, in which round-off has gathered. */
void local_renew(Local *local);
