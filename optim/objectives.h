/* objectives.h - objectives of vertex positions (three dofs per vertex, first in x). */
#pragma once
#include "solve/objective.h"

/* sum over the listed vertices of |x_v - target_v|^2, m^2; vertices[count] and target[count][3] are copied.
 */
Objective objective_target(int count, const int *vertices, const double (*target)[3], double weight);

/* Mean height (z) of the listed vertices, m; no sum of squares. */
Objective objective_height(int count, const int *vertices, double weight);
