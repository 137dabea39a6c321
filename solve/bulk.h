/* bulk.h - an energy of all dofs together, where a Term's small and fixed elements will not do: what acts on
 * what is found from x (close pairs of strokes; ink and the tone that it makes).
 *
 * A Bulk stands beside the Terms of a System and brings value, gradient and Hessian. It is for minimising:
 * there are no products with d2E/dx dp, so no adjoints. */
#pragma once
#include "solve/term.h"
#include <stdbool.h>

/* Where a Bulk puts its Hessian: add() adds block[n][n] at rows row .. row + n - 1 and columns column ..
 * column + n - 1 and, where these are other dofs, its transpose at the transposed place. On the diagonal (row
 * == column) the block is symmetric; else the two ranges of dofs do not meet. */
typedef struct BulkMatrix {
    void (*add)(void *self, int row, int column, int n, const double *block);
    void *self;
} BulkMatrix;

/* Groups of dofs that the Hessian couples, as in sparse_create; the lists belong to the Bulk. */
typedef struct BulkCoupling {
    int group_count;
    const long *start; /* [group_count + 1] */
    const int *dofs;   /* a dof may appear twice in a group */
} BulkCoupling;

typedef struct BulkOps {
    const char *name; /* also the name of its energy in the result */

    /* The energy; adds dE/dx to g and puts d2E/dx2 into H, each where not NULL. A function of `at` alone, but
     * not re-entrant. */
    double (*eval)(void *self, const Point *at, double *g, const BulkMatrix *H);

    /* What eval couples at x, or more. False where the list that was given last still holds all of it: the
     * pattern of the matrix is kept then. */
    bool (*couple)(void *self, const double *x, BulkCoupling *coupling);

    void (*destroy)(void *self);
} BulkOps;

typedef struct Bulk {
    const BulkOps *ops;
    void *self;
} Bulk;
