/* slender check: everything that can be said about a scene without running it. */
#include "base/memory.h"
#include "base/random.h"
#include "cli/say.h"
#include "cli/verb.h"
#include "job/predict.h"
#include "model/world_report.h"
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
    if (model->world && (model->world->obstacle_count || model->world->self))
        printf("not in it: further Newton iterations where the body touches something%s\n",
               model->world->self ? ", and couplings of parts that come near each other" : "");
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

static bool is_right(TermError error)
{
    return check_differences(error) <= DERIVATIVE_TOL && check_products(error) <= DERIVATIVE_TOL;
}

static TermError least(TermError a, TermError b)
{
    return (TermError){.idle = a.idle && b.idle,
                       .gradient = fmin(a.gradient, b.gradient),
                       .hessian = fmin(a.hessian, b.hessian),
                       .forward = fmin(a.forward, b.forward),
                       .adjoint = fmax(a.adjoint, b.adjoint),
                       .prev_forward = fmin(a.prev_forward, b.prev_forward),
                       .prev = fmax(a.prev, b.prev),
                       .lag_forward = fmin(a.lag_forward, b.lag_forward),
                       .lag = fmax(a.lag, b.lag)};
}

/* Contact and friction have kinks in their second derivatives, where a place begins to touch or to slip: differences across
 * one are off. They cross fewer the smaller they are, and what is wrong is wrong at all sizes. */
static TermError check_at_sizes(const Term *term, const Params *params, const Point *at, int dofs,
                                const double *size, Random *random)
{
    const double sizes[] = {1, 1e-2, 1e-4};
    TermError error = {0};
    for (int k = 0; k < 3 && (k == 0 || (!is_right(error) && !error.idle)); k++) {
        double own[TERM_MAX_DOF];
        for (int i = 0; i < term->ops->size(term->self); i++) own[i] = sizes[k] * size[i];
        TermError now = check_term(term, params, at, dofs, own, random);
        error = k == 0 ? now : least(error, now);
    }
    return error;
}

static bool print_errors(const TermOps *ops, TermError error)
{
    const char *name = ops->name;
    bool right = is_right(error);
    if (error.idle && ops->idles) {
        printf("derivatives of %-10s nothing touches there\n", name);
        return true;
    }
    printf("derivatives of %-10s gradient %.1e  Hessian %.1e  parameters %.1e, adjoint %.1e  ", name,
           error.gradient, error.hessian, error.forward, error.adjoint);
    printf("start of step %.1e, adjoint %.1e", error.prev_forward, error.prev);
    if (error.lag_forward > 0) printf("  lagged %.1e, adjoint %.1e", error.lag_forward, error.lag);
    printf("%s\n", right ? "" : "  WRONG");
    return right;
}

/* Of the first case, near its start: the body moved to an obstacle, its points moved by a tenth of a cell's length, angles by
 * 0.3 rad. */
static bool check_derivatives(const Model *model, const Scene *scene)
{
    const Case *c = &model->cases[0];
    int dofs = system_dof_count(c->sys), positions = system_position_count(c->sys);
    State state = state_clone(&c->state);
    double *x = state.x, *sizes = mem_alloc((size_t)dofs, sizeof *sizes), size[TERM_MAX_DOF];
    Random random = random_seed(1);
    model->body->ops->dof_sizes(model, sizes);
    if (model->world && model->world->obstacle_count)
        world_lean(model->world, state.time, c->stages[0].p, 0.1 * sizes[model->world->body.first], x);
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
        Point own = system_term_point(c->sys, t, &at);
        if (term->ops->update) term->ops->update(term->self, &own);
        bool any = term->ops->count(term->self) > 0;
        if (!any && !term->ops->update) continue; /* the scene has none of it: a solid without a film */
        if (any) term->ops->dofs(term->self, 0, dof);
        for (int i = 0; i < term->ops->size(term->self); i++) size[i] = any ? sizes[dof[i]] : 1;
        ok = print_errors(term->ops, check_at_sizes(term, model->params, &own, dofs, size, &random)) && ok;
    }
    mem_free(sizes);
    mem_free(p);
    state_destroy(&state);
    return ok;
}

/* "groups of faces: hub (24), flap1 (48)", a line for each kind that there is; so many are named. */
static void report_groups(const Mesh *mesh)
{
    enum { NAMED = 60 };
    for (int dim = 3; dim >= 0; dim--) {
        char *list = mem_text("");
        int count = 0;
        for (int g = 0; g < mesh->group_count; g++) {
            const MeshGroup *group = &mesh->groups[g];
            if (group->dim != dim || ++count > NAMED) continue;
            char *more = mem_format("%s%s%s (%d)", list, *list ? ", " : "", group->name, group->count);
            mem_free(list);
            list = more;
        }
        if (*list)
            say(stdout, count > NAMED ? "groups of %s: %s, .. (%d in all)" : "groups of %s: %s",
                build_elements[dim], list, count);
        mem_free(list);
    }
}

static bool report(const Model *model, const Scene *scene, bool derivatives)
{
    char *lines = model->body->ops->describe(model, scene), *world = world_describe(model, scene);
    say_lines(stdout, lines);
    if (world) say_lines(stdout, world);
    if (model->mesh) report_groups(model->mesh);
    mem_free(lines);
    mem_free(world);
    if (scene->design) printf("%d design unknowns\n", model->design.size);
    if (!model->case_count && derivatives)
        printf("derivatives: there is no load case whose terms could be checked\n");
    if (!model->case_count) return true;
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
        {"set", .kind = OPTION_OTHER, .value = &settings, .take = settings_take, .allowed = SETTINGS_ALLOWED,
         .words = SETTINGS_WORDS},
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
