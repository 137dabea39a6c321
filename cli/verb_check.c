/* slender check: everything that can be said about a scene without running it. */
#include "base/memory.h"
#include "base/random.h"
#include "cli/say.h"
#include "cli/verb.h"
#include "job/predict.h"
#include "solve/check.h"
#include "solve/kernels.h"
#include <math.h>
#include <stdio.h>

static const char usage[] =
    "check SCENE [--set key=value].. [--derivatives]\n"
    "  Reads the scene and its files, says what they make and what one solve costs.\n"
    "  --derivatives  checks every term's gradient and Hessian on this scene by differences";

static const double DERIVATIVE_TOL = 1e-6;

/* What one solve costs, and the job. */
static void report_cost(const Model *model, const Scene *scene)
{
    Prediction r = predict(model, scene);
    const char *note = kernels_note();
    printf("OpenBLAS's kernels: %s%s%s\n", kernels_name(), *note ? ", " : "", note);
    printf("one Newton iteration: %.3g s, with %.3g s for each factorisation; %g of these are assumed, of "
           "%s%.3g "
           "million numbers (%.3g MB)\n",
           r.iteration, r.factorization, r.factorizations, r.exact ? "" : "about ", 1e-6 * r.numbers,
           1e-6 * r.factor_bytes);
    printf("estimated: %.3g s in all by one thread (%.2g s to prepare, %g Newton iterations are assumed, "
           "%.2g s for stability "
           "and result); about %.3g MB of memory\n",
           predict_seconds(&r), r.start, r.iterations, r.end, 1e-6 * r.bytes);
}

/* The parameters of a case, at random where a whole block is 0: no term is idle. The caller frees them. */
static double *params_at_work(const Params *params, const double *p, Random *random)
{
    double *q = mem_copy(p, (size_t)params->size, sizeof *q);
    for (int b = 0; b < params->block_count; b++) {
        const ParamBlock *block = &params->blocks[b];
        int end = block->offset + block->count * block->width;
        bool idle = true;
        for (int i = block->offset; i < end; i++) idle = idle && q[i] == 0;
        for (int i = block->offset; idle && i < end; i++) q[i] = random_signed(random);
    }
    return q;
}

static bool print_errors(const char *name, TermError error)
{
    bool right = check_differences(error) <= DERIVATIVE_TOL && check_products(error) <= DERIVATIVE_TOL;
    printf("derivatives of %-10s gradient %.1e  Hessian %.1e  parameters %.1e, adjoint %.1e  ", name,
           error.gradient, error.hessian, error.forward, error.adjoint);
    printf("start of step %.1e, adjoint %.1e", error.prev_forward, error.prev);
    if (error.lag_forward > 0) printf("  lagged %.1e, adjoint %.1e", error.lag_forward, error.lag);
    printf("%s\n", right ? "" : "  WRONG");
    return right;
}

/* Of the first case, near its start: points moved by a tenth of a cell's length, angles by 0.3 rad. */
static bool check_derivatives(const Model *model, const Scene *scene)
{
    const Case *c = &model->cases[0];
    int dofs = system_dof_count(c->sys), positions = system_position_count(c->sys);
    State state = state_clone(&c->state);
    double *x = state.x, *sizes = mem_alloc((size_t)dofs, sizeof *sizes), size[TERM_MAX_DOF];
    Random random = random_seed(1);
    model->body->ops->dof_sizes(model, sizes);
    for (int i = 0; i < dofs; i++)
        if (sizes[i] > 0) x[i] += (i < positions ? 0.1 : 0.3) * sizes[i] * random_signed(&random);
    double *p = params_at_work(model->params, c->stages[0].p, &random);
    Point at = state_point(&state, p);
    if (model->job->motion) at.dt = scene->time.step;
    bool ok = true;
    system_accept(c->sys, x, state.memory);
    for (int t = 0; t < system_term_count(c->sys); t++) {
        const Term *term = system_term(c->sys, t);
        int dof[TERM_MAX_DOF];
        term->ops->dofs(term->self, 0, dof);
        for (int i = 0; i < term->ops->size(term->self); i++) size[i] = sizes[dof[i]];
        Point own = system_term_point(c->sys, t, &at);
        ok = print_errors(term->ops->name, check_term(term, model->params, &own, dofs, size, &random)) && ok;
    }
    mem_free(sizes);
    mem_free(p);
    state_destroy(&state);
    return ok;
}

static bool report(const Model *model, const Scene *scene, bool derivatives)
{
    char *lines = model->body->ops->describe(model, scene);
    say_lines(stdout, lines);
    mem_free(lines);
    if (scene->design) printf("%d design unknowns\n", model->design.size);
    if (!model->case_count && derivatives)
        printf("derivatives: there is no load case whose terms could be checked\n");
    if (!model->case_count) {
        printf("time and memory of such a job are not foretold\n");
        return true;
    }
    report_cost(model, scene);
    return !derivatives || check_derivatives(model, scene);
}

int verb_check(int argc, char **argv)
{
    Settings settings = {0};
    const char *path;
    int code;
    bool derivatives = false;
    const Option options[] = {
        {"set", .kind = OPTION_OTHER, .value = &settings, .take = settings_take, .allowed = SETTINGS_ALLOWED},
        {"derivatives", .value = &derivatives},
    };
    if (!options_parse(argc, argv, usage, options, 2, &path, &code)) {
        settings_clear(&settings);
        return code;
    }
    YamlFile *file;
    Scene scene;
    Model *model = verb_load_scene(path, &settings, &file, &scene) ? verb_build_model(&scene, file) : NULL;
    code = !model ? RUN_REFUSED : report(model, &scene, derivatives) ? RUN_DONE : RUN_NOT_CONVERGED;
    model_destroy(model);
    yaml_clear(scene_table(), &scene);
    yaml_destroy(file);
    settings_clear(&settings);
    return code;
}
