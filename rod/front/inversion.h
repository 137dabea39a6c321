/* inversion.h - what the files of job: invert share: the job and its result (job_invert.c), and the discrete rods that rest on
 * the curves (discrete.c). */
#pragma once
#include "job/run.h"
#include "rod/front/front.h"

/* Everything about all strands, one after the other: nodes N + 1 and elements N each. */
typedef struct Inversion {
    int lost; /* natural shapes that are not finite */
    Run *run;
    const RodModel *rm;
    RodLoads *loads; /* [strands] what acts on each curve, its last end's support included */
    int strands, elements, nodes;
    double *s, *curvature, *torsion;                                     /* [strands*nodes]               */
    double *input, *natural, *natural_strain, *moment, *strain_elements; /* [strands*nodes][3], ..    */
    double *tangent, *n1, *n2, *strain, *force;                          /* of the input                  */
    double *x;                                                           /* simulated; NULL: not asked for */
    double *lowest, *critical_young, *tail, *contact, *round_trip, *residual, *route; /* [strands]     */
    double *gain; /* [strands] energy at the curve less that where the simulated rod rests, J */
    int *stable, *index, *touching; /* [strands]     */
    double spread;                  /* rms, of a moving rod's natural strains over time, 1/m */
    int pair_count;
    int *pairs;     /* [pair_count][3] strand, elements */
    double lengths; /* of the longest element, in bending lengths (stability.h) */
    NewtonStatus worst;
} Inversion;

bool inversion_asks(const Scene *scene, SceneCheck check);

/* Of vectors of all nodes those of a strand. */
static inline Vec3 *inversion_strand(const Inversion *o, double *all, int k)
{
    return (Vec3 *)(all + 3 * (size_t)k * (size_t)o->nodes);
}

/* The discrete rod that rests on curve k: its natural strains, what is left of forces; where it is asked for, whether it is
 * stable between held ends, and where it comes to rest when it is let down from its natural shape. */
void inversion_elements(Inversion *o, int k);
