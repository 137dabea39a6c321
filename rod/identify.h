/* identify.h - what a rod is made of, from two or more poses of it: Young's modulus, its radius or its density, and
 * Poisson's ratio.
 *
 * A pose is a measured equilibrium of the same rod under the same known loads, held at its first end in
 * another orientation. Whatever EI and GJ are taken to be, each pose has one natural shape (inverse.h); seen
 * from the clamp the shapes of all poses are one and the same only for the right pair. Sought is the least
 * mean square distance of the shapes from their mean, over the log of what is sought and Poisson's ratio in [-0.9, 0.5]: a
 * scan over six decades around load L^2 = EI, judged by that distance over the size of the shapes (a rod
 * taken for far too soft curls up, and its shapes are close because they are small), then damped Gauss-Newton
 * from the best places.
 *
 * What the poses tell is EI over the loads, and GJ/EI = 1/(1 + nu): of Young's modulus, radius and density two must be
 * known. Twisting moments are what tells nu. */
#pragma once
#include "rod/inverse.h"

typedef struct RodPose {
    const RodCurve *curve; /* borrowed; all of about the same length, with the same number of elements */
    RodFrame clamp;        /* material frame at its start, of the same section in all poses; made
                              orthonormal                                                            */
    const RodCurve *draws; /* [draw_count] borrowed: what it might have been measured as instead, by
                              noise alone; NULL: it is exact                                         */
    const Vec3 *along;     /* [stations] N/m, loads that vary along it, and after these along each of its
                              draws; NULL: none; borrowed                                            */
} RodPose;

typedef enum RodSought { ROD_SOUGHT_YOUNG, ROD_SOUGHT_RADIUS, ROD_SOUGHT_DENSITY } RodSought;

typedef struct RodIdentifyDef {
    const RodPose *poses;
    int pose_count, draw_count;
    RodSought sought;
    double young, radius, density; /* Pa, m, kg/m^3; the sought one is not read        */
    double poisson;                /* NAN: sought, too                                 */
    Vec3 gravity;                  /* m/s^2                                            */
    RodLoads loads;       /* beside weight and field, in all poses, but for what varies along them; points
                             beyond a pose's end act there                                              */
    double magnetization; /* along the tangent, A/m                           */
    Vec3 flux_density;    /* T                                                */
} RodIdentifyDef;

/* Standard errors say how far the values move from draw to draw of the poses' noise, by the slopes at the optimum; more
 * where the distance that is left is more than noise leaves. Without draws they follow from that distance, of which each
 * pose beyond the first counts as three residuals (what noise does to a shape is mostly one slow drift). INFINITY where the poses do not tell. The condition is that of
 * the slopes by (log value, nu): their largest singular value over the least, how much less the poses tell of the worst
 * mix of the two than of the best one; 1 where nu was given. */
typedef struct RodMaterial {
    double value, error;           /* of what is sought, in its unit; NAN where the poses do not tell */
    double poisson, poisson_error; /* the same; of a given one the error is 0                         */
    bool known, poisson_known;     /* the error is below a third of the value, 0.3 of nu              */
    bool poisson_at_limit;         /* the best value lies beyond [-0.9, 0.5]                          */
    double condition;
    double distance; /* of the natural shapes from their mean, rms, m */
    int iterations;
    bool converged; /* else all iterations were done before the best match was found */
} RodMaterial;

/* Of a round rod where what is sought has that value. */
RodSection rod_identify_section(const RodIdentifyDef *def, double value, double poisson);

/* All that acts on it in a pose. */
RodLoads rod_identify_loads(const RodIdentifyDef *def, int pose, double value);

/* Can the poses be of one rod? False and a sentence where they cannot: fewer than two, other element counts, lengths
 * that differ by more than 2 %, frames that are not orthonormal and right-handed to 0.02 or whose tangent is 30 degrees
 * or more off the curve's; without loads, or without gravity where density is sought. */
bool rod_identify_check(const RodIdentifyDef *def, Error *err);

/* Of poses that pass the check. */
RodMaterial rod_identify(const RodIdentifyDef *def);
