/* Equilibria of all cases, and of the stages of a sequence, each from the one before; or of all load steps of these, where
 * they are frames. */
#include "base/memory.h"
#include "job/jobs.h"
#include "model/sequence.h"
#include "solve/ramp.h"
#include <math.h>
#include <string.h>

typedef struct Mover {
    const Model *model;
    double since, time;
    Error err; /* where it failed */
    bool failed;
} Mover;

static bool move(void *self, double from, double to, double *x)
{
    Mover *mover = self;
    HeldWay way = {mover->since, mover->time, from, to};
    mover->failed = !model_move(mover->model, way, x, &mover->err);
    return !mover->failed;
}

/* What makes a frame: a stage, or that part of its way. */
typedef struct Piece {
    int stage;
    double begin, end;
} Piece;

static Piece piece_of(const Run *run, int k)
{
    int each = sequence_frames_each(run->scene), step = k % each;
    return (Piece){k / each, (double)step / each, step + 1 < each ? (step + 1.0) / each : 1};
}

static int piece_count(const Run *run, const Case *c)
{
    return c->stage_count * sequence_frames_each(run->scene);
}

/* What acts before a stage; NULL: nothing. */
static const double *loads_before(const Case *c, int stage)
{
    return stage > 0 ? c->stages[stage - 1].p : c->loads;
}

/* What acts at a part of a stage, maybe in p. */
static const double *loads_at(const Run *run, const Case *c, int stage, double part, double *p)
{
    const double *all = c->stages[stage].p;
    if (part >= 1) return all;
    ramp_loads(run->model->params, loads_before(c, stage), all, part, p);
    return p;
}

/* Where what is held is before a stage: where the one before has left it; at first where the body was made, or, of one that
 * starts from a result, near where it goes. */
static double held_since(const Case *c, int stage)
{
    return stage > 0 ? c->stages[stage - 1].time : c->loads ? c->stages[0].time : NAN;
}

static RampInfo solve_piece(Run *run, Case *c, Piece piece)
{
    Mover mover = {
        .model = run->model, .since = held_since(c, piece.stage), .time = c->stages[piece.stage].time};
    RampDef def = ramp_default();
    run_newton(run, &def.newton);
    def.observer = run_observer(run);
    def.begin = piece.begin, def.end = piece.end;
    if (!run->scene->load_steps.frames) def.steps = sequence_load_steps(run->model, run->scene);
    if (run->model->moves) def.move = move, def.self = &mover;
    RampInfo info = ramp_solve(c->sys, run->model->params, &def, loads_before(c, piece.stage),
                               c->stages[piece.stage].p, &c->state);
    if (mover.failed) host_say(run->host, "%s: %s", c->name, mover.err.text);
    return info;
}

/* Frames are shown at the times of their stages, if those go on; else they are numbered. */
static double shown_time(const Run *run, const Snapshot *shot, int frame)
{
    const Case *c = shot->load_case;
    bool goes_on = c->stage_count > 1 && sequence_frames_each(run->scene) == 1;
    for (int s = 1; s < c->stage_count; s++) goes_on = goes_on && c->stages[s].time > c->stages[s - 1].time;
    return goes_on ? shot->at.time : frame;
}

enum { KEPT = 4 };

/* What a resumed run needs: the status, the part of the loads and the state after each stage. */
static void kept_rows(const State *state, double *status, double *part, Kept rows[KEPT])
{
    rows[0] = (Kept){"status", status, 1};
    rows[1] = (Kept){"part", part, 1};
    rows[2] = (Kept){"x", state->x, (size_t)state->dofs};
    rows[3] = (Kept){"memory", state->memory, (size_t)state->memory_count};
}

/* The frame first: what is kept says that it is there. */
static bool put_progress(Run *run, int frame, const Snapshot *shot, Error *err)
{
    double status = shot->status, part = shot->part;
    Kept rows[KEPT];
    kept_rows(&shot->at, &status, &part, rows);
    return run_put_frame(run, frame, shown_time(run, shot, frame), shot, frame == 0, err) &&
           run_put_state(run, frame, rows, KEPT, err);
}

static bool get_progress(Run *run, int frame, Snapshot *shot, bool *has, Error *err)
{
    double status;
    Kept rows[KEPT];
    kept_rows(&shot->at, &status, &shot->part, rows);
    if (!run_get_state(run, frame, rows, KEPT, has, err)) return false;
    if (*has) shot->status = (NewtonStatus)status;
    return true;
}

static int total_frames(const Run *run)
{
    const Model *model = run->model;
    int total = 0;
    for (int c = 0; c < model->case_count; c++) total += piece_count(run, &model->cases[c]);
    return total;
}

/* One piece, as the frame of that number; p is for what acts there. False where err has to be said. */
static bool solve_frame(Run *run, Case *c, Piece piece, int frame, double *p, Snapshot *shot, Error *err)
{
    RampInfo info = solve_piece(run, c, piece);
    shot->status = info.newton.status, shot->part = info.part;
    shot->p = loads_at(run, c, piece.stage, info.part, p);
    if (shot->status == NEWTON_STOPPED) return true;
    if (shot->status != NEWTON_CONVERGED) run_say_unknown_field(run, shot, 0);
    run_is_crushed(run, shot, shot->status != NEWTON_CONVERGED);
    host_step(run->host, frame + 1, total_frames(run),
              "%s: %s, %d Newton iterations with %d factorisations in %d load steps", c->name,
              newton_status_name(shot->status), info.newton.iterations, info.newton.factorizations,
              info.steps + info.refused);
    return put_progress(run, frame, shot, err);
}

/* One case, its pieces from frame number *frame on; p is for what acts at the last one. False where err has to be said. */
static bool solve_case(Run *run, Case *c, double *p, Snapshot *shot, int *frame, bool *interrupted,
                       Error *err)
{
    bool ok = true;
    NewtonStatus worst = NEWTON_CONVERGED;
    for (int k = 0; ok && !*interrupted && k < piece_count(run, c); k++) {
        Piece piece = piece_of(run, k);
        c->state.time = c->stages[piece.stage].time;
        *shot = (Snapshot){.load_case = c, .at = c->state};
        bool has;
        ok = get_progress(run, *frame, shot, &has, err);
        shot->p = loads_at(run, c, piece.stage, shot->part, p);
        if (ok && !has) ok = solve_frame(run, c, piece, *frame, p, shot, err);
        *interrupted = shot->status == NEWTON_STOPPED;
        if (shot->status > worst) worst = shot->status;
        if (!*interrupted) ++*frame;
        if (piece.end < 1 && !ramp_reached(shot->status)) break; /* what follows would not begin there */
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
    Arrays list = {0};
    for (; ok && !interrupted && done < model->case_count; done++) {
        double *p = arrays_numbers(&list, (size_t)model->params->size);
        ok = solve_case(run, &model->cases[done], p, &shots[done], &frame, &interrupted, err);
        if (shots[done].status > worst) worst = shots[done].status;
    }
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
    .leads = true,
    .frames = FRAMES_STAY,
    .free_keys = free_keys,
    .effort = {12, 5, 2, 2, 100e6},
};
