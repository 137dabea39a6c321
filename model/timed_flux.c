#include "model/timed_flux.h"
#include "base/vec3.h"
#include "model/build.h"
#include <string.h>

enum {
    COLUMNS = 4,        /* t, Bx, By, Bz                  */
    MOMENTS_MAX = 10000 /* at which a motion is looked at */
};

void timed_flux_clear(TimedFlux *timed)
{
    formula_destroy(timed->formula);
    table_clear(&timed->table);
    timed->formula = NULL;
}

bool timed_flux_read(const char *path, TimedFlux *timed, Error *err)
{
    if (!table_read(path, "t [s], Bx [T], By [T], Bz [T]", &timed->table, err)) return false;
    if (table_check_increasing(&timed->table, path, "t", err)) return true;
    table_clear(&timed->table);
    return false;
}

static void interpolate(const Table *table, double time, double *flux)
{
    int row = 0;
    while (row + 1 < table->rows && table->values[COLUMNS * (row + 1)] <= time) row++;
    const double *low = table->values + COLUMNS * row, *high = row + 1 < table->rows ? low + COLUMNS : low;
    double part = high > low && time > low[0] ? (time - low[0]) / (high[0] - low[0]) : 0;
    for (int i = 0; i < 3; i++) flux[i] = low[1 + i] + part * (high[1 + i] - low[1 + i]);
}

bool timed_flux_eval(const TimedFlux *timed, double time, double *flux, Error *err)
{
    double variables[BUILD_VARIABLES];
    if (!timed->formula) {
        interpolate(&timed->table, time, flux);
        return true;
    }
    build_position(variables, (double[3]){0}, time);
    return formula_eval(timed->formula, variables, flux, err);
}

double timed_flux_largest(const TimedFlux *timed, double start, double step, int steps, double *flux)
{
    double largest = vec3_length(vec3_load(flux)), now[3];
    int moments = steps < MOMENTS_MAX ? steps : MOMENTS_MAX;
    for (int n = 0; timed_flux_is_given(timed) && n <= moments; n++) {
        if (!timed_flux_eval(timed, start + (double)n / moments * steps * step, now, NULL)) continue;
        if (!(vec3_length(vec3_load(now)) > largest)) continue;
        largest = vec3_length(vec3_load(now));
        memcpy(flux, now, sizeof now);
    }
    return largest;
}
