/* Descent: L-BFGS [Nocedal 1980], preconditioned by the factor of what couples along strokes only, with a cap
 * on the way of each stroke; without memory and preconditioner, the gradient with a step that adapts itself.
 */
#include "base/memory.h"
#include "spline/relax_private.h"
#include <math.h>

enum { CHUNK = 8192, TRIES = 25 };

static const double ARMIJO = 1e-4;
static const double SHIFT = 0.3; /* over the line distance: added to the preconditioner's diagonal      */
static const double FIRST_STEP = 0.1; /* of the cap, where nothing is known of the curvature */

typedef struct Descent {
    Relaxation *r;
    const DescentDef *def;
    Point at;                                                  /* its x is x */
    double *x, *gradient, *direction, *trial, *trial_gradient; /* [n] */
    double *s, *y;     /* [memory][n] steps, and the changes of the gradient in them */
    double *curvature; /* [memory] s.y    */
    double *factor;    /* [memory] of the two loops */
    double *partial;   /* [chunks] of a sum */
    int count, next;   /* steps remembered; place of the next one */
    int age;           /* steps since the factor was made */
    bool factored;
    double energy, length; /* of the last successful step, in parts of the direction */
} Descent;

/* y += a x, and y.z: chunk by chunk, so that threads can share it and the sums stay the same. */
typedef struct Sweep {
    int n;
    double a;
    const double *x, *z;
    double *y, *partial;
} Sweep;

static void sweep_task(void *self, int chunk)
{
    const Sweep *s = self;
    int end = (chunk + 1) * CHUNK < s->n ? (chunk + 1) * CHUNK : s->n;
    double sum = 0;
    for (int i = chunk * CHUNK; s->x && i < end; i++) s->y[i] += s->a * s->x[i];
    for (int i = chunk * CHUNK; s->z && i < end; i++) sum += s->y[i] * s->z[i];
    s->partial[chunk] = sum;
}

/* x and z may be NULL. */
static double sweep(Descent *d, double a, const double *x, double *y, const double *z)
{
    Sweep s = {d->r->n, a, x, z, y, d->partial};
    int chunks = (s.n + CHUNK - 1) / CHUNK;
    workers_run(d->r->workers, chunks, sweep_task, &s);
    double sum = 0;
    for (int k = 0; k < chunks; k++) sum += d->partial[k];
    return sum;
}

static double evaluate(Descent *d, double *x, double *gradient)
{
    Point at = d->at;
    at.x = x;
    Evaluation e = system_gradient(d->r->sys, &at, gradient);
    d->r->info.evaluations++;
    return e.finite ? e.energy : INFINITY;
}

/* The factor at x; the memory goes on. */
static void refresh(Descent *d)
{
    system_hessian(d->r->sys, &d->at, d->trial_gradient);
    d->factored = system_factor_positions(d->r->sys, SHIFT / d->r->target->spacing);
    d->r->info.factorizations++;
    d->age = 0;
}

/* direction = -H gradient, by the two loops. */
static void find_direction(Descent *d)
{
    int n = d->r->n, m = d->def->memory;
    for (int i = 0; i < n; i++) d->direction[i] = -d->gradient[i];
    double product = 0;
    for (int k = 1; k <= d->count; k++) {
        int row = (d->next - k + m) % m, before = (row + m - 1) % m;
        double *s = d->s + (size_t)row * (size_t)n, *y = d->y + (size_t)row * (size_t)n;
        if (k == 1) product = sweep(d, 0, NULL, d->direction, s);
        d->factor[row] = product / d->curvature[row];
        product = sweep(d, -d->factor[row], y, d->direction,
                        k < d->count ? d->s + (size_t)before * (size_t)n : NULL);
    }
    int last = (d->next + m - 1) % (m > 0 ? m : 1);
    if (d->factored) {
        system_solve(d->r->sys, d->direction, d->direction);
    } else if (d->count > 0) {
        double *y = d->y + (size_t)last * (size_t)n, scale = d->curvature[last] / sweep(d, 0, NULL, y, y);
        for (int i = 0; i < n; i++) d->direction[i] *= scale;
    }
    for (int k = d->count; k >= 1; k--) {
        int row = (d->next - k + m) % m, after = (row + 1) % m;
        double *s = d->s + (size_t)row * (size_t)n;
        if (k == d->count) product = sweep(d, 0, NULL, d->direction, d->y + (size_t)row * (size_t)n);
        double a = d->factor[row] - product / d->curvature[row];
        product = sweep(d, a, s, d->direction, k > 1 ? d->y + (size_t)after * (size_t)n : NULL);
    }
}

/* No node of a stroke, nor a control point beside it, goes further than the cap at once; each stroke is
 * shortened for itself. */
static void cap_strokes(Descent *d)
{
    const SplineModel *model = d->r->model;
    double cap = d->r->def->step_cap * d->r->target->spacing;
    for (int k = 0; k < model->stroke_count; k++) {
        double way = 0;
        for (int i = 4 * model->start[k]; i < 4 * model->start[k + 1]; i += 2)
            way = fmax(way, d->direction[i] * d->direction[i] + d->direction[i + 1] * d->direction[i + 1]);
        way = sqrt(way);
        if (!(way > cap)) continue;
        for (int i = 4 * model->start[k]; i < 4 * model->start[k + 1]; i++) d->direction[i] *= cap / way;
    }
}

static double largest(const double *a, int n)
{
    double size = 0;
    for (int i = 0; i < n; i++) size = fmax(size, fabs(a[i]));
    return size;
}

/* How much of the direction is tried first. */
static double first_length(const Descent *d)
{
    if (d->factored || d->count > 0) return 1;
    double step = FIRST_STEP * d->r->def->step_cap * d->r->target->spacing;
    return d->length > 0 ? 1.5 * d->length : step / largest(d->gradient, d->r->n);
}

/* Armijo's rule, with the way that is left by walls. Leaves energy and gradient of the trial; false: none was
 * found. */
static bool search(Descent *d, double *energy)
{
    double length = first_length(d);
    int n = d->r->n;
    for (int k = 0; k < TRIES; k++, length /= 2) {
        for (int i = 0; i < n; i++) d->trial[i] = d->x[i] + length * d->direction[i];
        system_project(d->r->sys, d->x, d->trial);
        *energy = evaluate(d, d->trial, d->trial_gradient);
        double slope = 0;
        for (int i = 0; i < n; i++) slope += d->gradient[i] * (d->trial[i] - d->x[i]);
        if (!(slope < 0) || !(*energy <= d->energy + ARMIJO * slope)) continue;
        d->length = length;
        return true;
    }
    return false;
}

/* The step that was found becomes x, and is remembered where the gradient grew along it. */
static void take(Descent *d, double energy)
{
    size_t n = (size_t)d->r->n;
    if (d->def->memory > 0) {
        double *s = d->s + (size_t)d->next * n, *y = d->y + (size_t)d->next * n;
        for (size_t i = 0; i < n; i++)
            s[i] = d->trial[i] - d->x[i], y[i] = d->trial_gradient[i] - d->gradient[i];
        double sy = sweep(d, 0, NULL, s, y), yy = sweep(d, 0, NULL, y, y), ss = sweep(d, 0, NULL, s, s);
        if (sy > 1e-10 * sqrt(ss * yy)) {
            d->curvature[d->next] = sy;
            d->next = (d->next + 1) % d->def->memory;
            if (d->count < d->def->memory) d->count++;
        }
    }
    memcpy(d->x, d->trial, n * sizeof *d->x);
    double *old = d->gradient;
    d->gradient = d->trial_gradient;
    d->trial_gradient = old;
    d->energy = energy;
    d->age++;
}

/* Along the direction; where that fails, once more with nothing remembered. */
static bool step(Descent *d)
{
    double energy;
    for (int attempt = 0; attempt < 2; attempt++) {
        if (d->def->refresh > 0 && (!d->factored || d->age >= d->def->refresh || attempt > 0)) refresh(d);
        if (attempt > 0) d->count = 0;
        find_direction(d);
        cap_strokes(d);
        if (search(d, &energy)) {
            take(d, energy);
            return true;
        }
        if (d->count == 0 && d->age == 0) break;
    }
    return false;
}

static Descent descent_create(Relaxation *r, const DescentDef *def, const Point *at, double *x)
{
    size_t n = (size_t)r->n, m = (size_t)def->memory;
    Descent d = {.r = r, .def = def, .at = *at, .x = x};
    d.at.x = x;
    d.gradient = mem_alloc(n, sizeof(double));
    d.trial_gradient = mem_alloc(n, sizeof(double));
    d.direction = mem_alloc(n, sizeof(double));
    d.trial = mem_alloc(n, sizeof(double));
    d.s = mem_alloc(2 * n * m, sizeof(double));
    d.y = d.s + n * m;
    d.curvature = mem_alloc(2 * m, sizeof(double));
    d.factor = d.curvature + m;
    d.partial = mem_alloc(n / CHUNK + 1, sizeof(double));
    return d;
}

static void descent_clear(Descent *d)
{
    mem_free(d->gradient);
    mem_free(d->trial_gradient);
    mem_free(d->direction);
    mem_free(d->trial);
    mem_free(d->s);
    mem_free(d->curvature);
    mem_free(d->partial);
}

static RelaxStatus iterate(Descent *d)
{
    RelaxInfo *info = &d->r->info;
    RelaxPast past = {0};
    for (int k = 0; k < d->def->max_iterations; k++) {
        if (!step(d)) return RELAX_STALLED;
        info->gradient_max = largest(d->gradient, d->r->n);
        if (d->def->tell) {
            info->iterations++;
            relax_take_energies(d->r);
            if (!relax_tell(d->r)) return RELAX_STOPPED;
        }
        if (info->gradient_max <= d->def->gradient_tol) return RELAX_CONVERGED;
        if (relax_has_settled(&past, d->def->window, d->energy, d->def->energy_tol)) return RELAX_SETTLED;
    }
    return RELAX_MAX_ITERATIONS;
}

RelaxStatus relax_minimize(Relaxation *r, const DescentDef *def, const Point *at, double *x)
{
    Descent d = descent_create(r, def, at, x);
    d.energy = evaluate(&d, x, d.gradient);
    RelaxStatus status = isfinite(d.energy) ? iterate(&d) : RELAX_NOT_FINITE;
    descent_clear(&d);
    return status;
}

void relax_descent(Relaxation *r)
{
    bool plain = r->def->method == RELAX_GRADIENT;
    DescentDef def = {.memory = plain ? 0 : r->def->memory,
                      .refresh = plain ? 0 : r->def->refresh,
                      .max_iterations = r->def->max_iterations,
                      .window = RELAX_WINDOW,
                      .energy_tol = r->def->energy_tol,
                      .gradient_tol = r->def->gradient_tol,
                      .tell = true};
    Point at = relax_point(r, r->strokes->q);
    r->info.status = relax_minimize(r, &def, &at, r->strokes->q);
}
