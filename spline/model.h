/* model.h - the strokes of a drawing as dofs of a System: dof 4 node + i is number i of (p.x, p.y, v.x, v.y)
 * of a node (strokes.h). */
#pragma once
#include "base/workers.h"
#include "spline/rule.h"
#include "spline/strokes.h"
#include "spline/target.h"
#include "spline/weights.h"

typedef enum PairKernel {
    PAIR_WENDLAND,  /* (1 - d/R)^4 (4 d/R + 1): C2, positive definite */
    PAIR_TRIWEIGHT, /* (1 - d^2/R^2)^3                                */
    PAIR_COULOMB,   /* R/d, everywhere, between different strokes only [Linewise, as printed] */
} PairKernel;

typedef struct SplineModelDef {
    int points;             /* of quadrature in a segment, 3, 4, 5 or 8; default 4   */
    PairKernel pair_kernel; /* default PAIR_WENDLAND                                 */
    double pair_radius;     /* R of it, in mean line distances; default 1.6          */
    Workers *workers;       /* borrowed; NULL: one thread                            */
} SplineModelDef;

SplineModelDef spline_model_default(void);

typedef struct SplineModel {
    const SplineTarget *target; /* borrowed */
    Workers *workers;
    int stroke_count, node_count, segment_count;
    int *start;              /* [stroke_count + 1] first node of each stroke                    */
    int *segment_node;       /* [segment_count] first node of each segment                      */
    int group_count;         /* of whole strokes with about as many segments each, for threads  */
    int *group;              /* [group_count + 1] first stroke of each                          */
    double *rest;            /* [segment_count] L0                                              */
    Pack *rest_pack;         /* the same in packs, as TermOps count them                        */
    SplineRule rule;         /* quadrature of the energies                                      */
    SplineRule wall_rule;    /* the hull's                                                      */
    SplineRule outline_rule; /* places half a pen apart, where there is an outline           */
    PairKernel pair_kernel;
    double pair_radius, pair_reach; /* R, and where the kernel ends: units of the page */
} SplineModel;

/* Copies the layout; rest[segments] is L0 of each segment. */
SplineModel *spline_model_create(const SplineTarget *target, const Strokes *strokes, const double *rest,
                                 const SplineModelDef *def);
void spline_model_destroy(SplineModel *model);

/* First segment of a stroke, also of the one after the last: segments count through all strokes. */
static inline int spline_first_segment(const SplineModel *model, int stroke)
{
    return model->start[stroke] - stroke;
}
