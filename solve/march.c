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
    double *other; /* [dofs] another start */
} March;

MarchDef march_default(void)
{
    MarchDef def = {.newton = newton_default(), .cuts = 10};
    def.newton.energy_tol = 1e-10;
    def.newton.cg_iterations = 8;
    return def;
}

/* Takes the other start if its energy is less. */
static void compare_start(March *m, Point *at, double *energy)
{
    system_project(m->sys, m->state->x, m->other);
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

/* The previous state, the inertial guess x + dt v or the caller's, whichever has least energy. */
static void choose_start(March *m, Point *at)
{
    int positions = system_position_count(m->sys);
    double *x = m->trial.x;
    state_copy(&m->trial, m->state);
    put_state(m, at->time, x);
    system_project(m->sys, m->state->x, x);
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
}

static bool try_step(March *m, double dt)
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
    choose_start(m, &at);
    NewtonInfo newton = newton_minimize(m->sys, &m->def->newton, &at, trial, observer);
    newton_add_counts(&newton, &m->info->newton);
    m->info->newton = newton;
    if (newton.status != NEWTON_CONVERGED) return false;
    for (int i = 0; i < system_position_count(m->sys); i++) trial->v[i] = (trial->x[i] - state->x[i]) / dt;
    trial->time += dt;
    state_copy(state, trial);
    m->info->steps++;
    if (m->def->stored) m->def->stored(m->def->self, state, dt);
    return true;
}

/* The step, or its two halves. */
static bool advance(March *m, double dt, int cuts)
{
    if (try_step(m, dt)) return true;
    if (cuts == 0 || m->info->newton.status == NEWTON_STOPPED) return false;
    m->info->refused++;
    return advance(m, dt / 2, cuts - 1) && advance(m, dt / 2, cuts - 1);
}

bool march_step(System *sys, const MarchDef *def, double dt, double *p, State *state, MarchInfo *info)
{
    *info = (MarchInfo){0};
    March m = {.sys = sys, .def = def, .p = p, .state = state, .trial = state_clone(state), .info = info};
    m.other = mem_alloc((size_t)state->dofs, sizeof *m.other);
    bool ok = advance(&m, dt, def->cuts);
    mem_free(m.other);
    state_destroy(&m.trial);
    return ok;
}
