#include "job/run.h"
#include "base/memory.h"
#include "job/obstacles.h"
#include "job/sources.h"
#include "model/forces.h"
#include "model/probe.h"
#include "model/state_arrays.h"
#include <string.h>

RunStatus job_run(Run *run, Error *err)
{
    return run->model->job->run(run, err);
}

static bool go_on(void *self, const NewtonInfo *info)
{
    (void)info;
    return !host_stops(((Run *)self)->host);
}

NewtonObserver run_observer(Run *run)
{
    return (NewtonObserver){go_on, run};
}

void run_newton(const Run *run, NewtonDef *def)
{
    def->max_iterations = run->scene->solver.max_iterations;
    def->step_tol = run->scene->solver.step_tolerance;
    def->force_tol = run->scene->solver.force_tolerance;
    def->step_cap = run->model->step_cap;
}

void run_release_threads(Run *run)
{
    for (int c = 0; run->inside && c < run->model->case_count; c++) {
        system_set_workers(run->model->cases[c].sys, NULL);
        workers_destroy(run->inside[c]);
    }
    mem_free(run->inside);
    workers_destroy(run->side_by_side);
    run->inside = NULL, run->side_by_side = NULL;
}

Workers *run_share_threads(Run *run, int at_once)
{
    int cases = run->model->case_count, outside = at_once < run->threads ? at_once : run->threads;
    run_release_threads(run);
    if (outside > 1) run->side_by_side = workers_create(outside);
    if (cases == 0 || run->threads / outside < 2) return run->side_by_side;
    run->inside = mem_alloc((size_t)cases, sizeof *run->inside);
    for (int c = 0; c < cases; c++) {
        if (c < outside) run->inside[c] = workers_create(run->threads / outside);
        system_set_workers(run->model->cases[c].sys, run->inside[c % outside]);
    }
    return run->side_by_side;
}

Array run_block(const char *name, const ParamBlock *block, const double *p)
{
    int rank = block->width > 1 ? 2 : 1;
    return array_float(name, block->unit, p + block->offset, rank, block->count, block->width);
}

bool run_is_crushed(Run *run, Snapshot *shot, bool failed)
{
    const BodyOps *body = run->model->body->ops;
    char *crushed = body->crushed ? body->crushed(run->model, shot, failed) : NULL;
    if (!crushed) return false;
    host_say(run->host, "%s: %s", shot->load_case->name, crushed);
    mem_free(crushed);
    shot->status = body->crushed_as;
    return true;
}

static double *places(const Model *model, const Snapshot *shot, Arrays *list)
{
    double *place = arrays_numbers(list, 3 * (size_t)model->point_count);
    model->body->ops->places(model, shot->at.x, place);
    return place;
}

void run_say_unknown_field(const Run *run, Snapshot *shot, double dt)
{
    State next = state_clone(&shot->at);
    Snapshot then = *shot;
    Arrays list = {0};
    Error err;
    for (int i = 0; i < next.dofs; i++) next.x[i] += dt * next.v[i];
    next.time += dt, then.at = next;
    if (!model_knows_fields(run->model, shot->p, shot->at.time, places(run->model, shot, &list), &err) ||
        !model_knows_fields(run->model, shot->p, next.time, places(run->model, &then, &list), &err)) {
        host_say(run->host, "%s: %s", shot->load_case->name, err.text);
        shot->status = NEWTON_UNKNOWN_FIELD;
    }
    arrays_clear(&list);
    state_destroy(&next);
}

/* Of terms of one name (contact at vertices, at the middles of edges, ..) the sum. */
static void add_energies(Arrays *list, const char *prefix, System *sys, const Point *at)
{
    int count = system_term_count(sys);
    double *energy = arrays_numbers(list, (size_t)count);
    for (int t = 0; t < count; t++) {
        const char *name = system_term(sys, t)->ops->name;
        int first = 0;
        while (strcmp(system_term(sys, first)->ops->name, name) != 0) first++;
        energy[first] += system_term_energy(sys, t, at, NULL);
        if (first < t) continue;
        char *path = arrays_keep(list, mem_format("%s/energy/%s", prefix, name));
        arrays_add(list, array_float(path, "J", &energy[t], 0, 0, 0));
    }
}

/* ---- Frames ---- */

/* What obstacles do to it: of a frame the forces on its points, of a state under a prefix their sums. */
static void add_felt(Arrays *list, const Model *model, const Snapshot *shot, const char *prefix)
{
    const World *world = model->world;
    if (!world || world->obstacle_count == 0) return;
    ContactSums sums = model_contacts(model, shot, list);
    double *numbers = arrays_numbers(list, 2);
    numbers[0] = sums.touching, numbers[1] = sums.depth;
    if (!prefix) {
        arrays_add(list, array_float("point/contact_force", "N", sums.point + world->body.first, 2,
                                     model->point_count, 3));
        return;
    }
    arrays_add(list, array_float(arrays_keep(list, mem_format("%s/contacts", prefix)), "", numbers, 0, 0, 0));
    arrays_add(list, array_float(arrays_keep(list, mem_format("%s/contact_depth", prefix)), "m", numbers + 1,
                                 0, 0, 0));
    arrays_add(list, array_float(arrays_keep(list, mem_format("%s/contact_force", prefix)), "N",
                                 sums.force[0], 2, world->obstacle_count, 3));
}

/* What each stage of a sequence, or load step, keeps of its own, under stages/. */
static void add_stage(Arrays *list, const Run *run, const Snapshot *shot)
{
    const Model *model = run->model;
    bool steps = run->scene->load_steps.frames;
    if (shot->load_case->stage_count < 2 && !steps) return;
    Point at = state_point(&shot->at, shot->p);
    arrays_add(list, array_text("stages/status", newton_status_name(shot->status)));
    arrays_add(list, array_float("stages/time", "s", &shot->at.time, 0, 0, 0));
    if (model->flux_blocks.uniform >= 0) {
        double *flux = arrays_numbers(list, 3);
        model_flux(model, shot->p, shot->at.time, flux);
        arrays_add(list, array_float("stages/flux_density", "T", flux, 2, 1, 3));
    }
    if (model->gravity >= 0)
        arrays_add(list, array_float("stages/gravity", "m/s^2", shot->p + model->gravity, 2, 1, 3));
    if (steps) arrays_add(list, array_float("stages/load_part", "", &shot->part, 0, 0, 0));
    add_energies(list, "stages", shot->load_case->sys, &at);
    add_felt(list, model, shot, "stages");
    model_add_supports(model, shot, "stages", list);
}

/* Of a frame, unless a row is an evaluation. */
static void add_probes(Arrays *list, const Model *model, const Snapshot *shot, int index)
{
    if (model->probe_count == 0 || model->job->probed == PROBED_EVALUATIONS) return;
    double *values = arrays_numbers(list, (size_t)model_probe_count(model));
    model_measure(model, shot, values);
    model_add_probes(model, values, 1, true, model->job->motion ? shot->at.time : index, list);
}

bool run_put_frame(Run *run, int index, double shown, const Snapshot *shot, bool whole, Error *err)
{
    const Model *model = run->model;
    Arrays list = {0};
    double *place = places(model, shot, &list);
    if (run->host->frame) run->host->frame(run->host->self, shown, model->point_count, place);
    arrays_add(&list, array_float("x", "m", place, 2, model->point_count, 3));
    arrays_add(&list, array_float("time", "s", &shown, 0, 0, 0));
    if (model->flux_blocks.uniform >= 0) {
        double *flux = arrays_numbers(&list, 3);
        model_flux(model, shot->p, shot->at.time, flux);
        arrays_add(&list, array_float("flux_density", "T", flux, 2, 1, 3));
    }
    add_felt(&list, model, shot, NULL);
    obstacles_add_poses(model, shot->at.time, &list);
    sources_add_poses(model, shot, &list);
    sources_tell_within(run, shot, index);
    if (model->body->ops->add_frame) model->body->ops->add_frame(model, shot, whole, &list);
    bool stress = !model->job->motion || run->scene->output.stress; /* frames of rest are few */
    if (stress && model->body->ops->add_stress) model->body->ops->add_stress(model, shot, &list);
    add_stage(&list, run, shot);
    add_probes(&list, model, shot, index);
    if (run->scene->output.states == STATES_ALL) state_arrays_add(model, shot, "state", true, &list);
    return arrays_put(&list, run->journal, "frame", index, err);
}

/* ---- Final arrays ---- */

/* What both the plain paths and cases/<name> have. */
static void add_state(Arrays *list, const Model *model, const char *x_name, const char *prefix,
                      const Snapshot *shot)
{
    System *sys = shot->load_case->sys;
    Point at = state_point(&shot->at, shot->p);
    char *name = arrays_keep(list, mem_text(x_name));
    arrays_add(list, array_float(name, "m", places(model, shot, list), 2, model->point_count, 3));
    add_energies(list, prefix, sys, &at);
    add_felt(list, model, shot, prefix);
    if (!model->job->motion) model_add_supports(model, shot, prefix, list); /* where inertia does nothing */
    model->body->ops->add_state(model, shot, prefix, list);
}

/* Parameters of the last state; flux_density has a row for each. */
static void add_params(Arrays *list, const Params *params, const Snapshot *shots, int count)
{
    const Snapshot *last = &shots[count - 1];
    for (int b = 0; b < params->block_count; b++) {
        const ParamBlock *block = &params->blocks[b];
        const char *name = arrays_keep(list, mem_format("design/%s", block->name));
        if (block->count == 0) continue;
        if (strcmp(block->name, "flux_density")) {
            arrays_add(list, run_block(name, block, last->p));
            continue;
        }
        double *flux = arrays_numbers(list, 3 * (size_t)count);
        for (int k = 0; k < count; k++) memcpy(flux + 3 * k, shots[k].p + block->offset, 3 * sizeof *flux);
        arrays_add(list, array_float(name, block->unit, flux, 2, count, 3));
    }
}

/* Three numbers of p, if the body has them. Takes the name. */
static void add_vector(Arrays *list, char *name, const char *unit, const double *p, int first)
{
    arrays_keep(list, name);
    if (first >= 0) arrays_add(list, array_float(name, unit, p + first, 1, 3, 0));
}

/* Places of the points, and clouds, one after the other. */
static void add_targets(Arrays *list, const Model *model, const char *prefix, const Case *c)
{
    double(*place)[3] = model_target_places(c, model->point_count), (*cloud)[3] = NULL;
    size_t count = 0;
    if (place)
        arrays_add(list, array_float(arrays_keep(list, mem_format("%s/target", prefix)), "m",
                                     arrays_keep(list, place), 2, model->point_count, 3));
    for (int k = 0; k < c->target_count; k++) {
        const PointCloud *own = &c->targets[k].cloud;
        size_t more = (size_t)own->point_count;
        cloud = mem_resize(cloud, count, count + more, sizeof *cloud);
        if (more) memcpy(cloud[count], own->points, more * sizeof *cloud);
        count += more;
    }
    if (count)
        arrays_add(list, array_float(arrays_keep(list, mem_format("%s/cloud", prefix)), "m", cloud[0], 2,
                                     (int)count, 3));
    arrays_keep(list, cloud);
}

static void add_case(Arrays *list, const Model *model, const Snapshot *shot)
{
    const char *prefix = arrays_keep(list, mem_format("cases/%s", shot->load_case->name));
    const char *x_name = arrays_keep(list, mem_format("%s/x", prefix));
    add_state(list, model, x_name, prefix, shot);
    arrays_add(list, array_text(arrays_keep(list, mem_format("%s/status", prefix)),
                                newton_status_name(shot->status)));
    add_vector(list, mem_format("%s/flux_density", prefix), "T", shot->p, model->flux_blocks.uniform);
    add_vector(list, mem_format("%s/gravity", prefix), "m/s^2", shot->p, model->gravity);
    add_targets(list, model, prefix, shot->load_case);
}

/* In the scene's order, a line each. */
static char *case_names(const Snapshot *shots, int count)
{
    char *names = mem_text("");
    for (int k = 0; k < count; k++) names = mem_join(names, shots[k].load_case->name, "\n");
    return names;
}

/* The lowest frequencies, where they were asked for. */
static void say_vibrations(const Run *run, const Arrays *list)
{
    enum { SAID = 10 };
    bool found = false;
    for (size_t k = 0; k < list->count; k++) {
        const Array *hz = &list->arrays[k];
        if (strcmp(hz->name, "final/modes_hz") != 0) continue;
        found = true;
        char *text = mem_text("");
        for (int i = 0; i < hz->dims[0] && i < SAID; i++) {
            char *number = mem_format("%.4g", ((const double *)hz->data)[i]);
            text = mem_join(text, i ? ", " : "", number);
            mem_free(number);
        }
        host_say(run->host, "vibrations: %s%s Hz", text, hz->dims[0] > SAID ? ", .." : "");
        mem_free(text);
    }
    if (run->scene->modes && !found)
        host_say(run->host,
                 "no vibrations are told: a point without mass, or a motion that nothing holds and "
                 "no mass has");
}

static void say_doubt(Run *run, const Snapshot *shot)
{
    const BodyOps *body = run->model->body->ops;
    char *doubt = body->doubt ? body->doubt(run->model, shot) : NULL;
    if (doubt) host_say(run->host, "%s: %s", shot->load_case->name, doubt);
    mem_free(doubt);
}

void run_add_final(Run *run, const Snapshot *shots, int count, const char *status, Arrays *list)
{
    const Model *model = run->model;
    add_state(list, model, "state/x", "final", &shots[count - 1]);
    state_arrays_add(model, &shots[count - 1], "state", false, list);
    add_params(list, model->params, shots, count);
    model->body->ops->add_final(model, &shots[count - 1], run->scene->modes, list);
    say_vibrations(run, list);
    arrays_add(list, array_text("status", status));
    arrays_add(list, array_text("case_names", arrays_keep(list, case_names(shots, count))));
    for (int k = 0; k < count; k++) {
        add_case(list, model, &shots[k]);
        char *prefix = arrays_keep(list, mem_format("cases/%s/state", shots[k].load_case->name));
        if (k < count - 1) state_arrays_add(model, &shots[k], prefix, false, list);
        say_doubt(run, &shots[k]);
    }
}

/* ---- State ---- */

bool run_put_state(Run *run, int index, const Kept *rows, int count, Error *err)
{
    Arrays list = {0};
    for (int k = 0; k < count; k++)
        arrays_add(&list, array_float(rows[k].name, "", rows[k].values, 1, (int)rows[k].count, 0));
    return arrays_put(&list, run->journal, "state", index, err);
}

bool run_get_state(Run *run, int index, const Kept *rows, int count, bool *has, Error *err)
{
    *has = true;
    for (int k = 0; *has && k < count; k++) {
        Array array;
        if (!journal_find(run->journal, "state", index, rows[k].name, &array, err)) return false;
        *has = array.data && array.type == ARRAY_FLOAT64 && array_count(&array) == rows[k].count;
        if (*has && rows[k].count) memcpy(rows[k].values, array.data, rows[k].count * sizeof(double));
        array_clear(&array);
    }
    return true;
}
