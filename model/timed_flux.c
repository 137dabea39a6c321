#include "model/timed_flux.h"
#include "model/build.h"

enum { COLUMNS = 4 }; /* t, Bx, By, Bz */

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
