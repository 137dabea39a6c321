/* Equilibria of all cases, and of the stages of a sequence, each from the one before. */
#include "base/memory.h"
#include "job/jobs.h"
#include "solve/ramp.h"
#include <string.h>

typedef struct Mover {
    const Model *model;
    double time;
    Error err; /* where it failed */
    bool failed;
} Mover;

static bool move(void *self, double part, double *x)
{
    Mover *mover = self;
    mover->failed = !model_move(mover->model, mover->time, part, x, &mover->err);
    return !mover->failed;
}

static RampInfo solve_stage(Run *run, Case *c, int stage)
{
    Mover mover = {.model = run->model, .time = c->stages[stage].time};
    RampDef def = ramp_default();
    run_newton(run, &def.newton);
    def.observer = run_observer(run);
    def.steps = run->scene->load_steps.mode < 0 ? run->scene->load_steps.count : run->model->load_steps;
    if (run->model->moves) def.move = move, def.self = &mover;
    const double *from = stage > 0 ? c->stages[stage - 1].p : c->loads;
    RampInfo info = ramp_solve(c->sys, run->model->params, &def, from, c->stages[stage].p, &c->state);
    if (mover.failed) host_say(run->host, "%s: %s", c->name, mover.err.text);
    return info;
}

/* Frames are shown at the times of their stages, if those go on; else they are numbered. */
static double shown_time(const Case *c, const Snapshot *shot, int frame)
{
    bool goes_on = c->stage_count > 1;
    for (int s = 1; s < c->stage_count; s++) goes_on = goes_on && c->stages[s].time > c->stages[s - 1].time;
    return goes_on ? shot->at.time : frame;
}

enum { KEPT = 3 };

/* What a resumed run needs: the status and the state after each stage. */
static void kept_rows(const State *state, double *status, Kept rows[KEPT])
{
    rows[0] = (Kept){"status", status, 1};
    rows[1] = (Kept){"x", state->x, (size_t)state->dofs};
    rows[2] = (Kept){"memory", state->memory, (size_t)state->memory_count};
}

/* The frame first: what is kept says that it is there. */
static bool put_progress(Run *run, int frame, const Snapshot *shot, Error *err)
{
    double status = shot->status;
    Kept rows[KEPT];
    kept_rows(&shot->at, &status, rows);
    return run_put_frame(run, frame, shown_time(shot->load_case, shot, frame), shot, frame == 0, err) &&
           run_put_state(run, frame, rows, KEPT, err);
}

static bool get_progress(Run *run, int frame, Snapshot *shot, bool *has, Error *err)
{
    double status;
    Kept rows[KEPT];
    kept_rows(&shot->at, &status, rows);
    if (!run_get_state(run, frame, rows, KEPT, has, err)) return false;
    if (*has) shot->status = (NewtonStatus)status;
    return true;
}

static int total_stages(const Model *model)
{
    int total = 0;
    for (int c = 0; c < model->case_count; c++) total += model->cases[c].stage_count;
    return total;
}

/* One case, its stages from frame number *frame on. False where err has to be said. */
static bool solve_case(Run *run, Case *c, Snapshot *shot, int *frame, bool *interrupted, Error *err)
{
    bool ok = true;
    int total = total_stages(run->model);
    NewtonStatus worst = NEWTON_CONVERGED;
    for (int s = 0; ok && !*interrupted && s < c->stage_count; s++, (*frame)++) {
        c->state.time = c->stages[s].time;
        *shot = (Snapshot){c, c->stages[s].p, c->state, NEWTON_CONVERGED, NULL, NULL};
        bool has;
        ok = get_progress(run, *frame, shot, &has, err);
        if (ok && !has) {
            RampInfo info = solve_stage(run, c, s);
            shot->status = info.newton.status;
            *interrupted = info.newton.status == NEWTON_STOPPED;
            if (*interrupted) break;
            if (shot->status != NEWTON_CONVERGED) run_say_unknown_field(run, shot, 0);
            run_is_crushed(run, shot, shot->status != NEWTON_CONVERGED);
            host_step(run->host, *frame + 1, total,
                      "%s: %s, %d Newton iterations with %d factorisations in %d load steps", c->name,
                      newton_status_name(shot->status), info.newton.iterations, info.newton.factorizations,
                      info.steps + info.refused);
            ok = put_progress(run, *frame, shot, err);
        }
        if (shot->status > worst) worst = shot->status;
    }
    if (!*interrupted) shot->status = worst;
    return ok;
}

static RunStatus run_equilibrium(Run *run, Error *err)
{
    Model *model = run->model;
    Snapshot *shots = mem_alloc((size_t)model->case_count, sizeof *shots);
    NewtonStatus worst = NEWTON_CONVERGED;
    bool ok = true, interrupted = false;
    int frame = 0, done = 0;
    for (; ok && !interrupted && done < model->case_count; done++) {
        ok = solve_case(run, &model->cases[done], &shots[done], &frame, &interrupted, err);
        if (shots[done].status > worst) worst = shots[done].status;
    }
    Arrays list = {0};
    if (ok) run_add_final(run, shots, done, interrupted ? "interrupted" : newton_status_name(worst), &list);
    ok = ok && arrays_replace(&list, run->journal, "final", err);
    if (ok && !interrupted && worst != NEWTON_CONVERGED) host_say(run->host, "%s", newton_status_text(worst));
    mem_free(shots);
    if (!ok) return RUN_CANNOT_WRITE;
    return interrupted ? RUN_INTERRUPTED : worst == NEWTON_CONVERGED ? RUN_DONE : RUN_NOT_CONVERGED;
}

static const char *const free_keys[] = {"output.precision", "modes", "time.steps", NULL};

const JobRow job_equilibrium = {
    .name = "equilibrium",
    .noun = "an equilibrium",
    .run = run_equilibrium,
    .rest = true,
    .frames = FRAMES_STAY,
    .free_keys = free_keys,
    .effort = {12, 5, 2, 2, 100e6},
};
