/* objectives.h - what a design may want: rows of functions of vertex positions (three dofs per vertex, first
 * in x) and of controls. All that is passed is copied. They count at frame 0 until told otherwise
 * (Objective.first, .last). */
#pragma once
#include "optim/control.h"
#include "optim/probe.h"
#include "solve/objective.h"
#include <stdbool.h>

/* sum over the listed vertices of |x_v - target_v|^2, m^2; coordinates whose target is NAN do not count. */
Objective objective_target(int count, const int *vertices, const double (*target)[3], double weight);

/* Points that are to lie on the body's line, which is made of segments between its vertices. */
typedef struct PointCloud {
    int segment_count, point_count;
    int (*segments)[2];
    double (*points)[3]; /* m; coordinates that are NAN (of all points alike) do not count */
    double blend;        /* m, > 0 */
} PointCloud;

/* sum over the points of the squared distance to the body's line, m^2: that to the nearest segment, blended between
 * segments as objective_polyline does. Each POINT has its distance, not each vertex: points are measured, with an error of
 * their own, so that the sum is that of orthogonal least squares, which errors of zero mean do not bias; how finely the body
 * is divided, and which part of it the points show, changes nothing. */
Objective objective_cloud(const PointCloud *cloud, double weight);

/* Mean height (z) of the listed vertices, m; no sum of squares. Or the square of its difference to one, m^2. */
Objective objective_height(int count, const int *vertices, double weight);
Objective objective_height_at(int count, const int *vertices, double at, double weight);

/* |q - at|^2, m^2, q the point of the probe. */
Objective objective_waypoint(const Probe *probe, const double at[3], double weight);

/* The squared distance of q to a polyline of count >= 2 points: that to the nearest segment, blended between
 * segments whose squared distances differ by less than blend^2 (their mean with weights exp(-d^2/blend^2)),
 * so that the gradient has no jump where two segments meet. blend > 0, m. */
Objective objective_polyline(const Probe *probe, int count, const double (*points)[3], double blend,
                             double weight);

/* The squared distance of q to the arc from points[0] through points[1] to points[2], which are not on one
 * line. */
Objective objective_arc(const Probe *probe, const double points[3][3], double weight);

/* Distance of q to a waypoint or to the curve of a polyline or an arc, m; NAN for other rows. */
double objective_distance(const Objective *objective, const double *x, const double *p);

/* Where q is; false for rows without one. */
bool objective_point(const Objective *objective, const double *x, const double *p, double q[3]);

/* What q is to meet: its place, or its curve's points, of an arc those of OBJECTIVE_CHORDS chords. The caller frees; NULL and
 * count 0 for rows without one. */
enum { OBJECTIVE_CHORDS = 128 };
double (*objective_reference(const Objective *objective, int *count))[3];

/* Of a control B: sum over the steps of |B_n|^2, and of |B_n - B_{n-1}|^2 from the second step on. */
Objective objective_field_magnitude(const Control *control, double weight);
Objective objective_field_smoothness(const Control *control, double weight);

/* sum over steps n and components i of (B_n,i - sum_j alpha_ji cos(w_j t_n) + beta_ji sin(w_j t_n))^2 with
 * w = p[omega ..][pairs], alpha = p[alpha ..][pairs][3], beta likewise: keeps a field near few frequencies,
 * which are unknowns too [Chen 2022, after eq. 44; alpha and beta with an index i of their own]. */
Objective objective_dmp(const Control *control, int pairs, int omega, int alpha, int beta, double weight);

/* Where they begin, into p: the first harmonics of the whole time, amplitudes as they fit the control best. */
void objective_dmp_start(const Control *control, int pairs, int omega, int alpha, int beta, double *p);
