/* Descent: L-BFGS [Nocedal 1980], preconditioned by the factor of what couples along strokes only, with a cap
 * on the way of each stroke; without memory and preconditioner, the gradient with a step that adapts itself.
 */
#include "base/memory.h"
#include "spline/relax_private.h"
#include <math.h>

enum { CHUNK = 2048, TRIES = 25 };

static const double ARMIJO = 1e-4;
static const double SHIFT = 0.3; /* over the line distance: added to the preconditioner's diagonal      */
static const double FIRST_STEP = 0.1; /* of the cap, where nothing is known of the curvature */

/* Sums over all dofs of a trial: its step s, the change y of the gradient in it, and the gradient g before. */
enum { GS, SY, YY, SS, TRIAL_SUMS };

typedef struct Descent {
    Relaxation *r;
    const DescentDef *def;
    Point at; /* its x is x */
    double *x, *gradient, *direction, *trial,
        *trial_gradient; /* [n], but for x with room for a pack more, of zeros */
    double *s, *y;    /* [memory + 1][stride] steps, and the changes of the gradient in them; a row is free */
    double *products; /* [memory + 1][memory + 1] s_i.y_j, row i not after j */
    double *alpha;    /* [memory + 1] of the first loop; then what is added of each s */
    double *partial;  /* [chunks][sums] */
    size_t stride;
    int chunks, sums;
    int count, next; /* steps remembered; row of the next one */
    int age;         /* steps since the factor was made */
    bool factored;
    double newest_yy;                        /* y.y of the newest step */
    double energy, gradient_max;             /* at x */
    double trial_energy, trial_gradient_max; /* at the trial */
    double length;                           /* of the last successful step, in parts of the direction */
    double tried;                            /* the same of the trial */
} Descent;

/* ---- Sums in chunks of the dofs, so that threads share them out and bits do not depend on them ---- */

static int chunk_start(const Descent *d, int chunk)
{
    return chunk * CHUNK < d->r->n ? chunk * CHUNK : d->r->n;
}

/* Of whole packs: beyond n there are zeros. */
static double chunk_dot(const Descent *d, int chunk, const double *a, const double *b)
{
    Pack sum = {0};
    for (int i = chunk_start(d, chunk); i < chunk_start(d, chunk + 1); i += PACK_LANES)
        sum += pack_load(a + i) * pack_load(b + i);
    return pack_sum(sum, PACK_LANES);
}

static double total(const Descent *d, int k)
{
    double sum = 0;
    for (int chunk = 0; chunk < d->chunks; chunk++) sum += d->partial[chunk * d->sums + k];
    return sum;
}

static void for_chunks(Descent *d, void (*task)(void *self, int chunk))
{
    workers_run(d->r->workers, d->chunks, task, d);
}

/* ---- The energy ---- */

static double evaluate(Descent *d, double *x, double *gradient, double *gradient_max)
{
    Point at = d->at;
    at.x = x;
    Evaluation e = system_gradient(d->r->sys, &at, gradient);
    d->r->info.evaluations++;
    *gradient_max = e.gradient_max;
    return e.finite ? e.energy : INFINITY;
}

/* The factor at x; the memory goes on. */
static void refresh(Descent *d)
{
    system_hessian(d->r->sys, &d->at, d->trial_gradient);
    d->factored = system_factor_positions(d->r->sys, SHIFT / d->r->target->spacing, NULL);
    d->r->info.factorizations++;
    d->age = 0;
}

/* ---- The direction ----
 *
 * The two loops, each with its products first and its vectors then [Chen, Wang and Zhou 2014]: every step
 * remembered is read twice, and not four times as by one loop after the other.
 *
 *     alpha_i = (s_i.q - sum over newer j of alpha_j s_i.y_j)/s_i.y_i,   q = -g,   q -= sum alpha_i y_i
 *     r = H0 q
 *     beta_i = (y_i.r + sum over older j of (alpha_j - beta_j) s_j.y_i)/s_i.y_i,   r += sum (alpha_i - beta_i) s_i */

/* Row of the k-th step before the next; 1 is the newest. */
static int row_of(const Descent *d, int k)
{
    int rows = d->def->memory + 1;
    return (d->next - k + rows) % rows;
}

static double *product(const Descent *d, int i, int j)
{
    return &d->products[i * (d->def->memory + 1) + j];
}

/* s_i.g, and s_i.y of the newest step. */
static void first_products_task(void *self, int chunk)
{
    const Descent *d = self;
    double *sum = d->partial + chunk * d->sums;
    const double *y = d->y + (size_t)row_of(d, 1) * d->stride;
    for (int k = 1; k <= d->count; k++) {
        const double *s = d->s + (size_t)row_of(d, k) * d->stride;
        sum[2 * k - 2] = chunk_dot(d, chunk, s, d->gradient);
        sum[2 * k - 1] = chunk_dot(d, chunk, s, y);
    }
}

static void first_loop_task(void *self, int chunk)
{
    const Descent *d = self;
    int first = chunk_start(d, chunk), end = chunk_start(d, chunk + 1);
    for (int i = first; i < end; i++) d->direction[i] = -d->gradient[i];
    for (int k = 1; k <= d->count; k++) {
        int row = row_of(d, k);
        const double *y = d->y + (size_t)row * d->stride, alpha = d->alpha[row];
        for (int i = first; i < end; i++) d->direction[i] -= alpha * y[i];
    }
}

static void second_products_task(void *self, int chunk)
{
    const Descent *d = self;
    for (int k = 1; k <= d->count; k++)
        d->partial[chunk * d->sums + k - 1] =
            chunk_dot(d, chunk, d->y + (size_t)row_of(d, k) * d->stride, d->direction);
}

static void second_loop_task(void *self, int chunk)
{
    const Descent *d = self;
    for (int k = d->count; k >= 1; k--) {
        int row = row_of(d, k);
        const double *s = d->s + (size_t)row * d->stride, alpha = d->alpha[row];
        for (int i = chunk_start(d, chunk); i < chunk_start(d, chunk + 1); i++)
            d->direction[i] += alpha * s[i];
    }
}

static void first_loop(Descent *d)
{
    if (d->count > 0) for_chunks(d, first_products_task);
    for (int k = 1; k <= d->count; k++) *product(d, row_of(d, k), row_of(d, 1)) = total(d, 2 * k - 1);
    for (int k = 1; k <= d->count; k++) {
        int i = row_of(d, k);
        double sum = -total(d, 2 * k - 2);
        for (int l = 1; l < k; l++) sum -= d->alpha[row_of(d, l)] * *product(d, i, row_of(d, l));
        d->alpha[i] = sum / *product(d, i, i);
    }
    for_chunks(d, first_loop_task);
}

static void second_loop(Descent *d)
{
    if (d->count == 0) return;
    for_chunks(d, second_products_task);
    for (int k = d->count; k >= 1; k--) {
        int i = row_of(d, k);
        double sum = total(d, k - 1);
        for (int l = d->count; l > k; l--) sum += d->alpha[row_of(d, l)] * *product(d, row_of(d, l), i);
        d->alpha[i] -= sum / *product(d, i, i);
    }
    for_chunks(d, second_loop_task);
}

/* direction = -H gradient. */
static void find_direction(Descent *d)
{
    first_loop(d);
    if (d->factored) {
        system_solve(d->r->sys, d->direction, d->direction);
    } else if (d->count > 0) {
        int newest = row_of(d, 1);
        double scale = *product(d, newest, newest) / d->newest_yy;
        for (int i = 0; i < d->r->n; i++) d->direction[i] *= scale;
    }
    second_loop(d);
}

/* No node of a stroke, nor a control point beside it, goes further than the cap at once; each stroke is
 * shortened for itself. */
static void cap_stroke(const Descent *d, int stroke)
{
    const SplineModel *model = d->r->model;
    double cap = d->r->def->step_cap * d->r->target->spacing, way = 0;
    int first = 4 * model->start[stroke], end = 4 * model->start[stroke + 1];
    for (int i = first; i < end; i += 2) {
        double square = d->direction[i] * d->direction[i] + d->direction[i + 1] * d->direction[i + 1];
        way = square > way ? square : way;
    }
    way = sqrt(way);
    for (int i = first; way > cap && i < end; i++) d->direction[i] *= cap / way;
}

static void cap_task(void *self, int group)
{
    const Descent *d = self;
    const SplineModel *model = d->r->model;
    for (int k = model->group[group]; k < model->group[group + 1]; k++) cap_stroke(d, k);
}

/* ---- The step ---- */

/* How much of the direction is tried first. */
static double first_length(const Descent *d)
{
    if (d->factored || d->count > 0) return 1;
    double step = FIRST_STEP * d->r->def->step_cap * d->r->target->spacing;
    return d->length > 0 ? 1.5 * d->length : step / d->gradient_max;
}

static void move_task(void *self, int chunk)
{
    const Descent *d = self;
    for (int i = chunk_start(d, chunk); i < chunk_start(d, chunk + 1); i++)
        d->trial[i] = d->x[i] + d->tried * d->direction[i];
}

/* s and y of the trial to the free row, and their sums. */
static void difference_task(void *self, int chunk)
{
    const Descent *d = self;
    double *s = d->s + (size_t)d->next * d->stride, *y = d->y + (size_t)d->next * d->stride;
    double *sum = d->partial + chunk * d->sums;
    for (int i = chunk_start(d, chunk); i < chunk_start(d, chunk + 1); i++) {
        s[i] = d->trial[i] - d->x[i];
        y[i] = d->trial_gradient[i] - d->gradient[i];
    }
    sum[GS] = chunk_dot(d, chunk, d->gradient, s);
    sum[SY] = chunk_dot(d, chunk, s, y);
    sum[YY] = chunk_dot(d, chunk, y, y);
    sum[SS] = chunk_dot(d, chunk, s, s);
}

/* Armijo's rule, with the way that is left by walls. Leaves the trial with its energy and gradient; false: none was
 * found. */
static bool search(Descent *d)
{
    d->tried = first_length(d);
    for (int k = 0; k < TRIES; k++, d->tried /= 2) {
        for_chunks(d, move_task);
        system_project(d->r->sys, d->x, d->trial);
        d->trial_energy = evaluate(d, d->trial, d->trial_gradient, &d->trial_gradient_max);
        for_chunks(d, difference_task);
        double slope = total(d, GS);
        if (slope < 0 && d->trial_energy <= d->energy + ARMIJO * slope) return true;
    }
    return false;
}

/* The trial becomes x, and its step is remembered where the gradient grew along it. */
static void take(Descent *d)
{
    double sy = total(d, SY), yy = total(d, YY);
    if (d->def->memory > 0 && sy > 1e-10 * sqrt(total(d, SS) * yy)) {
        *product(d, d->next, d->next) = sy;
        d->newest_yy = yy;
        d->next = (d->next + 1) % (d->def->memory + 1);
        if (d->count < d->def->memory) d->count++;
    }
    memcpy(d->x, d->trial, (size_t)d->r->n * sizeof *d->x);
    double *old = d->gradient;
    d->gradient = d->trial_gradient;
    d->trial_gradient = old;
    d->energy = d->trial_energy;
    d->gradient_max = d->trial_gradient_max;
    d->length = d->tried;
    d->age++;
}

/* Along the direction; where that fails, once more with nothing remembered. */
static bool step(Descent *d)
{
    for (int attempt = 0; attempt < 2; attempt++) {
        if (d->def->refresh > 0 && (!d->factored || d->age >= d->def->refresh || attempt > 0)) refresh(d);
        if (attempt > 0) d->count = 0;
        find_direction(d);
        workers_run(d->r->workers, d->r->model->group_count, cap_task, d);
        if (search(d)) {
            take(d);
            return true;
        }
        if (d->count == 0 && d->age == 0) break;
    }
    return false;
}

static Descent descent_create(Relaxation *r, const DescentDef *def, const Point *at, double *x)
{
    size_t n = (size_t)r->n, rows = (size_t)def->memory + 1, stride = n + PACK_LANES;
    Descent d = {.r = r, .def = def, .at = *at, .x = x, .stride = stride};
    d.at.x = x;
    d.chunks = (r->n + CHUNK - 1) / CHUNK;
    d.sums = 2 * def->memory > TRIAL_SUMS ? 2 * def->memory : TRIAL_SUMS;
    d.gradient = mem_alloc(stride, sizeof(double));
    d.trial_gradient = mem_alloc(stride, sizeof(double));
    d.direction = mem_alloc(stride, sizeof(double));
    d.trial = mem_alloc(stride, sizeof(double));
    d.s = mem_alloc(2 * rows * stride, sizeof(double));
    d.y = d.s + rows * stride;
    d.products = mem_alloc(rows * (rows + 1), sizeof(double));
    d.alpha = d.products + rows * rows;
    d.partial = mem_alloc((size_t)d.chunks * (size_t)d.sums, sizeof(double));
    return d;
}

static void descent_clear(Descent *d)
{
    mem_free(d->gradient);
    mem_free(d->trial_gradient);
    mem_free(d->direction);
    mem_free(d->trial);
    mem_free(d->s);
    mem_free(d->products);
    mem_free(d->partial);
}

static RelaxStatus iterate(Descent *d)
{
    RelaxInfo *info = &d->r->info;
    RelaxPast past = {0};
    for (int k = 0; k < d->def->max_iterations; k++) {
        if (!step(d)) return RELAX_STALLED;
        info->gradient_max = d->gradient_max;
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
    d.energy = evaluate(&d, x, d.gradient, &d.gradient_max);
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
