/* Lowest eigenvalues and modes of a final state, and how it vibrates. */
#include "base/memory.h"
#include "job/run.h"
#include "solve/eigen.h"
#include <math.h>
#include <string.h>

/* The positions' part of so many modes, [count][point_count][3] of v'v = 1. */
static void add_modes(const Model *model, const char *name, const double *vectors, int dofs, int count,
                      Arrays *list)
{
    size_t positions = 3 * (size_t)model->point_count;
    double *mode = arrays_numbers(list, (size_t)count * positions);
    for (int k = 0; k < count; k++)
        memcpy(mode + (size_t)k * positions, vectors + (size_t)k * (size_t)dofs, positions * sizeof *mode);
    Array shape = array_float(name, "", mode, 3, count, model->point_count);
    shape.dims[2] = 3;
    arrays_add(list, shape);
}

/* Of every position the lumped mass of its point; NULL: some have none, and there are no frequencies. */
static double *position_masses(const Model *model, const double *p, Arrays *list)
{
    int points = model->point_count;
    if (!model->body->ops->masses) return NULL;
    double *mass = arrays_numbers(list, (size_t)points), *M = arrays_numbers(list, 3 * (size_t)points);
    model_masses(model, p, mass);
    for (int i = 0; i < 3 * points; i++) {
        M[i] = mass[i / 3];
        if (!(M[i] > 0)) return NULL;
    }
    return M;
}

/* H v = omega^2 M v */
void run_add_vibrations(const Model *model, System *sys, const Point *at, int count, Arrays *list)
{
    const double *M = position_masses(model, at->p, list);
    int dofs = system_dof_count(sys);
    double *hz = arrays_numbers(list, (size_t)count),
           *vectors = arrays_numbers(list, (size_t)count * (size_t)dofs);
    if (!M || !eigen_lowest(sys, at, M, count, hz, vectors)) return;
    for (int k = 0; k < count; k++) {
        double *v = vectors + (size_t)k * (size_t)dofs, size = 0;
        hz[k] = copysign(sqrt(fabs(hz[k])) / (2 * M_PI), hz[k]);
        for (int i = 0; i < 3 * model->point_count; i++) size += v[i] * v[i];
        for (int i = 0; size > 0 && i < dofs; i++) v[i] /= sqrt(size);
    }
    arrays_add(list, array_float("final/modes_hz", "Hz", hz, 1, count, 0));
    add_modes(model, "final/vibrations", vectors, dofs, count, list);
}

void run_add_stability(const Model *model, const Snapshot *shot, int modes, Arrays *list)
{
    System *sys = shot->load_case->sys;
    Point at = state_point(&shot->at, shot->p);
    int dofs = system_dof_count(sys), count = modes > 1 ? modes : 1;
    if (system_free_count(sys) == 0) return;
    double *values = arrays_numbers(list, (size_t)count),
           *vectors = arrays_numbers(list, (size_t)count * (size_t)dofs);
    if (!eigen_lowest(sys, &at, NULL, count, values, vectors)) return;
    arrays_add(list, array_float("final/lowest_eigenvalue", "N/m", values, 0, 0, 0));
    /* The mode of an instability is kept in any case: it says which way the body would go. */
    if (!modes && values[0] >= 0) return;
    arrays_add(list, array_float("final/eigenvalues", "N/m", values, 1, count, 0));
    add_modes(model, "final/modes", vectors, dofs, count, list);
    if (modes) run_add_vibrations(model, sys, &at, count, list);
}
