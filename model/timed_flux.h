/* timed_flux.h - a uniform flux density that changes in time: three formulas of t, or a table of it. */
#pragma once
#include "io/formula.h"
#include "io/table.h"

/* Either a formula of x, y, z, r, t (of which it uses t only) or rows t, Bx, By, Bz with t ascending; or
 * nothing. */
typedef struct TimedFlux {
    Formula *formula;
    Table table;
} TimedFlux;

void timed_flux_clear(TimedFlux *timed);

static inline bool timed_flux_is_given(const TimedFlux *timed)
{
    return timed->formula || timed->table.rows > 0;
}

/* Reads and checks a table. False with a sentence. */
bool timed_flux_read(const char *path, TimedFlux *timed, Error *err);

/* flux[3] in T; between rows of a table linear, before and after it as at its ends. */
bool timed_flux_eval(const TimedFlux *timed, double time, double *flux, Error *err);

/* The largest of those at up to 10 000 of a motion's moments, T; flux[3] stays where there is none larger. */
double timed_flux_largest(const TimedFlux *timed, double start, double step, int steps, double *flux);
