/* turn.h - finite motion of a sheet from a velocity: faces turn, they do not only shift.
 *
 * A straight step x + a d stretches all that it turns, by the square of the angle; in a thin sheet that costs more than
 * bending will ever gain. So each face is given the finite rotation exp(a w) of its angular velocity w, and its stretch
 * I + a D, where w and D are the skew and the symmetric part of the velocity's gradient, the normal's turn included; the
 * positions are those whose gradients come nearest to these over the rest areas (one linear solve with a matrix that never
 * changes, as for as-rigid-as-possible surfaces [Sorkine, Alexa 2007]). To first order in a that is the straight step. A rigid
 * turn stays rigid, and a sheet that rolls up keeps its lengths, at any angle. */
#pragma once
#include "shell/shell.h"

typedef struct Turn Turn;

/* Of a shell whose coordinates are held as they are now; borrows it. Memory and factor come with the first use. */
Turn *turn_create(const Shell *shell);
void turn_destroy(Turn *turn);

/* Moves the positions in to, which is x + a d, to where the motion from x with velocity d is after the time a; whole vectors of
 * dofs. Held coordinates stay; of a part that nothing holds along an axis the first vertex goes the straight way. */
void turn_follow(Turn *turn, const double *x, const double *d, double a, double *to);
