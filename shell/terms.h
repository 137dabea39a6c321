/* terms.h - the energy terms of a shell. This list is the only place that names them all.
 *
 * To add a term: write shell/<name>.c that defines shell_<name>_term() and ends in one private TermOps, and add a row
 * here. System, adjoint, derivative tests and result file then know it (docs/adding_a_term.md). */
#pragma once
#include "shell/shell.h"
#include "solve/term.h"

#define SHELL_TERMS(X)                                                                                       \
    X(membrane) /* in-plane St. Venant-Kirchhoff stretch           [Chen 2022, eqs. 18, 22] */               \
    X(bending)  /* shape operator from dihedral and edge angles    [Chen 2022, eqs. 19, 23] */               \
    X(magnetic) /* hard-magnetic work -A h (F M).B                 [Chen 2022, eq. 24]      */               \
    X(gravity)  /* weight of the lumped masses                     [Chen 2022, eq. 25]      */               \
    X(load)     /* dead loads on the vertices                                               */

/* The term borrows the shell; the caller owns the result and passes it to system_add(). */
typedef Term ShellTermCreate(const Shell *shell);

#define X(name) ShellTermCreate shell_##name##_term;
SHELL_TERMS(X)
#undef X

typedef struct ShellTermRow {
    const char *name;
    ShellTermCreate *create;
} ShellTermRow;

extern const ShellTermRow shell_term_rows[];
extern const int shell_term_row_count;

/* Of the bending term, at the point as it sees it (system_term_point): how far the three edges of each face are turned,
 * theta - rest theta + 2 s alpha (bending.c), rad; turn[face][3]. */
void shell_bending_turns(const Term *bending, const Point *at, double (*turn)[3]);
