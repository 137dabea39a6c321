/* Quasi-static design: unknowns that bring all cases' equilibria near their targets.
 *
 * Every evaluation is a unit of the journal. A resumed run feeds the recorded ones to the optimiser, which
 * goes the same way without solving anything; the state of the best design (x, where its factor stands, what
 * the terms remember) is kept in two slots by turns, each written before the evaluation that it belongs to,
 * so that one of them always fits. */
#include "base/clock.h"
#include "base/memory.h"
#include "cli/job.h"
#include "optim/optimiser.h"
#include "optim/static_design.h"
#include "solve/ramp.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct DesignJob {
    Run *run;
    Error *err;
    const Design *design;
    LoadCase *cases;
    StaticDesign *sd;
    CaseInfo *info;       /* [case] of the last evaluation                         */
    double *u, *gradient; /* [n] of the last evaluation                            */
    double *lower, *upper;
    double objective, first, best, started;
    int evaluations, recorded, improvements, slot;
    bool accepted, failed, aborted; /* aborted: interrupted within an evaluation      */
} DesignJob;

/* ---- The journal ---- */

static double case_norm(const double *v, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += v[i] * v[i];
    return sqrt(sum);
}

static bool put_evaluation(DesignJob *job)
{
    int iterations = 0, cases = job->run->model->case_count;
    double *objectives = mem_alloc((size_t)cases, sizeof *objectives);
    for (int c = 0; c < cases; c++) {
        iterations += job->info[c].newton.iterations;
        objectives[c] = job->info[c].objective;
    }
    double norm = case_norm(job->gradient, job->design->size), seconds = clock_seconds() - job->started;
    double newton = iterations;
    Array arrays[] = {
        array_float("unknowns", "", job->u, 1, job->design->size, 0),
        array_float("gradient", "", job->gradient, 1, job->design->size, 0),
        array_float("case_objectives", "", objectives, 1, cases, 0),
        array_float("objective", "", &job->objective, 0, 0, 0),
        array_float("gradient_norm", "", &norm, 0, 0, 0),
        array_float("newton_iterations", "", &newton, 0, 0, 0),
        array_float("seconds", "s", &seconds, 0, 0, 0),
    };
    bool ok = journal_put(job->run->journal, "evaluation", job->evaluations, arrays,
                          sizeof arrays / sizeof *arrays, job->err);
    mem_free(objectives);
    return ok;
}

static size_t case_vector(const DesignJob *job, int c, int which, double **vector, char *name)
{
    static const char *const names[] = {"x", "linearised", "memory"};
    CaseState state = static_design_state(job->sd, c);
    double *vectors[] = {state.x, state.linearised, state.memory};
    const System *sys = job->cases[c].sys;
    snprintf(name, 32, "%s/%d", names[which], c);
    *vector = vectors[which];
    return (size_t)(which < 2 ? system_dof_count(sys) : system_memory_count(sys));
}

/* The best design's state, which is that of the evaluation about to be put. */
static bool put_best(DesignJob *job)
{
    job->slot = 1 - job->slot;
    double number = job->evaluations, *vector;
    char name[32];
    bool ok = true;
    for (int k = 0; ok && k < 3 * job->run->model->case_count; k++) {
        size_t count = case_vector(job, k / 3, k % 3, &vector, name);
        ok = run_put_state(job->run, job->slot, name, vector, count, job->err);
    }
    return ok && run_put_state(job->run, job->slot, "evaluation", &number, 1, job->err);
}

/* Fills the best design's state from the slot that belongs to this evaluation. */
static bool restore_best(DesignJob *job)
{
    for (int slot = 0; slot < 2; slot++) {
        double number, *vector;
        char name[32];
        if (!run_get_state(job->run, slot, "evaluation", &number, 1) || (int)number != job->evaluations)
            continue;
        for (int k = 0; k < 3 * job->run->model->case_count; k++) {
            size_t count = case_vector(job, k / 3, k % 3, &vector, name);
            if (!run_get_state(job->run, slot, name, vector, count)) return false;
        }
        job->slot = slot;
        static_design_restore(job->sd, job->u);
        return true;
    }
    return false;
}

/* A vector of a recorded evaluation. */
static bool recorded(const DesignJob *job, int evaluation, const char *name, double *values, size_t count)
{
    Array array;
    if (!journal_get(job->run->journal, "evaluation", evaluation, name, &array, job->err)) return false;
    bool ok = array_count(&array) == count && array.type == ARRAY_FLOAT64;
    if (ok)
        memcpy(values, array.data, count * sizeof *values);
    else
        error_set(job->err, "the journal's evaluation %d is of another scene", evaluation);
    array_clear(&array);
    return ok;
}

/* ---- What the optimiser calls ---- */

static bool is_replaying(const DesignJob *job)
{
    return job->evaluations < job->recorded;
}

static double evaluate(void *self, const double *u, double *gradient)
{
    DesignJob *job = self;
    size_t n = (size_t)job->design->size;
    memcpy(job->u, u, n * sizeof *u);
    job->accepted = false;
    if (is_replaying(job)) {
        double *known = mem_alloc(n, sizeof *known);
        bool ok = recorded(job, job->evaluations, "unknowns", known, n) &&
                  recorded(job, job->evaluations, "gradient", gradient, n) &&
                  recorded(job, job->evaluations, "objective", &job->objective, 1);
        if (ok && memcmp(known, u, n * sizeof *u))
            ok = error_set(
                job->err,
                "this program does not repeat evaluation %d of the journal bit by bit: it was written by "
                "another version or on another machine; start anew with --force",
                job->evaluations);
        mem_free(known);
        job->failed |= !ok;
    } else {
        job->objective = static_design_evaluate(job->sd, u, gradient, job->info);
        for (int c = 0; c < job->run->model->case_count; c++)
            job->aborted |= job->info[c].newton.status == NEWTON_STOPPED;
    }
    memcpy(job->gradient, gradient, n * sizeof *gradient);
    return job->failed || job->aborted ? INFINITY : job->objective;
}

static void accept(void *self)
{
    DesignJob *job = self;
    job->accepted = true;
    job->best = job->objective;
    if (job->improvements++ == 0) job->first = job->objective;
    if (is_replaying(job))
        restore_best(job);
    else
        static_design_accept(job->sd);
}

static State best_state(const DesignJob *job, int c)
{
    return (State){&job->run->model->cases[c], static_design_params(job->sd, c), job->cases[c].x,
                   job->run->model->cases[c].stages[0].time, NEWTON_CONVERGED};
}

static bool put_improvement(DesignJob *job)
{
    int every = job->run->scene->output.every, index = job->improvements - 1;
    if (every == 0 || index % every) return true;
    State state = best_state(job, job->run->model->case_count - 1);
    return run_put_frame(job->run, index / every, index / every, &state, true, job->err);
}

static void show(const DesignJob *job)
{
    progress_step(job->run->progress, job->evaluations, job->run->scene->design->iterations + 1,
                  "F %.3e, %.3g of the start%s", job->best, job->best / job->first,
                  isfinite(job->objective) ? "" : "  (no equilibrium, refused)");
}

static bool go_on(void *self)
{
    DesignJob *job = self;
    if (job->failed || job->aborted) return false;
    if (!is_replaying(job)) {
        if (job->accepted && !(put_best(job) && put_improvement(job))) job->failed = true;
        if (!job->failed && !put_evaluation(job)) job->failed = true;
    }
    if (job->failed) return false;
    job->evaluations++;
    show(job);
    return !progress_interrupted();
}

static void product(void *self, const double *v, double *out)
{
    static_design_product(((DesignJob *)self)->sd, v, out);
}

static bool recall(void *self, double *u)
{
    DesignJob *job = self;
    if (!is_replaying(job)) return false;
    if (!recorded(job, job->evaluations, "unknowns", u, (size_t)job->design->size)) job->failed = true;
    return !job->failed;
}

/* ---- The job ---- */

/* Equilibria of the start, by load steps where that is needed. */
static void find_start(DesignJob *job)
{
    RampDef def = ramp_default();
    run_newton(job->run, &def.newton);
    def.observer = run_observer(job->run);
    for (int c = 0; c < job->run->model->case_count; c++) {
        LoadCase *load = &job->cases[c];
        design_apply(job->design, c, job->u, load->p);
        if (load->objective_count)
            ramp_solve(load->sys, &job->run->model->shell->params, &def, NULL, load->p, load->time, load->x);
    }
}

static bool put_gradients(DesignJob *job)
{
    const Params *params = &job->run->model->shell->params;
    int cases = job->run->model->case_count;
    double *dp = mem_alloc((size_t)params->size, sizeof *dp),
           *sum = mem_alloc((size_t)params->size, sizeof *sum);
    double *flux = mem_alloc(3 * (size_t)cases, sizeof *flux);
    const ParamBlock *flux_block = params_find(params, "flux_density");
    for (int c = 0; c < cases; c++) {
        static_design_param_gradient(job->sd, c, dp);
        for (int i = 0; i < params->size; i++) sum[i] += dp[i];
        memcpy(flux + 3 * c, dp + flux_block->offset, 3 * sizeof *flux);
    }
    bool ok = true;
    for (int k = 0; ok && k < job->design->unknown_count; k++) {
        const ParamBlock *block = job->design->unknowns[k].block;
        char name[64], unit[64];
        snprintf(name, sizeof name, "design/gradient/%s", block->name);
        snprintf(unit, sizeof unit, block->unit[0] ? "m^2/(%s)" : "m^2", block->unit);
        Array array =
            array_float(name, unit, block == flux_block ? flux : sum + block->offset,
                        block->width > 1 ? 2 : 1, block == flux_block ? cases : block->count, block->width);
        ok = journal_put(job->run->journal, "final", 0, &array, 1, job->err);
    }
    mem_free(dp);
    mem_free(sum);
    mem_free(flux);
    return ok;
}

/* One frame for each case of the final design, after those of the improvements. */
static bool put_results(DesignJob *job, const char *status)
{
    int cases = job->run->model->case_count, every = job->run->scene->output.every;
    int frame = every ? (job->improvements + every - 1) / every : 0; /* a resumed run has at least as many */
    State *states = mem_alloc((size_t)cases, sizeof *states);
    bool ok = true;
    for (int c = 0; ok && c < cases; c++) {
        states[c] = best_state(job, c);
        ok = run_put_frame(job->run, frame + c, frame + c, &states[c], true, job->err);
    }
    ok = ok && put_gradients(job) && run_put_final(job->run, states, cases, status, job->err);
    mem_free(states);
    return ok;
}

static RunStatus finish(DesignJob *job, const OptimiserInfo *info)
{
    bool interrupted = job->aborted || info->status == OPTIMISER_STOPPED;
    if (job->failed) return RUN_CANNOT_WRITE;
    if (job->improvements == 0) {
        progress_say(job->run->progress, interrupted
                                             ? "interrupted before the first evaluation was done"
                                             : "no equilibrium was found for the start of the design");
        if (interrupted) return RUN_INTERRUPTED;
        Array status = array_text("status", newton_status_name(job->info[0].newton.status));
        return journal_put(job->run->journal, "final", 0, &status, 1, job->err) ? RUN_NOT_CONVERGED
                                                                                : RUN_CANNOT_WRITE;
    }
    if (!put_results(job, interrupted ? "interrupted" : "converged")) return RUN_CANNOT_WRITE;
    progress_say(job->run->progress,
                 "%s after %d evaluations: F %.4g, %.4g of the start; projected gradient %.3g",
                 optimiser_status_name(info->status), job->evaluations, job->best, job->best / job->first,
                 info->gradient_norm);
    return interrupted ? RUN_INTERRUPTED : RUN_DONE;
}

static RunStatus optimise_design(DesignJob *job)
{
    const DesignScene *scene = job->run->scene->design;
    static const OptimiserMethod methods[] = {OPTIMISER_MMA, OPTIMISER_LBFGS, OPTIMISER_GAUSS_NEWTON};
    OptimiserDef def = optimiser_default();
    def.method = methods[scene->optimizer];
    def.evaluations = scene->iterations + 1;
    if (def.evaluations < job->recorded) def.evaluations = job->recorded; /* what has been done stays done */
    def.gradient_tol = scene->tolerance;
    Problem problem = {.n = job->design->size,
                       .lower = job->lower,
                       .upper = job->upper,
                       .self = job,
                       .evaluate = evaluate,
                       .accept = accept,
                       .product = product,
                       .recall = recall,
                       .go_on = go_on};
    double *u = mem_copy(job->u, (size_t)problem.n, sizeof *u);
    OptimiserInfo info = optimise(&problem, &def, u);
    mem_free(u);
    return finish(job, &info);
}

static LoadCase *make_cases(Model *model)
{
    LoadCase *cases = mem_alloc((size_t)model->case_count, sizeof *cases);
    for (int c = 0; c < model->case_count; c++) {
        ModelCase *from = &model->cases[c];
        cases[c] = (LoadCase){from->name,   from->sys,           from->stages[0].p,
                              from->x,      from->objectives,    from->objective_count,
                              from->weight, from->stages[0].time};
    }
    return cases;
}

RunStatus job_design(Run *run, Error *err)
{
    Model *model = run->model;
    size_t n = (size_t)model->design.size;
    DesignJob job = {.run = run,
                     .err = err,
                     .design = &model->design,
                     .cases = make_cases(model),
                     .started = clock_seconds(),
                     .best = INFINITY,
                     .recorded = journal_count(run->journal, "evaluation"),
                     .slot = 1};
    job.info = mem_alloc((size_t)model->case_count, sizeof *job.info);
    double *work = mem_alloc(4 * n, sizeof *work);
    job.u = work, job.gradient = work + n, job.lower = work + 2 * n, job.upper = work + 3 * n;
    for (int c = 0; c < model->case_count; c++)
        design_read(&model->design, c, model->cases[c].stages[0].p, job.u);
    design_bounds(&model->design, job.lower, job.upper);
    if (job.recorded <= 0) find_start(&job);
    StaticDesignDef def = static_design_default();
    run_newton(run, &def.newton);
    def.observer = run_observer(run);
    def.threads = run->threads;
    job.sd = static_design_create(&model->design, &model->shell->params, job.cases, &def);
    RunStatus status = optimise_design(&job);
    static_design_destroy(job.sd);
    mem_free(job.cases);
    mem_free(job.info);
    mem_free(work);
    return status;
}
