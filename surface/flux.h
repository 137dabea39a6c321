/* flux.h - the flux density at a pack of points, with its derivatives in space: a uniform part and fields, each with
 * a factor of its own. */
#pragma once
#include "base/pack_mat.h"
#include "surface/flux_field.h"

typedef struct Flux {
    Pack3 B;
    PackMat gradient;     /* rows k: dB_k/dx              */
    PackMat curvature[3]; /* [k]: d2B_k/dx dx             */
} Flux;

/* A uniform one, B[3]. */
Flux flux_uniform(const double *B);

/* One field's part at x, before its factor. */
Flux flux_of_field(const FluxField *field, Pack3 x, double time);

/* The numbers of which a flux density is the sum: uniform[3] in T, and a factor for each field. */
typedef struct FluxNumbers {
    const double *uniform, *factor;
} FluxNumbers;

/* The sum at x. Fields whose factor is 0 are not evaluated. */
Flux flux_at(const FluxFields *fields, FluxNumbers numbers, Pack3 x, double time);
