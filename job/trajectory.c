/* Design of a motion: unknowns, most of all a field over time, that make the body go where it should. */
#include "base/memory.h"
#include "job/contacts.h"
#include "job/design_run.h"
#include "job/jobs.h"
#include "job/reference.h"
#include "optim/objectives.h"
#include "optim/trajectory_adjoint.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct TrajectoryJob {
    Run *run;
    Case *c;
    Trajectory *t;
    double *v;         /* [dofs] of the state that is shown */
    Contacts contacts; /* of the step to it */
    double objective;
    bool refused; /* a formula of time is not finite; err says so */
    Error err;
} TrajectoryJob;

static void load(void *self, double time, double *p)
{
    TrajectoryJob *job = self;
    bool given = job->run->model->control.rows > 0;
    job->refused |= !model_load(job->run->model, time, given, p, &job->err);
}

static bool move(void *self, double time, double *x)
{
    TrajectoryJob *job = self;
    job->refused |= !model_move(job->run->model, held_way(time), x, &job->err);
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

enum { KEPT = 3 };

/* Of so many steps. */
static void kept_rows(const TrajectoryJob *job, size_t count, Kept rows[KEPT])
{
    rows[0] = (Kept){"dt", NULL, count};
    rows[1] = (Kept){"x", NULL, (count + 1) * (size_t)system_dof_count(job->c->sys)};
    rows[2] = (Kept){"memory", NULL, (count + 1) * (size_t)system_memory_count(job->c->sys)};
}

static bool put_best(void *self, int slot, Error *err)
{
    TrajectoryJob *job = self;
    TrajectoryState state = trajectory_state(job->t);
    double number = state.count;
    Kept rows[1 + KEPT] = {{"count", &number, 1}};
    kept_rows(job, (size_t)state.count, rows + 1);
    rows[1].values = (double *)state.dt, rows[2].values = (double *)state.x,
    rows[3].values = (double *)state.memory;
    return run_put_state(job->run, slot, rows, 1 + KEPT, err);
}

static bool get_best(void *self, int slot, const double *u, bool *has, Error *err)
{
    TrajectoryJob *job = self;
    double number;
    Kept first = {"count", &number, 1}, rows[KEPT];
    if (!run_get_state(job->run, slot, &first, 1, has, err)) return false;
    if (!*has) return true;
    kept_rows(job, (size_t)number, rows);
    for (int k = 0; k < KEPT; k++) rows[k].values = mem_alloc(rows[k].count, sizeof(double));
    bool ok = run_get_state(job->run, slot, rows, KEPT, has, err);
    TrajectoryState state = {(int)number, rows[1].values, rows[2].values, rows[0].values};
    if (ok && *has) trajectory_restore(job->t, u, &state);
    for (int k = 0; k < KEPT; k++) mem_free(rows[k].values);
    return ok;
}

/* ---- The result ---- */

static Snapshot frame_state(TrajectoryJob *job, int frame)
{
    Snapshot shot = {
        .load_case = job->c, .p = trajectory_params(job->t, frame), .at = trajectory_frame(job->t, frame)};
    trajectory_velocities(job->t, frame, job->v);
    shot.at.v = job->v;
    shot.at.time = job->run->model->time + job->run->scene->time.step * frame;
    return shot;
}

/* With what the body met in the step to it: all frames in their order. */
static Snapshot next_frame(TrajectoryJob *job, int frame)
{
    Snapshot shot = frame_state(job, frame);
    if (frame == 0) {
        contacts_start(&job->contacts, &shot.at);
        return shot;
    }
    contacts_begin(&job->contacts);
    contacts_add(&job->contacts, &shot.at, job->run->scene->time.step, shot.p);
    contacts_show(&job->contacts, &shot);
    return shot;
}

/* Frames of the best motion, every so many, and the last, which is *end; trajectory/contacts, ..: a row for each step. */
static bool put_frames(TrajectoryJob *job, int first, Snapshot *end, Arrays *list, Error *err)
{
    int every = job->run->scene->output.every, steps = job->run->scene->time.steps, index = first;
    double *rows[CONTACTS_ROWS];
    if (every == 0) every = 1;
    for (int n = 0; n <= steps; n++) {
        *end = next_frame(job, n);
        if (n > 0) contacts_add_row(&job->contacts, "trajectory/", n, steps, rows, list);
        if (n % every && n != steps) continue;
        if (!run_put_frame(job->run, index, end->at.time, end, index == first, err)) return false;
        index++;
    }
    return true;
}

/* What acts in each step: numbers of p from an entry on. */
static void add_over_time(const TrajectoryJob *job, Arrays *list, Array named, int entry, int width)
{
    int steps = job->run->scene->time.steps;
    double *rows = arrays_numbers(list, (size_t)width * (size_t)steps);
    for (int n = 1; n <= steps; n++)
        memcpy(rows + width * (n - 1), trajectory_params(job->t, n) + entry, (size_t)width * sizeof *rows);
    arrays_add(list, array_float(named.name, named.unit, rows, 2, steps, width));
}

/* Of the sources whose strengths are unknown over time, a line each. */
static char *strength_names(const Model *model)
{
    const Control *strengths = &model->strengths;
    int first = strengths->to - model->flux_blocks.strength;
    char *names = mem_text("");
    for (int k = 0; k < strengths->width; k++)
        names = mem_join(names, flux_field_name(model->fields->items[first + k]), "\n");
    return names;
}

/* trajectory/flux_density, and trajectory/source_strength, source_names where that is unknown over time. */
static void add_field(const TrajectoryJob *job, Arrays *list)
{
    const Model *model = job->run->model;
    const Control *strengths = &model->strengths;
    if (model->flux_blocks.uniform >= 0)
        add_over_time(job, list, (Array){.name = "trajectory/flux_density", .unit = "T"},
                      model->flux_blocks.uniform, 3);
    if (!strengths->rows) return;
    add_over_time(job, list, (Array){.name = "trajectory/source_strength", .unit = ""}, strengths->to,
                  strengths->width);
    arrays_add(list, array_text("trajectory/source_names", arrays_keep(list, strength_names(model))));
}

/* dF/dp of the unknowns, and what the start's places and velocities do to F. */
static void add_gradients(const TrajectoryJob *job, Arrays *list)
{
    const Model *model = job->run->model;
    size_t dofs = (size_t)system_dof_count(job->c->sys);
    double *dp = arrays_numbers(list, (size_t)model->params->size), *dx = arrays_numbers(list, 2 * dofs);
    trajectory_gradients(job->t, dp, dx, dx + dofs);
    for (int k = 0; k < model->design.unknown_count; k++) {
        const ParamBlock *block = model->design.unknowns[k].block;
        const char *name = design_unknown_name(model, block);
        design_add_gradient(list, name, block->unit, dp + block->offset, block->count, block->width);
        if (name != block->name) /* a control's rows, in the place of what acts at the end */
            arrays_add(list, array_float(arrays_keep(list, mem_format("design/%s", name)), block->unit,
                                         trajectory_params(job->t, 0) + block->offset, 2, block->count,
                                         block->width));
    }
    int vertices = model->point_count;
    design_add_gradient(list, "start_x", "m", dx, vertices, 3);
    design_add_gradient(list, "start_v", "m/s", dx + dofs, vertices, 3);
}

/* The largest distance of each row's point to its place or curve, over the frames at which it counts. */
static void add_distances(const TrajectoryJob *job, Arrays *list)
{
    int rows = job->c->objective_count;
    double *largest = arrays_numbers(list, (size_t)rows);
    bool any = false;
    for (int k = 0; k < rows; k++) {
        const Objective *row = &job->c->objectives[k];
        for (int n = row->first; n <= row->last; n++) {
            double distance =
                objective_distance(row, trajectory_frame(job->t, n).x, trajectory_params(job->t, n));
            largest[k] = n == row->first ? distance : fmax(largest[k], distance);
        }
        if (isnan(largest[k])) continue;
        any = true;
        host_say(job->run->host, "%s, frames %d to %d: largest distance %.3g mm", row->ops->name, row->first,
                 row->last, 1e3 * largest[k]);
    }
    if (any) arrays_add(list, array_float("metrics/largest_distance", "m", largest, 1, rows, 0));
}

static bool put_results(void *self, int first, const char *status, Error *err)
{
    TrajectoryJob *job = self;
    Arrays list = {0};
    Snapshot end;
    if (!put_frames(job, first, &end, &list, err)) {
        arrays_clear(&list);
        return false;
    }
    end.p = arrays_keep(&list, mem_copy(end.p, (size_t)job->run->model->params->size, sizeof *end.p));
    run_add_final(job->run, &end, 1, status, &list);
    add_field(job, &list);
    add_distances(job, &list);
    reference_add(job->c, job->t, job->run->scene->time.steps, &list);
    add_gradients(job, &list);
    return arrays_replace(&list, job->run->journal, "final", err);
}

static RunStatus run_trajectory(Run *run, Error *err)
{
    static const DesignOps ops = {.evaluate = evaluate,
                                  .accept = accept,
                                  .product = product,
                                  .put_best = put_best,
                                  .get_best = get_best,
                                  .put_results = put_results};
    Model *model = run->model;
    const TimeScene *time = &run->scene->time;
    Case *c = &model->cases[0];
    TrajectoryJob job = {.run = run, .c = c};
    Control controls[2];
    int control_count = model_controls(model, controls);
    TrajectoryProblem problem = {.sys = c->sys,
                                 .design = &model->design,
                                 .params = model->params,
                                 .controls = controls,
                                 .objectives = c->objectives,
                                 .control_count = control_count,
                                 .objective_count = c->objective_count,
                                 .start = &c->state,
                                 .step = time->step,
                                 .steps = time->steps,
                                 .p = c->stages[0].p};
    TrajectoryDef def = trajectory_default();
    run_newton(run, &def.march.newton);
    def.march.observer = run_observer(run);
    def.march.load = load, def.march.self = &job;
    def.march.implicit = model->world && model->world->implicit;
    if (model->moves) def.march.move = move;
    job.t = trajectory_create(&problem, &def);
    job.contacts = contacts_create(model, c);
    job.v = mem_alloc((size_t)c->state.dofs, sizeof *job.v);
    double *u = mem_alloc((size_t)model->design.size, sizeof *u);
    design_read(&model->design, 0, problem.p, u);
    RunStatus status = design_run(run, &ops, &job, u, err);
    if (job.refused) {
        *err = job.err;
        status = RUN_REFUSED;
    }
    trajectory_destroy(job.t);
    contacts_destroy(&job.contacts);
    mem_free(job.v);
    mem_free(u);
    return status;
}

/* Its steps are part of its problem. */
static const char *const free_keys[] = {"design.iterations", "design.tolerance", "output.precision", "modes",
                                        NULL};

const JobRow job_trajectory = {
    .name = "trajectory",
    .noun = "a trajectory",
    .run = run_trajectory,
    .motion = true,
    .path = true,
    .design = true,
    .frames = FRAMES_AGAIN,
    .probed = PROBED_TIMES,
    .free_keys = free_keys,
    .effort = {2, 2, 1, 8, 25e6},
};
