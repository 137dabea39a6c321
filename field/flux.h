/* flux.h - the flux density at a pack of points, with its derivatives in space: a uniform part and fields, which are stronger
 * or weaker, moved and turned by numbers of p. */
#pragma once
#include "base/pack_mat.h"
#include "field/flux_field.h"
#include "solve/params.h"

/* First entries in p of what a flux density follows from. */
typedef struct FluxBlocks {
    int uniform;  /* flux_density [3] T                                                            */
    int scale;    /* field_scale [field]: 1 where a load case has it, else 0                       */
    int strength; /* source_strength [field]: factors, 1 as the scene has it                       */
    int move;     /* source_move [field][3] m, beyond where the scene has it at the time           */
    int turn;     /* source_turn [field][3] rad, a rotation vector about its middle, after its own */
} FluxBlocks;

/* Adds those of the fields; uniform is there. */
FluxBlocks flux_blocks_add(Params *params, const FluxFields *fields, int uniform);

/* All fields as they are: scales and strengths 1. */
void flux_blocks_default(const FluxFields *fields, const FluxBlocks *blocks, double *p);

typedef struct Flux {
    Pack3 B;
    PackMat gradient;     /* rows k: dB_k/dx              */
    PackMat curvature[3]; /* [k]: d2B_k/dx dx             */
} Flux;

/* A uniform one, B[3]. */
Flux flux_uniform(const double *B);

/* What a flux density is at some time, with numbers p. */
typedef struct FluxSum {
    const FluxFields *fields;
    FluxBlocks blocks;
    const double *p;
    double time;
} FluxSum;

/* The sum at x. Fields whose factor is 0 are not evaluated. */
Flux flux_at(FluxSum sum, Pack3 x);

/* How it changes with p by dp; its curvature is not known. */
Flux flux_change(FluxSum sum, const double *dp, Pack3 x);

/* How weight (a.B + Q.(G b)) at x changes with p is added to dp, of so many lanes. */
typedef struct FluxWork {
    Pack weight;
    Pack3 x, a, Q, b;
} FluxWork;

void flux_add_param(FluxSum sum, const FluxWork *work, int lanes, double *dp);

/* The value alone, at one point. */
void flux_value(FluxSum sum, const double x[3], double flux[3]);
