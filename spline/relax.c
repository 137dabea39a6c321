#include "base/clock.h"
#include "base/memory.h"
#include "spline/outline.h"
#include "spline/relax_private.h"
#include <math.h>

static const struct {
    const char *name;
    RelaxFunction *run;
    SplineHessian hessian;
} methods[RELAX_METHOD_COUNT] = {
    [RELAX_AUTO] = {"auto", relax_descent, SPLINE_OWN},
    [RELAX_NEWTON] = {"newton", relax_newton, SPLINE_POSITIVE},
    [RELAX_GRADIENT] = {"gradient", relax_descent, SPLINE_OWN},
    [RELAX_MONTE_CARLO] = {"monte_carlo", relax_monte_carlo, SPLINE_OWN},
    [RELAX_DYNAMICS] = {"dynamics", relax_dynamics, SPLINE_OWN},
};

static const struct {
    const char *name, *text;
} statuses[] = {
    [RELAX_CONVERGED] = {"converged", "the energy is least"},
    [RELAX_SETTLED] = {"settled", "the energy hardly falls any more"},
    [RELAX_STALLED] = {"stalled", "no step lowers the energy any more"},
    [RELAX_MAX_ITERATIONS] = {"max_iterations", "all iterations are done"},
    [RELAX_NOT_FINITE] = {"not_finite",
                          "the energy at the start is not a finite number: a stroke has no length"},
    [RELAX_STOPPED] = {"stopped", "interrupted"},
};

const char *relax_method_name(RelaxMethod method)
{
    return methods[method].name;
}

const char *relax_status_name(RelaxStatus status)
{
    return statuses[status].name;
}

const char *relax_status_text(RelaxStatus status)
{
    return statuses[status].text;
}

RelaxDef relax_default(void)
{
    return (RelaxDef){.weights = spline_weights_default(),
                      .model = spline_model_default(),
                      .rest = 1.2,
                      .threads = 1,
                      .max_iterations = 500,
                      .energy_tol = 3e-3,
                      .gradient_tol = 1e-6,
                      .memory = 20,
                      .refresh = 20,
                      .step_cap = 1,
                      .temperature_first = 0.03,
                      .temperature_last = 3e-4,
                      .temperatures = 20,
                      .sweeps = 50,
                      .seed = 1,
                      .time_step = 1,
                      .time_steps = 100,
                      .damping = 0.1};
}

Point relax_point(const Relaxation *r, const double *x)
{
    return (Point){.x = x, .p = (const double *)&r->weights};
}

void relax_take_energies(Relaxation *r)
{
    const double *energies = system_energies(r->sys), *weights = (const double *)&r->weights;
    int next[2] = {0, system_term_count(r->sys)};
    r->info.energy = 0;
    for (int row = 0; row < SPLINE_WEIGHT_COUNT; row++) {
        if (weights[row] == 0) continue;
        r->info.energies[row] = energies[next[spline_term_rows[row].bulk != 0]++];
        r->info.energy += r->info.energies[row];
    }
}

bool relax_tell(Relaxation *r)
{
    r->info.seconds = clock_seconds() - r->started;
    return !r->observer || r->observer->iteration(r->observer->self, &r->info, r->strokes);
}

bool relax_has_settled(RelaxPast *past, int window, double energy, double tolerance)
{
    double *place = &past->energy[past->count++ % window], before = *place;
    *place = energy;
    return past->count > window && before - energy <= tolerance * fabs(energy);
}

static void add_energies(Relaxation *r, SplineHessian hessian)
{
    const double *weights = (const double *)&r->weights;
    for (int row = 0; row < SPLINE_WEIGHT_COUNT; row++) {
        if (weights[row] == 0) continue;
        if (spline_term_rows[row].term)
            system_add(r->sys, spline_term_rows[row].term(r->model, hessian));
        else
            system_add_bulk(r->sys, spline_term_rows[row].bulk(r->model, hessian));
    }
}

/* Strokes that are coupled only along themselves are eliminated node by node. */
static void set_natural_order(System *sys)
{
    int n = system_dof_count(sys), *order = mem_alloc((size_t)n, sizeof *order);
    for (int i = 0; i < n; i++) order[i] = i;
    system_set_order(sys, order);
    mem_free(order);
}

void relax_create_system(Relaxation *r, SplineHessian hessian)
{
    system_destroy(r->sys);
    r->sys =
        system_create(r->n, &(DofClass){.count = r->n, .size = 4 * r->def->step_cap * r->target->spacing}, 1);
    add_energies(r, hessian);
    if (r->def->method == RELAX_DYNAMICS)
        system_add(r->sys, spline_inertia_term(r->model, r->def->damping / r->target->spacing));
    if (r->def->method == RELAX_NEWTON)
        system_add(r->sys, spline_leash_term(r->model, r->def->step_cap * r->target->spacing));
    system_set_workers(r->sys, r->workers);
    if (hessian == SPLINE_OWN) set_natural_order(r->sys);
    system_prepare(r->sys);
}

double *spline_rest_lengths(const SplineTarget *target, const RelaxDef *def, const Strokes *strokes)
{
    double *rest = mem_alloc((size_t)strokes_segment_count(strokes), sizeof *rest);
    double same = spline_segment_length(def->rest, target->spacing);
    for (int k = 0, segment = 0; k < strokes->count; k++)
        for (int node = strokes->start[k]; node < strokes->start[k + 1] - 1; node++)
            rest[segment++] = same > 0 ? same : strokes_segment_length(strokes, node);
    return rest;
}

static double clamp(double a, double low, double high)
{
    return fmin(fmax(a, low), high);
}

/* A control point stays off the edge by this part of the pen. */
static const double EDGE = 0.01;

static bool is_inside(const SplinePage *page, const Strokes *strokes, int stroke)
{
    double edge = EDGE * page->pen;
    for (int node = strokes->start[stroke]; node < strokes->start[stroke + 1] - 1; node++) {
        Vec2 c[4];
        strokes_bezier(strokes, node, c);
        for (int k = 0; k < 4; k++)
            if (!(fmin(c[k].x, page->width - c[k].x) >= edge && fmin(c[k].y, page->height - c[k].y) >= edge))
                return false;
    }
    return true;
}

/* Control points within the page: so is the whole stroke, in their convex hull. */
static void bring_inside(const SplinePage *page, double q[4])
{
    double size[2] = {page->width, page->height}, edge = EDGE * page->pen;
    for (int i = 0; i < 2; i++) {
        q[i] = clamp(q[i], 2 * edge, size[i] - 2 * edge);
        double room = fmin(q[i], size[i] - q[i]) - edge;
        q[2 + i] = clamp(q[2 + i], -room, room);
    }
}

/* Strokes that cross a wall would have no finite energy. Those that leave the page are pressed into it, of those
 * that leave the outline what is inside stays. */
static void bring_strokes_inside(const SplineTarget *target, const SplineWeights *weights, Strokes *strokes)
{
    const SplinePage *page = &target->page;
    bool walled = weights->wall != 0 || weights->boundary != 0;
    for (int k = 0; walled && k < strokes->count; k++) {
        if (is_inside(page, strokes, k)) continue;
        for (int node = strokes->start[k]; node < strokes->start[k + 1]; node++)
            bring_inside(page, strokes->q + 4 * node);
    }
    if (weights->outline != 0) spline_outline_cut(target, EDGE * page->pen, strokes);
}

/* Of the strokes as they are left. */
static void take_final_figures(Relaxation *r)
{
    Point at = relax_point(r, r->strokes->q);
    double *gradient = mem_alloc((size_t)r->n, sizeof *gradient);
    r->info.gradient_max = system_gradient(r->sys, &at, gradient).gradient_max;
    relax_take_energies(r);
    r->info.seconds = clock_seconds() - r->started;
    mem_free(gradient);
}

RelaxInfo spline_relax(const SplineTarget *target, const RelaxDef *def, Strokes *strokes,
                       const RelaxObserver *observer)
{
    bring_strokes_inside(target, &def->weights, strokes);
    Relaxation r = {.def = def,
                    .target = target,
                    .observer = observer,
                    .strokes = strokes,
                    .n = 4 * strokes_node_count(strokes),
                    .started = clock_seconds(),
                    .weights = spline_weights_scaled(def->weights, target->page.pen, target->spacing)};
    r.info.status = RELAX_CONVERGED;
    r.workers = def->threads > 1 ? workers_create(def->threads) : NULL;
    SplineModelDef model = def->model;
    model.workers = r.workers;
    double *rest = spline_rest_lengths(target, def, strokes);
    r.model = spline_model_create(target, strokes, rest, &model);
    relax_create_system(&r, methods[def->method].hessian);
    if (strokes->count > 0) methods[def->method].run(&r); /* blank paper has an energy all the same */
    take_final_figures(&r);
    system_destroy(r.sys);
    spline_model_destroy(r.model);
    workers_destroy(r.workers);
    mem_free(rest);
    return r.info;
}
