/* membrane.h - the stretching energy of a thin layer: a shell's, or a film on a solid's skin. */
#pragma once
#include "solve/term.h"
#include "surface/face.h"

/* In the order of the scene's keys `material`. */
typedef enum MembraneMaterial {
    MEMBRANE_ST_VENANT_KIRCHHOFF, /* resists being crushed less and less: energy finite without area */
    MEMBRANE_NEO_HOOKEAN,         /* incompressible for a Poisson's ratio of 1/2                     */
} MembraneMaterial;

typedef struct MembraneDef {
    MembraneMaterial material;
    double poisson;
    int young; /* first entry in p of [row] Pa */
} MembraneDef;

/* Is a face with that part of its area at rest none any more? A twentieth and less, of St. Venant-Kirchhoff, which may be at rest
 * and stable without any: where a face is free across, pulled to a Green strain of 1/(2 nu). Never of neo-Hookean, which has no
 * energy there. */
bool membrane_is_crushed(MembraneMaterial material, double area);

/* Takes the layer. Where steps turn (TermOps.follow), its Hessian heeds Point.x_from. */
Term membrane_term(FaceLayer layer, const MembraneDef *def);

/* Symmetric, in the two axes of face_gradients. */
typedef struct PlaneTensor {
    double xx, xy, yy;
} PlaneTensor;

/* Both principal values, the larger one first. */
void plane_principal(PlaneTensor t, double value[2]);

/* Green's strain of a face, (F^T F - 1)/2. */
PlaneTensor membrane_strain(double (*rest)[3], const double *x, const int *face);

/* Von Mises' stress, of Cauchy's, that a material in plane stress has at Green's strain, over Young's modulus; NAN where
 * nothing is left of the area, or of the thickness. */
double membrane_von_mises(MembraneMaterial material, double poisson, PlaneTensor strain);
