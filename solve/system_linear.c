#include "base/memory.h"
#include "solve/system_private.h"
#include <math.h>
#include <string.h>

/* Free dofs of a whole vector. */
static double *pick(const System *sys, const double *whole)
{
    for (int i = 0; i < sys->dof_count; i++)
        if (sys->unknown[i] >= 0) sys->work[sys->unknown[i]] = whole[i];
    return sys->work;
}

static void spread(const System *sys, const double *free, double *whole)
{
    for (int i = 0; i < sys->dof_count; i++) whole[i] = sys->unknown[i] >= 0 ? free[sys->unknown[i]] : 0;
}

/* Where something is lagged: whether the point says where (1), or it is x_prev (0), for then things that move are where they
 * were there, too; and the place. */
static int lag_count(const System *sys)
{
    return system_lags(sys) ? 1 + sys->dof_count : 0;
}

void system_note_point(System *sys, const Point *at)
{
    size_t n = (size_t)sys->dof_count;
    double *to = sys->linearised + ANCHOR_X;
    sys->linearised[ANCHOR_USABLE] = at->convex    ? ANCHOR_OF_CONVEX
                                     : at->tangled ? ANCHOR_OF_TANGLED
                                                   : ANCHOR_OF_ALL;
    sys->linearised[ANCHOR_TIME] = at->time;
    sys->linearised[ANCHOR_DT] = at->dt;
    memcpy(to, at->x, n * sizeof *to);
    if (at->x_prev) memcpy(to + n, at->x_prev, n * sizeof *to);
    if (at->v_prev) memcpy(to + 2 * n, at->v_prev, n * sizeof *to);
    to += 3 * n;
    if (lag_count(sys)) to[0] = at->x_lag != NULL;
    if (lag_count(sys) && at->x_prev) memcpy(to + 1, point_lag(at), n * sizeof *to);
    to += lag_count(sys);
    if (at->memory) memcpy(to, at->memory, (size_t)sys->memory_count * sizeof *to);
}

bool system_factor(System *sys, double shift)
{
    double sum = 0, *diagonal = sys->work;
    for (int i = 0; i < sys->dof_count; i++)
        if (sys->unknown[i] >= 0) {
            double *to = &diagonal[sys->unknown[i]];
            *to = (sys->base + shift) * sys->scale[i] - sys->compliance[i];
            sum += fabs(*to);
        }
    bool ok = sparse_factor(sys->matrix, sum > 0 ? diagonal : NULL);
    memcpy(sys->anchor, sys->linearised, (size_t)system_anchor_count(sys) * sizeof *sys->anchor);
    sys->factored = ok;
    if (!ok) sys->anchor[ANCHOR_USABLE] = ANCHOR_NONE;
    sys->anchor[ANCHOR_SHIFT] = shift;
    return ok;
}

int system_anchor_count(const System *sys)
{
    return ANCHOR_X + 3 * sys->dof_count + lag_count(sys) + system_memory_count(sys);
}

const double *system_anchor(const System *sys)
{
    return sys->anchor;
}

double system_anchor_time(const double *anchor)
{
    return anchor[ANCHOR_TIME];
}

void system_restore_factor(System *sys, const double *anchor, const double *p)
{
    size_t n = (size_t)sys->dof_count;
    const double *x = anchor + ANCHOR_X, *lag = x + 3 * n;
    sys->anchor[ANCHOR_USABLE] = sys->factored = false;
    if (anchor[ANCHOR_USABLE] == 0) return;
    double *gradient = mem_alloc(n, sizeof *gradient);
    Point at = {.x = x,
                .p = p,
                .memory = lag + lag_count(sys),
                .time = anchor[ANCHOR_TIME],
                .x_prev = x + n,
                .v_prev = x + 2 * n,
                .dt = anchor[ANCHOR_DT],
                .convex = anchor[ANCHOR_USABLE] == ANCHOR_OF_CONVEX,
                .tangled = anchor[ANCHOR_USABLE] == ANCHOR_OF_TANGLED,
                .x_lag = lag_count(sys) && lag[0] ? lag + 1 : NULL};
    system_hessian(sys, &at, gradient);
    system_factor(sys, anchor[ANCHOR_SHIFT]);
    mem_free(gradient);
}

bool system_factor_positions(System *sys, double sigma, const double *M)
{
    for (int i = 0; i < sys->dof_count; i++)
        if (sys->unknown[i] >= 0)
            sys->work[sys->unknown[i]] = i < sys->classes[0].count
                                             ? sigma * (M ? M[i] : 1)
                                             : sys->base * sys->scale[i] - sys->compliance[i];
    sys->anchor[ANCHOR_USABLE] = 0;
    return sys->factored = sparse_factor(sys->matrix, sys->work);
}

double system_scale_mean(const System *sys)
{
    double mean = 0;
    for (int i = 0; i < sys->classes[0].count; i++) mean = fmax(mean, sys->scale[i]);
    return mean;
}

double system_shift(const System *sys)
{
    return sys->factored && sys->anchor[ANCHOR_USABLE] ? sys->anchor[ANCHOR_SHIFT] : 0;
}

void system_solve(System *sys, const double *b, double *y)
{
    double *work = pick(sys, b);
    sparse_solve(sys->matrix, work, work);
    spread(sys, work, y);
}

int system_solve_cg(System *sys, const double *b, double tolerance, int max_iterations, double *y)
{
    if (!sys->factored || sys->multiplier_count) return -1; /* for positive definite matrices only */
    double *work = pick(sys, b);
    int iterations = sparse_solve_cg(sys->matrix, work, tolerance, max_iterations, work);
    if (iterations >= 0) spread(sys, work, y);
    return iterations;
}

Factor *system_share_factor(System *sys)
{
    system_build(sys);
    return sparse_share_factor(sys->matrix);
}

/* It may serve solves, but where it stands is not known here any more. */
void system_use_factor(System *sys, Factor *factor)
{
    system_build(sys);
    sys->anchor[ANCHOR_USABLE] = 0;
    sys->factored = factor && sparse_use_factor(sys->matrix, factor);
}

void system_multiply(const System *sys, const double *v, double *y)
{
    double *work = pick(sys, v);
    sparse_multiply(sys->matrix, work, work);
    spread(sys, work, y);
}

void system_param(System *sys, const Point *at, const double *w, double *dp)
{
    system_update(sys, at);
    Pack x[TERM_MAX_DOF], v[TERM_MAX_DOF];
    for (int t = 0; t < sys->term_count; t++) {
        const Entry *entry = &sys->entries[t];
        Point own = system_term_point(sys, t, at);
        for (int k = 0; entry->term.ops->param && k < entry->packs; k++) {
            system_gather(entry, k, at->x, x);
            system_gather(entry, k, w, v);
            entry->term.ops->param(entry->term.self, k, system_lanes(entry, k), &own, x, v, dp);
        }
    }
}

void system_param_forward(System *sys, const Point *at, const double *dp, double *r)
{
    system_update(sys, at);
    Pack x[TERM_MAX_DOF], v[TERM_MAX_DOF];
    memset(r, 0, (size_t)sys->dof_count * sizeof *r);
    for (int t = 0; t < sys->term_count; t++) {
        const Entry *entry = &sys->entries[t];
        Point own = system_term_point(sys, t, at);
        for (int k = 0; entry->term.ops->param_forward && k < entry->packs; k++) {
            system_gather(entry, k, at->x, x);
            entry->term.ops->param_forward(entry->term.self, k, &own, x, dp, v);
            system_scatter(entry, k, v, r);
        }
    }
}

static void prev_of_term(const Entry *entry, const Point *own, const double *w, double *dx, double *dv)
{
    Pack x[TERM_MAX_DOF], v[TERM_MAX_DOF], from_x[TERM_MAX_DOF], from_v[TERM_MAX_DOF];
    for (int k = 0; k < entry->packs; k++) {
        system_gather(entry, k, own->x, x);
        system_gather(entry, k, w, v);
        entry->term.ops->prev(entry->term.self, k, own, x, v, from_x, from_v);
        for (int i = 0; i < entry->size; i++) from_x[i] = -from_x[i], from_v[i] = -from_v[i];
        system_scatter(entry, k, from_x, dx);
        system_scatter(entry, k, from_v, dv);
    }
}

/* dx += sign w^T d2E/dx dx_lag */
static void lag_of_term(const Entry *entry, const Point *own, const double *w, double sign, double *dx)
{
    Pack x[TERM_MAX_DOF], v[TERM_MAX_DOF], from[TERM_MAX_DOF];
    for (int k = 0; k < entry->packs; k++) {
        system_gather(entry, k, own->x, x);
        system_gather(entry, k, w, v);
        entry->term.ops->lag(entry->term.self, k, own, x, v, from);
        for (int i = 0; i < entry->size; i++) from[i] = sign * from[i];
        system_scatter(entry, k, from, dx);
    }
}

void system_prev(System *sys, const Point *at, const double *w, double *dx, double *dv)
{
    system_update(sys, at);
    for (int t = 0; t < sys->term_count; t++) {
        const Entry *entry = &sys->entries[t];
        Point own = system_term_point(sys, t, at);
        if (entry->term.ops->prev) prev_of_term(entry, &own, w, dx, dv);
        if (entry->term.ops->lag && !at->x_lag) lag_of_term(entry, &own, w, -1, dx);
    }
}

void system_lag(System *sys, const Point *at, const double *w, double *dx)
{
    system_update(sys, at);
    for (int t = 0; t < sys->term_count; t++) {
        const Entry *entry = &sys->entries[t];
        Point own = system_term_point(sys, t, at);
        if (entry->term.ops->lag) lag_of_term(entry, &own, w, 1, dx);
    }
}

/* TermOps.lag_forward or circulate. */
typedef void TermProduct(const void *self, int pack, const Point *at, const Pack *x, const Pack *d, Pack *r);

static void product_of_term(const Entry *entry, TermProduct *product, const Point *own, const double *d,
                            double *r)
{
    Pack x[TERM_MAX_DOF], along[TERM_MAX_DOF], out[TERM_MAX_DOF];
    for (int k = 0; k < entry->packs; k++) {
        system_gather(entry, k, own->x, x);
        system_gather(entry, k, d, along);
        product(entry->term.self, k, own, x, along, out);
        system_scatter(entry, k, out, r);
    }
}

static void prev_forward_of_term(const Entry *entry, const Point *own, const double *dx, const double *dv,
                                 double *r)
{
    Pack x[TERM_MAX_DOF], to_x[TERM_MAX_DOF], to_v[TERM_MAX_DOF], out[TERM_MAX_DOF];
    for (int k = 0; k < entry->packs; k++) {
        system_gather(entry, k, own->x, x);
        system_gather(entry, k, dx, to_x);
        system_gather(entry, k, dv, to_v);
        entry->term.ops->prev_forward(entry->term.self, k, own, x, to_x, to_v, out);
        system_scatter(entry, k, out, r);
    }
}

void system_prev_forward(System *sys, const Point *at, const double *dx, const double *dv, double *r)
{
    system_update(sys, at);
    for (int t = 0; t < sys->term_count; t++) {
        const Entry *entry = &sys->entries[t];
        Point own = system_term_point(sys, t, at);
        if (entry->term.ops->prev_forward) prev_forward_of_term(entry, &own, dx, dv, r);
        if (entry->term.ops->lag_forward && !at->x_lag)
            product_of_term(entry, entry->term.ops->lag_forward, &own, dx, r);
    }
}

void system_lag_forward(System *sys, const Point *at, const double *dx, double *r)
{
    system_update(sys, at);
    for (int t = 0; t < sys->term_count; t++) {
        const Entry *entry = &sys->entries[t];
        Point own = system_term_point(sys, t, at);
        if (entry->term.ops->lag_forward) product_of_term(entry, entry->term.ops->lag_forward, &own, dx, r);
    }
}

bool system_lags(const System *sys)
{
    bool found = false;
    for (int t = 0; t < sys->term_count; t++) found = found || sys->entries[t].term.ops->lag;
    return found;
}

void system_circulate(System *sys, const Point *at, const double *d, double *r)
{
    system_update(sys, at);
    for (int t = 0; t < sys->term_count; t++) {
        const Entry *entry = &sys->entries[t];
        Point own = system_term_point(sys, t, at);
        if (entry->term.ops->circulate) product_of_term(entry, entry->term.ops->circulate, &own, d, r);
    }
}

bool system_circulates(const System *sys)
{
    bool found = false;
    for (int t = 0; t < sys->term_count; t++) found = found || sys->entries[t].term.ops->circulate;
    return found;
}

void system_follow(System *sys, const double *x, const double *d, double a, double *to)
{
    for (int i = 0; i < sys->dof_count; i++) to[i] = x[i] + a * d[i];
    for (int t = 0; t < sys->term_count; t++) {
        const Term *term = &sys->entries[t].term;
        if (term->ops->follow) term->ops->follow(term->self, x, d, a, to);
    }
}

bool system_has_follow(const System *sys)
{
    bool found = false;
    for (int t = 0; t < sys->term_count; t++) found = found || sys->entries[t].term.ops->follow;
    return found;
}

bool system_convexes(const System *sys)
{
    bool found = false;
    for (int t = 0; t < sys->term_count; t++) {
        const Term *term = &sys->entries[t].term;
        found = found || (term->ops->convexes && term->ops->convexes(term->self));
    }
    return found;
}

bool system_tangles(const System *sys, const Point *at)
{
    for (int t = 0; t < sys->term_count; t++) {
        const Term *term = &sys->entries[t].term;
        if (term->ops->tangles && term->ops->tangles(term->self, at)) return true;
    }
    return false;
}

double system_reach(System *sys, const Point *at, const double *d)
{
    double reach = 1;
    system_update(sys, at);
    for (int t = 0; t < sys->term_count; t++) {
        const Term *term = &sys->entries[t].term;
        Point own = system_term_point(sys, t, at);
        if (term->ops->reach) reach = fmin(reach, term->ops->reach(term->self, &own, d));
    }
    return reach;
}

bool system_passes(const System *sys, const Point *at)
{
    bool passes = false;
    for (int t = 0; t < sys->term_count; t++) {
        const Term *term = &sys->entries[t].term;
        passes = passes || (term->ops->passes && term->ops->passes(term->self, at));
    }
    return passes;
}

void system_project(const System *sys, const double *from, double *x)
{
    for (int t = 0; t < sys->term_count; t++) {
        const Term *term = &sys->entries[t].term;
        if (term->ops->project) term->ops->project(term->self, from, x);
    }
}

void system_accept(const System *sys, double *x, double *memory)
{
    for (int t = 0; t < sys->term_count; t++) {
        const Entry *entry = &sys->entries[t];
        if (!entry->term.ops->accept) continue;
        entry->term.ops->accept(entry->term.self, x, memory ? memory + entry->memory : NULL);
    }
}

int system_memory_count(const System *sys)
{
    return sys->memory_count;
}

State system_state(const System *sys)
{
    State state = state_create(sys->dof_count, sys->memory_count);
    for (int t = 0; t < sys->term_count; t++) {
        const Entry *entry = &sys->entries[t];
        if (entry->term.ops->memory) entry->term.ops->memory(entry->term.self, state.memory + entry->memory);
    }
    return state;
}
