#include "job/design_run.h"
#include "base/clock.h"
#include "base/memory.h"
#include "io/text.h"
#include "model/probe.h"
#include "optim/optimiser.h"
#include <math.h>
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
    const Array arrays[] = {
        array_float("unknowns", "", d->u, 1, d->n, 0),
        array_float("gradient", "", d->gradient, 1, d->n, 0),
        array_float("case_objectives", "", d->evaluated.case_objectives, 1, d->evaluated.case_count, 0),
        array_float("objective", "", &d->objective, 0, 0, 0),
        array_float("gradient_norm", "", &size, 0, 0, 0),
        array_float("newton_iterations", "", &newton, 0, 0, 0),
        array_float("seconds", "s", &seconds, 0, 0, 0),
    };
    Arrays list = {0};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++) arrays_add(&list, arrays[k]);
    if (d->evaluated.probes)
        model_add_probes(d->run->model, d->evaluated.probes, d->evaluated.case_count, false, d->evaluations,
                         &list);
    return arrays_put(&list, d->run->journal, "evaluation", d->evaluations, d->err);
}

/* The best design's state, which is that of the evaluation about to be put. */
static bool put_best(DesignRun *d)
{
    d->slot = 1 - d->slot;
    double number = d->evaluations;
    Kept row = {"evaluation", &number, 1};
    return d->ops->put_best(d->self, d->slot, d->err) && run_put_state(d->run, d->slot, &row, 1, d->err);
}

/* The best design's state from the slot that belongs to this evaluation, if it is still there. */
static bool get_best(DesignRun *d)
{
    for (int slot = 0; slot < 2; slot++) {
        double number;
        Kept row = {"evaluation", &number, 1};
        bool has;
        if (!run_get_state(d->run, slot, &row, 1, &has, d->err)) return false;
        if (!has || (int)number != d->evaluations) continue;
        if (!d->ops->get_best(d->self, slot, d->u, &has, d->err)) return false;
        if (has) d->slot = slot;
        return true;
    }
    return true;
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

/* Unknowns without effect on the start, where others have one. */
static void say_idle(const DesignRun *d)
{
    const Design *design = &d->run->model->design;
    for (int k = 0; k < design->unknown_count && !optimiser_is_zero(d->gradient, d->n, d->objective); k++) {
        const Unknown *unknown = &design->unknowns[k];
        int end = k + 1 < design->unknown_count ? unknown[1].first : design->size;
        if (!unknown->auxiliary &&
            optimiser_is_zero(d->gradient + unknown->first, end - unknown->first, d->objective))
            host_say(d->run->host, "the unknown %s does not act on the objective at the start",
                     design_unknown_name(d->run->model, unknown->block));
    }
}

static void accept(void *self)
{
    DesignRun *d = self;
    d->accepted = true;
    d->best = d->objective;
    if (d->improvements++ == 0) {
        d->first = d->objective;
        say_idle(d);
    }
    if (is_replaying(d))
        d->failed |= !get_best(d);
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
    int total = d->run->scene->design->iterations + 1;
    if (d->improvements == 0) {
        host_step(d->run->host, d->evaluations, total, "no solution yet");
        return;
    }
    host_step(d->run->host, d->evaluations, total, "F %.3e, %.3g of the start%s", d->best,
              d->first != 0 ? d->best / d->first : 0,
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
    return !host_stops(d->run->host);
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

/* Without a solution for the start there is nothing to show but why. */
static RunStatus finish_unsolved(DesignRun *d, bool interrupted)
{
    if (interrupted)
        host_say(d->run->host, "interrupted before the first evaluation was done");
    else
        host_say(d->run->host, "no solution was found for the start of the design: %s",
                 newton_status_text(d->evaluated.status));
    if (interrupted) return RUN_INTERRUPTED;
    d->run->unsolved = true;
    Array status = array_text("status", "unsolved");
    return journal_replace(d->run->journal, "final", 0, &status, 1, d->err) ? RUN_NOT_CONVERGED
                                                                            : RUN_CANNOT_WRITE;
}

/* "F 0.0012, 0.0023 of the start": of a start at 0 there are no parts. */
static char *reached(const DesignRun *d, const OptimiserInfo *info)
{
    char *part = d->first != 0 ? mem_format(", %.4g of the start", d->best / d->first) : mem_text("");
    char *text = mem_format("F %.4g%s; projected gradient %.3g, %.3g at the start", d->best, part,
                            info->gradient_norm, info->first_norm);
    mem_free(part);
    return text;
}

/* "magnetization, young"; the caller frees. */
static char *unknown_names(const Model *model)
{
    char *list = mem_text("");
    for (int k = 0; k < model->design.unknown_count; k++) {
        const Unknown *unknown = &model->design.unknowns[k];
        if (!unknown->auxiliary)
            list = mem_join(list, *list ? ", " : "", design_unknown_name(model, unknown->block));
    }
    return list;
}

static void say_stationary(const DesignRun *d)
{
    char *names = unknown_names(d->run->model);
    host_say(
        d->run->host,
        "the gradient is zero at the start: either no unknown (%s) acts on the objective (is something "
        "magnetised, is there a field, can what the objective looks at move?), or the start is a symmetric "
        "point: give the unknowns `noise` or another `start`",
        names);
    mem_free(names);
}

enum { FEW = 12 };

/* Adds "young 6.23e+05 Pa", with p of that case; of more numbers than a few nothing. */
static void add_few(const Model *model, const Unknown *unknown, const double *p, const char *of, Text *text)
{
    const ParamBlock *block = unknown->block;
    if (unknown->auxiliary || unknown->group_count * block->width > FEW) return;
    text_add(text, "%s%s%s", text->length ? "; " : "", design_unknown_name(model, block), of);
    for (int g = 0; g < unknown->group_count; g++) {
        int row = 0;
        while (row < block->count - 1 && unknown->group[row] != g) row++;
        for (int i = 0; i < block->width; i++)
            text_add(text, "%s %.4g", g || i ? "," : "", p[block->offset + row * block->width + i]);
    }
    text_add(text, "%s%s", block->unit[0] ? " " : "", block->unit);
}

/* The unknowns of few numbers, where the best design has them. */
static void say_found(const DesignRun *d, const double *u)
{
    const Model *model = d->run->model;
    const Design *design = &model->design;
    Text text = {0};
    for (int c = 0; c < design->case_count; c++) {
        double *p = mem_copy(model->cases[c].stages[0].p, (size_t)model->params->size, sizeof *p);
        design_apply(design, c, u, p);
        char *of = design->case_count > 1 ? mem_format(" of %s", model->cases[c].name) : mem_text("");
        for (int k = 0; k < design->unknown_count; k++)
            if (design->unknowns[k].per_case || c == 0)
                add_few(model, &design->unknowns[k], p, design->unknowns[k].per_case ? of : "", &text);
        mem_free(of);
        mem_free(p);
    }
    if (text.length) host_say(d->run->host, "found: %s", text.text);
    mem_free(text.text);
}

/* Points with a place, or measured ones. */
static int target_points(const Model *model, const Target *target)
{
    int count = 0;
    for (int v = 0; target->place && v < model->point_count; v++) {
        const double *at = target->place[v];
        count += !(isnan(at[0]) && isnan(at[1]) && isnan(at[2]));
    }
    return target->place ? count : target->cloud.point_count;
}

/* How far a case's best state is off its targets; a motion has them in its frames. */
static void say_target(const DesignRun *d, const Case *c)
{
    const Model *model = d->run->model;
    double sum = 0;
    int count = 0;
    for (int k = 0; k < c->target_count; k++) {
        Objective objective = model_target_objective(&c->targets[k], model->point_count, 1);
        sum += objective.ops->value(objective.self, 0, c->state.x, c->stages[0].p, NULL, NULL);
        count += target_points(model, &c->targets[k]);
        objective_destroy(objective);
    }
    if (count && !model->job->motion)
        host_say(d->run->host, "%s: %.3g m off the target, rms of %d points", c->name, sqrt(sum / count),
                 count);
}

/* What has happened, in a sentence. */
static void say(const DesignRun *d, const OptimiserInfo *info)
{
    const Host *host = d->run->host;
    int iterations = d->run->scene->design->iterations;
    char *F = reached(d, info);
    switch (info->status) {
    case OPTIMISER_CONVERGED:
        host_say(host, "converged after %d evaluations: %s", d->evaluations, F);
        break;
    case OPTIMISER_MAX_ITERATIONS:
        if (iterations == 0)
            host_say(host, "the start was evaluated: %s", F);
        else
            host_say(host,
                     "stopped at design.iterations = %d, not yet converged: %s; --resume with more of them "
                     "goes on",
                     iterations, F);
        break;
    case OPTIMISER_STALLED:
        host_say(host, "stalled after %d evaluations, no better design was found: %s", d->evaluations, F);
        break;
    case OPTIMISER_STATIONARY:
        say_stationary(d);
        break;
    default: /* stopped: the verb says it */
        break;
    }
    mem_free(F);
}

/* A start that was to be evaluated and nothing more is done; and so is a design that has used what it was
 * given, whose status says that it could go on. */
static RunStatus finish(DesignRun *d, const OptimiserInfo *info, const double *u)
{
    bool interrupted = d->evaluated.aborted || info->status == OPTIMISER_STOPPED;
    if (d->failed) return RUN_CANNOT_WRITE;
    if (d->improvements == 0) return finish_unsolved(d, interrupted);
    int every = d->ops->put_frame ? d->run->scene->output.every : 0;
    int first = every ? (d->improvements + every - 1) / every : 0; /* a resumed run has at least as many */
    bool limit = info->status == OPTIMISER_MAX_ITERATIONS,
         start_only = d->run->scene->design->iterations == 0;
    const char *status = interrupted           ? "interrupted"
                         : limit && start_only ? "evaluated"
                                               : optimiser_status_name(info->status);
    const Array best = array_float("final/objective", "", &d->best, 0, 0, 0);
    if (!d->ops->put_results(d->self, first, status, d->err) ||
        !journal_put(d->run->journal, "final", 0, &best, 1, d->err))
        return RUN_CANNOT_WRITE;
    say(d, info);
    if (!start_only) say_found(d, u);
    for (int c = 0; c < d->run->model->case_count; c++) say_target(d, &d->run->model->cases[c]);
    if (interrupted) return RUN_INTERRUPTED;
    return limit || info->status == OPTIMISER_CONVERGED ? RUN_DONE : RUN_NOT_CONVERGED;
}

/* The optimisers begin within the bounds. */
static void say_outside(const DesignRun *d, const double *u)
{
    int outside = 0;
    for (int i = 0; i < d->n; i++)
        outside +=
            u[i] < d->lower[i] - 1e-9 * fabs(d->lower[i]) || u[i] > d->upper[i] + 1e-9 * fabs(d->upper[i]);
    if (outside)
        host_say(d->run->host, "%d of %d unknowns start beyond their bounds, and are put on them", outside,
                 d->n);
}

RunStatus design_run(Run *run, const DesignOps *ops, void *self, const double *u, Error *err)
{
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
                   .slot = 1};
    if (!journal_count(run->journal, "evaluation", &d.recorded, err)) {
        mem_free(work);
        return RUN_CANNOT_WRITE;
    }
    design_bounds(&run->model->design, d.lower, d.upper);
    say_outside(&d, u);
    OptimiserDef def = optimiser_default();
    def.method = (OptimiserMethod)scene->optimizer;
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
    RunStatus status = finish(&d, &info, start);
    mem_free(work);
    return status;
}

const char *design_unknown_name(const Model *model, const ParamBlock *block)
{
    if (model->control.rows && block->offset == model->control.from) return "flux_density";
    if (model->strengths.rows && block->offset == model->strengths.from) return "source_strength";
    return block->name;
}

void design_add_gradient(Arrays *list, const char *name, const char *unit, const double *values, int count,
                         int width)
{
    char *path = arrays_keep(list, mem_format("design/gradient/%s", name));
    char *of = arrays_keep(list, unit[0] ? mem_format("m^2/(%s)", unit) : mem_text("m^2"));
    arrays_add(list, array_float(path, of, values, width > 1 ? 2 : 1, count, width));
}
