/* timed.h - three numbers that change in time: a uniform flux density, how far something has moved or turned. */
#pragma once
#include "io/formula.h"
#include "io/table.h"

/* Either a formula of t, or of x, y, z, r, t that uses t only, or rows t, a, b, c with t ascending; or nothing. */
typedef struct Timed {
    Formula *formula;
    int first; /* variable of the formula, of x, y, z, r, t: TIMED_ALL or TIMED_ALONE */
    Table table;
    double add[3]; /* to all of them */
} Timed;

enum { TIMED_ALL = 0, TIMED_ALONE = 4 };

void timed_clear(Timed *timed);

static inline bool timed_is_given(const Timed *timed)
{
    return timed->formula || timed->table.rows > 0;
}

/* Reads and checks a table; columns as in table_read, the first one t. False with a sentence. */
bool timed_read(const char *path, const char *columns, Timed *timed, Error *err);

/* value[3]; between rows of a table linear, before and after it as at its ends. Re-entrant. */
bool timed_eval(const Timed *timed, double time, double *value, Error *err);

/* The largest of those at up to 10 000 of a motion's moments; value[3] stays where there is none larger. */
double timed_largest(const Timed *timed, double start, double step, int steps, double *value);
