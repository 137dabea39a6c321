/* check.h - a Term's derivatives against differences of what they are derivatives of.
 *
 * Errors are relative to the largest entry of the exact quantity over all elements; differences are central, of
 * fourth order, with a step of 1e-3 of a dof's natural size. Tests and `slender check --derivatives` use it.
 *
 * Nothing passes because it is not there: param, param_forward, prev, prev_forward, lag and lag_forward that are NULL
 * count as products of 0, so that a force that does depend on p, or on the start of the step, is an infinite error; so is a term whose
 * energy, gradient and Hessian are all 0. */
#pragma once
#include "base/random.h"
#include "solve/bulk.h"
#include "solve/params.h"

typedef struct TermError {
    bool idle;           /* all was 0: its gradient's error is infinite                          */
    double gradient;     /* dE/dx against E                                                      */
    double hessian;      /* d2E/dx2 against dE/dx                                                */
    double forward;      /* param_forward against dE/dx along a random direction dp              */
    double adjoint;      /* w.param_forward(dp) against dp.param(w): exact                       */
    double prev_forward; /* prev_forward against dE/dx along a random direction (dx_prev, dv_prev) */
    double prev;         /* w.prev_forward(d) against d.prev(w): exact                           */
    double lag_forward;  /* lag_forward against dE/dx along a random direction dx_lag            */
    double lag;          /* w.lag_forward(d) against d.lag(w): exact                             */
} TermError;

/* dof_size[i]: natural size of local dof i (an edge length, 1 rad); directions in each block of p are scaled by the
 * block's largest value, or 1. The step of time is at->dt, or 1 s where that is 0; its start, and where lagged quantities are
 * taken, are chosen at random within a dof's size of x, whatever at->x_prev, v_prev and x_lag say. dof_count: of x. A term whose elements change has those of that
 * start; what begins or ends with its elements must do so smoothly. */
TermError check_term(const Term *term, const Params *params, const Point *at, int dof_count,
                     const double *dof_size, Random *random);

/* The largest of the errors that differences show, and of the exact ones. */
double check_differences(TermError error);
double check_products(TermError error);

/* The same of a Bulk over so many dofs, as a whole: its gradient, and its Hessian with all of its couplings. */
TermError check_bulk(const Bulk *bulk, const Point *at, int dof_count, double dof_size);
