#include "field/timed.h"
#include "base/vec3.h"
#include <string.h>

enum {
    VARIABLES_MAX = 5,  /* x, y, z, r, t */
    COLUMNS = 4,        /* t and three numbers            */
    MOMENTS_MAX = 10000 /* at which a motion is looked at */
};

void timed_clear(Timed *timed)
{
    formula_destroy(timed->formula);
    table_clear(&timed->table);
    timed->formula = NULL;
}

bool timed_read(const char *path, const char *columns, Timed *timed, Error *err)
{
    if (!table_read(path, columns, &timed->table, err)) return false;
    if (table_check_increasing(&timed->table, path, "t", err)) return true;
    table_clear(&timed->table);
    return false;
}

static void interpolate(const Table *table, double time, double *value)
{
    int row = 0;
    while (row + 1 < table->rows && table->values[COLUMNS * (row + 1)] <= time) row++;
    const double *low = table->values + COLUMNS * row, *high = row + 1 < table->rows ? low + COLUMNS : low;
    double part = high > low && time > low[0] ? (time - low[0]) / (high[0] - low[0]) : 0;
    for (int i = 0; i < 3; i++) value[i] = low[1 + i] + part * (high[1 + i] - low[1 + i]);
}

bool timed_eval(const Timed *timed, double time, double *value, Error *err)
{
    double variables[VARIABLES_MAX] = {0};
    variables[VARIABLES_MAX - 1] = time;
    if (!timed->formula)
        interpolate(&timed->table, time, value);
    else if (!formula_eval(timed->formula, variables + timed->first, value, err))
        return false;
    for (int i = 0; i < 3; i++) value[i] += timed->add[i];
    return true;
}

double timed_largest(const Timed *timed, double start, double step, int steps, double *value)
{
    double largest = vec3_length(vec3_load(value)), now[3];
    int moments = steps < MOMENTS_MAX ? steps : MOMENTS_MAX;
    for (int n = 0; timed_is_given(timed) && n <= moments; n++) {
        if (!timed_eval(timed, start + (double)n / moments * steps * step, now, NULL)) continue;
        if (!(vec3_length(vec3_load(now)) > largest)) continue;
        largest = vec3_length(vec3_load(now));
        memcpy(value, now, sizeof now);
    }
    return largest;
}
