#include "optim/static_design.h"
#include "base/memory.h"
#include "base/vector.h"
#include "optim/implicit.h"
#include "solve/tangent.h"
#include <math.h>
#include <string.h>

/* One case at work. */
typedef struct Work {
    double *p;               /* of the last evaluation                                 */
    State state;             /* of it                                                  */
    double *best_p;          /* p of the best design; its state is Case.state      */
    double *best_linearised; /* [dofs] where its factor stands                        */
    double *dp, *dx, *w;     /* directions and gradients                               */
    double *hp;              /* [params] second parameter vector                       */
    double soft_pull;        /* find_soft_pull of the best design; < 0: not known yet  */
    bool factored_best;      /* the system's factor is that of the best design         */
    bool has_best;
} Work;

struct StaticDesign {
    const Design *design;
    const Params *params;
    Case *cases;
    StaticDesignDef def;
    Work *work;
    double *u, *best_u;
};

StaticDesignDef static_design_default(void)
{
    return (StaticDesignDef){.newton = newton_default()};
}

StaticDesign *static_design_create(const Design *design, const Params *params, Case *cases,
                                   const StaticDesignDef *def)
{
    StaticDesign *sd = mem_alloc(1, sizeof *sd);
    *sd = (StaticDesign){.design = design, .params = params, .cases = cases, .def = *def};
    sd->u = mem_alloc((size_t)design->size, sizeof(double));
    sd->best_u = mem_alloc((size_t)design->size, sizeof(double));
    sd->work = mem_alloc((size_t)design->case_count, sizeof *sd->work);
    for (int c = 0; c < design->case_count; c++) {
        Work *work = &sd->work[c];
        size_t dofs = (size_t)system_dof_count(cases[c].sys), size = (size_t)params->size;
        work->p = mem_copy(cases[c].stages[0].p, size, sizeof(double));
        work->best_p = mem_copy(cases[c].stages[0].p, size, sizeof(double));
        work->state = state_clone(&cases[c].state);
        work->best_linearised = mem_alloc(dofs, sizeof(double));
        work->dx = mem_alloc(dofs, sizeof(double));
        work->w = mem_alloc(dofs, sizeof(double));
        work->dp = mem_alloc(size, sizeof(double));
        work->hp = mem_alloc(size, sizeof(double));
    }
    return sd;
}

void static_design_destroy(StaticDesign *sd)
{
    if (!sd) return;
    for (int c = 0; c < sd->design->case_count; c++) {
        Work *work = &sd->work[c];
        double *owned[] = {work->p,  work->best_p, work->best_linearised, work->dx, work->w,
                           work->dp, work->hp};
        for (size_t k = 0; k < sizeof owned / sizeof *owned; k++) mem_free(owned[k]);
        state_destroy(&work->state);
    }
    mem_free(sd->work);
    mem_free(sd->u);
    mem_free(sd->best_u);
    mem_free(sd);
}

/* x with what is remembered at the best design. */
static Point point(const Case *load, const double *x, const double *p)
{
    return (Point){.x = x, .p = p, .memory = load->state.memory, .time = load->state.time};
}

/* Leaves the factor of the best design in the system, shifted by nothing but the base. */
static bool factor_best(StaticDesign *sd, int c)
{
    Work *work = &sd->work[c];
    const Case *load = &sd->cases[c];
    if (work->factored_best) return true;
    Point at = point(load, work->best_linearised, work->best_p);
    system_hessian(load->sys, &at, work->w);
    work->factored_best = tangent_factor(load->sys);
    return work->factored_best;
}

/* The best equilibrium, moved along the tangent if that lowers the energy of the new design. */
static void predict(StaticDesign *sd, int c)
{
    Work *work = &sd->work[c];
    const Case *load = &sd->cases[c];
    state_copy(&work->state, &load->state);
    if (!work->has_best || !factor_best(sd, c)) return;
    for (int i = 0; i < sd->params->size; i++) work->dp[i] = work->p[i] - work->best_p[i];
    Point best = point(load, load->state.x, work->best_p);
    implicit_predict(load->sys, &best, work->dp, work->p, &work->state);
}

/* Objectives at the point and, where dp is not NULL, dF/dp by the adjoint with the factor at hand. */
static double evaluate_objective(StaticDesign *sd, int c, const Point *at, double *dp)
{
    Work *work = &sd->work[c];
    const Case *load = &sd->cases[c];
    double value = 0;
    memset(work->dx, 0, (size_t)system_dof_count(load->sys) * sizeof *work->dx);
    if (dp) memset(dp, 0, (size_t)sd->params->size * sizeof *dp);
    for (int k = 0; k < load->objective_count; k++) {
        const Objective *objective = &load->objectives[k];
        double weight = load->weight * objective->weight;
        value +=
            weight * objective->ops->value(objective->self, weight, at->x, at->p, dp ? work->dx : NULL, dp);
    }
    if (dp) implicit_adjoint(load->sys, at, work->dx, dp);
    return value;
}

static CaseInfo evaluate_case(StaticDesign *sd, int c, const double *u, bool with_gradient)
{
    Work *work = &sd->work[c];
    const Case *load = &sd->cases[c];
    const NewtonObserver *observer = sd->def.observer.iteration ? &sd->def.observer : NULL;
    CaseInfo info = {.objective = INFINITY};
    design_apply(sd->design, c, u, work->p);
    predict(sd, c);
    work->factored_best = false;
    Point at = state_point(&work->state, work->p);
    info.newton = newton_minimize(load->sys, &sd->def.newton, &at, &work->state, observer);
    if (info.newton.status == NEWTON_CONVERGED)
        info.objective = evaluate_objective(sd, c, &at, with_gradient ? work->dp : NULL);
    return info;
}

/* An evaluation of all cases or, with v, a product. */
typedef struct Sweep {
    StaticDesign *sd;
    const double *u, *v;
    double soft;
    bool with_gradient;
    CaseInfo *info;
} Sweep;

static void product_case(StaticDesign *sd, int c, const double *v, double soft);

static void case_task(void *self, int c)
{
    const Sweep *sweep = self;
    if (sweep->v)
        product_case(sweep->sd, c, sweep->v, sweep->soft);
    else
        sweep->info[c] = evaluate_case(sweep->sd, c, sweep->u, sweep->with_gradient);
}

static void do_cases(Sweep sweep)
{
    workers_run(sweep.sd->def.workers, sweep.sd->design->case_count, case_task, &sweep);
}

double static_design_evaluate(StaticDesign *sd, const double *u, double *gradient, CaseInfo *case_info)
{
    double F = 0;
    memcpy(sd->u, u, (size_t)sd->design->size * sizeof *u);
    do_cases((Sweep){.sd = sd, .u = u, .with_gradient = gradient != NULL, .info = case_info});
    for (int c = 0; c < sd->design->case_count; c++) F += case_info[c].objective;
    if (!gradient) return F;
    memset(gradient, 0, (size_t)sd->design->size * sizeof *gradient);
    for (int c = 0; isfinite(F) && c < sd->design->case_count; c++)
        design_transpose(sd->design, c, u, sd->work[c].dp, gradient);
    return F;
}

void static_design_accept(StaticDesign *sd)
{
    memcpy(sd->best_u, sd->u, (size_t)sd->design->size * sizeof *sd->u);
    for (int c = 0; c < sd->design->case_count; c++) {
        Work *work = &sd->work[c];
        System *sys = sd->cases[c].sys;
        memcpy(work->best_p, work->p, (size_t)sd->params->size * sizeof *work->p);
        state_copy(&sd->cases[c].state, &work->state);
        memcpy(work->best_linearised, system_linearised(sys),
               (size_t)system_dof_count(sys) * sizeof *work->best_linearised);
        work->has_best = work->factored_best = true;
        work->soft_pull = -1;
    }
}

const State *static_design_trial(const StaticDesign *sd, int load_case, const double **p)
{
    *p = sd->work[load_case].p;
    return &sd->work[load_case].state;
}

CaseState static_design_state(StaticDesign *sd, int load_case)
{
    return (CaseState){&sd->cases[load_case].state, sd->work[load_case].best_linearised};
}

void static_design_restore(StaticDesign *sd, const double *u)
{
    memcpy(sd->best_u, u, (size_t)sd->design->size * sizeof *u);
    for (int c = 0; c < sd->design->case_count; c++) {
        design_apply(sd->design, c, u, sd->work[c].best_p);
        sd->work[c].has_best = true;
        sd->work[c].factored_best = false;
        sd->work[c].soft_pull = -1;
    }
}

/* hx, hp += the objectives' own products with (work->dx, work->hp). */
static void add_products(StaticDesign *sd, int c, double *hx, double *hp)
{
    Work *work = &sd->work[c];
    const Case *load = &sd->cases[c];
    for (int k = 0; k < load->objective_count; k++) {
        const Objective *objective = &load->objectives[k];
        if (objective->ops->product)
            objective->ops->product(objective->self, load->weight * objective->weight, load->state.x,
                                    work->best_p, work->dx, work->hp, hx, hp);
    }
}

/* y = H^-1 x of the positions alone. */
static void soften(System *sys, const double *x, double *y)
{
    int positions = system_position_count(sys);
    memset(y, 0, (size_t)system_dof_count(sys) * sizeof *y);
    memcpy(y, x, (size_t)positions * sizeof *y);
    system_solve(sys, y, y);
    for (int i = positions; i < system_dof_count(sys); i++) y[i] = 0;
}

/* a'(d2F/dx2) a / a'H^-1 a with a = H^-1 dF/dx, in which the mode that is about to snap prevails: x'H^-1 x
 * times this is as much as the objectives pull at that mode. */
static double find_soft_pull(StaticDesign *sd, int c)
{
    Work *work = &sd->work[c];
    System *sys = sd->cases[c].sys;
    Point at = point(&sd->cases[c], sd->cases[c].state.x, work->best_p);
    int dofs = system_dof_count(sys);
    evaluate_objective(sd, c, &at, work->dp); /* leaves -a in dx */
    memset(work->hp, 0, (size_t)sd->params->size * sizeof *work->hp);
    memset(work->w, 0, (size_t)dofs * sizeof *work->w);
    add_products(sd, c, work->w, work->dp);
    double pull = vector_dot(dofs, work->dx, work->w);
    soften(sys, work->dx, work->w);
    double softness = vector_dot(dofs, work->dx, work->w);
    return softness > 0 ? pull / softness : 0;
}

/* The case's part of J^T J v over the parameters, in work->dp. */
static void product_case(StaticDesign *sd, int c, const double *v, double soft)
{
    Work *work = &sd->work[c];
    const Case *load = &sd->cases[c];
    int dofs = system_dof_count(load->sys);
    bool factored = factor_best(sd, c);
    if (factored && soft > 0 && work->soft_pull < 0) work->soft_pull = find_soft_pull(sd, c);
    memset(work->hp, 0, (size_t)sd->params->size * sizeof *work->hp);
    memset(work->dp, 0, (size_t)sd->params->size * sizeof *work->dp);
    if (!factored) return;
    design_forward(sd->design, c, sd->best_u, v, work->hp);
    Point at = point(load, load->state.x, work->best_p);
    implicit_tangent(load->sys, &at, work->hp, work->dx);
    memset(work->w, 0, (size_t)dofs * sizeof *work->w);
    if (soft > 0) soften(load->sys, work->dx, work->w);
    for (int i = 0; soft > 0 && i < dofs; i++) work->w[i] *= soft * work->soft_pull;
    add_products(sd, c, work->w, work->dp);
    implicit_adjoint(load->sys, &at, work->w, work->dp);
}

void static_design_product(StaticDesign *sd, const double *v, double soft, double *out)
{
    memset(out, 0, (size_t)sd->design->size * sizeof *out);
    do_cases((Sweep){.sd = sd, .v = v, .soft = soft});
    for (int c = 0; c < sd->design->case_count; c++)
        design_transpose(sd->design, c, sd->best_u, sd->work[c].dp, out);
}

void static_design_param_gradient(StaticDesign *sd, int load_case, double *dp)
{
    Point at = point(&sd->cases[load_case], sd->cases[load_case].state.x, sd->work[load_case].best_p);
    memset(dp, 0, (size_t)sd->params->size * sizeof *dp);
    if (factor_best(sd, load_case)) evaluate_objective(sd, load_case, &at, dp);
}

const double *static_design_params(const StaticDesign *sd, int load_case)
{
    return sd->work[load_case].best_p;
}
