#include "base/memory.h"
#include "solve/newton_private.h"
#include "solve/tangent.h"
#include <float.h>
#include <math.h>
#include <string.h>

enum { HALVINGS = 30, BASE_CG_MAX = 12, TANGLED_MAX = 10, ASTRAY_MIN = 20, UNHALVED_MAX = 3 };

static const double SHIFT_LAST = 1e8;   /* D: beyond this a step is no longer a Newton step       */
static const double STALL_SHIFT = 1e6;  /* D: no decrease even with such a shift                  */
static const double SETTLED = 1e-4;     /* of a gap's force: more is a force that goes on growing */
static const double LAST_STEP = 1e-8;   /* body's measure: longer ones are no rounding           */
static const double LONG_STEP = 1e-4;   /* body's measure: shorter ones need no extrapolated stress */
static const double CONVEX_GROWTH = 64; /* of a shift: what is indefinite without contact is so by much */
static const double ASTRAY_PART =
    0.9; /* of the least force of the first half of the iterations: so far the second falls */
static const double BASE_CG_TOL = 1e-4; /* what is left of the base shift's part in a step        */

double newton_round_off(const System *sys, const double *x)
{
    double largest = 0;
    for (int i = 0; i < system_dof_count(sys); i++) largest = fmax(largest, fabs(x[i]));
    return 8 * DBL_EPSILON * system_stiffness_max(sys) * largest;
}

NewtonDef newton_default(void)
{
    return (NewtonDef){.max_iterations = 300,
                       .step_tol = 1e-8,
                       .force_tol = 1e-6,
                       .step_cap = 0.25,
                       .cg_tol = 1e-3,
                       .shift_first = 1e-8,
                       .shift_least = 1e-10,
                       .shift_growth = 4,
                       .shift_decay = 16,
                       .armijo = 1e-4,
                       .shifted_max = 3};
}

static const struct {
    const char *name, *text;
} status_rows[] = {
    [NEWTON_CONVERGED] = {"converged", "a stable equilibrium"},
    [NEWTON_SADDLE] = {"saddle", "in equilibrium but unstable, and no way down was found"},
    [NEWTON_NEUTRAL] = {"neutral",
                        "in equilibrium with a mode of zero stiffness (a buckling point or a free motion)"},
    [NEWTON_STALLED] = {"stalled", "no step lowers the energy any more, but the forces are not in balance"},
    [NEWTON_MAX_ITERATIONS] =
        {"max_iterations", "the energy was still falling at the last iteration: raise solver.max_iterations"},
    [NEWTON_NOT_FINITE] = {"not_finite", "energy or forces at the start are not finite numbers"},
    [NEWTON_STOPPED] = {"stopped", "interrupted"},
    [NEWTON_UNBALANCED] = {"evaluated", "a pose whose forces are not in balance"},
    [NEWTON_CRUSHED] = {"crushed", "a piece of the body is crushed to nothing"},
    [NEWTON_TANGLED] = {"tangled", "a piece of the body is turned inside out, or flattened to nothing"},
    [NEWTON_BLOCKED] = {"blocked", "what is held was moved through another part of the body"},
    [NEWTON_PIERCED] = {"pierced", "something has gone through the body"},
    [NEWTON_ASTRAY] =
        {"max_iterations",
         "all iterations are done, and the later ones have come no nearer to balance: there may "
         "be no such equilibrium (what holds the body pulls it too far, or the loads are too "
         "large), or the way there is long: try more load_steps, then solver.max_iterations"},
    [NEWTON_UNKNOWN_FIELD] =
        {"not_finite", "a field has no value where the body is or would go, and it must stay where the "
                       "field is known"},
    [NEWTON_UNSETTLED] = {"unsettled", "friction and the forces that press do not agree with each other"},
};

const char *newton_status_name(NewtonStatus status)
{
    return status_rows[status].name;
}

const char *newton_status_text(NewtonStatus status)
{
    return status_rows[status].text;
}

bool newton_is_used_up(NewtonStatus status)
{
    return status == NEWTON_MAX_ITERATIONS || status == NEWTON_ASTRAY;
}

void newton_add_counts(NewtonInfo *info, const NewtonInfo *before)
{
    info->iterations += before->iterations;
    info->factorizations += before->factorizations;
    info->cg_iterations += before->cg_iterations;
    info->evaluations += before->evaluations;
}

bool search_factor(Search *s, double shift)
{
    s->info.factorizations++;
    return system_factor(s->sys, shift);
}

/* The smallest shift, from a part of the remembered one on, that makes the matrix positive definite. */
static bool factor_shifted(Search *s)
{
    const NewtonDef *def = s->def;
    double kept = s->shift_kept, growth = s->convex ? CONVEX_GROWTH : def->shift_growth;
    s->shift = kept < def->shift_decay * def->shift_least ? 0 : kept / def->shift_decay;
    while (!search_factor(s, s->shift)) {
        s->shift = s->shift > 0 ? growth * s->shift : kept > 0 ? def->shift_least : def->shift_first;
        if (s->shift > SHIFT_LAST) return false;
    }
    return true;
}

/* to = where a step leads: in statics along the way that the terms know. */
static void advance(Search *s, const double *direction, double a, double *to)
{
    if (s->follows)
        system_follow(s->sys, s->x, direction, a, to);
    else
        for (int i = 0; i < s->n; i++) to[i] = s->x[i] + a * direction[i];
}

double search_energy(Search *s, const double *direction, double a, Evaluation *evaluation)
{
    advance(s, direction, a, s->trial);
    system_project(s->sys, s->x, s->trial);
    Point at = s->at;
    at.x = s->trial;
    s->info.evaluations++;
    *evaluation = s->open ? system_gradient(s->sys, &at, s->trial_gradient) : system_energy(s->sys, &at);
    return evaluation->finite ? evaluation->energy + gap_energy(s) : INFINITY;
}

/* Near a minimum energies differ by less than their rounding: there the slope at the new point decides. */
static bool slope_is_fine(Search *s, const Evaluation *trial, double slope)
{
    double rounding = system_gap(s->sys) > 0 ? 1e-9 : 1e-12; /* forces times positions round, too */
    if (!(trial->energy <= s->now.energy + rounding * s->now.energy_scale)) return false;
    Point at = s->at;
    at.x = s->trial;
    gap_pull(s);
    system_gradient(s->sys, &at, s->trial_gradient);
    s->info.evaluations++;
    for (int i = 0; i < s->n; i++)
        if (system_is_fixed(s->sys, i)) s->trial_gradient[i] = 0;
    return gap_falls(s) || vector_dot(s->n, s->trial_gradient, s->step) <= (2 * s->def->armijo - 1) * slope;
}

/* Largest of 1, 1/2, 1/4 ... along the step that satisfies Armijo's rule; leaves the point in trial; 0: none. */
static double line_search(Search *s)
{
    double slope = vector_dot(s->n, s->gradient, s->step), a = 1;
    for (int k = 0; k < HALVINGS; k++, a /= 2) {
        Evaluation trial;
        double energy = search_energy(s, s->step, a, &trial);
        if (energy <= s->now.energy + s->def->armijo * a * slope) return a;
        if (isfinite(energy) && slope_is_fine(s, &trial, slope)) return a;
    }
    return 0;
}

void search_move(Search *s, const double *direction, double a)
{
    if (s->follows) {
        memcpy(s->from, s->x, (size_t)s->n * sizeof *s->x);
        for (int i = 0; i < s->n; i++) s->moved[i] = a * direction[i];
        s->extrapolate = system_step_size(s->sys, s->moved) >= LONG_STEP;
    }
    advance(s, direction, a, s->trial);
    system_project(s->sys, s->x, s->trial);
    memcpy(s->x, s->trial, (size_t)s->n * sizeof *s->x);
    system_accept(s->sys, s->x, s->state->memory);
}

/* The last step, squared small: taken if it does not raise the forces. */
static void finish(Search *s)
{
    Point at = s->at;
    if (system_reach(s->sys, &at, s->step) < 1) return;
    for (int i = 0; i < s->n; i++) s->trial[i] = s->x[i] + s->step[i];
    system_project(s->sys, s->x, s->trial);
    at.x = s->trial;
    Evaluation last = system_gradient(s->sys, &at, s->trial_gradient);
    s->info.evaluations++;
    if (!last.finite || last.gradient_max > s->now.gradient_max) return;
    memcpy(s->x, s->trial, (size_t)s->n * sizeof *s->x);
    system_accept(s->sys, s->x, s->state->memory);
    s->now = last;
}

/* step = H^-1 gradient with the factor at hand. Where that has a base shift, which may be more than what holds a free hinge, a
 * few conjugate gradients take its part out again; they end where a motion costs nothing at all. With forces that have no
 * potential it is for the whole derivative: downhill still, for the symmetric part of that is positive definite; or, `plain`,
 * without the shift. */
static void solve(Search *s)
{
    int iterations = -1;
    if (s->circulates) {
        Point at = s->at;
        at.x_lag = NULL; /* what is lagged stays while Newton steps */
        if (s->plain)
            tangent_solve(s->sys, &at, false, s->gradient, s->step);
        else
            tangent_solve_shifted(s->sys, &at, s->gradient, s->step);
        return;
    }
    if (s->shift == 0 && system_base_shift(s->sys) > 0)
        iterations = system_solve_cg(s->sys, s->gradient, BASE_CG_TOL, BASE_CG_MAX, s->step);
    if (iterations < 0) system_solve(s->sys, s->gradient, s->step);
}

/* Hessian at x, of the stress that the last step was to bring or of its own; or without negative parts. */
static void linearise(Search *s, bool extrapolate, bool tangled)
{
    Point at = s->at;
    at.tangled = s->convex = tangled;
    if (extrapolate) at.x_from = s->from, at.step = s->moved;
    s->now = system_hessian(s->sys, &at, s->gradient);
    s->info.evaluations++;
}

/* Of the Hessian, or, where that is not positive definite, of its convex part, with the least shift that it takes. */
static bool factor_convex(Search *s, bool indefinite)
{
    s->shift = 0;
    if (!indefinite && search_factor(s, 0)) return true;
    Point at = s->at;
    at.convex = true;
    system_hessian(s->sys, &at, s->gradient);
    s->info.evaluations++;
    s->convex = true;
    return factor_shifted(s);
}

/* step = -H^-1 gradient: by conjugate gradients where they do, else with a new factor, shifted if need be. False where no
 * shift makes the matrix positive definite. */
static bool newton_step(Search *s, bool small)
{
    int iterations = -1;
    if (s->def->cg_iterations > 0 && s->shift_kept == 0 && !s->circulates)
        iterations = system_solve_cg(s->sys, s->gradient, s->def->cg_tol, s->def->cg_iterations, s->step);
    if (iterations >= 0) {
        s->info.cg_iterations += iterations;
    } else {
        bool indefinite = iterations == SPARSE_INDEFINITE || s->shift_kept > 0;
        bool convex = !small && !s->convex && system_convexes(s->sys);
        bool found = convex ? factor_convex(s, indefinite) : factor_shifted(s);
        if (!found) return false;
        if (small && s->shift > 0 && s->shift_kept > 0) { /* a remembered shift proves nothing */
            if (search_factor(s, 0))
                s->shift = 0;
            else
                search_factor(s, s->shift);
        }
        s->shift_kept = s->shift;
        solve(s);
    }
    for (int i = 0; i < s->n; i++) s->step[i] = -s->step[i];
    s->info.step = system_step_size(s->sys, s->step);
    return true;
}

/* Near the end each step is a small part of the one before, unless it is rounding. */
static void note_step(Search *s, bool small)
{
    bool falls = s->info.step < s->least_step / 2 || s->info.step > LAST_STEP;
    s->unhalved = small && !falls ? s->unhalved + 1 : 0;
    s->least_step = fmin(s->least_step, s->info.step);
}

static bool is_converged(const Search *s, bool small)
{
    if ((s->shift > 0 && !s->plain) || s->convex || system_gap(s->sys) > 0 ||
        system_force_change(s->sys, s->step) > SETTLED)
        return false;
    double gain = -vector_dot(s->n, s->gradient, s->step);
    for (int i = 0; system_multiplier_count(s->sys) && i < s->n;
         i++) /* what must vanish and does not counts in full */
        if (system_is_multiplier(s->sys, i))
            gain += s->gradient[i] * s->step[i] + fabs(s->gradient[i] * s->step[i]);
    if (s->plain) gain = fabs(gain); /* a step may lead up */
    return (small && (s->info.step <= s->def->step_tol || s->unhalved >= UNHALVED_MAX)) ||
           gain <= s->def->energy_tol * s->now.energy_scale;
}

/* The step to take from x. Near the end the Hessian is the true one: so the end is quadratic, and its factor tells of a
 * minimum. Returns MAX_ITERATIONS as long as there is more to do. */
static NewtonStatus find_step(Search *s, double *floor, bool *small)
{
    bool tangled = s->tangled > 0 && system_tangles(s->sys, &s->at);
    s->tangled = tangled ? s->tangled - 1 : 0;
    for (bool extrapolate = s->extrapolate;; extrapolate = tangled = false) {
        linearise(s, extrapolate, tangled);
        if (!s->now.finite) return NEWTON_NOT_FINITE;
        *floor = newton_round_off(s->sys, s->x);
        *small = s->now.gradient_max <= fmax(s->def->force_tol * s->now.force_scale, *floor);
        if ((extrapolate || tangled) && *small) continue;
        if (!newton_step(s, *small)) return NEWTON_STALLED;
        if (!extrapolate || s->info.step >= LONG_STEP) return NEWTON_MAX_ITERATIONS;
    }
}

/* One iteration; the status stays MAX_ITERATIONS while there is more to do. */
static NewtonStatus iterate(Search *s)
{
    double floor;
    bool small;
    NewtonStatus status = find_step(s, &floor, &small);
    if (status != NEWTON_MAX_ITERATIONS) return status;
    s->extrapolate = false;
    gap_note(s);
    note_step(s, small);
    /* A convex part has no way down, and plain steps seek none. */
    s->shifted = s->shift > 0 && !s->convex && !s->plain ? s->shifted + 1 : 0;
    if (is_converged(s, small)) {
        finish(s);
        return NEWTON_CONVERGED;
    }
    int patience = s->open ? 2 : 1; /* with a gap every other step is one of the multipliers */
    bool saddle = (small && s->shifted >= patience) || s->shifted >= s->def->shifted_max;
    if (saddle && search_leave_saddle(s, small, floor, &status)) return status;

    gap_take_multipliers(s);
    double shrink = fmin(1, s->def->step_cap / s->info.step);
    for (int i = 0; i < s->n; i++) s->step[i] *= shrink;
    double reach = system_reach(s->sys, &s->at, s->step);
    for (int i = 0; reach < 1 && i < s->n; i++) s->step[i] *= reach;
    double a = s->plain && s->shift > 0 ? 1 : line_search(s);
    gap_keep_multipliers(s, a * shrink * reach);
    if (a > 0) {
        search_move(s, s->step, a);
        return status;
    }
    s->shift_kept = 160 * fmax(s->shift, s->def->shift_first);
    return s->shift_kept > STALL_SHIFT ? NEWTON_STALLED : status;
}

/* The least force of each half of the iterations, in parts of the forces' scale. */
static void note_force(Search *s)
{
    double *least = &s->least_force[2 * s->info.iterations > s->def->max_iterations];
    *least = fmin(*least, s->now.gradient_max / s->now.force_scale);
}

static bool is_astray(const Search *s)
{
    return s->info.status == NEWTON_MAX_ITERATIONS && s->def->max_iterations >= ASTRAY_MIN &&
           s->least_force[1] > ASTRAY_PART * s->least_force[0];
}

/* Where a body is inside out, or flat, its energy may well be stationary, or have no way down, but it is no equilibrium of
 * such a body. */
static bool ends_tangled(const Search *s)
{
    NewtonStatus status = s->info.status;
    bool ended = status == NEWTON_CONVERGED || status == NEWTON_SADDLE || status == NEWTON_NEUTRAL ||
                 status == NEWTON_STALLED;
    return ended && system_tangles(s->sys, &s->at);
}

static NewtonInfo minimize(System *sys, const NewtonDef *def, const Point *at, State *state,
                           const NewtonObserver *observer, bool plain)
{
    int n = system_dof_count(sys);
    double *work = mem_alloc(10 * (size_t)n, sizeof *work);
    Search s = {.sys = sys,
                .def = def,
                .n = n,
                .state = state,
                .at = *at,
                .x = state->x,
                .gradient = work,
                .step = work + n,
                .trial = work + 2 * n,
                .trial_gradient = work + 3 * n,
                .mode = work + 4 * n,
                .product = work + 5 * n,
                .from = work + 6 * n,
                .moved = work + 7 * n,
                .gap = work + 8 * n,
                .change = work + 9 * n,
                .tangled = TANGLED_MAX,
                .least_force = {INFINITY, INFINITY},
                .least_step = INFINITY,
                .follows = !at->x_prev && system_has_follow(sys),
                .circulates = system_circulates(sys),
                .plain = plain};
    s.at.x = state->x, s.at.memory = state->memory;
    s.info.status = NEWTON_MAX_ITERATIONS;
    system_accept(sys, s.x, state->memory);
    while (s.info.iterations < def->max_iterations && s.info.status == NEWTON_MAX_ITERATIONS) {
        s.info.iterations++;
        s.info.status = iterate(&s);
        s.info.energy = s.now.energy;
        s.info.gradient_max = s.now.gradient_max;
        s.info.force_scale = s.now.force_scale;
        note_force(&s);
        if (observer && s.info.status == NEWTON_MAX_ITERATIONS &&
            !observer->iteration(observer->self, &s.info))
            s.info.status = NEWTON_STOPPED;
    }
    if (is_astray(&s)) s.info.status = NEWTON_ASTRAY;
    if (ends_tangled(&s)) s.info.status = NEWTON_TANGLED;
    mem_free(work);
    return s.info;
}

/* Without a potential: what is near by plain steps; else what energies of the symmetric part lead to; else by plain steps. */
static const struct {
    int most; /* iterations; 0: the caller's */
    bool plain;
} ways[] = {{8, true}, {100, false}, {0, true}};

NewtonInfo newton_minimize(System *sys, const NewtonDef *def, const Point *at, State *state,
                           const NewtonObserver *observer)
{
    if (!system_circulates(sys)) return minimize(sys, def, at, state, observer, false);
    State start = state_clone(state);
    NewtonInfo info = {0}, before;
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
        NewtonDef own = *def;
        if (ways[k].most && ways[k].most < own.max_iterations) own.max_iterations = ways[k].most;
        state_copy(state, &start);
        before = info;
        info = minimize(sys, &own, at, state, observer, ways[k].plain);
        newton_add_counts(&info, &before);
        if (info.status == NEWTON_CONVERGED || info.status == NEWTON_STOPPED) break;
    }
    state_destroy(&start);
    return info;
}
