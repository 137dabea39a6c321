/* relax_private.h - what the methods of relaxation share. */
#pragma once
#include "solve/system.h"
#include "spline/relax.h"
#include "spline/terms.h"

typedef struct Relaxation {
    const RelaxDef *def;
    const SplineTarget *target;
    const RelaxObserver *observer; /* may be NULL */
    Strokes *strokes;              /* its q is x  */
    SplineModel *model;
    SplineWeights weights; /* scaled */
    System *sys;           /* terms and Bulks of all weights other than 0 */
    Workers *workers;
    int n; /* dofs */
    RelaxInfo info;
    double started;
} Relaxation;

typedef void RelaxFunction(Relaxation *relaxation);
RelaxFunction relax_descent, relax_newton, relax_monte_carlo, relax_dynamics;

/* The point at x: the weights are the parameters. */
Point relax_point(const Relaxation *relaxation, const double *x);

/* L0 of all segments; the caller frees it. */
double *spline_rest_lengths(const SplineTarget *target, const RelaxDef *def, const Strokes *strokes);

/* Makes the system (again), with these second derivatives. */
void relax_create_system(Relaxation *relaxation, SplineHessian hessian);

/* Takes the energies of the system's last evaluation. */
void relax_take_energies(Relaxation *relaxation);

/* Tells the observer: false when it wants to stop. */
bool relax_tell(Relaxation *relaxation);

/* Energies of the last iterations. */
enum { RELAX_WINDOW = 20 };
typedef struct RelaxPast {
    int count;
    double energy[RELAX_WINDOW];
} RelaxPast;

/* Notes an energy: true when it is less than `window` iterations ago by no more than that part. */
bool relax_has_settled(RelaxPast *past, int window, double energy, double tolerance);

typedef struct DescentDef {
    int memory, refresh, max_iterations;
    int window; /* <= RELAX_WINDOW iterations, over which energy_tol is */
    double energy_tol, gradient_tol;
    bool tell; /* the observer, of each iteration */
} DescentDef;

/* Minimises the system's energy from x on by L-BFGS, with the other members of `at`. Counts go to the info.
 */
RelaxStatus relax_minimize(Relaxation *relaxation, const DescentDef *def, const Point *at, double *x);

/* 1/(2 dt^2) (q - x_prev - dt v_prev).M (q - x_prev - dt v_prev) + damping/(2 dt) (q - x_prev).M (q -
 * x_prev), M the mass matrix of strokes of mass L0 per segment: implicit Euler minimises it with the energy.
 * Nothing where dt = 0. */
Term spline_inertia_term(const SplineModel *model, double damping);

/* v.M v/2 */
double spline_kinetic_energy(const SplineModel *model, const double *v);

/* No energy; keeps each stroke within that distance of where it was accepted last. */
Term spline_leash_term(const SplineModel *model, double length);
