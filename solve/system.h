/* system.h - a sum of Terms (and of Bulks) over n dofs, some of them fixed: energy, gradient, Hessian, factor, solve, and
 * the two products with d2E/dx dp.
 *
 * Vectors over dofs (x, g, w) always have all dof_count entries; fixed dofs keep their x, and solves leave zero
 * there. The terms are owned. Sums are taken in a fixed order: the same input gives the same bits. */
#pragma once
#include "base/workers.h"
#include "solve/bulk.h"
#include "solve/sparse.h"
#include "solve/state.h"

/* Dofs of one kind, which lie together: positions in metres, edge angles in radians. */
typedef struct DofClass {
    int first, count;
    double size; /* a large change of such a dof: the body's diagonal, or 1 rad; INFINITY: of no interest */
    bool multipliers; /* Lagrange multipliers: the energy is the others' plus theirs times what must vanish */
    double force;     /* of multipliers, N: they change by so much in an iteration while what must vanish is
                       * far from it (system_gap); 0: it always vanishes */
} DofClass;

enum { SYSTEM_MAX_CLASSES = 5, SYSTEM_MAX_BULKS = 4 };

typedef struct System System;

/* The first class are the positions, or what stands for them. classes are copied. Dofs in no class are no unknowns: to be
 * fixed. */
System *system_create(int dof_count, const DofClass *classes, int class_count);
void system_destroy(System *sys);

void system_add(System *sys, Term term);

/* What a Bulk couples may change with x. Products with d2E/dx dp leave Bulks out. */
void system_add_bulk(System *sys, Bulk bulk);
void system_fix(System *sys, int dof);

/* The order in which unknowns are eliminated: all dofs, fixed ones are passed over. Before system_prepare; else an order
 * for low fill is found. For chains, and needed with multipliers (SparseDef). */
void system_set_order(System *sys, const int *order);

/* Which direct solver factors it. Before its matrix is built. */
void system_set_direct(System *sys, DirectKind direct);

/* base shift, in parts of each class's mean diagonal, that is always added: 1e-10 for bodies with free rigid motions
 * in statics, else 0 (physics: a zero eigenvalue decides nothing). */
void system_set_base_shift(System *sys, double base);

/* Evaluations, factors and solves are shared out to these threads, from now on (borrowed; NULL: the calling one does
 * all). No bit depends on them. */
void system_set_workers(System *sys, Workers *workers);

/* After the last add and fix: numbers the unknowns. Matrix and patches are built when they are needed. */
void system_prepare(System *sys);

/* Builds them now; once. */
void system_build(System *sys);

int system_dof_count(const System *sys);
int system_free_count(const System *sys);
int system_multiplier_count(const System *sys);
bool system_is_multiplier(const System *sys, int dof);
bool system_is_fixed(const System *sys, int dof);
double system_base_shift(const System *sys);
int system_term_count(const System *sys);
const Term *system_term(const System *sys, int t);

/* The point as that term sees it: of memory its own part. */
Point system_term_point(const System *sys, int t, const Point *at);

int system_bulk_count(const System *sys);
const Bulk *system_bulk(const System *sys, int b);

/* Largest |d_i| over the class's size, over all classes: the length of a step in the body's own measure. */
double system_step_size(const System *sys, const double *d);

/* Energies of the elements of term t, energy[count of the term]; NULL for the sum only. */
double system_term_energy(System *sys, int t, const Point *at, double *energy);

typedef struct Evaluation {
    double energy;       /* J                                                                           */
    double energy_scale; /* sum of |energy| over the terms: what round-off is relative to               */
    double gradient_max; /* largest |dE/dx| of the free position dofs, N                                */
    double force_scale;  /* largest sum of |element force| over the position dofs, N (with the gradient) */
    bool finite;         /* false where any number asked for is not                                     */
} Evaluation;

Evaluation system_energy(System *sys, const Point *at);

/* Of the last gradient: at each dof the sum of |element force|, what rounding of the gradient is relative to. */
const double *system_force_sums(const System *sys);

/* gradient[dof_count], at fixed dofs too (there it is the support's force on the body). */
Evaluation system_gradient(System *sys, const Point *at, double *gradient);

/* The same, and assembles the Hessian of the free dofs. */
Evaluation system_hessian(System *sys, const Point *at, double *gradient);

/* Of the last evaluation: the energy of each term, and after these of each Bulk. */
const double *system_energies(const System *sys);

/* How far what must vanish is from it at the last Hessian, m; 0: less than 1e-10 of the body, or no class has a
 * `force`. Such a class's multipliers are regularised: as if what they hold gave way by a compliance c, m/N, which the
 * matrix has as -c on their diagonal. It is the gap over the force (the class's and their own), and at least 1e-10 of
 * the body's size over it: then solutions are those without it, for Newton's right-hand sides know nothing of it, but
 * there is one for multipliers that nothing depends on, as the axial force in a straight inextensible rod. */
double system_gap(const System *sys);
double system_compliance(const System *sys, int dof);

/* The largest change of such a multiplier in a step, in parts of that force. */
double system_force_change(const System *sys, const double *step);

/* x[dof_count] of the last Hessian. */
const double *system_linearised(const System *sys);

/* Factor of H + (base + shift) D, D = each class's mean |H_ii|. False where not positive definite; with multipliers, where
 * not so on what they allow. */
bool system_factor(System *sys, double shift);

/* Factor of H + sigma M with M on the diagonal of the free positions only, M[position_count] (NULL: 1, and sigma N/m), and the
 * base shift on the other dofs only: nothing else may hold them (a rod on hinges spins, and turns have no mass). Multipliers are
 * regularised as above (a straight rod between hinges). For eigen.h. */
bool system_factor_positions(System *sys, double sigma, const double *M);

/* Of the last factor, where it is known (not of one that was shared); else 0. */
double system_shift(const System *sys);

/* y = (H + (base + shift) D)^-1 b with the last factor. */
void system_solve(System *sys, const double *b, double *y);

/* Solves H y = b, H the last Hessian, by conjugate gradients with the last factor, of a Hessian nearby, as
 * preconditioner; less than 0: not reached in max_iterations, no usable factor, or H not positive definite
 * (SPARSE_INDEFINITE, sparse.h). */
int system_solve_cg(System *sys, const double *b, double tolerance, int max_iterations, double *y);

/* The last factor, shared (direct.h: factor_release); and one made the last one again, of whatever pattern. NULL, or one of
 * another size: there is none from now on. */
Factor *system_share_factor(System *sys);
void system_use_factor(System *sys, Factor *factor);

/* What the last factor depends on beside p, in system_anchor_count() numbers: with it, and with p of its time,
 * system_restore_factor makes the same factor again, bit by bit; or none, where there was no usable one. */
int system_anchor_count(const System *sys);
const double *system_anchor(const System *sys);
double system_anchor_time(const double *anchor);
void system_restore_factor(System *sys, const double *anchor, const double *p);

/* y = H v, unshifted. */
void system_multiply(const System *sys, const double *v, double *y);

/* The diagonal D of the last Hessian, D[dof_count], 0 at fixed dofs; and the largest H_ii of the positions. */
const double *system_scale(const System *sys);
double system_stiffness_max(const System *sys);

/* Dofs of the first class, and D of it, N/m. */
int system_position_count(const System *sys);
double system_scale_mean(const System *sys);

/* dp += w^T d2E/dx dp. */
void system_param(System *sys, const Point *at, const double *w, double *dp);

/* r = d2E/dx dp . dp, r[dof_count]. */
void system_param_forward(System *sys, const Point *at, const double *dp, double *r);

/* dx, dv -= w^T d2E/dx d(x_prev, v_prev), and r += d2E/dx d(x_prev, v_prev) . (dx, dv); all [dof_count]. Where lagged
 * quantities are taken at x_prev (at->x_lag is NULL), with what depends on it through them. */
void system_prev(System *sys, const Point *at, const double *w, double *dx, double *dv);
void system_prev_forward(System *sys, const Point *at, const double *dx, const double *dv, double *r);

/* dx += w^T d2E/dx dx_lag, and r += d2E/dx dx_lag . dx; all [dof_count]. False from system_lags: no term lags anything. */
void system_lag(System *sys, const Point *at, const double *w, double *dx);
void system_lag_forward(System *sys, const Point *at, const double *dx, double *r);
bool system_lags(const System *sys);

/* r += S d, the skew part of the derivative of forces without potential (TermOps.circulate); r[dof_count]. False from
 * system_circulates: all have one. */
void system_circulate(System *sys, const Point *at, const double *d, double *r);
bool system_circulates(const System *sys);

/* to = where the motion from x with velocity d is after the time a: x + a d, or what the terms make of it (TermOps.follow).
 * False from system_has_follow: no term makes anything of it. */
void system_follow(System *sys, const double *x, const double *d, double a, double *to);
bool system_has_follow(const System *sys);

/* Does a term heed Point.convex, with the elements at hand? */
bool system_convexes(const System *sys);

/* Is the body turned inside out or flat somewhere (TermOps.tangles)? */
bool system_tangles(const System *sys, const Point *at);

/* The largest part of a step d from at->x that the terms admit, in (0, 1] (TermOps.reach). */
double system_reach(System *sys, const Point *at, const double *d);

/* Has something gone through the body in the step of time, solved, that ends at->x (TermOps.passes)? */
bool system_passes(const System *sys, const Point *at);

/* Makes x, a trial reached from `from`, admissible; and x an accepted one, of which memory[system_memory_count()] notes
 * what must be remembered. Both may write to x (TermOps). */
void system_project(const System *sys, const double *from, double *x);
void system_accept(const System *sys, double *x, double *memory);

/* A State of the system's size: x and v are 0, memory as at rest. Caller: state_destroy. */
State system_state(const System *sys);
int system_memory_count(const System *sys);

/* Of the matrix at hand: all 0 before it is built. */
SparseInfo system_info(const System *sys);

/* What a factor will cost, from the pattern alone, which is ordered, analysed and let go. */
SparseInfo system_cost(const System *sys);
