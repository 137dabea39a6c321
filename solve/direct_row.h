/* direct_row.h - what a direct solver is: a row of the table in direct.c, which does all that they share. */
#pragma once
#include "solve/direct.h"

/* What a row keeps of a pattern, and the numbers of one factor, are known to it alone. */
typedef struct DirectRow {
    const char *version;       /* "CHOLMOD 3.0.14"; NULL: not in this program   */
    bool spread;               /* over all processes of the run (ranks.h)       */
    bool (*ready)(Error *err); /* is there all that it needs? NULL: there is    */

    /* Of a pattern, as in direct_analyse. */
    void *(*analyse)(const Pattern *pattern, int negative);
    void (*forget)(void *analysis);
    DirectCost (*cost)(const void *analysis);

    /* Numbers to come: in the memory of others, of whatever analysis (both may be NULL), which are gone then. */
    void *(*make_room)(void *analysis, void *other_analysis, void *other);
    void (*drop)(void *analysis, void *numbers);

    /* As direct_factor, of finite values; and as factor_solve. */
    bool (*factor)(void *analysis, const Pattern *pattern, double *values, void *numbers, Workers *workers);
    const double *(*solve)(void *analysis, void *numbers, const double *b, Workers *workers);
} DirectRow;

extern const DirectRow direct_cholmod, direct_mumps;
