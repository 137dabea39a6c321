/* A rod's motion by the position-based solver: quick, for the eye. A run that is resumed begins anew: it
 * repeats itself bit by bit. */
#include "base/memory.h"
#include "job/jobs.h"
#include "rod/front/front.h"
#include "rod/pbd.h"

typedef struct Preview {
    Run *run;
    PbdRod *rod;
    int nodes;
    double now;    /* s */
    double *state; /* pbd_rod_get_state, as it was put last */
    Error *err;
} Preview;

static PbdRod *create(const Run *run)
{
    const RodModel *rm = run->model->self;
    const Rod *rod = rm->rod;
    const RodScene *scene = rod_scene(run->scene);
    const double *p = run->model->cases[0].stages[0].p;
    Vec3 *start = mem_alloc((size_t)rod->elements, sizeof *start);
    rod_element_strains(rod, &rm->layout, run->model->x, start);
    Quat frame = rod->strand[0].frame;
    RodFrame clamp = {quat_rotate(frame, vec3(1, 0, 0)), quat_rotate(frame, vec3(0, 1, 0)),
                      quat_rotate(frame, vec3(0, 0, 1))};
    PbdRodDef def = {.elements = rod->elements,
                     .length = rod_length(rod),
                     .section = rm->section,
                     .stretch = rm->young * rm->area,
                     .natural_strain = (const Vec3 *)(p + rod->natural_strain),
                     .start_strain = start,
                     .position = rod->strand[0].position,
                     .clamp = clamp,
                     .gravity = vec3_load(p + rod->gravity),
                     .force = (const Vec3 *)(p + rod->load),
                     .drag = scene->damping / rod->unit.mass,
                     .substeps = scene->pbd.substeps,
                     .sweeps = scene->pbd.sweeps};
    PbdRod *made = pbd_rod_create(&def);
    if (rm->moving) pbd_rod_set_state(made, rm->moving);
    mem_free(start);
    return made;
}

static Array positions(const Preview *o, const char *name)
{
    return array_float(name, "m", &pbd_rod_positions(o->rod)->x, 2, o->nodes, 3);
}

/* All of its state: a row of the frames', or the last one. */
static Array whole_state(const Preview *o, bool row)
{
    int count = pbd_rod_state_count(o->nodes - 1);
    pbd_rod_get_state(o->rod, o->state);
    return row ? array_float("state/dofs", "", o->state, 2, 1, count)
               : array_float("state/dofs", "", o->state, 1, count, 0);
}

static bool put_frame(const Preview *o, int frame)
{
    bool whole = o->run->scene->output.states == STATES_ALL;
    Array arrays[] = {positions(o, "x"), array_float("time", "s", &o->now, 0, 0, 0), whole_state(o, true),
                      array_float("state/time", "s", &o->now, 1, 1, 0)};
    return journal_put(o->run->journal, "frame", frame, arrays, whole ? 4 : 2, o->err);
}

static bool put_step(const Preview *o, int step)
{
    Array array = array_float("time", "s", &o->now, 0, 0, 0);
    return journal_put(o->run->journal, "evaluation", step, &array, 1, o->err);
}

static bool put_final(const Preview *o, const char *status)
{
    PbdRodSums sums = pbd_rod_sums(o->rod);
    Array arrays[] = {array_text("status", status),
                      positions(o, "state/x"),
                      positions(o, "rod/x"),
                      whole_state(o, false),
                      array_float("state/time", "s", &o->now, 0, 0, 0),
                      array_float("state/v", "m/s", &pbd_rod_velocities(o->rod)->x, 2, o->nodes, 3),
                      array_float("final/energy/kinetic", "J", &sums.kinetic, 0, 0, 0),
                      array_float("final/energy/elastic", "J", &sums.elastic, 0, 0, 0),
                      array_float("final/energy/gravity", "J", &sums.potential, 0, 0, 0)};
    return journal_replace(o->run->journal, "final", 0, arrays, sizeof arrays / sizeof *arrays, o->err);
}

static RunStatus preview(Run *run, Error *err)
{
    const TimeScene *time = &run->scene->time;
    Preview o = {.run = run,
                 .rod = create(run),
                 .nodes = run->model->point_count,
                 .now = run->model->time,
                 .err = err};
    o.state = mem_alloc((size_t)pbd_rod_state_count(o.nodes - 1), sizeof *o.state);
    int every = run->scene->output.every ? run->scene->output.every : 1, step = 0;
    bool ok = journal_forget(run->journal, "frame", err) && journal_forget(run->journal, "evaluation", err) &&
              put_frame(&o, 0);
    for (; ok && step < time->steps && !host_stops(run->host);) {
        pbd_rod_step(o.rod, time->step);
        o.now += time->step;
        step++;
        ok = put_step(&o, step) && (step % every || put_frame(&o, step / every));
        host_step(run->host, step, time->steps, "t %.4g s", o.now);
    }
    bool interrupted = step < time->steps;
    if (ok && step % every) ok = put_frame(&o, step / every + 1);
    ok = ok && put_final(&o, interrupted ? "interrupted" : "converged");
    pbd_rod_destroy(o.rod);
    mem_free(o.state);
    return !ok ? RUN_CANNOT_WRITE : interrupted ? RUN_INTERRUPTED : RUN_DONE;
}

/* By implicit Euler, or so. */
static RunStatus run_simulate(Run *run, Error *err)
{
    return rod_scene(run->scene)->solver == ROD_SOLVER_PBD ? preview(run, err) : job_simulate.run(run, err);
}

const JobRow rod_job_simulate = {
    .name = "simulate",
    .noun = "a simulation",
    .run = run_simulate,
    .motion = true,
    .frames = FRAMES_MOVE,
    .free_keys = job_simulate_free_keys,
    .effort = {2, 2, 0.9, 4, 25e6},
};
