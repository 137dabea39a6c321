/* Energies, forces and stability of a given pose: points stay, the rest (edge angles) is relaxed. */
#include "base/memory.h"
#include "job/jobs.h"
#include "solve/eigen.h"
#include <math.h>
#include <string.h>

/* What is left of the pose where all points are held: edge angles. */
static NewtonStatus relax(Run *run, Case *c)
{
    const BodyOps *ops = run->model->body->ops;
    System *held = ops->pose_system ? model_take_system(run->model, ops->pose_system(run->model)) : NULL;
    NewtonStatus status = NEWTON_CONVERGED;
    NewtonDef def = newton_default();
    run_newton(run, &def);
    Point at = state_point(&c->state, c->stages[0].p);
    if (held && system_free_count(held)) status = newton_minimize(held, &def, &at, &c->state, NULL).status;
    system_destroy(held);
    return status;
}

/* All forces, or their derivatives. */
static Evaluation differentiate(const Case *c, bool twice)
{
    Point at = state_point(&c->state, c->stages[0].p);
    double *gradient = mem_alloc((size_t)c->state.dofs, sizeof *gradient);
    Evaluation now = twice ? system_hessian(c->sys, &at, gradient) : system_gradient(c->sys, &at, gradient);
    mem_free(gradient);
    return now;
}

static Balance balance_of_points(const Case *c)
{
    Evaluation now = differentiate(c, true);
    bool little = now.finite && now.gradient_max <= newton_round_off(c->sys, c->state.x);
    return (Balance){"forces", "N", little ? 0 : now.gradient_max, now.force_scale, now.finite};
}

/* Would the body leave the pose? Without an eigenvalue it does, by what moves no point (a rod that spins where it is).
 * False where nothing is known. */
static bool find_stability(const Case *c, bool *leaves)
{
    Point at = state_point(&c->state, c->stages[0].p);
    double lowest = INFINITY;
    bool found = system_free_count(c->sys) == 0 || eigen_lowest(c->sys, &at, NULL, 1, &lowest, NULL);
    *leaves = !found || lowest < 0;
    return found || differentiate(c, true).finite;
}

/* Is the pose an equilibrium, as Newton's method would call it, and would the body stay? Says so. */
static NewtonStatus judge(Run *run, Case *c, int k)
{
    const Model *model = run->model;
    Balance now = model->body->ops->balance ? model->body->ops->balance(model, c) : balance_of_points(c);
    bool leaves;
    if (!now.finite || !find_stability(c, &leaves)) return NEWTON_NOT_FINITE;
    bool judged = !system_circulates(c->sys);
    const char *said = !judged ? "of forces without a potential, so that no energy says whether it would stay"
                       : leaves ? "unstable"
                                : "stable";
    int count = model->case_count;
    if (now.most > newton_default().force_tol * now.scale) {
        host_step(run->host, k + 1, count,
                  "%s: %s, but no equilibrium: %s of up to %.3g %s are not in balance", c->name, said,
                  now.what, now.most, now.unit);
        return NEWTON_UNBALANCED;
    }
    host_step(run->host, k + 1, count, "%s: an equilibrium, %s", c->name, said);
    return judged && leaves ? NEWTON_SADDLE : NEWTON_CONVERGED;
}

static RunStatus run_evaluate(Run *run, Error *err)
{
    Model *model = run->model;
    Snapshot *shots = mem_alloc((size_t)model->case_count, sizeof *shots);
    NewtonStatus worst = NEWTON_CONVERGED;
    bool ok = true;
    for (int k = 0; ok && k < model->case_count; k++) {
        Case *c = &model->cases[k];
        NewtonStatus relaxed = relax(run, c);
        if (relaxed > worst) worst = relaxed;
        shots[k] =
            (Snapshot){.load_case = c, .p = c->stages[0].p, .at = c->state, .status = judge(run, c, k)};
        bool finite = shots[k].status != NEWTON_NOT_FINITE;
        if (!finite) {
            run_say_unknown_field(run, &shots[k], 0);
            host_say(run->host, "%s: %s", c->name, newton_status_text(shots[k].status));
        }
        if (run_is_crushed(run, &shots[k], false) || !finite) worst = shots[k].status;
        ok = run_put_frame(run, k, k, &shots[k], k == 0, err);
    }
    Arrays list = {0};
    const char *status = worst == NEWTON_CONVERGED ? "evaluated" : newton_status_name(worst);
    if (ok) run_add_final(run, shots, model->case_count, status, &list);
    ok = ok && arrays_replace(&list, run->journal, "final", err);
    mem_free(shots);
    if (!ok) return RUN_CANNOT_WRITE;
    return worst == NEWTON_CONVERGED ? RUN_DONE : RUN_NOT_CONVERGED;
}

static const char *const free_keys[] = {"output.precision", "modes", "time.steps", NULL};

const JobRow job_evaluate = {
    .name = "evaluate",
    .noun = "an evaluation",
    .run = run_evaluate,
    .given = true,
    .frames = FRAMES_STAY,
    .free_keys = free_keys,
    .effort = {1, 1, 2, 25, 100e6},
};
