#include "optim/static_design.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

/* One case at work. */
typedef struct Work {
    double *p, *x;          /* of the last evaluation                                 */
    double *best_p;         /* p of the best design; x of it is LoadCase.x            */
    double *dp, *dx, *w;    /* directions and gradients                               */
    double *hp;             /* [params] second parameter vector                       */
    double *memory, *best_memory; /* what the terms remember                          */
    bool factored_best;     /* the system's factor is that of the best design         */
    bool has_best;
} Work;

struct StaticDesign {
    const Design *design;
    const Params *params;
    LoadCase *cases;
    NewtonDef newton;
    Work *work;
    double *u, *best_u;
};

StaticDesign *static_design_create(const Design *design, const Params *params, LoadCase *cases, const NewtonDef *newton)
{
    StaticDesign *sd = mem_alloc(1, sizeof *sd);
    *sd = (StaticDesign){design, params, cases, *newton, NULL, NULL, NULL};
    sd->u = mem_alloc((size_t)design->size, sizeof(double));
    sd->best_u = mem_alloc((size_t)design->size, sizeof(double));
    sd->work = mem_alloc((size_t)design->case_count, sizeof *sd->work);
    for (int c = 0; c < design->case_count; c++) {
        Work *work = &sd->work[c];
        size_t dofs = (size_t)system_dof_count(cases[c].sys), size = (size_t)params->size;
        size_t memory = (size_t)system_memory_count(cases[c].sys);
        work->p = mem_copy(cases[c].p, size, sizeof(double));
        work->best_p = mem_copy(cases[c].p, size, sizeof(double));
        work->x = mem_copy(cases[c].x, dofs, sizeof(double));
        work->dx = mem_alloc(dofs, sizeof(double));
        work->w = mem_alloc(dofs, sizeof(double));
        work->dp = mem_alloc(size, sizeof(double));
        work->hp = mem_alloc(size, sizeof(double));
        work->memory = mem_alloc(memory, sizeof(double));
        work->best_memory = mem_alloc(memory, sizeof(double));
        system_memory_read(cases[c].sys, work->best_memory);
    }
    return sd;
}

void static_design_destroy(StaticDesign *sd)
{
    if (!sd) return;
    for (int c = 0; c < sd->design->case_count; c++) {
        Work *work = &sd->work[c];
        double *owned[] = {work->p, work->best_p, work->x, work->dx, work->w, work->dp, work->hp, work->memory,
                           work->best_memory};
        for (size_t k = 0; k < sizeof owned / sizeof *owned; k++) mem_free(owned[k]);
    }
    mem_free(sd->work);
    mem_free(sd->u);
    mem_free(sd->best_u);
    mem_free(sd);
}

static Point point(const double *x, const double *p)
{
    return (Point){.x = x, .p = p};
}

/* Leaves the factor of the best design in the system, shifted by nothing but the base. */
static bool factor_best(StaticDesign *sd, int c)
{
    Work *work = &sd->work[c];
    const LoadCase *load = &sd->cases[c];
    if (work->factored_best) return true;
    system_memory_write(load->sys, work->best_memory);
    Point at = point(load->x, work->best_p);
    system_hessian(load->sys, &at, work->w);
    work->factored_best = system_factor(load->sys, 0);
    return work->factored_best;
}

/* dx = -H^-1 (d2E/dx dp) dp at the best design. */
static void tangent(StaticDesign *sd, int c, const double *dp, double *dx)
{
    Point at = point(sd->cases[c].x, sd->work[c].best_p);
    system_param_forward(sd->cases[c].sys, &at, dp, dx);
    system_solve(sd->cases[c].sys, dx, dx);
    for (int i = 0; i < system_dof_count(sd->cases[c].sys); i++) dx[i] = -dx[i];
}

/* dp -= (d2E/dx dp)^T H^-1 gx with the factor at hand; gx is overwritten. */
static void adjoint(System *sys, const Point *at, double *gx, double *dp)
{
    system_solve(sys, gx, gx);
    for (int i = 0; i < system_dof_count(sys); i++) gx[i] = -gx[i];
    system_param(sys, at, gx, dp);
}

/* The best equilibrium, moved along the tangent if that lowers the energy of the new design. */
static void predict(StaticDesign *sd, int c)
{
    Work *work = &sd->work[c];
    const LoadCase *load = &sd->cases[c];
    int dofs = system_dof_count(load->sys);
    memcpy(work->x, load->x, (size_t)dofs * sizeof *work->x);
    if (!work->has_best || !factor_best(sd, c)) return;
    for (int i = 0; i < sd->params->size; i++) work->dp[i] = work->p[i] - work->best_p[i];
    tangent(sd, c, work->dp, work->dx);
    Point from = point(load->x, work->p), to = point(work->w, work->p);
    for (int i = 0; i < dofs; i++) work->w[i] = load->x[i] + work->dx[i];
    Evaluation moved = system_energy(load->sys, &to);
    if (moved.finite && moved.energy < system_energy(load->sys, &from).energy)
        memcpy(work->x, work->w, (size_t)dofs * sizeof *work->x);
}

/* Objective and, where asked for, its gradient over the parameters in work->dp. */
static double evaluate_objective(StaticDesign *sd, int c, bool with_gradient)
{
    Work *work = &sd->work[c];
    const LoadCase *load = &sd->cases[c];
    double value = 0;
    memset(work->dx, 0, (size_t)system_dof_count(load->sys) * sizeof *work->dx);
    memset(work->dp, 0, (size_t)sd->params->size * sizeof *work->dp);
    for (int k = 0; k < load->objective_count; k++) {
        const Objective *objective = &load->objectives[k];
        value += load->weight * objective->weight *
                 objective->ops->value(objective->self, load->weight * objective->weight, work->x, work->p,
                                       with_gradient ? work->dx : NULL, with_gradient ? work->dp : NULL);
    }
    if (!with_gradient) return value;
    Point at = point(work->x, work->p);
    adjoint(load->sys, &at, work->dx, work->dp);
    return value;
}

static CaseInfo evaluate_case(StaticDesign *sd, int c, const double *u, bool with_gradient)
{
    Work *work = &sd->work[c];
    const LoadCase *load = &sd->cases[c];
    CaseInfo info = {.objective = INFINITY};
    design_apply(sd->design, c, u, work->p);
    predict(sd, c);
    system_memory_write(load->sys, work->best_memory);
    work->factored_best = false;
    info.newton = newton_minimize(load->sys, &sd->newton, work->p, 0, work->x, NULL);
    system_memory_read(load->sys, work->memory);
    if (info.newton.status == NEWTON_CONVERGED) info.objective = evaluate_objective(sd, c, with_gradient);
    return info;
}

double static_design_evaluate(StaticDesign *sd, const double *u, double *gradient, CaseInfo *case_info)
{
    double F = 0;
    memcpy(sd->u, u, (size_t)sd->design->size * sizeof *u);
    for (int c = 0; c < sd->design->case_count; c++) {
        case_info[c] = evaluate_case(sd, c, u, gradient != NULL);
        F += case_info[c].objective;
    }
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
        memcpy(sd->cases[c].x, work->x, (size_t)system_dof_count(sys) * sizeof *work->x);
        memcpy(work->best_memory, work->memory, (size_t)system_memory_count(sys) * sizeof *work->memory);
        work->has_best = work->factored_best = true;
    }
}

static void product_case(StaticDesign *sd, int c, const double *v, double *out)
{
    Work *work = &sd->work[c];
    const LoadCase *load = &sd->cases[c];
    if (!factor_best(sd, c)) return;
    memset(work->hp, 0, (size_t)sd->params->size * sizeof *work->hp);
    design_forward(sd->design, c, sd->best_u, v, work->hp);
    tangent(sd, c, work->hp, work->dx);
    memset(work->w, 0, (size_t)system_dof_count(load->sys) * sizeof *work->w);
    memset(work->dp, 0, (size_t)sd->params->size * sizeof *work->dp);
    for (int k = 0; k < load->objective_count; k++) {
        const Objective *objective = &load->objectives[k];
        objective->ops->product(objective->self, load->weight * objective->weight, work->dx, work->hp, work->w, work->dp);
    }
    Point at = point(load->x, work->best_p);
    adjoint(load->sys, &at, work->w, work->dp);
    design_transpose(sd->design, c, sd->best_u, work->dp, out);
}

void static_design_product(StaticDesign *sd, const double *v, double *out)
{
    memset(out, 0, (size_t)sd->design->size * sizeof *out);
    for (int c = 0; c < sd->design->case_count; c++) product_case(sd, c, v, out);
}

long static_design_factorizations(const StaticDesign *sd)
{
    long count = 0;
    for (int c = 0; c < sd->design->case_count; c++) count += system_info(sd->cases[c].sys).factorizations;
    return count;
}

const double *static_design_param_gradient(const StaticDesign *sd, int load_case)
{
    return sd->work[load_case].dp;
}
