#include "solve/ramp.h"
#include "base/memory.h"
#include <math.h>
#include <math.h>
#include <string.h>

RampDef ramp_default(void)
{
    return (RampDef){.newton = newton_default(), .end = 1, .steps = 1, .step_min = 1.0 / 1024};
}

void ramp_loads(const Params *params, const double *from, const double *to, double part, double *p)
{
    memcpy(p, to, (size_t)params->size * sizeof *p);
    for (int b = 0; part < 1 && b < params->block_count; b++) {
        const ParamBlock *block = &params->blocks[b];
        for (int i = block->offset; block->load && i < block->offset + block->count * block->width; i++) {
            double start = from ? from[i] : 0;
            p[i] = start + part * (to[i] - start);
        }
    }
}

/* Are the loads the same at both ends? */
static bool is_steady(const Params *params, const double *from, const double *to)
{
    bool same = true;
    for (int b = 0; same && b < params->block_count; b++) {
        const ParamBlock *block = &params->blocks[b];
        size_t count = (size_t)(block->count * block->width);
        same = !block->load || !memcmp(from + block->offset, to + block->offset, count * sizeof *to);
    }
    return same;
}

bool ramp_reached(NewtonStatus status)
{
    return status == NEWTON_CONVERGED || status == NEWTON_SADDLE || status == NEWTON_NEUTRAL;
}

/* Can what is held go from where it is to where it has been moved in the state? */
static bool way_is_free(const System *sys, const double *from, const State *state)
{
    bool free = true;
    double *x = mem_copy(state->x, (size_t)state->dofs, sizeof *x);
    system_project(sys, from, x);
    for (int i = 0; i < state->dofs; i++) free = free && isfinite(x[i]);
    mem_free(x);
    return free;
}

RampInfo ramp_solve(System *sys, const Params *params, const RampDef *def, const double *from,
                    const double *to, State *state)
{
    double *p = mem_alloc((size_t)params->size, sizeof *p);
    State kept = state_clone(state);
    const NewtonObserver *observer = def->observer.iteration ? &def->observer : NULL;
    RampInfo info = {.reached = def->begin, .part = def->begin};
    bool steady = from && !def->move && is_steady(params, from, to);
    double step = (def->end - def->begin) / (steady ? 1 : def->steps);
    while (info.reached < def->end) {
        double part = info.reached + step > def->end - 1e-9 ? def->end : info.reached + step;
        state_copy(&kept, state);
        ramp_loads(params, from, to, part, p);
        NewtonInfo newton = {.status = NEWTON_NOT_FINITE};
        bool moved = !def->move || def->move(def->self, info.reached, part, state->x);
        if (moved && def->move && !way_is_free(sys, kept.x, state))
            newton.status = NEWTON_BLOCKED;
        else if (moved)
            newton =
                newton_minimize(sys, &def->newton, &(Point){.p = p, .time = state->time}, state, observer);
        newton_add_counts(&newton, &info.newton);
        info.newton = newton;
        if (ramp_reached(newton.status)) {
            info.reached = info.part = part;
            info.steps++;
            continue;
        }
        bool falling = newton_is_used_up(newton.status); /* half a load would not get there sooner */
        bool hopeless = falling || newton.status == NEWTON_STOPPED || step / 2 < def->step_min;
        if (hopeless && (falling || info.steps == 0) && newton.status != NEWTON_STOPPED) {
            info.part = part; /* the iterate says more than the start */
            break;
        }
        state_copy(state, &kept);
        if (hopeless) break;
        info.refused++;
        step /= 2;
    }
    mem_free(p);
    state_destroy(&kept);
    return info;
}
