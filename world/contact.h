/* contact.h - contact of a body with obstacles: a penalty on depth, and friction.
 *
 * At a sample s (samples.h) of gap phi the depth is d = offset - phi, and the energy [C2: its force begins as a square]
 *
 *     E = 0 | k d^3/(6 e) | k (d^2/2 - e d/2 + e^2/6)     for d <= 0 | 0 < d < e | d >= e,    N = dE/dd,
 *
 * so that what is pressed by N sinks in by N/k + e/2. Energies of several obstacles are summed. Where the body's outside is
 * not the same everywhere, each sample has its own offset, and e is the same part of it.
 *
 * Friction is the incremental potential dt mu N |grad phi| f0(|u|/dt), u the part of the sample's motion in the step that
 * is tangential to the obstacle and beyond the obstacle's own; f0' is 1 from the slip speed v on and 2 y/v - y^2/v^2 below
 * it [Li et al. 2020, IPC]. N, the normal and the place on the obstacle are lagged (Point.x_lag): each step is a minimisation.
 * What sticks creeps, by less than the slip speed.
 *
 * Steps, and trials that did not come along them, end where a sample is half a thickness (of a rod half a radius) deep: what flies at a thin obstacle
 * does not pass through it in one step, as far as its samples meet it. A trial that would have to be pulled back so is not
 * finite where that would move held vertices, or positions that follow from other dofs.
 *
 * What obstacles that are thin or fast go through in a step (pierce.h) is asked for at its end. */
#pragma once
#include "world/obstacle.h"
#include "world/outside.h"

typedef struct ContactDef {
    const Obstacle *obstacles; /* borrowed, as long as the terms */
    int obstacle_count;
    Samples samples; /* copied                                              */
    Samples
        faces; /* of the body, or a rod's elements, that nothing is to go through; copied; count 0: not asked */
    int vertex_count;       /* of the body                                         */
    const bool *fixed;      /* [3*vertex_count] held; borrowed; NULL: nothing      */
    bool derived;           /* positions follow from other dofs, a rod's from its turns */
    double offset;          /* m, from the sample to the body's outside: half a thickness; the largest */
    double smoothing;       /* m, e there                                          */
    const Outside *outside; /* [sample] its own offset; borrowed; NULL: all have the largest */
    double slip_speed;      /* m/s                                                 */
    int stiffness;          /* first entries in p: k, N/m;                         */
    int friction;           /* mu of each obstacle                                 */
} ContactDef;

Term contact_term(const ContactDef *def);
Term friction_term(const ContactDef *def);

/* What a body feels of obstacles at a point, over the samples of a def: added to what is there. */
typedef struct ContactSums {
    double touching;    /* samples that touch                                            */
    double depth;       /* m, the deepest one                                            */
    double friction;    /* J, what friction has taken in the step                        */
    double (*force)[3]; /* [obstacle] N on the body, normal and friction; may be NULL    */
    double *point;      /* [dofs] N on the body; may be NULL                             */
} ContactSums;

void contact_measure(const ContactDef *def, const Point *at, ContactSums *sums);
