/* design.h - which parameters are unknown: the map between the optimiser's scaled vector u and the blocks of p.
 *
 * An unknown is a block of p, one row per face (or edge, ...) or one row per group of them, the same in all
 * load cases or one for each. Its values are scaled before an optimiser sees them:
 *
 *     linear   p = scale u
 *     log      p = exp(scale u)
 *     fixed    p = limit u/|u|                               (|.| over a row)
 *     capped   p = scale u/sqrt(1 + |scale u|^2/limit^2) */
#pragma once
#include "solve/params.h"

typedef enum UnknownMap {
    UNKNOWN_LINEAR,
    UNKNOWN_LOG,
    UNKNOWN_FIXED_LENGTH,
    UNKNOWN_CAPPED_LENGTH
} UnknownMap;

typedef struct Unknown {
    const ParamBlock *block; /* borrowed                                                 */
    int group_count;         /* rows of u                                                */
    int *group;              /* [block->count] which row of u, -1: stays as it is; owned */
    UnknownMap map;
    double scale, limit;
    double lower, upper; /* bounds of p, -/+INFINITY: none; not for the two lengths */
    bool per_case;
    bool auxiliary; /* an objective's own, none that the user asks for */
    int first;      /* first entry in u (of case 0); set by design_add */
} Unknown;

enum { DESIGN_MAX_UNKNOWNS = 12 };

typedef struct Design {
    int case_count, unknown_count, size; /* size of u */
    Unknown unknowns[DESIGN_MAX_UNKNOWNS];
} Design;

/* Takes unknown->group. group NULL: a row of u for every row of the block. */
void design_add(Design *design, Unknown unknown);
void design_clear(Design *design);

/* Writes the unknown blocks into p of that case. */
void design_apply(const Design *design, int load_case, const double *u, double *p);

/* u from p: the inverse of apply; rows of one group take the mean. */
void design_read(const Design *design, int load_case, const double *p, double *u);

/* dp = (dp/du) du (unknown blocks only), and du += (dp/du)^T dp. */
void design_forward(const Design *design, int load_case, const double *u, const double *du, double *dp);
void design_transpose(const Design *design, int load_case, const double *u, const double *dp, double *du);

/* Bounds of u. */
void design_bounds(const Design *design, double *lower, double *upper);
