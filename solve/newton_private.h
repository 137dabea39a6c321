/* newton_private.h - what newton.c (steps) and newton_saddle.c (ways out of a saddle) share. */
#pragma once
#include "solve/newton.h"

typedef struct Search {
    System *sys;
    const NewtonDef *def;
    int n;
    Point at;                       /* at.x is x                                               */
    double *x, *gradient, *step;    /* [n]                                                     */
    double *trial, *trial_gradient; /* [n]                                                     */
    double *mode, *product;         /* [n] direction of lowest curvature, kept between uses    */
    bool mode_known;
    bool follows;         /* steps go the way that the terms know (system_follow)       */
    bool extrapolate;     /* the last step was long: */
    double *from, *moved; /* [n] where it began, and what it was                        */
    double shift, shift_kept; /* in use; remembered                                      */
    int shifted;              /* iterations in a row that needed one                     */
    Evaluation now;
    NewtonInfo info;
} Search;

static inline double search_dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += a[i] * b[i];
    return sum;
}

/* Factor of the last Hessian with a shift; counted. */
bool search_factor(Search *s, double shift);

/* Energy after a step of a times a direction, which is left in trial; infinite where it is not finite. */
double search_energy(Search *s, const double *direction, double a, Evaluation *evaluation);

/* Takes such a step. */
void search_move(Search *s, const double *direction, double a);

/* Leaves along negative curvature where there is some. Returns true when the iteration is decided: a step was taken, or
 * there is none and *status says what kind of point this is. */
bool search_leave_saddle(Search *s, bool small, double floor, NewtonStatus *status);
