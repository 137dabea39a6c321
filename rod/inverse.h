/* inverse.h - the one natural shape that sags into a given curve, clamped at its first end [Hafner 2021 after
 * the errata of docs/theory.md; the frame-free form is ours], and free at the other one, or held by a known force and
 * couple.
 *
 * What hangs beyond a station pulls on it with the moment M(s) = int_s^L (x(u) - x(s)) x p du, a plain
 * integral. The curve is in equilibrium if its strains differ from the natural ones by K^-1 R^T M; so a
 * material frame of the natural shape turns against the same frame of the curve by Q' = Q [w]x, w = -R K^-1
 * R^T M, and the natural curve is xbar' = Q t. For a circular section no frame is needed at all: w =
 * -(M_across/EI + M_along/GJ). Fourth order. Sections are those of the stations, [2 elements + 1], with Young's modulus. */
#pragma once
#include "rod/frame.h"
#include "rod/section.h"

typedef struct RodPointLoad {
    double s;    /* arclength, m                       */
    Vec3 force;  /* N                                  */
    Vec3 couple; /* N m, of the world as the force is  */
} RodPointLoad;

/* All dead. A rod that is magnetised along its tangent by m (A m^2 per metre) in a uniform flux density B
 * feels the couple m t x B, which is that of a force m B at its end. */
typedef struct RodLoads {
    Vec3 line;       /* weight and what else pulls on each metre, N/m, the same all along          */
    Vec3 end;        /* at the last end, N: of what holds it, too                                  */
    Vec3 end_couple; /* there, N m                                                                 */
    const Vec3
        *along; /* [stations] what varies from metre to metre beside line, N/m; NULL: nothing; borrowed */
    int point_count;
    const RodPointLoad *points; /* borrowed */
} RodLoads;

/* What inertia and drag of a moving rod are as loads, along[stations]: -mass a - drag v (kg/m, N s/m^2), by its places at
 * three times, curves of as many elements. The acceleration is their second difference: of second order for the middle one
 * where steps are even; and for the last one just what implicit Euler took it for. `at`, 1 or 2, says whose it is. */
void rod_inertia(const RodCurve *const curves[3], const double time[3], int at, RodSections sections,
                 double drag, Vec3 *along);

/* M at all stations, N m. Fourth order; second order in an element that a point load acts within. A couple makes M
 * jump: nodes have what it is on their own side of the couple (one at a node is beyond those before it, one at the end beyond
 * all), and the middle of the element that the couple acts in what makes Simpson's rule over it exact. */
void rod_moments(const RodCurve *curve, RodLoads loads, Vec3 *moment);

/* T = what pulls beyond, at each element's start, middle and end, pull[3 elements]: point loads make it jump
 * at nodes. */
void rod_pulls(const RodCurve *curve, RodLoads loads, Vec3 *pull);

/* natural[elements + 1]: the natural shape's nodes, from the curve's first place and tangent on.
 * frames[stations] tell where the section's axes are; NULL for a section that bends alike in all directions.
 */
void rod_invert(const RodCurve *curve, RodSections sections, const Vec3 *moment, const RodFrame *frames,
                Vec3 *natural);

/* The curve's own strains (twist, k1, k2) in the given frames, at all stations, 1/m. */
void rod_strains(const RodCurve *curve, const RodFrame *frames, Vec3 *strains);

/* Natural strains (twist, k1, k2) in the given frames, at all stations, 1/m: those of the curve less K^-1 R^T
 * M. */
void rod_natural_strains(const RodCurve *curve, RodSections sections, const Vec3 *moment,
                         const RodFrame *frames, Vec3 *strains);

/* Natural strains in frames that do not twist where the rod is unloaded, from those in any frames with the same n1 at the
 * clamp: one and the same for every equilibrium of a round rod, whatever frames each was seen in. All stations. */
void rod_untwist(const RodCurve *curve, Vec3 *strains);

/* What a support at the last end does where it is not known. */
typedef enum RodEndChoice {
    ROD_STRAIGHTEST,    /* so that the natural shape bends least: int k1^2 + k2^2 ds of its natural strains */
    ROD_LEAST_STRESSED, /* so that the rod stores the least energy: int M.K^-1 M ds                           */
} RodEndChoice;

/* Puts that force and couple (of a hinge: the force alone) into loads->end, beside what is there, and end_couple: least
 * squares; what makes no difference, or 1e-12 of the most that something makes, is zero. */
void rod_choose_end(const RodCurve *curve, RodSections sections, const RodFrame *frames, RodEndChoice choice,
                    bool hinge, RodLoads *loads);

/* Natural strains less the curve's by the way of eq. (10) of the paper, an equation in the frames alone that is integrated
 * from the free end, for the moment in place of the strain, whatever the sections: an independent check. */
void rod_strain_route(const RodCurve *curve, RodSections sections, RodLoads loads, const RodFrame *frames,
                      Vec3 *difference);
