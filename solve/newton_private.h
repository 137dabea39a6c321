/* newton_private.h - what newton.c (steps), newton_saddle.c (ways out of a saddle) and newton_gap.c (what Lagrange
 * multipliers hold) share. */
#pragma once
#include "base/vector.h"
#include "solve/newton.h"

typedef struct Search {
    System *sys;
    const NewtonDef *def;
    int n;
    State *state;
    Point at;                       /* of the state                                            */
    double *x, *gradient, *step;    /* [n]; x is the state's                                   */
    double *trial, *trial_gradient; /* [n]                                                     */
    double *mode, *product;         /* [n] direction of lowest curvature, kept between uses    */
    bool mode_known;
    bool follows;         /* steps go the way that the terms know (system_follow)       */
    bool circulates;      /* there are forces without a potential (TermOps.circulate)   */
    bool plain;           /* and steps are taken without shift and line search          */
    bool extrapolate;     /* the last step was long: */
    double *from, *moved; /* [n] where it began, and what it was                        */
    double *gap, *change; /* [n] of multipliers: what is to vanish; Newton's step                         */
    bool open;            /* a held end is so far off that forces change by much (gap_take_multipliers) */
    int tangled; /* iterations left without negative parts, if it starts inside out (TermOps.tangles) */
    bool convex; /* the step is by the convex part of what terms have one (Point.convex)     */
    double shift, shift_kept; /* in use; remembered                                      */
    double least_step;        /* so far, body's measure                                  */
    int unhalved;             /* iterations in a row that did not halve it: rounding     */
    double least_force[2];    /* of the first half of the iterations, and of the second      */
    int shifted;              /* iterations in a row that needed one                     */
    Evaluation now;
    NewtonInfo info;
} Search;

/* Factor of the last Hessian with a shift; counted. */
bool search_factor(Search *s, double shift);

/* Energy after a step of a times a direction, which is left in trial; infinite where it is not finite. */
double search_energy(Search *s, const double *direction, double a, Evaluation *evaluation);

/* Takes such a step. */
void search_move(Search *s, const double *direction, double a);

/* Leaves along negative curvature where there is some. Returns true when the iteration is decided: a step was taken, or
 * there is none and *status says what kind of point this is. */
bool search_leave_saddle(Search *s, bool small, double floor, NewtonStatus *status);

/* ---- What Lagrange multipliers hold (newton_gap.c); nothing where there are none ---- */

/* After Newton's step has been found: notes what must vanish and does not, and whether the step changes forces by much on
 * its account (open). */
void gap_note(Search *s);

/* Lagrange multipliers take their whole step at once; the line search is for the other dofs, with the energy and the forces
 * that belong to the new multipliers. While the gap is open, these are what the gap over the compliance makes of them, and
 * the step is theirs afterwards, as far as the others go along it (gap_keep_multipliers). */
void gap_take_multipliers(Search *s);
void gap_keep_multipliers(Search *s, double part);

/* While the gap is open, what the multipliers hold is as if it stood still and gave way by the compliance c, and with
 * the gap g the energy gains sum (g - g_0)^2/(2 c): that is an augmented Lagrangian, whose Newton direction the regularised
 * matrix gives, so that it falls along it. Of the trial's gradient; its pull, added to the trial's multipliers; and the
 * curvature that it adds along the mode, whose product with the Hessian is at hand. */
double gap_energy(const Search *s);
void gap_pull(Search *s);
double gap_curvature(const Search *s);

/* Does the last of the gap close at the trial? The energy does not tell any more, and along no other way would it be lower. */
bool gap_falls(const Search *s);
