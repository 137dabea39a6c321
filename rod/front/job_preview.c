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
    double *x;     /* [dofs] of the model, with its ends where they are; of those that move */
    double *state; /* pbd_rod_get_state, as it was put last */
    Error *err;
} Preview;

/* Magnetic moments of the elements; NULL: it has none. Caller: mem_free. */
static Vec3 *magnets(const Rod *rod, const double *p)
{
    Vec3 *magnet = mem_alloc((size_t)rod->elements, sizeof *magnet);
    bool any = false;
    for (int e = 0; e < rod->elements; e++) {
        magnet[e] = vec3_scale(rod->unit[e].area * rod_element_length(rod, e),
                               vec3_load(p + rod->magnetization + 3 * e));
        any = any || vec3_dot(magnet[e], magnet[e]) > 0;
    }
    if (!any) mem_free(magnet);
    return any ? magnet : NULL;
}

static PbdRod *create(const Run *run, const double *x)
{
    const RodModel *rm = run->model->self;
    const Rod *rod = rm->rod;
    const RodScene *scene = rod_scene(run->scene);
    const RodSection *section = &rm->section;
    const double *p = run->model->cases[0].stages[0].p;
    Vec3 *start = mem_alloc((size_t)rod->elements, sizeof *start), *magnet = magnets(rod, p);
    double inextensible =
        rm->young * rm->unit.area; /* as stiff in all directions: what is left of it is the error */
    rod_element_strains(rod, &rm->layout, x, start);
    PbdRodDef def = {.elements = rod->elements,
                     .length = rod_length(rod),
                     .section = *section,
                     .stretch = rod->cosserat ? vec3(section->stretch, section->shear1, section->shear2)
                                              : vec3(inextensible, inextensible, inextensible),
                     .natural_strain = (const Vec3 *)(p + rod->natural_strain),
                     .start_strain = start,
                     .position = rod->strand[0].position,
                     .start_places = rm->held ? (const Vec3 *)(x + rm->layout.position) : NULL,
                     .clamp = rod_reference(&rm->layout, x, 0),
                     .end_frame =
                         run->model->moves ? rod_reference(&rm->layout, x, rod->elements) : rm->end_frame,
                     .start = rod->start,
                     .end = rod->end,
                     .magnet = magnet,
                     .gravity = vec3_load(p + rod->gravity),
                     .force = (const Vec3 *)(p + rod->load),
                     .drag = scene->damping / section->mass,
                     .substeps = scene->pbd.substeps,
                     .sweeps = scene->pbd.sweeps};
    PbdRod *made = pbd_rod_create(&def);
    pbd_rod_set_field(made, vec3_load(p + rod->flux.uniform));
    if (rm->moving) pbd_rod_set_state(made, rm->moving);
    mem_free(start);
    mem_free(magnet);
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
    Arrays list = {0};
    arrays_add(&list, positions(o, "x"));
    arrays_add(&list, array_float("time", "s", &o->now, 0, 0, 0));
    rod_add_poses(o->run->model->self, o->x, &list);
    if (o->run->scene->output.states == STATES_ALL) {
        arrays_add(&list, whole_state(o, true));
        arrays_add(&list, array_float("state/time", "s", &o->now, 1, 1, 0));
    }
    return arrays_put(&list, o->run->journal, "frame", frame, o->err);
}

static bool put_step(const Preview *o, int step)
{
    Array array = array_float("time", "s", &o->now, 0, 0, 0);
    return journal_put(o->run->journal, "evaluation", step, &array, 1, o->err);
}

static bool put_final(const Preview *o, const char *status)
{
    PbdRodSums sums = pbd_rod_sums(o->rod);
    Arrays list = {0};
    Array arrays[] = {array_text("status", status),
                      positions(o, "state/x"),
                      positions(o, "rod/x"),
                      whole_state(o, false),
                      array_float("state/time", "s", &o->now, 0, 0, 0),
                      array_float("state/v", "m/s", &pbd_rod_velocities(o->rod)->x, 2, o->nodes, 3),
                      array_float("final/energy/kinetic", "J", &sums.kinetic, 0, 0, 0),
                      array_float("final/energy/elastic", "J", &sums.elastic, 0, 0, 0),
                      array_float("final/energy/gravity", "J", &sums.potential, 0, 0, 0)};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) arrays_add(&list, arrays[k]);
    if (sums.magnetic != 0)
        arrays_add(&list, array_float("final/energy/magnetic", "J", &sums.magnetic, 0, 0, 0));
    if (((const RodModel *)o->run->model->self)->rod->cosserat) {
        double *strain = arrays_numbers(&list, 3 * (size_t)(o->nodes - 1));
        pbd_rod_stretches(o->rod, (Vec3 *)strain);
        arrays_add(&list, array_float("final/stretch", "", strain, 2, o->nodes - 1, 3));
    }
    return arrays_replace(&list, o->run->journal, "final", o->err);
}

static void lead_ends(const Preview *o)
{
    const RodModel *rm = o->run->model->self;
    for (int k = 0; k < 1 + rm->held; k++) {
        int node = k ? o->nodes - 1 : 0;
        pbd_rod_lead(o->rod, k, vec3_load(o->x + rm->layout.position + 3 * node),
                     rod_reference(&rm->layout, o->x, node));
    }
}

/* The field at the end of a step, as all loads, and where the ends are then. */
static bool put_field(const Preview *o, double time)
{
    const Model *model = o->run->model;
    double *p = model->cases[0].stages[0].p;
    if (!model_load(model, time, false, p, o->err) || !model_move(model, held_way(time), o->x, o->err))
        return false;
    pbd_rod_set_field(o->rod, vec3_load(p + model->flux_blocks.uniform));
    if (model->moves) lead_ends(o);
    return true;
}

static RunStatus preview(Run *run, Error *err)
{
    const TimeScene *time = &run->scene->time;
    const Model *model = run->model;
    Preview o = {.run = run, .nodes = model->point_count, .now = model->time, .err = err};
    o.state = mem_alloc((size_t)pbd_rod_state_count(o.nodes - 1), sizeof *o.state);
    o.x = mem_copy(model->x, (size_t)((const RodModel *)model->self)->layout.dofs, sizeof *o.x);
    int every = run->scene->output.every ? run->scene->output.every : 1, step = 0;
    bool known = model_move(model, held_way(o.now), o.x, err);
    o.rod = create(run, o.x);
    bool ok = known && journal_forget(run->journal, "frame", err) &&
              journal_forget(run->journal, "evaluation", err) && put_frame(&o, 0);
    for (; ok && step < time->steps && !host_stops(run->host);) {
        known = ok = put_field(&o, o.now + time->step);
        if (!ok) break;
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
    mem_free(o.x);
    return !known ? RUN_REFUSED : !ok ? RUN_CANNOT_WRITE : interrupted ? RUN_INTERRUPTED : RUN_DONE;
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
    .probed = PROBED_TIMES,
    .free_keys = job_simulate_free_keys,
    .effort = {2, 2, 0.9, 4, 25e6},
};
