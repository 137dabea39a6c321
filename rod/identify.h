/* identify.h - Young's modulus and Poisson's ratio of a rod from two or more poses of it.
 *
 * A pose is a measured equilibrium of the same rod under the same known loads, held at its first end in
 * another orientation. Whatever EI and GJ are taken to be, each pose has one natural shape (inverse.h); seen
 * from the clamp the shapes of all poses are one and the same only for the right pair. Sought is the least
 * mean square distance of the shapes from their mean, over log E and Poisson's ratio in [-0.9, 0.5]: a scan
 * over six decades of E around load L^2 = EI, judged by that distance over the size of the shapes (a rod
 * taken for far too soft curls up, and its shapes are close because they are small), then damped Gauss-Newton
 * from the best places.
 *
 * What the poses tell is EI over the loads, and GJ/EI = 1/(1 + nu): radius and weight must be
 * known. Twisting moments are what tells nu. */
#pragma once
#include "rod/inverse.h"

typedef struct RodPose {
    const RodCurve *curve; /* borrowed; all of about the same length, with the same number of elements */
    RodFrame clamp;        /* material frame at its start, of the same section in all poses; made
                              orthonormal                                                            */
    const Vec3 *along;     /* [stations] N/m, loads that vary along it; NULL: none; borrowed           */
} RodPose;

typedef struct RodIdentifyDef {
    const RodPose *poses;
    int pose_count;
    double radius;  /* m */
    RodLoads loads; /* in all poses: weight, and what else pulls; points beyond a pose's end act there */
} RodIdentifyDef;

typedef struct RodMaterial {
    double young, poisson;             /* Pa; NAN where the poses do not tell                        */
    double young_error, poisson_error; /* standard errors, from the distance that is left: what noise does
                                          to a shape is mostly one slow drift, so that each pose beyond
                                          the first counts as three residuals, whatever its samples.
                                          INFINITY where the poses do not tell                       */
    bool young_known, poisson_known;   /* the standard error is below a third of E, 0.3 of nu        */
    bool poisson_at_limit;             /* the best value lies beyond [-0.9, 0.5]                     */
    double distance;                   /* of the natural shapes from their mean, rms, m              */
    int iterations;
    bool converged; /* else all iterations were done before the best match was found */
} RodMaterial;

/* Can the poses be of one rod? False and a sentence where they cannot: fewer than two, other element counts, lengths
 * that differ by more than 2 %, frames that are not orthonormal and right-handed to 0.02 or whose tangent is 30 degrees
 * or more off the curve's; or without loads. */
bool rod_identify_check(const RodIdentifyDef *def, Error *err);

/* Of poses that pass the check. */
RodMaterial rod_identify(const RodIdentifyDef *def);
