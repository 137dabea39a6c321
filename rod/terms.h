/* terms.h - the energy terms of a rod. This list is the only place that names them all (with positions, the
 * lumped terms of solve/ come to them: weight, loads, inertia, damping).
 *
 * To add a term: write rod/<name>.c that defines rod_<name>_term() and ends in one private TermOps, and add a
 * row here. */
#pragma once
#include "rod/rod.h"
#include "solve/term.h"

#define ROD_TERMS(X)                                                                                         \
    X(strain, ROD_ANY_FORM)     /* bending and twist, h/2 |k - kbar|_K^2                         */          \
    X(stretch, ROD_STRETCHING)  /* of a Cosserat rod: stretch and shear, h/2 |G|^2               */          \
    X(magnetic, ROD_ANY_FORM)   /* hard-magnetic work -V M.R^T B                                 */          \
    X(hang, ROD_HANGING)        /* weight and dead loads on positions that follow from rotations */          \
    X(link, ROD_WITH_POSITIONS) /* positions are where rotations and strains have them, by multipliers */    \
    X(couple, ROD_WITH_COUPLES) /* couples on nodes, without a potential                         */          \
    X(potential, ROD_WITH_POTENTIALS) /* energies by formulas of the place                       */

/* The rods that have a term: of that form; or, in any form, with such loads. */
typedef enum RodForm {
    ROD_ANY_FORM,
    ROD_STRETCHING,
    ROD_HANGING,
    ROD_WITH_POSITIONS,
    ROD_WITH_COUPLES,
    ROD_WITH_POTENTIALS
} RodForm;

/* What every term of a rod begins with; the rod must outlive it. */
typedef struct RodTerm {
    const Rod *rod;
    RodLayout layout;
    double hold; /* N/m, of the link */
} RodTerm;

typedef Term RodTermCreate(const Rod *rod, RodLayout layout, double hold);

typedef struct RodTermRow {
    const char *name;
    RodTermCreate *create;
    RodForm form;
} RodTermRow;

#define X(name, form) RodTermCreate rod_##name##_term;
ROD_TERMS(X)
#undef X

extern const RodTermRow rod_term_rows[];
extern const int rod_term_row_count;
