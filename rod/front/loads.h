/* loads.h - what a scene says under rod.loads, numbers and formulas, and what these are at a time: on a curve, and in the p of
 * a discrete rod. */
#pragma once
#include "model/build.h"
#include "rod/front/scene.h"
#include "rod/rod.h"

/* Three numbers, or formulas of them. */
typedef struct LoadVector {
    Vec3 value;
    Formula *formula; /* owned; NULL: the value */
} LoadVector;

typedef struct RodLoad {
    double point;             /* m; INFINITY: the end; NAN: all along */
    LoadVector line;          /* N/m; of rod_place_variables          */
    LoadVector force, couple; /* N, N m; of t                         */
} RodLoad;

typedef struct RodLoadList {
    int count;
    RodLoad *items;           /* owned                                                   */
    RodPotentials potentials; /* owned                                                   */
    bool couples, timed;      /* are there any; does any but a potential depend on time? */
    bool along;               /* are there any by formula of where on the rod?           */
    bool placed;              /* do any depend on where the rod is?                      */
} RodLoadList;

/* size: m, on which potentials vary. `known`: so is the place of the rod, of which line loads may then be formulas. False
 * after a refusal. */
bool rod_loads_read(const RodScene *scene, const Build *b, double size, bool known, RodLoadList *list);
void rod_loads_clear(RodLoadList *list);

/* What is the same all along, without weight, and what acts at points, points[count]: into loads, which borrows them. False and
 * a sentence where a formula is not finite. */
bool rod_loads_at(const RodLoadList *list, double time, RodPointLoad *points, RodLoads *loads, Error *err);

/* What varies along a rod, along[2 elements + 1] N/m; where it lies on a curve (not NULL), with the forces of potentials. */
bool rod_loads_along(const RodLoadList *list, int elements, double length, const RodCurve *curve, double time,
                     Vec3 *along, Error *err);

/* Those of a stage or case in place of all of them into p. False after a refusal. */
bool rod_loads_put_dead(const Rod *rod, const Build *b, const char *at, const LoadScene *loads, int count,
                        double *p);

/* Are there couples among those of stages and cases? */
bool rod_loads_couple(const Scene *scene);

/* All into p, but for weight; curves[strands]: where line loads know the rod to be (NULL: nowhere). */
bool rod_loads_put(const RodLoadList *list, const Rod *rod, const RodCurve *curves, double time, double *p,
                   Error *err);
