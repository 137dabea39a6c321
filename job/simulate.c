/* Motion in time by implicit Euler, from the pose and the velocities given.
 *
 * With every stored frame goes the state to go on from, in two slots by turns, each closed by its step's
 * number: a run that is killed goes on from the last frame and repeats the steps since bit by bit. */
#include "base/memory.h"
#include "job/contacts.h"
#include "job/jobs.h"
#include "job/sources.h"
#include "solve/march.h"
#include <string.h>

typedef struct Simulation {
    Run *run;
    Error *err;
    Case *c;
    double *p;
    State *now;
    double *anchor;      /* of its system, as the last step that was reached left it */
    Contacts contacts;   /* of the last step */
    int step;            /* that one                                               */
    NewtonStatus status; /* of the last step                                       */
    bool refused;        /* a formula of time is not finite; err says so           */
} Simulation;

static void load(void *self, double time, double *p)
{
    Simulation *s = self;
    s->refused |= !model_load(s->run->model, time, false, p, s->err);
}

static bool move(void *self, double time, double *x)
{
    Simulation *s = self;
    s->refused |= !model_move(s->run->model, held_way(time), x, s->err);
    return !s->refused;
}

/* A part of a step. */
static void stored(void *self, const State *state, double dt)
{
    Simulation *s = self;
    contacts_add(&s->contacts, state, dt, s->p);
}

static Snapshot shown_state(const Simulation *s)
{
    Snapshot shot = {.load_case = s->c, .p = s->p, .at = *s->now, .status = s->status, .anchor = s->anchor};
    if (s->step) contacts_show(&s->contacts, &shot);
    return shot;
}

enum { KEPT = 6 };

/* What a run goes on from: the last step that was stored. */
static void kept_rows(Simulation *s, double *step, Kept rows[KEPT])
{
    State *now = s->now;
    rows[0] = (Kept){"step", step, 1};
    rows[1] = (Kept){"time", &now->time, 1};
    rows[2] = (Kept){"x", now->x, (size_t)now->dofs};
    rows[3] = (Kept){"v", now->v, (size_t)now->dofs};
    rows[4] = (Kept){"memory", now->memory, (size_t)now->memory_count};
    rows[5] = (Kept){"anchor", s->anchor, (size_t)system_anchor_count(s->c->sys)};
}

static bool put_step(Simulation *s, int frame, int step)
{
    double number = step;
    Snapshot shot = shown_state(s);
    Kept rows[KEPT];
    kept_rows(s, &number, rows);
    return run_put_frame(s->run, frame, s->now->time, &shot, frame == 0, s->err) &&
           run_put_state(s->run, frame % 2, rows, KEPT, s->err);
}

/* The factor that the next step's conjugate gradients begin with, as it was. */
static void restore(Simulation *s)
{
    load(s, system_anchor_time(s->anchor), s->p);
    system_restore_factor(s->c->sys, s->anchor, s->p);
    load(s, s->now->time, s->p);
}

static bool get_slot(Simulation *s, int slot)
{
    double step;
    bool has;
    Kept rows[KEPT];
    kept_rows(s, &step, rows);
    if (!run_get_state(s->run, slot, rows, KEPT, &has, s->err)) return false;
    if (has) restore(s);
    return has || error_set(s->err, "the journal's state is of another scene");
}

/* The step to go on from; 0 after putting the start. -1: err says what is wrong. */
static int find_start(Simulation *s)
{
    double number[2];
    for (int slot = 0; slot < 2; slot++) {
        Kept row = {"step", &number[slot], 1};
        bool has;
        if (!run_get_state(s->run, slot, &row, 1, &has, s->err)) return -1;
        if (!has) number[slot] = -1;
    }
    int newest = number[1] > number[0];
    if (number[newest] >= 0) return get_slot(s, newest) ? (int)number[newest] : -1;
    load(s, s->now->time, s->p);
    if (s->c->anchor) {
        memcpy(s->anchor, s->c->anchor, (size_t)system_anchor_count(s->c->sys) * sizeof *s->anchor);
        restore(s);
    }
    return put_step(s, 0, 0) ? 0 : -1;
}

/* How a step went, for history/. */
static bool put_history(Simulation *s, int step, const MarchInfo *info)
{
    double iterations = info->newton.iterations, factorizations = info->newton.factorizations,
           cg_iterations = info->newton.cg_iterations;
    const Contacts *contacts = &s->contacts;
    Array arrays[5 + CONTACTS_ROWS] = {array_float("newton_iterations", "", &iterations, 0, 0, 0),
                                       array_float("factorizations", "", &factorizations, 0, 0, 0),
                                       array_float("cg_iterations", "", &cg_iterations, 0, 0, 0),
                                       array_float("time", "s", &s->now->time, 0, 0, 0)};
    int count = 4 + contacts_history(contacts, arrays + 4);
    if (contacts->world && (contacts->world->obstacle_count || contacts->world->self))
        arrays[count++] = array_float("pierced", "", &contacts->pierced, 0, 0, 0);
    return journal_put(s->run->journal, "evaluation", step, arrays, count, s->err);
}

static int frame_interval(const Simulation *s)
{
    int every = s->run->scene->output.every;
    return every ? every : 1;
}

/* A step that fails, or is interrupted, may leave another one. */
static void keep_anchor(Simulation *s)
{
    memcpy(s->anchor, system_anchor(s->c->sys), (size_t)system_anchor_count(s->c->sys) * sizeof *s->anchor);
}

/* One step, and what it leaves. */
static RunStatus make_step(Simulation *s, const MarchDef *def)
{
    const Scene *scene = s->run->scene;
    int every = frame_interval(s), step = s->step + 1;
    MarchInfo info;
    char touches[64];
    contacts_begin(&s->contacts);
    bool reached = march_step(s->c->sys, def, scene->time.step, s->p, s->now, &info);
    if (s->refused) return RUN_REFUSED;
    if (host_stops(s->run->host)) return RUN_INTERRUPTED;
    s->status = reached ? NEWTON_CONVERGED : info.newton.status;
    Snapshot shot = shown_state(s);
    if (!reached) {
        run_say_unknown_field(s->run, &shot, scene->time.step);
        host_say(s->run->host, "step %d failed at t = %g s: %s", step, s->now->time,
                 newton_status_text(shot.status));
    }
    s->status = shot.status;
    bool crushed = run_is_crushed(s->run, &shot, !reached);
    if (crushed) s->status = shot.status;
    if (!reached) return RUN_NOT_CONVERGED;
    s->step = step;
    sources_tell_within(s->run, &shot, 0);
    contacts_tell(&s->contacts, s->run->host, step, info.passed);
    keep_anchor(s);
    if (!put_history(s, step, &info) || (step % every == 0 && !put_step(s, step / every, step)))
        return RUN_CANNOT_WRITE;
    if (crushed) return RUN_NOT_CONVERGED;
    host_step(s->run->host, step, scene->time.steps, "t %.4g s, %d Newton iterations%s", s->now->time,
              info.newton.iterations, contacts_text(&s->contacts, touches));
    return RUN_DONE;
}

/* Steps until the end, an interruption or a failure. */
static RunStatus march(Simulation *s)
{
    s->step = find_start(s);
    if (s->step < 0) return RUN_CANNOT_WRITE;
    if (s->step > 0 && !contacts_recall(&s->contacts, s->run->journal, s->step, s->err))
        return RUN_CANNOT_WRITE;
    contacts_start(&s->contacts, s->now);
    MarchDef def = march_default();
    run_newton(s->run, &def.newton);
    def.observer = run_observer(s->run);
    def.load = load, def.self = s;
    def.stored = stored;
    def.implicit = s->run->model->world && s->run->model->world->implicit;
    if (s->run->model->moves) def.move = move;
    RunStatus status = RUN_DONE;
    while (status == RUN_DONE && s->step < s->run->scene->time.steps) status = make_step(s, &def);
    if (status != RUN_DONE || !contacts_pierced(&s->contacts)) return status;
    s->status = NEWTON_PIERCED;
    return RUN_NOT_CONVERGED;
}

/* The last state, also where it is between two frames: a resumed run replaces that frame by the one that is
 * due. */
static bool put_end(Simulation *s, const char *status)
{
    Snapshot shot = shown_state(s);
    int every = frame_interval(s);
    Arrays list = {0};
    if (s->step % every && !run_put_frame(s->run, s->step / every + 1, s->now->time, &shot, false, s->err))
        return false;
    run_add_final(s->run, &shot, 1, status, &list);
    arrays_add(&list, array_float("state/v", "m/s", s->now->v, 2, s->run->model->point_count, 3));
    return arrays_replace(&list, s->run->journal, "final", s->err);
}

static RunStatus run_simulate(Run *run, Error *err)
{
    Case *c = &run->model->cases[0];
    Simulation s = {.run = run, .err = err, .c = c, .p = c->stages[0].p, .now = &c->state};
    s.anchor = mem_alloc((size_t)system_anchor_count(c->sys), sizeof *s.anchor);
    s.contacts = contacts_create(run->model, c);
    RunStatus status = march(&s);
    const char *said = status == RUN_INTERRUPTED ? "interrupted" : newton_status_name(s.status);
    bool ended = status != RUN_CANNOT_WRITE && status != RUN_REFUSED;
    if (ended && !put_end(&s, said)) status = RUN_CANNOT_WRITE;
    if (ended) contacts_doubt(&s.contacts, run->host);
    mem_free(s.anchor);
    contacts_destroy(&s.contacts);
    return status;
}

const char *const job_simulate_free_keys[] = {"output.precision", "modes", "time.steps", NULL};

const JobRow job_simulate = {
    .name = "simulate",
    .noun = "a simulation",
    .run = run_simulate,
    .motion = true,
    .frames = FRAMES_MOVE,
    .probed = PROBED_TIMES,
    .free_keys = job_simulate_free_keys,
    .effort = {2, 2, 0.9, 4, 25e6},
};
