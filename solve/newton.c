#include "solve/newton.h"
#include "base/memory.h"
#include "base/random.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { HALVINGS = 30, INVERSE_ITERATIONS = 8, CURVATURE_TRIES = 25 };

static const double SHIFT_LAST = 1e8;        /* D: beyond this a step is no longer a Newton step       */
static const double STALL_SHIFT = 1e6;       /* D: no decrease even with such a shift                  */
static const double CURVATURE_STEP = 0.05;   /* body's measure: first step along negative curvature    */
static const double CURVATURE_LAST = 0.5;    /* ... and the last                                       */
static const double PUSHED = 0.1;            /* part of a gap's force: more is much (system_gap)       */
static const double SETTLED = 1e-4;          /* ... and less is none: a force that goes on growing      */
static const double LIKELY = 1e4;            /* of the step in a mode's start, against chance           */
static const double ZERO_CURVATURE = 1e-12;  /* v'Hv with v'Dv = 1 that counts as zero                 */

typedef struct Search {
    System *sys;
    const NewtonDef *def;
    int n;
    Point at;                       /* at.x is x                                               */
    double *x, *gradient, *step;    /* [n]                                                     */
    double *trial, *trial_gradient; /* [n]                                                     */
    double *mode, *product;         /* [n] direction of lowest curvature, kept between uses    */
    double *gap, *change;           /* [n] of multipliers: what is to vanish; Newton's step    */
    bool mode_known;
    bool open;                /* a held end is so far off that forces change by much (take_multipliers) */
    double shift, shift_kept; /* in use; remembered                                      */
    int shifted;              /* iterations in a row that needed one                     */
    Evaluation now;
    NewtonInfo info;
} Search;

NewtonDef newton_default(void)
{
    return (NewtonDef){.max_iterations = 300, .step_tol = 1e-8, .force_tol = 1e-6, .step_cap = 0.25,
                       .cg_tol = 1e-3, .shift_first = 1e-8, .shift_growth = 4, .armijo = 1e-4, .shifted_max = 3};
}

static const struct {
    const char *name, *text;
} status_rows[] = {
    [NEWTON_CONVERGED] = {"converged", "a stable equilibrium"},
    [NEWTON_SADDLE] = {"saddle", "in equilibrium but unstable, and no way down was found"},
    [NEWTON_NEUTRAL] = {"neutral", "in equilibrium with a mode of zero stiffness (a buckling point or a free motion)"},
    [NEWTON_STALLED] = {"stalled", "no step lowers the energy any more, but the forces are not in balance"},
    [NEWTON_MAX_ITERATIONS] = {"max_iterations", "the energy was still falling at the last iteration"},
    [NEWTON_NOT_FINITE] = {"not_finite", "energy or forces at the start are not finite numbers"},
    [NEWTON_STOPPED] = {"stopped", "interrupted"},
};

const char *newton_status_name(NewtonStatus status)
{
    return status_rows[status].name;
}

const char *newton_status_text(NewtonStatus status)
{
    return status_rows[status].text;
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

static bool factor(Search *s, double shift)
{
    s->info.factorizations++;
    return system_factor(s->sys, shift);
}

/* The smallest shift, from the remembered one on, that makes the matrix positive definite. */
static bool factor_shifted(Search *s)
{
    const NewtonDef *def = s->def;
    s->shift = s->shift_kept < def->shift_growth * def->shift_first ? 0 : s->shift_kept / def->shift_growth;
    while (!factor(s, s->shift)) {
        s->shift = fmax(def->shift_first, def->shift_growth * s->shift);
        if (s->shift > SHIFT_LAST) return false;
    }
    return true;
}

/* While what the multipliers hold is far from where it is to be, they are as they would be if it stood still and
 * gave way by the compliance c (take_multipliers), and with the gap g the energy gains sum (g - g_0)^2/(2 c): that
 * is an augmented Lagrangian, whose Newton direction the regularised matrix gives, so that it falls along it. */
static double gap_energy(const Search *s)
{
    double energy = 0;
    for (int i = 0; i < s->n; i++) {
        double compliance = system_compliance(s->sys, i), change = s->trial_gradient[i] - s->gap[i];
        if (compliance > 0) energy += change * change / (2 * compliance);
    }
    return energy;
}

static double energy_at(Search *s, const double *direction, double a, Evaluation *evaluation)
{
    for (int i = 0; i < s->n; i++) s->trial[i] = s->x[i] + a * direction[i];
    system_project(s->sys, s->trial);
    Point at = s->at;
    at.x = s->trial;
    s->info.evaluations++;
    *evaluation = s->open ? system_gradient(s->sys, &at, s->trial_gradient) : system_energy(s->sys, &at);
    return evaluation->finite ? evaluation->energy + (s->open ? gap_energy(s) : 0) : INFINITY;
}

/* Does the last gap close? The energy does not tell any more, and along no other way would it be lower. */
static bool gap_falls(const Search *s)
{
    double before = 0, after = 0;
    for (int i = 0; system_gap(s->sys) > 0 && i < s->n; i++) {
        if (system_compliance(s->sys, i) == 0) continue;
        before = fmax(before, fabs(s->gap[i]));
        after = fmax(after, fabs(s->trial_gradient[i]));
    }
    return after < before / 2;
}

/* Near a minimum energies differ by less than their rounding: there the slope at the new point decides. */
static bool slope_is_fine(Search *s, const Evaluation *trial, double slope)
{
    double rounding = system_gap(s->sys) > 0 ? 1e-9 : 1e-12; /* forces times positions round, too */
    if (!(trial->energy <= s->now.energy + rounding * s->now.energy_scale)) return false;
    Point at = s->at;
    at.x = s->trial;
    for (int i = 0; i < s->n && s->open; i++) /* what gap_energy adds pulls, too */
        if (system_compliance(s->sys, i) > 0)
            s->trial[i] += (s->trial_gradient[i] - s->gap[i]) / system_compliance(s->sys, i);
    system_gradient(s->sys, &at, s->trial_gradient);
    s->info.evaluations++;
    for (int i = 0; i < s->n; i++)
        if (system_is_fixed(s->sys, i)) s->trial_gradient[i] = 0;
    return gap_falls(s) || dot(s->n, s->trial_gradient, s->step) <= (2 * s->def->armijo - 1) * slope;
}

/* Largest of 1, 1/2, 1/4 ... along the step that satisfies Armijo's rule; leaves the point in trial; 0: none. */
static double line_search(Search *s)
{
    double slope = dot(s->n, s->gradient, s->step), a = 1;
    for (int k = 0; k < HALVINGS; k++, a /= 2) {
        Evaluation trial;
        double energy = energy_at(s, s->step, a, &trial);
        if (energy <= s->now.energy + s->def->armijo * a * slope) return a;
        if (isfinite(energy) && slope_is_fine(s, &trial, slope)) return a;
    }
    return 0;
}

/* What gap_energy adds along the mode. */
static double gap_curvature(const Search *s)
{
    double sum = 0;
    for (int i = 0; s->open && i < s->n; i++)
        if (system_compliance(s->sys, i) > 0) sum += s->product[i] * s->product[i] / system_compliance(s->sys, i);
    return sum;
}

/* Where several modes are all but equal, as the ways in which a round rod buckles, the forces say which one is
 * downhill: of two or three, an iteration keeps what it was given. */
static void add_step(Search *s)
{
    double size = system_step_size(s->sys, s->step), own = system_step_size(s->sys, s->mode);
    for (int i = 0; size > 0 && i < s->n; i++) s->mode[i] += LIKELY * own / size * s->step[i];
}

/* Inverse iteration with the factor at hand: the mode of lowest curvature v'Hv/v'Dv, scaled to v'Dv = 1 and pointing
 * downhill. Returns its curvature. */
static double lowest_mode(Search *s)
{
    const double *scale = system_scale(s->sys);
    Random random = random_seed(1);
    for (int i = 0; !s->mode_known && i < s->n; i++)
        s->mode[i] = scale[i] > 0 ? random_signed(&random) / sqrt(scale[i]) : 0;
    if (!s->mode_known && s->open) add_step(s);
    s->mode_known = true;
    for (int k = 0; k < INVERSE_ITERATIONS; k++) {
        for (int i = 0; i < s->n; i++) s->product[i] = scale[i] * s->mode[i];
        system_solve(s->sys, s->product, s->mode);
        double norm = 0;
        for (int i = 0; i < s->n; i++) norm += scale[i] * s->mode[i] * s->mode[i];
        norm = 1 / sqrt(norm);
        for (int i = 0; i < s->n; i++) s->mode[i] *= norm;
    }
    for (int i = 0; s->open && i < s->n; i++)
        if (system_is_multiplier(s->sys, i)) s->mode[i] = 0;
    system_multiply(s->sys, s->mode, s->product);
    double curvature = dot(s->n, s->mode, s->product) + gap_curvature(s);
    if (dot(s->n, s->mode, s->gradient) > 0)
        for (int i = 0; i < s->n; i++) s->mode[i] = -s->mode[i];
    return curvature;
}

/* A step along the mode that lowers the energy by a quarter of what its curvature promises; 0: none. */
static double curvature_step(Search *s, double curvature)
{
    double size = system_step_size(s->sys, s->mode), slope = dot(s->n, s->gradient, s->mode);
    double a = CURVATURE_STEP / size;
    for (int k = 0; k < CURVATURE_TRIES; k++, a /= 4) {
        Evaluation trial;
        double energy = energy_at(s, s->mode, a, &trial);
        if (!(energy < s->now.energy + (a * slope + a * a * curvature / 2) / 4)) continue;
        while (k == 0 && 2 * a * size <= CURVATURE_LAST) {
            double further = energy_at(s, s->mode, 2 * a, &trial);
            if (!(further < energy)) break;
            energy = further;
            a *= 2;
        }
        return a;
    }
    return 0;
}

static void move(Search *s, const double *direction, double a)
{
    for (int i = 0; i < s->n; i++) s->x[i] += a * direction[i];
    system_project(s->sys, s->x);
    system_accept(s->sys, s->x);
}

/* The last step, squared small: taken if it does not raise the forces. */
static void finish(Search *s)
{
    Point at = s->at;
    for (int i = 0; i < s->n; i++) s->trial[i] = s->x[i] + s->step[i];
    system_project(s->sys, s->trial);
    at.x = s->trial;
    Evaluation last = system_gradient(s->sys, &at, s->trial_gradient);
    s->info.evaluations++;
    if (!last.finite || last.gradient_max > s->now.gradient_max) return;
    memcpy(s->x, s->trial, (size_t)s->n * sizeof *s->x);
    system_accept(s->sys, s->x);
    s->now = last;
}

/* Leaves along negative curvature where there is some. Returns true when the iteration is decided. */
static bool leave_saddle(Search *s, bool small, double floor, NewtonStatus *status)
{
    double curvature = lowest_mode(s);
    s->info.curvature = curvature;
    double a = curvature < 0 ? curvature_step(s, curvature) : 0;
    if (a > 0) {
        move(s, s->mode, a);
        s->shifted = 0;
        return true;
    }
    if (!small || s->shift == 0) return false;
    if (fabs(curvature) < ZERO_CURVATURE) *status = NEWTON_NEUTRAL;
    else if (s->now.gradient_max <= floor) *status = curvature < 0 ? NEWTON_SADDLE : NEWTON_NEUTRAL;
    return *status != NEWTON_MAX_ITERATIONS;
}

/* step = -H^-1 gradient: by conjugate gradients where they do, else with a new factor, shifted if need be. False where no
 * shift makes the matrix positive definite. */
static bool newton_step(Search *s, bool small)
{
    int iterations = -1;
    if (s->def->cg_iterations > 0 && s->shift_kept == 0)
        iterations = system_solve_cg(s->sys, s->gradient, s->def->cg_tol, s->def->cg_iterations, s->step);
    if (iterations >= 0) {
        s->info.cg_iterations += iterations;
    } else {
        if (!factor_shifted(s)) return false;
        if (small && s->shift > 0 && s->shift_kept > 0) { /* a remembered shift proves nothing */
            if (factor(s, 0))
                s->shift = 0;
            else
                factor(s, s->shift);
        }
        s->shift_kept = s->shift;
        system_solve(s->sys, s->gradient, s->step);
    }
    for (int i = 0; i < s->n; i++) s->step[i] = -s->step[i];
    s->info.step = system_step_size(s->sys, s->step);
    return true;
}

static bool is_converged(const Search *s, bool small)
{
    if (s->shift > 0 || system_gap(s->sys) > 0 || system_force_change(s->sys, s->step) > SETTLED) return false;
    double gain = -dot(s->n, s->gradient, s->step);
    for (int i = 0; system_multiplier_count(s->sys) && i < s->n; i++) /* what must vanish and does not counts in full */
        if (system_is_multiplier(s->sys, i)) gain += s->gradient[i] * s->step[i] + fabs(s->gradient[i] * s->step[i]);
    return (small && s->info.step <= s->def->step_tol) || gain <= s->def->energy_tol * s->now.energy_scale;
}

/* Notes what must vanish and does not, and whether the step changes forces by much on its account. */
static void note_gap(Search *s)
{
    s->open = system_gap(s->sys) > 0 && system_force_change(s->sys, s->step) > PUSHED;
    for (int i = 0; system_gap(s->sys) > 0 && i < s->n; i++) s->gap[i] = s->gradient[i];
}

/* Lagrange multipliers take their whole step at once; the line search is for the other dofs, with the energy and the
 * forces that belong to the new multipliers. While there is a gap, these are what the gap over the compliance makes
 * of them, and the step is theirs afterwards, as far as the others go along it (keep_multipliers). */
static void take_multipliers(Search *s)
{
    if (system_multiplier_count(s->sys) == 0) return;
    for (int i = 0; i < s->n; i++)
        if (system_is_multiplier(s->sys, i)) {
            double compliance = system_compliance(s->sys, i);
            s->change[i] = s->step[i];
            if (s->open && compliance > 0)
                s->x[i] += s->gap[i] / compliance;
            else if (!s->open)
                s->x[i] += s->step[i];
            s->step[i] = 0;
        }
    s->now = system_gradient(s->sys, &s->at, s->gradient);
    s->info.evaluations++;
}

/* After a step of this part of Newton's, while there is a gap. */
static void keep_multipliers(Search *s, double part)
{
    for (int i = 0; s->open && i < s->n; i++) {
        if (!system_is_multiplier(s->sys, i)) continue;
        double compliance = system_compliance(s->sys, i);
        s->x[i] += part * s->change[i] - (compliance > 0 ? s->gap[i] / compliance : 0);
    }
}

/* A largest force below this is rounding of the coordinates times the stiffness. */
static double round_off(const Search *s)
{
    double largest = 0;
    for (int i = 0; i < s->n; i++) largest = fmax(largest, fabs(s->x[i]));
    return 8 * DBL_EPSILON * system_stiffness_max(s->sys) * largest;
}

/* One iteration; the status stays MAX_ITERATIONS while there is more to do. */
static NewtonStatus iterate(Search *s)
{
    NewtonStatus status = NEWTON_MAX_ITERATIONS;
    s->now = system_hessian(s->sys, &s->at, s->gradient);
    s->info.evaluations++;
    if (!s->now.finite) return NEWTON_NOT_FINITE;

    double floor = round_off(s);
    bool small = s->now.gradient_max <= fmax(s->def->force_tol * s->now.force_scale, floor);
    if (!newton_step(s, small)) return NEWTON_STALLED;
    note_gap(s);
    s->shifted = s->shift > 0 ? s->shifted + 1 : 0;
    if (is_converged(s, small)) {
        finish(s);
        return NEWTON_CONVERGED;
    }
    int patience = s->open ? 2 : 1; /* with a gap every other step is one of the multipliers */
    if (((small && s->shifted >= patience) || s->shifted >= s->def->shifted_max) && leave_saddle(s, small, floor, &status))
        return status;

    take_multipliers(s);
    double shrink = fmin(1, s->def->step_cap / s->info.step);
    for (int i = 0; i < s->n; i++) s->step[i] *= shrink;
    double a = line_search(s);
    keep_multipliers(s, a * shrink);
    if (a > 0) {
        move(s, s->step, a);
        return status;
    }
    s->shift_kept = 160 * fmax(s->shift, s->def->shift_first);
    return s->shift_kept > STALL_SHIFT ? NEWTON_STALLED : status;
}

NewtonInfo newton_minimize(System *sys, const NewtonDef *def, const Point *at, double *x, const NewtonObserver *observer)
{
    int n = system_dof_count(sys);
    double *work = mem_alloc(8 * (size_t)n, sizeof *work);
    Search s = {.sys = sys, .def = def, .n = n, .at = *at, .x = x, .gradient = work,
                .step = work + n, .trial = work + 2 * n, .trial_gradient = work + 3 * n, .mode = work + 4 * n,
                .product = work + 5 * n, .gap = work + 6 * n, .change = work + 7 * n};
    s.at.x = x;
    s.info.status = NEWTON_MAX_ITERATIONS;
    system_accept(sys, x);
    while (s.info.iterations < def->max_iterations && s.info.status == NEWTON_MAX_ITERATIONS) {
        s.info.iterations++;
        s.info.status = iterate(&s);
        s.info.energy = s.now.energy;
        s.info.gradient_max = s.now.gradient_max;
        s.info.force_scale = s.now.force_scale;
        if (observer && s.info.status == NEWTON_MAX_ITERATIONS && !observer->iteration(observer->self, &s.info))
            s.info.status = NEWTON_STOPPED;
    }
    mem_free(work);
    return s.info;
}
