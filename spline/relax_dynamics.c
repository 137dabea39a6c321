/* Dynamics: strokes with mass fall in the energy's landscape, by implicit Euler. Each step minimises energy
 * and inertia (inertia.c). Where Linewise's equations of motion had L = T + V and a mass that changed with
 * the stretch, this has L = T - V and a constant mass matrix. */
#include "base/memory.h"
#include "spline/relax_private.h"

enum { STEP_ITERATIONS = 30, STEP_WINDOW = 4 };

static const double STEP_TOL = 1e-4; /* of the energies: what a step's last four iterations may still gain */

void relax_dynamics(Relaxation *r)
{
    size_t n = (size_t)r->n;
    double *x = r->strokes->q, *before = mem_alloc(2 * n, sizeof *before), *v = before + n;
    double dt = r->def->time_step * r->target->spacing;
    DescentDef def = {.memory = r->def->memory,
                      .refresh = r->def->refresh,
                      .max_iterations = STEP_ITERATIONS,
                      .window = STEP_WINDOW,
                      .energy_tol = STEP_TOL,
                      .gradient_tol = r->def->gradient_tol};
    r->info.status = RELAX_MAX_ITERATIONS;
    for (int k = 0; k < r->def->time_steps; k++) {
        memcpy(before, x, n * sizeof *x);
        Point at = relax_point(r, x);
        at.x_prev = before, at.v_prev = v, at.dt = dt;
        RelaxStatus status = relax_minimize(r, &def, &at, x);
        if (status == RELAX_NOT_FINITE) r->info.status = status;
        for (size_t i = 0; i < n; i++) v[i] = (x[i] - before[i]) / dt;
        r->info.kinetic = spline_kinetic_energy(r->model, v);
        r->info.iterations++;
        relax_take_energies(r);
        if (!relax_tell(r)) r->info.status = RELAX_STOPPED;
        if (r->info.status != RELAX_MAX_ITERATIONS) break;
    }
    mem_free(before);
}
