/* smoothness.h - objectives that need the shell's neighbours. */
#pragma once
#include "shell/shell.h"
#include "solve/objective.h"

/* The sum of squared jumps of a block of parameters between neighbours: small where what is made need not change at once.
 * Faces are neighbours over inner edges, edges where they bound one face. Magnetisation: of the vectors, (A/m)^2; Young's
 * modulus: of its logarithm, as it goes over decades; folds, which may be 0: of their factor. Borrows the shell. */
Objective shell_smoothness(const Shell *shell, const ParamBlock *block, double weight);
