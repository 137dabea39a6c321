/* Quasi-static design: unknowns that bring all cases' equilibria near their targets. */
#include "base/memory.h"
#include "job/design_run.h"
#include "job/jobs.h"
#include "model/probe.h"
#include "optim/static_design.h"
#include "solve/ramp.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct DesignJob {
    Run *run;
    StaticDesign *sd;
    CaseInfo *info;          /* [case] of the last evaluation */
    double *case_objectives; /* [case]                        */
    double *probes;          /* [case][probe_count] likewise; NULL: none */
} DesignJob;

/* What the probes say of a case's last evaluation; NAN where no equilibrium was found. */
static void measure(const DesignJob *job, int c)
{
    const Model *model = job->run->model;
    int count = model_probe_count(model);
    double *values = job->probes + c * count;
    const double *p;
    const State *state = static_design_trial(job->sd, c, &p);
    Snapshot shot = {.load_case = &model->cases[c], .p = p, .at = *state};
    if (job->info[c].newton.status == NEWTON_CONVERGED)
        model_measure(model, &shot, values);
    else
        for (int i = 0; i < count; i++) values[i] = NAN;
}

static double evaluate(void *self, const double *u, double *gradient, Evaluated *evaluated)
{
    DesignJob *job = self;
    int cases = job->run->model->case_count;
    double F = static_design_evaluate(job->sd, u, gradient, job->info);
    *evaluated =
        (Evaluated){.case_objectives = job->case_objectives, .case_count = cases, .probes = job->probes};
    for (int c = 0; job->probes && c < cases; c++) measure(job, c);
    evaluated->status = job->info[0].newton.status;
    for (int c = 0; c < cases; c++) {
        evaluated->newton_iterations += job->info[c].newton.iterations;
        evaluated->aborted |= job->info[c].newton.status == NEWTON_STOPPED;
        job->case_objectives[c] = job->info[c].objective;
    }
    return F;
}

static void accept(void *self)
{
    static_design_accept(((DesignJob *)self)->sd);
}

static void product(void *self, const double *v, double soft, double *out)
{
    static_design_product(((DesignJob *)self)->sd, v, soft, out);
}

/* ---- The best design's state: x, where its factor stands, what the terms remember, of each case ---- */

enum { VECTORS = 3, NAME = 32 };

typedef struct BestRows {
    int count;
    Kept *rows; /* [count] one block with the names */
    char (*names)[NAME];
} BestRows;

static BestRows best_rows(const DesignJob *job)
{
    static const char *const names[VECTORS] = {"x", "linearised", "memory"};
    BestRows best = {.count = VECTORS * job->run->model->case_count};
    size_t count = (size_t)best.count;
    best.rows = mem_alloc(count, sizeof *best.rows + sizeof *best.names);
    best.names = (char(*)[NAME])(best.rows + count);
    for (int k = 0; k < best.count; k++) {
        int c = k / VECTORS, which = k % VECTORS;
        CaseState state = static_design_state(job->sd, c);
        double *vectors[] = {state.state->x, state.linearised, state.state->memory};
        snprintf(best.names[k], NAME, "%s/%d", names[which], c);
        best.rows[k] = (Kept){best.names[k], vectors[which],
                              (size_t)(which < 2 ? state.state->dofs : state.state->memory_count)};
    }
    return best;
}

static bool put_best(void *self, int slot, Error *err)
{
    DesignJob *job = self;
    BestRows best = best_rows(job);
    bool ok = run_put_state(job->run, slot, best.rows, best.count, err);
    mem_free(best.rows);
    return ok;
}

static bool get_best(void *self, int slot, const double *u, bool *has, Error *err)
{
    DesignJob *job = self;
    BestRows best = best_rows(job);
    bool ok = run_get_state(job->run, slot, best.rows, best.count, has, err);
    mem_free(best.rows);
    if (ok && *has) static_design_restore(job->sd, u);
    return ok;
}

/* ---- What is shown ---- */

static Snapshot best_state(const DesignJob *job, int c)
{
    const Case *best = &job->run->model->cases[c];
    return (Snapshot){.load_case = best, .p = static_design_params(job->sd, c), .at = best->state};
}

static bool put_frame(void *self, int index, Error *err)
{
    DesignJob *job = self;
    Snapshot shot = best_state(job, job->run->model->case_count - 1);
    return run_put_frame(job->run, index, index, &shot, true, err);
}

static void add_gradients(const DesignJob *job, Arrays *list)
{
    const Model *model = job->run->model;
    size_t size = (size_t)model->params->size;
    int cases = model->case_count;
    double *dp = mem_alloc(size, sizeof *dp), *sum = arrays_numbers(list, size),
           *flux = arrays_numbers(list, 3 * (size_t)cases);
    for (int c = 0; c < cases; c++) {
        static_design_param_gradient(job->sd, c, dp);
        for (size_t i = 0; i < size; i++) sum[i] += dp[i];
        if (model->flux_blocks.uniform >= 0)
            memcpy(flux + 3 * c, dp + model->flux_blocks.uniform, 3 * sizeof *flux);
    }
    mem_free(dp);
    for (int k = 0; k < model->design.unknown_count; k++) {
        const ParamBlock *block = model->design.unknowns[k].block;
        bool per_case = block->offset == model->flux_blocks.uniform;
        design_add_gradient(list, block->name, block->unit, per_case ? flux : sum + block->offset,
                            per_case ? cases : block->count, block->width);
    }
}

/* One frame for each case of the final design, after those of the improvements. */
static bool put_results(void *self, int first, const char *status, Error *err)
{
    DesignJob *job = self;
    int cases = job->run->model->case_count;
    Snapshot *shots = mem_alloc((size_t)cases, sizeof *shots);
    bool ok = true;
    for (int c = 0; ok && c < cases; c++) {
        shots[c] = best_state(job, c);
        ok = run_put_frame(job->run, first + c, first + c, &shots[c], true, err);
    }
    Arrays list = {0};
    if (ok) add_gradients(job, &list); /* first: by the factors of the best design */
    if (ok) run_add_final(job->run, shots, cases, status, &list);
    ok = ok && arrays_replace(&list, job->run->journal, "final", err);
    mem_free(shots);
    return ok;
}

/* ---- The job ---- */

/* Equilibria of the start, by load steps where that is needed. */
static void find_start(DesignJob *job, const double *u)
{
    RampDef def = ramp_default();
    run_newton(job->run, &def.newton);
    def.observer = run_observer(job->run);
    for (int c = 0; c < job->run->model->case_count; c++) {
        Case *load = &job->run->model->cases[c];
        double *p = load->stages[0].p;
        design_apply(&job->run->model->design, c, u, p);
        if (load->objective_count)
            ramp_solve(load->sys, job->run->model->params, &def, load->loads, p, &load->state);
    }
}

static RunStatus run_design(Run *run, Error *err)
{
    static const DesignOps ops = {.evaluate = evaluate,
                                  .accept = accept,
                                  .product = product,
                                  .knows_soft = true,
                                  .put_best = put_best,
                                  .get_best = get_best,
                                  .put_frame = put_frame,
                                  .put_results = put_results};
    Model *model = run->model;
    size_t cases = (size_t)model->case_count;
    DesignJob job = {.run = run,
                     .info = mem_alloc(cases, sizeof *job.info),
                     .case_objectives = mem_alloc(cases, sizeof *job.case_objectives)};
    if (model->probe_count)
        job.probes = mem_alloc(cases * (size_t)model_probe_count(model), sizeof *job.probes);
    double *u = mem_alloc((size_t)model->design.size, sizeof *u);
    for (int c = 0; c < model->case_count; c++)
        design_read(&model->design, c, model->cases[c].stages[0].p, u);
    int recorded;
    bool ok = journal_count(run->journal, "evaluation", &recorded, err);
    if (ok && recorded == 0) find_start(&job, u);
    StaticDesignDef def = static_design_default();
    run_newton(run, &def.newton);
    def.observer = run_observer(run);
    def.workers = run_share_threads(run, model->case_count);
    job.sd = static_design_create(&model->design, model->params, model->cases, &def);
    RunStatus status = ok ? design_run(run, &ops, &job, u, err) : RUN_CANNOT_WRITE;
    static_design_destroy(job.sd);
    mem_free(job.info);
    mem_free(job.case_objectives);
    mem_free(job.probes);
    mem_free(u);
    return status;
}

static const char *const free_keys[] = {"design.iterations", "design.tolerance", "output.precision", "modes",
                                        NULL};

const JobRow job_design = {
    .name = "design",
    .noun = "a design",
    .run = run_design,
    .rest = true,
    .design = true,
    .frames = FRAMES_STAY,
    .probed = PROBED_EVALUATIONS,
    .free_keys = free_keys,
    .effort = {5, 5, 1.1, 8, 60e6},
};
