/* Energies, forces and stability of a given pose: positions stay, only edge angles are relaxed. */
#include "base/memory.h"
#include "cli/job.h"
#include "solve/eigen.h"
#include <string.h>

/* Edge angles of the pose, with all positions held. */
static NewtonStatus relax_angles(Run *run, ModelCase *c)
{
    Shell *shell = run->model->shell;
    size_t positions = 3 * (size_t)shell->mesh->vertex_count;
    bool *fixed = mem_copy(shell->fixed, positions, sizeof *fixed);
    for (size_t i = 0; i < positions; i++) shell->fixed[i] = true;
    System *held = shell_system(shell);
    memcpy(shell->fixed, fixed, positions * sizeof *fixed);
    mem_free(fixed);
    NewtonStatus status = NEWTON_CONVERGED;
    NewtonDef def = newton_default();
    run_newton(run, &def);
    Point at = state_point(&c->state, c->stages[0].p);
    if (system_free_count(held)) status = newton_minimize(held, &def, &at, &c->state, NULL).status;
    system_destroy(held);
    return status;
}

/* The body may move: is the pose stable, whether or not it is an equilibrium? */
static NewtonStatus stability(const ModelCase *c)
{
    Point at = state_point(&c->state, c->stages[0].p);
    double lowest;
    if (!system_free_count(c->sys)) return NEWTON_CONVERGED;
    if (!eigen_lowest(c->sys, &at, 1, &lowest, NULL)) return NEWTON_NOT_FINITE;
    return lowest < 0 ? NEWTON_SADDLE : NEWTON_CONVERGED;
}

RunStatus job_evaluate(Run *run, Error *err)
{
    Model *model = run->model;
    Snapshot *shots = mem_alloc((size_t)model->case_count, sizeof *shots);
    NewtonStatus worst = NEWTON_CONVERGED;
    bool ok = true;
    for (int k = 0; ok && k < model->case_count; k++) {
        ModelCase *c = &model->cases[k];
        NewtonStatus relaxed = relax_angles(run, c);
        if (relaxed > worst) worst = relaxed;
        shots[k] = (Snapshot){c, c->stages[0].p, c->state, stability(c)};
        ok = run_put_frame(run, k, k, &shots[k], k == 0, err);
        progress_step(run->progress, k + 1, model->case_count, "%s: %s", c->name,
                      shots[k].status == NEWTON_CONVERGED ? "stable" : "unstable");
    }
    Arrays list = {0};
    const char *status = worst == NEWTON_CONVERGED ? "evaluated" : newton_status_name(worst);
    if (ok) run_add_final(run, shots, model->case_count, status, &list);
    ok = ok && arrays_replace(&list, run->journal, "final", err);
    mem_free(shots);
    if (!ok) return RUN_CANNOT_WRITE;
    return worst == NEWTON_CONVERGED ? RUN_DONE : RUN_NOT_CONVERGED;
}
