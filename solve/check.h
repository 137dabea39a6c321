/* check.h - a Term's derivatives against differences of what they are derivatives of.
 *
 * Errors are relative to the largest entry of the exact quantity over all elements; differences are central, of
 * fourth order, with a step of 1e-3 of a dof's natural size. Tests and `slender check --derivatives` use it. */
#pragma once
#include "base/random.h"
#include "solve/bulk.h"
#include "solve/params.h"

typedef struct TermError {
    double gradient; /* dE/dx against E                                         */
    double hessian;  /* d2E/dx2 against dE/dx                                   */
    double forward;  /* param_forward against dE/dx along a random direction dp */
    double adjoint;  /* w.param_forward(dp) against dp.param(w): exact          */
} TermError;

/* dof_size[i]: natural size of local dof i (an edge length, 1 rad); directions in each block of p are scaled by the
 * block's largest value, or 1. */
TermError check_term(const Term *term, const Params *params, const Point *at, const double *dof_size, Random *random);

/* The same of a Bulk over so many dofs, as a whole: its gradient, and its Hessian with all of its couplings. */
TermError check_bulk(const Bulk *bulk, const Point *at, int dof_count, double dof_size);
