/* ramp.h - an equilibrium whose loads come on in steps: as few as it takes.
 *
 * The blocks of p that are loads go from one vector to the other, and prescribed motion goes its way, over `steps` equal
 * steps. A step that fails is halved; one whose energy was still falling at the last iteration has not failed, half of it would
 * get there no sooner: there the ramp ends, and says so. An equilibrium under dead loads and fixed fields does not depend on the
 * way, as long as it is the only one near; so one step is the default, and the rest is for where Newton does not get there. */
#pragma once
#include "solve/newton.h"
#include "solve/params.h"

typedef struct RampDef {
    NewtonDef newton;
    double begin, end; /* which part of the way; default 0 and 1: all of it */
    int steps;         /* at first; default 1. One where nothing changes: loads are the same, nothing moves */
    double step_min;   /* of the whole, before it gives up; default 1/1024 */
    NewtonObserver observer; /* may be zero */
    /* Leads held coordinates on: x has them at a part (0..1) of their way, `from`, and gets them at the part `to`. May be
     * NULL. */
    bool (*move)(void *self, double from, double to, double *x);
    void *self;
} RampDef;

/* Of what is left of the way at `from`. */
static inline double ramp_part(double from, double to)
{
    return (to - from) / (1 - from);
}

RampDef ramp_default(void);

typedef struct RampInfo {
    NewtonInfo newton; /* of the last step; iterations and factorisations are those of all steps */
    int steps, refused;
    double reached; /* part of the loads that an equilibrium was found with; 1: all */
    double part;    /* part of the loads that x is under: `reached`, or, of an iterate, what was tried last */
} RampInfo;

/* The loads at a part of the way, p[params->size]; what is no load is as in `to`. */
void ramp_loads(const Params *params, const double *from, const double *to, double part, double *p);

/* Is it a stationary point, stable or not? */
bool ramp_reached(NewtonStatus status);

/* The state, in equilibrium with from (NULL: no loads), or with where the part of the way begins, comes to be in equilibrium
 * with to, or where it ends, all at its time.
 * Stationary points that are no minima count as reached: the status says so. On failure it is the last state
 * that was found. */
RampInfo ramp_solve(System *sys, const Params *params, const RampDef *def, const double *from,
                    const double *to, State *state);
