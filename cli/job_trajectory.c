/* Design of a motion: unknowns, most of all a field over time, that make the body go where it should. */
#include "base/memory.h"
#include "cli/design_run.h"
#include "cli/job.h"
#include "optim/objectives.h"
#include "optim/trajectory_adjoint.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct TrajectoryJob {
    Run *run;
    ModelCase *c;
    Trajectory *t;
    double objective;
    bool refused; /* a formula of time is not finite; err says so */
    Error err;
} TrajectoryJob;

static void load(void *self, double time, double *p)
{
    TrajectoryJob *job = self;
    if (!job->run->model->control.rows) job->refused |= !model_load(job->run->model, time, p, &job->err);
}

static bool move(void *self, double time, double *x)
{
    TrajectoryJob *job = self;
    job->refused |= !model_move(job->run->model, time, 1, x, &job->err);
    return !job->refused;
}

static double evaluate(void *self, const double *u, double *gradient, Evaluated *evaluated)
{
    TrajectoryJob *job = self;
    TrajectoryInfo info;
    job->objective = trajectory_evaluate(job->t, u, gradient, &info);
    *evaluated = (Evaluated){.newton_iterations = info.march.newton.iterations,
                             .aborted = info.march.newton.status == NEWTON_STOPPED,
                             .status = info.march.newton.status,
                             .case_objectives = &job->objective,
                             .case_count = 1};
    return job->objective;
}

static void accept(void *self)
{
    trajectory_accept(((TrajectoryJob *)self)->t);
}

static void product(void *self, const double *v, double soft, double *out)
{
    (void)soft;
    trajectory_product(((TrajectoryJob *)self)->t, v, out);
}

/* ---- The best motion's states ---- */

static bool put_best(void *self, int slot, Error *err)
{
    TrajectoryJob *job = self;
    TrajectoryState state = trajectory_state(job->t);
    size_t count = (size_t)state.count, dofs = (size_t)system_dof_count(job->c->sys),
           memory = (size_t)system_memory_count(job->c->sys);
    double number = state.count;
    return run_put_state(job->run, slot, "count", &number, 1, err) &&
           run_put_state(job->run, slot, "dt", state.dt, count, err) &&
           run_put_state(job->run, slot, "x", state.x, (count + 1) * dofs, err) &&
           run_put_state(job->run, slot, "memory", state.memory, (count + 1) * memory, err);
}

static bool get_best(void *self, int slot, const double *u)
{
    TrajectoryJob *job = self;
    size_t dofs = (size_t)system_dof_count(job->c->sys), memory = (size_t)system_memory_count(job->c->sys);
    double number;
    if (!run_get_state(job->run, slot, "count", &number, 1)) return false;
    size_t count = (size_t)number;
    double *dt = mem_alloc(count, sizeof *dt), *x = mem_alloc((count + 1) * dofs, sizeof *x),
           *turns = mem_alloc((count + 1) * memory, sizeof *turns);
    bool ok = run_get_state(job->run, slot, "dt", dt, count) &&
              run_get_state(job->run, slot, "x", x, (count + 1) * dofs) &&
              run_get_state(job->run, slot, "memory", turns, (count + 1) * memory);
    TrajectoryState state = {(int)count, x, turns, dt};
    if (ok) trajectory_restore(job->t, u, &state);
    mem_free(dt);
    mem_free(x);
    mem_free(turns);
    return ok;
}

/* ---- The result ---- */

static State frame_state(TrajectoryJob *job, int frame)
{
    const TimeScene *time = &job->run->scene->time;
    return (State){job->c, trajectory_params(job->t, frame), trajectory_frame(job->t, frame),
                   time->at + time->step * frame, NEWTON_CONVERGED};
}

/* Frames of the best motion: every so many, and the last. */
static bool put_frames(TrajectoryJob *job, int first, Error *err)
{
    int every = job->run->scene->output.every, steps = job->run->scene->time.steps, index = first;
    if (every == 0) every = 1;
    for (int n = 0; n <= steps; n++) {
        if (n % every && n != steps) continue;
        State state = frame_state(job, n);
        if (!run_put_frame(job->run, index, state.time, &state, index == first, err)) return false;
        index++;
    }
    return true;
}

/* trajectory/flux_density: what acts in each step. */
static bool put_field(TrajectoryJob *job, Error *err)
{
    int steps = job->run->scene->time.steps, flux = job->run->model->flux_density;
    double *rows = mem_alloc(3 * (size_t)steps, sizeof *rows);
    for (int n = 1; n <= steps; n++)
        memcpy(rows + 3 * (n - 1), trajectory_params(job->t, n) + flux, 3 * sizeof *rows);
    Array array = array_float("trajectory/flux_density", "T", rows, 2, steps, 3);
    bool ok = journal_put(job->run->journal, "final", 0, &array, 1, err);
    mem_free(rows);
    return ok;
}

/* dF/dp of the unknowns, and what the start's places and velocities do to F. */
static bool put_gradients(TrajectoryJob *job, Error *err)
{
    const Model *model = job->run->model;
    size_t dofs = (size_t)system_dof_count(job->c->sys);
    double *dp = mem_alloc((size_t)model->params->size, sizeof *dp), *dx = mem_alloc(2 * dofs, sizeof *dx);
    trajectory_gradients(job->t, dp, dx, dx + dofs);
    bool ok = true;
    for (int k = 0; ok && k < model->design.unknown_count; k++) {
        const ParamBlock *block = model->design.unknowns[k].block;
        bool control = model->control.rows && block->offset == model->control.from;
        ok = design_put_gradient(job->run, control ? "flux_density" : block->name, block->unit,
                                 dp + block->offset, block->count, block->width, err);
        Array values = array_float("design/flux_density", "T", trajectory_params(job->t, 0) + block->offset,
                                   2, block->count, 3);
        if (ok && control) ok = journal_put(job->run->journal, "final", 0, &values, 1, err);
    }
    int vertices = model->point_count;
    ok = ok && design_put_gradient(job->run, "start_x", "m", dx, vertices, 3, err) &&
         design_put_gradient(job->run, "start_v", "m/s", dx + dofs, vertices, 3, err);
    mem_free(dp);
    mem_free(dx);
    return ok;
}

/* The largest distance of each row's point to its place or curve, over the frames at which it counts. */
static bool put_distances(TrajectoryJob *job, Error *err)
{
    int rows = job->c->objective_count;
    double *largest = mem_alloc((size_t)rows, sizeof *largest);
    bool any = false;
    for (int k = 0; k < rows; k++) {
        const Objective *row = &job->c->objectives[k];
        for (int n = row->first; n <= row->last; n++) {
            double distance = objective_distance(row, trajectory_frame(job->t, n));
            largest[k] = n == row->first ? distance : fmax(largest[k], distance);
        }
        if (isnan(largest[k])) continue;
        any = true;
        progress_say(job->run->progress, "%s, frames %d to %d: largest distance %.3g mm", row->ops->name,
                     row->first, row->last, 1e3 * largest[k]);
    }
    Array array = array_float("metrics/largest_distance", "m", largest, 1, rows, 0);
    bool ok = !any || journal_put(job->run->journal, "final", 0, &array, 1, err);
    mem_free(largest);
    return ok;
}

static bool put_results(void *self, int first, const char *status, Error *err)
{
    TrajectoryJob *job = self;
    bool ok = put_frames(job, first, err) && put_field(job, err) && put_distances(job, err);
    State end = frame_state(job, job->run->scene->time.steps);
    return ok && run_put_final(job->run, &end, 1, status, err) && put_gradients(job, err);
}

RunStatus job_trajectory(Run *run, Error *err)
{
    static const DesignOps ops = {.evaluate = evaluate,
                                  .accept = accept,
                                  .product = product,
                                  .put_best = put_best,
                                  .get_best = get_best,
                                  .put_results = put_results};
    Model *model = run->model;
    const TimeScene *time = &run->scene->time;
    ModelCase *c = &model->cases[0];
    TrajectoryJob job = {.run = run, .c = c};
    TrajectoryProblem problem = {.sys = c->sys,
                                 .design = &model->design,
                                 .params = model->params,
                                 .controls = &model->control,
                                 .objectives = c->objectives,
                                 .control_count = model->control.rows > 0,
                                 .objective_count = c->objective_count,
                                 .start = time->at,
                                 .step = time->step,
                                 .steps = time->steps,
                                 .x = c->x,
                                 .v = model->v,
                                 .p = c->stages[0].p};
    TrajectoryDef def = trajectory_default();
    run_newton(run, &def.march.newton);
    def.march.observer = run_observer(run);
    def.march.load = load, def.march.self = &job;
    if (model->moves) def.march.move = move;
    job.t = trajectory_create(&problem, &def);
    double *u = mem_alloc((size_t)model->design.size, sizeof *u);
    design_read(&model->design, 0, problem.p, u);
    RunStatus status = design_run(run, &ops, &job, u, err);
    if (job.refused) {
        *err = job.err;
        status = RUN_CANNOT_WRITE;
    }
    trajectory_destroy(job.t);
    mem_free(u);
    return status;
}
