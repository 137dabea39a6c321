#include "cli/design_run.h"
#include "base/clock.h"
#include "base/memory.h"
#include "optim/optimiser.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct DesignRun {
    Run *run;
    const DesignOps *ops;
    void *self;
    Error *err;
    int n;
    double *u, *gradient; /* [n] of the last evaluation */
    double *lower, *upper;
    Evaluated evaluated;
    double objective, first, best, started;
    int evaluations, recorded, improvements, slot;
    bool accepted, failed;
} DesignRun;

/* ---- The journal ---- */

static double norm(const double *v, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += v[i] * v[i];
    return sqrt(sum);
}

static bool put_evaluation(DesignRun *d)
{
    double size = norm(d->gradient, d->n), seconds = clock_seconds() - d->started;
    double newton = d->evaluated.newton_iterations;
    Array arrays[] = {
        array_float("unknowns", "", d->u, 1, d->n, 0),
        array_float("gradient", "", d->gradient, 1, d->n, 0),
        array_float("case_objectives", "", d->evaluated.case_objectives, 1, d->evaluated.case_count, 0),
        array_float("objective", "", &d->objective, 0, 0, 0),
        array_float("gradient_norm", "", &size, 0, 0, 0),
        array_float("newton_iterations", "", &newton, 0, 0, 0),
        array_float("seconds", "s", &seconds, 0, 0, 0),
    };
    return journal_put(d->run->journal, "evaluation", d->evaluations, arrays, sizeof arrays / sizeof *arrays,
                       d->err);
}

/* The best design's state, which is that of the evaluation about to be put. */
static bool put_best(DesignRun *d)
{
    d->slot = 1 - d->slot;
    double number = d->evaluations;
    return d->ops->put_best(d->self, d->slot, d->err) &&
           run_put_state(d->run, d->slot, "evaluation", &number, 1, d->err);
}

/* The best design's state from the slot that belongs to this evaluation, if it is still there. */
static void get_best(DesignRun *d)
{
    for (int slot = 0; slot < 2; slot++) {
        double number;
        if (!run_get_state(d->run, slot, "evaluation", &number, 1) || (int)number != d->evaluations) continue;
        if (d->ops->get_best(d->self, slot, d->u)) d->slot = slot;
        return;
    }
}

/* A vector of a recorded evaluation. */
static bool recorded(const DesignRun *d, const char *name, double *values, size_t count)
{
    Array array;
    if (!journal_get(d->run->journal, "evaluation", d->evaluations, name, &array, d->err)) return false;
    bool ok = array_count(&array) == count && array.type == ARRAY_FLOAT64;
    if (ok)
        memcpy(values, array.data, count * sizeof *values);
    else
        error_set(d->err, "the journal's evaluation %d is of another scene", d->evaluations);
    array_clear(&array);
    return ok;
}

/* ---- What the optimiser calls ---- */

static bool is_replaying(const DesignRun *d)
{
    return d->evaluations < d->recorded;
}

static bool replay(DesignRun *d, const double *u, double *gradient)
{
    size_t n = (size_t)d->n;
    double *known = mem_alloc(n, sizeof *known);
    bool ok = recorded(d, "unknowns", known, n) && recorded(d, "gradient", gradient, n) &&
              recorded(d, "objective", &d->objective, 1);
    if (ok && memcmp(known, u, n * sizeof *u))
        ok = error_set(
            d->err,
            "this program does not repeat evaluation %d of the journal bit by bit: it was written by another "
            "version or on another machine; start anew with --force",
            d->evaluations);
    mem_free(known);
    return ok;
}

static double evaluate(void *self, const double *u, double *gradient)
{
    DesignRun *d = self;
    memcpy(d->u, u, (size_t)d->n * sizeof *u);
    d->accepted = false;
    if (is_replaying(d))
        d->failed |= !replay(d, u, gradient);
    else
        d->objective = d->ops->evaluate(d->self, u, gradient, &d->evaluated);
    memcpy(d->gradient, gradient, (size_t)d->n * sizeof *gradient);
    return d->failed || d->evaluated.aborted ? INFINITY : d->objective;
}

static void accept(void *self)
{
    DesignRun *d = self;
    d->accepted = true;
    d->best = d->objective;
    if (d->improvements++ == 0) d->first = d->objective;
    if (is_replaying(d))
        get_best(d);
    else
        d->ops->accept(d->self);
}

static bool put_improvement(DesignRun *d)
{
    int every = d->run->scene->output.every, index = d->improvements - 1;
    if (!d->ops->put_frame || every == 0 || index % every) return true;
    return d->ops->put_frame(d->self, index / every, d->err);
}

static void show(const DesignRun *d)
{
    progress_step(d->run->progress, d->evaluations, d->run->scene->design->iterations + 1,
                  "F %.3e, %.3g of the start%s", d->best, d->best / d->first,
                  isfinite(d->objective) ? "" : "  (no solution, refused)");
}

static bool go_on(void *self)
{
    DesignRun *d = self;
    if (d->failed || d->evaluated.aborted) return false;
    if (!is_replaying(d)) {
        if (d->accepted && !(put_best(d) && put_improvement(d))) d->failed = true;
        if (!d->failed && !put_evaluation(d)) d->failed = true;
    }
    if (d->failed) return false;
    d->evaluations++;
    show(d);
    return !progress_interrupted();
}

static void product(void *self, const double *v, double soft, double *out)
{
    DesignRun *d = self;
    d->ops->product(d->self, v, soft, out);
}

static bool recall(void *self, double *u)
{
    DesignRun *d = self;
    if (!is_replaying(d)) return false;
    if (!recorded(d, "unknowns", u, (size_t)d->n)) d->failed = true;
    return !d->failed;
}

/* ---- The run ---- */

static RunStatus finish(DesignRun *d, const OptimiserInfo *info)
{
    bool interrupted = d->evaluated.aborted || info->status == OPTIMISER_STOPPED;
    if (d->failed) return RUN_CANNOT_WRITE;
    if (d->improvements == 0) {
        progress_say(d->run->progress, interrupted ? "interrupted before the first evaluation was done"
                                                   : "no solution was found for the start of the design");
        if (interrupted) return RUN_INTERRUPTED;
        Array status = array_text("status", newton_status_name(d->evaluated.status));
        return journal_put(d->run->journal, "final", 0, &status, 1, d->err) ? RUN_NOT_CONVERGED
                                                                            : RUN_CANNOT_WRITE;
    }
    int every = d->ops->put_frame ? d->run->scene->output.every : 0;
    int first = every ? (d->improvements + every - 1) / every : 0; /* a resumed run has at least as many */
    if (!d->ops->put_results(d->self, first, interrupted ? "interrupted" : "converged", d->err))
        return RUN_CANNOT_WRITE;
    progress_say(d->run->progress,
                 "%s after %d evaluations: F %.4g, %.4g of the start; projected gradient %.3g",
                 optimiser_status_name(info->status), d->evaluations, d->best, d->best / d->first,
                 info->gradient_norm);
    return interrupted ? RUN_INTERRUPTED : RUN_DONE;
}

RunStatus design_run(Run *run, const DesignOps *ops, void *self, const double *u, Error *err)
{
    static const OptimiserMethod methods[] = {OPTIMISER_MMA, OPTIMISER_LBFGS, OPTIMISER_GAUSS_NEWTON};
    const DesignScene *scene = run->scene->design;
    int n = run->model->design.size;
    double *work = mem_alloc(5 * (size_t)n, sizeof *work);
    DesignRun d = {.run = run,
                   .ops = ops,
                   .self = self,
                   .err = err,
                   .n = n,
                   .u = work,
                   .gradient = work + n,
                   .lower = work + 2 * n,
                   .upper = work + 3 * n,
                   .best = INFINITY,
                   .started = clock_seconds(),
                   .recorded = journal_count(run->journal, "evaluation"),
                   .slot = 1};
    design_bounds(&run->model->design, d.lower, d.upper);
    OptimiserDef def = optimiser_default();
    def.method = methods[scene->optimizer];
    def.evaluations = scene->iterations + 1;
    if (def.evaluations < d.recorded) def.evaluations = d.recorded; /* what has been done stays done */
    def.gradient_tol = scene->tolerance;
    Problem problem = {.n = n,
                       .lower = d.lower,
                       .upper = d.upper,
                       .self = &d,
                       .evaluate = evaluate,
                       .accept = accept,
                       .product = product,
                       .knows_soft = ops->knows_soft,
                       .recall = recall,
                       .go_on = go_on};
    double *start = work + 4 * n;
    memcpy(start, u, (size_t)n * sizeof *u);
    OptimiserInfo info = optimise(&problem, &def, start);
    RunStatus status = finish(&d, &info);
    mem_free(work);
    return status;
}

bool design_put_gradient(Run *run, const char *name, const char *unit, const double *values, int count,
                         int width, Error *err)
{
    char path[64], of[64];
    snprintf(path, sizeof path, "design/gradient/%s", name);
    snprintf(of, sizeof of, unit[0] ? "m^2/(%s)" : "m^2", unit);
    Array array = array_float(path, of, values, width > 1 ? 2 : 1, count, width);
    return journal_put(run->journal, "final", 0, &array, 1, err);
}
