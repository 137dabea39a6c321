#include "solve/march.h"
#include "base/memory.h"
#include <math.h>
#include <string.h>

/* One march_step at work. */
typedef struct March {
    System *sys;
    const MarchDef *def;
    double *p;
    State *state, trial;
    MarchInfo *info;
    double *other;  /* [dofs] another start */
    double *wanted; /* [dofs] a start before it is made admissible */
    double *lag;    /* [dofs] where the last solution was; NULL: what is lagged is the start's */
} March;

enum { LAG_PASSES = 40 };

MarchDef march_default(void)
{
    MarchDef def = {.newton = newton_default(), .cuts = 10};
    def.newton.energy_tol = 1e-10;
    def.newton.cg_iterations = 8;
    return def;
}

/* Makes a start x admissible; false where what is held cannot be where it is to be. */
static bool admit(March *m, double *x)
{
    bool stays = true;
    size_t n = (size_t)m->trial.dofs;
    memcpy(m->wanted, x, n * sizeof *x);
    system_project(m->sys, m->state->x, x);
    for (size_t i = 0; m->def->move && i < n; i++)
        stays = stays && (x[i] == m->wanted[i] || !system_is_fixed(m->sys, (int)i));
    return stays;
}

/* Takes the other start if its energy is less. */
static void compare_start(March *m, Point *at, double *energy)
{
    if (!admit(m, m->other)) return;
    at->x = m->other;
    Evaluation other = system_energy(m->sys, at);
    if (!other.finite || other.energy >= *energy) return;
    *energy = other.energy;
    memcpy(m->trial.x, m->other, (size_t)m->trial.dofs * sizeof *m->other);
}

/* The state, with held coordinates where they are to be. */
static void put_state(const March *m, double time, double *x)
{
    memcpy(x, m->state->x, (size_t)m->trial.dofs * sizeof *x);
    if (m->def->move) m->def->move(m->def->self, time, x);
}

/* The previous state, the inertial guess x + dt v or the caller's, whichever has least energy. False where what is held
 * cannot go where it is to go. */
static bool choose_start(March *m, Point *at)
{
    int positions = system_position_count(m->sys);
    double *x = m->trial.x;
    state_copy(&m->trial, m->state);
    put_state(m, at->time, x);
    if (!admit(m, x)) return false;
    at->x = x;
    Evaluation rest = system_energy(m->sys, at);
    double energy = rest.finite ? rest.energy : INFINITY;
    put_state(m, at->time, m->other);
    for (int i = 0; i < positions; i++)
        if (!system_is_fixed(m->sys, i)) m->other[i] += at->dt * m->state->v[i];
    compare_start(m, at, &energy);
    if (m->def->guess) put_state(m, at->time, m->other);
    if (m->def->guess && m->def->guess(m->def->self, at->time, at->dt, m->other))
        compare_start(m, at, &energy);
    return true;
}

/* Solves the step again until what is lagged is that of the solution: one more iteration then changes nothing. */
static NewtonInfo settle_lag(March *m, Point at, NewtonInfo first, const NewtonObserver *observer)
{
    NewtonInfo newton = first;
    int pass = 0;
    at.x_lag = m->lag;
    for (; newton.status == NEWTON_CONVERGED && pass < LAG_PASSES; pass++) {
        memcpy(m->lag, m->trial.x, (size_t)m->trial.dofs * sizeof *m->lag);
        NewtonInfo next = newton_minimize(m->sys, &m->def->newton, &at, &m->trial, observer);
        bool stays = next.iterations == 1;
        newton_add_counts(&next, &newton);
        newton = next;
        if (stays) break;
    }
    if (pass == LAG_PASSES) newton.status = NEWTON_UNSETTLED;
    return newton;
}

/* `last`: one that can be cut no more. What goes through the body in it does so for want of points, and whoever knows the
 * body says so. */
static bool try_step(March *m, double dt, bool last)
{
    State *state = m->state, *trial = &m->trial;
    const NewtonObserver *observer = m->def->observer.iteration ? &m->def->observer : NULL;
    Point at = {.p = m->p,
                .memory = trial->memory,
                .time = state->time + dt,
                .x_prev = state->x,
                .v_prev = state->v,
                .dt = dt};
    if (m->def->load) m->def->load(m->def->self, at.time, m->p);
    NewtonInfo newton = {.status = NEWTON_BLOCKED};
    if (choose_start(m, &at)) newton = newton_minimize(m->sys, &m->def->newton, &at, trial, observer);
    if (m->lag) newton = settle_lag(m, at, newton, observer);
    at.x = trial->x;
    bool passes = newton.status == NEWTON_CONVERGED && system_passes(m->sys, &at);
    if (passes && !last) newton.status = NEWTON_PIERCED;
    newton_add_counts(&newton, &m->info->newton);
    m->info->newton = newton;
    if (newton.status != NEWTON_CONVERGED) return false;
    for (int i = 0; i < system_position_count(m->sys); i++) trial->v[i] = (trial->x[i] - state->x[i]) / dt;
    trial->time += dt;
    state_copy(state, trial);
    m->info->steps++;
    m->info->passed += passes;
    if (m->def->stored) m->def->stored(m->def->self, state, dt);
    return true;
}

/* The step, or its two halves. */
static bool advance(March *m, double dt, int cuts)
{
    if (try_step(m, dt, cuts == 0)) return true;
    if (cuts == 0 || m->info->newton.status == NEWTON_STOPPED) return false;
    m->info->refused++;
    return advance(m, dt / 2, cuts - 1) && advance(m, dt / 2, cuts - 1);
}

bool march_step(System *sys, const MarchDef *def, double dt, double *p, State *state, MarchInfo *info)
{
    *info = (MarchInfo){0};
    March m = {.sys = sys, .def = def, .p = p, .state = state, .trial = state_clone(state), .info = info};
    m.other = mem_alloc((size_t)state->dofs, sizeof *m.other);
    m.wanted = mem_alloc((size_t)state->dofs, sizeof *m.wanted);
    if (def->implicit && system_lags(sys)) m.lag = mem_alloc((size_t)state->dofs, sizeof *m.lag);
    bool ok = advance(&m, dt, def->cuts);
    mem_free(m.other);
    mem_free(m.wanted);
    mem_free(m.lag);
    state_destroy(&m.trial);
    return ok;
}
