/* Lowest eigenvalues and modes of a final state. */
#include "base/memory.h"
#include "job/run.h"
#include "solve/eigen.h"
#include <string.h>

void run_add_stability(const Model *model, const Snapshot *shot, int modes, Arrays *list)
{
    System *sys = shot->load_case->sys;
    Point at = state_point(&shot->at, shot->p);
    int positions = 3 * model->point_count, dofs = system_dof_count(sys), count = modes > 1 ? modes : 1;
    if (system_free_count(sys) == 0) return;
    double *values = arrays_numbers(list, (size_t)count),
           *vectors = arrays_numbers(list, (size_t)count * (size_t)dofs);
    if (!eigen_lowest(sys, &at, count, values, vectors)) return;
    arrays_add(list, array_float("final/lowest_eigenvalue", "N/m", values, 0, 0, 0));
    /* The mode of an instability is kept in any case: it says which way the body would go. */
    if (!modes && values[0] >= 0) return;
    double *mode = arrays_numbers(list, (size_t)count * (size_t)positions);
    for (int k = 0; k < count; k++)
        memcpy(mode + (size_t)k * (size_t)positions, vectors + (size_t)k * (size_t)dofs,
               (size_t)positions * sizeof *mode);
    arrays_add(list, array_float("final/eigenvalues", "N/m", values, 1, count, 0));
    Array shape = array_float("final/modes", "", mode, 3, count, positions / 3);
    shape.dims[2] = 3;
    arrays_add(list, shape);
}
